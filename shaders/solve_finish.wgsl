// coupled_solve, vector ends: the full right-hand side that the tolerance refers to, and X = X* + D at the end.
#include "shared/params.wgsl"
#include "shared/pcg_result.wgsl"
#include "shared/thread.wgsl"

@group(0) @binding(1) var<storage, read_write> pressure: array<f32>;
@group(0) @binding(2) var<storage, read> stiffness: array<f32>;
@group(0) @binding(3) var<storage, read> residual: array<f32>;
@group(0) @binding(4) var<storage, read_write> product: array<f32>;
@group(0) @binding(5) var<storage, read> solution: array<f32>;
@group(0) @binding(6) var<storage, read> direction: array<f32>;
@group(0) @binding(7) var<storage, read> pcg: PcgResult;

fn unknowns() -> u32 { return params.slots + 2u * params.extra_capacity; }

// S^-1 X* plus the increment's right-hand side: the size of what the full form would have on its right.
@compute @workgroup_size(WORKGROUP)
fn solve_reference(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                   @builtin(local_invocation_index) lane: u32) {
    for (var i = thread_index(group, groups, lane); i < unknowns(); i += groups.x * groups.y * WORKGROUP) {
        product[i] = stiffness[i] * pressure[i] + residual[i];
    }
}

@compute @workgroup_size(WORKGROUP)
fn solve_add(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
             @builtin(local_invocation_index) lane: u32) {
    for (var i = thread_index(group, groups, lane); i < unknowns(); i += groups.x * groups.y * WORKGROUP) {
        pressure[i] += solution[i] + pcg.alpha * direction[i];
    }
}
