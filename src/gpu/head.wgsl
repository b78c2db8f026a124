// Index of a thread in a flat dispatch of any length.

// Workgroups are counted along x, MAX_GROUPS to a row, then along y; WORKGROUP and MAX_GROUPS come from Rust. No kernel asks for the
// number of workgroups: DirectX 12 does not tell it in indirect dispatches. The result may exceed the last element: every kernel
// compares it with its count.
fn group_index(workgroup: vec3u) -> u32 { return workgroup.y * MAX_GROUPS + workgroup.x; }

fn thread_index(workgroup: vec3u, local: u32) -> u32 { return group_index(workgroup) * WORKGROUP + local; }

fn groups_of(threads: u32) -> u32 { return (threads + WORKGROUP - 1u) / WORKGROUP; }

// Turns of a loop that stands for a condition: `for (var turn = 0u; turn < when(condition); turn++)`. On a CPU the threads of an octet run in
// step and compute both sides of an `if`, but skip a loop that none of them enters. In bodies' kernels that is worth a quarter of a step and
// more (docs/notes/software_kernels.md). Not measured on a GPU.
fn when(condition: bool) -> u32 { return u32(condition); }
