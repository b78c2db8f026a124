// Index of a thread in a flat dispatch of any length.

// Workgroups are counted along x, MAX_GROUPS to a row, then along y; WORKGROUP and MAX_GROUPS come from Rust. No kernel asks for the
// number of workgroups: DirectX 12 does not tell it in indirect dispatches. The result may exceed the last element: every kernel
// compares it with its count.
fn group_index(workgroup: vec3u) -> u32 { return workgroup.y * MAX_GROUPS + workgroup.x; }

fn thread_index(workgroup: vec3u, local: u32) -> u32 { return group_index(workgroup) * WORKGROUP + local; }

fn groups_of(threads: u32) -> u32 { return (threads + WORKGROUP - 1u) / WORKGROUP; }

// The same for work that lies close together, in one part of the domain or of a list: neighbouring workgroups take it from everywhere.
// A software driver gives each of its threads as many workgroups in a row, and one of them would get most of the work.
fn spread_index(workgroup: vec3u, local: u32, threads: u32) -> u32 {
    let first = group_index(workgroup);
    let all = max(groups_of(threads), 1u);
    return select(first * STRIDE % all, first, first >= all || all % STRIDE == 0u) * WORKGROUP + local;
}

// A prime: every workgroup has its turn where their number is no multiple of it.
const STRIDE = 97u;

// The same with octets of threads, which run in step on a CPU, in place of workgroups.
fn octet_index(workgroup: vec3u, local: u32, threads: u32) -> u32 {
    let first = group_index(workgroup);
    let all = groups_of(threads);
    if first >= all { return first * WORKGROUP + local; }
    return OCTET * (local / OCTET * all + first) + local % OCTET;
}
