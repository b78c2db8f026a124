// Index of a thread in a flat dispatch of any length.

// Workgroups are counted along x, then y, then z, because one axis holds 65535 at most; WORKGROUP comes from Rust.
// The result may exceed the last element: every kernel compares it with its count.
fn thread_index(workgroup: vec3u, groups: vec3u, local: u32) -> u32 {
    return ((workgroup.z * groups.y + workgroup.y) * groups.x + workgroup.x) * WORKGROUP + local;
}

// The same for work that lies close together, in one part of the domain or of a list: neighbouring workgroups take it from everywhere.
// A software driver gives each of its threads as many workgroups in a row, and one of them would get most of the work.
fn spread_index(workgroup: vec3u, groups: vec3u, local: u32) -> u32 {
    let first = thread_index(workgroup, groups, 0u) / WORKGROUP;
    let all = groups.x * groups.y * groups.z;
    return select(first * STRIDE % all, first, all % STRIDE == 0u) * WORKGROUP + local;
}

// A prime: every workgroup has its turn where their number is no multiple of it.
const STRIDE = 97u;

// The same with octets of threads, which run in step on a CPU, in place of workgroups.
fn octet_index(workgroup: vec3u, groups: vec3u, local: u32) -> u32 {
    let first = thread_index(workgroup, groups, 0u) / WORKGROUP;
    return OCTET * (local / OCTET * groups.x * groups.y * groups.z + first) + local % OCTET;
}

const OCTET = 8u;
