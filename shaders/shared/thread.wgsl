// Index of a thread in a flat dispatch of any length.

// Workgroups are counted along x, then y, then z, because one axis holds 65535 at most; WORKGROUP comes from Rust.
// The result may exceed the last element: every kernel compares it with its count.
fn thread_index(workgroup: vec3u, groups: vec3u, local: u32) -> u32 {
    return ((workgroup.z * groups.y + workgroup.y) * groups.x + workgroup.x) * WORKGROUP + local;
}

// Neighbours that run in step on a CPU.
const OCTET = 8u;

// The same, with neighbouring octets in different workgroups: where work lies close together, no workgroup has all of it.
fn spread_index(workgroup: vec3u, groups: vec3u, local: u32) -> u32 {
    let first = thread_index(workgroup, groups, 0u) / WORKGROUP;
    return OCTET * (local / OCTET * groups.x * groups.y * groups.z + first) + local % OCTET;
}
