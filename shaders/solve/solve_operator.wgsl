// coupled_solve, second half of the operator: y = S^-1 x + dt^2 C^T (M^-1 C x), and the partial sums of x . y.
#include "shared/system.wgsl"
#include "solve/gather.wgsl"
#include "shared/reduce.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> work: array<vec4f>;
@group(0) @binding(5) var<storage, read> stiffness: array<f32>;
@group(0) @binding(6) var<storage, read> x: array<f32>;
@group(0) @binding(7) var<storage, read_write> y: array<f32>;
@group(0) @binding(8) var<storage, read_write> partials: array<vec4f>;

// y at a vertex; returns its share of x . y.
fn apply(slot: u32) -> f32 {
    let scale = control.dt * control.dt * face_area();
    let rows = gather_rows(slot, cells[slot]);
    let own = stiffness[slot] * x[slot] + scale * rows.own;
    y[slot] = own;
    var product = x[slot] * own;
    let i = interface_index(slot);
    if is_listed() && i != slot {
        let j = ghost_index(slot);
        let h = scale * rows.h;
        let q = stiffness[j] * x[j] + scale * rows.q;
        y[i] = h;
        y[j] = q;
        product += x[i] * h + x[j] * q;
    }
    return product;
}

@compute @workgroup_size(WORKGROUP)
fn solve_operator(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    var product = 0.0;
    if SWEEP == OVER_BOTH {
        for (var k = thread; k < params.slots; k += striding_threads()) {
            let slot = interior_slot(k);
            if slot < params.slots { product += apply(slot); }
        }
    }
    on_list = true;
    for (var k = thread; k < listed(); k += striding_threads()) { product += apply(listed_slot(k)); }
    let sum = workgroup_sum4(lane, vec4f(product, 0.0, 0.0, 0.0));
    if lane == 0u { partials[PARTIALS * BLOCK_DOTS + thread / WORKGROUP] = sum; }
}
