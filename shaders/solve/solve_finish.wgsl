// coupled_solve, end: X = X* + D.
#include "shared/index.wgsl"
#include "shared/pcg.wgsl"

@group(0) @binding(1) var<storage, read_write> pressure: array<f32>;
@group(0) @binding(5) var<storage, read> solution: array<f32>;
@group(0) @binding(6) var<storage, read> direction: array<f32>;

@compute @workgroup_size(WORKGROUP)
fn solve_add(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var i = thread_index(group, lane); i < unknowns(); i += striding_threads()) {
        pressure[i] += solution[i] + pcg.alpha * direction[i];
    }
}
