// Copies an array: what a kernel that does nothing but move memory reaches, the yardstick of `brisance bench`.
// Equation: to[i] = from[i]. Reads: from. Writes: to, of the same length.

@group(0) @binding(0) var<storage, read> from_here: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> to_there: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn copy(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let i = thread_index(group, lane);
    if i < arrayLength(&to_there) { to_there[i] = from_here[i]; }
}
