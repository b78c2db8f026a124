// coupled_solve, before the iteration: the size of the full right-hand side S^-1 X* + r, r that of the increment form, which the tolerance
// refers to; and on the way the inverse diagonal deep inside the gas with B1B0.
// Reads stiffness, X*, r, inverse node masses. Writes the inverse diagonal, and partial sums behind those of the iteration.
#include "shared/index.wgsl"
#include "shared/reduce.wgsl"
#include "solve/interior_mass.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> energy: array<f32>;
@group(0) @binding(4) var<storage, read> stiffness: array<f32>;
@group(0) @binding(5) var<storage, read> pressure: array<f32>;
@group(0) @binding(6) var<storage, read> residual: array<f32>;
@group(0) @binding(7) var<storage, read_write> inverse_diagonal: array<f32>;
@group(0) @binding(8) var<storage, read_write> partials: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn solve_reference(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let scale = control.dt * face_area();
    // Of the diagonal of C^T M^-1 C, in units of face_area()^2: a node gives every vertex that it rests on as much.
    let square = scale * scale * f32(DIM) / f32(1u << (2u * (DIM - 1u)));
    var sum = 0.0;
    for (var i = thread_index(group, lane); i < unknowns(); i += striding_threads()) {
        let own = stiffness[i];
        var inverse: f32;
        if !QUADRATIC && i < params.slots && has(cells[min(i, params.slots - 1u)], INTERIOR) {
            inverse = 1.0 / (own + square * mass_sum(i));
            inverse_diagonal[i] = inverse;
        } else {
            inverse = inverse_diagonal[i];
        }
        let whole = own * pressure[i] + residual[i];
        sum += inverse * whole * whole;
    }
    let part = workgroup_sum4(lane, vec4f(0.0, sum, 0.0, 0.0));
    if lane == 0u { partials[PARTIALS * BLOCK_REFERENCE + group_index(group)] = part; }
}
