// coupled_solve, B1B0 deep inside the gas: the whole operator of a vertex at once, forces and their transpose, without storing
// node velocities. A node between the vertices u gives its vertex v
//   (C^T M^-1 C x)_v = 1 / (M 4^(DIM-1)) sum over u of (axes on which u and v lie on the same side - axes on which not) x_u.
// Reads x, inverse node masses, stiffness, diagonal. Writes right-hand side or product.
#include "shared/domain.wgsl"
#include "shared/pcg.wgsl"
#include "shared/reduce.wgsl"
#include "solve/interior_mass.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;
@group(0) @binding(5) var<storage, read> x: array<f32>;
@group(0) @binding(6) var<storage, read> stiffness: array<f32>;
@group(0) @binding(7) var<storage, read_write> y: array<f32>;
@group(0) @binding(8) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(9) var<storage, read> inverse_diagonal: array<f32>;
@group(0) @binding(10) var<storage, read> extra: array<u32>;

// The four values around `at` in a plane, at (-x, -y), (+x, -y), (-x, +y), (+x, +y).
fn diagonals(at: u32) -> vec4f {
    let y = params.stride.x;
    return vec4f(x[at - 1u - y], x[at + 1u - y], x[at - 1u + y], x[at + 1u + y]);
}

// Values along x and y around `at` that a corner shares an edge with, summed per diagonal direction.
fn edges(at: u32) -> vec4f {
    let y = params.stride.x;
    return x[at - y] * vec4f(1.0, 1.0, 0.0, 0.0) + x[at + y] * vec4f(0.0, 0.0, 1.0, 1.0)
        + x[at - 1u] * vec4f(1.0, 0.0, 1.0, 0.0) + x[at + 1u] * vec4f(0.0, 1.0, 0.0, 1.0);
}

// C^T M^-1 C x at a vertex with value `own`, in units of face_area()^2.
fn operator_at(at: u32, own: f32) -> f32 {
    if DIM == 1u { return inverse_mass(at - 1u) * (own - x[at - 1u]) + inverse_mass(at) * (own - x[at + 1u]); }
    let above = masses(at);
    if DIM == 2u {
        let flows = rounded4(above * (own - diagonals(at)));
        return 0.5 * ((flows.x + flows.w) + (flows.y + flows.z));
    }
    let z = params.stride.x * params.stride.y;
    let below = masses(at - z);
    // Differences, so that a constant pressure moves nothing: its terms do not leave their rounding behind.
    let beside = edges(at);
    let around = diagonals(at);
    let low = 3.0 * (own - diagonals(at - z)) + (beside - edges(at - z)) + (x[at - z] - around);
    let high = 3.0 * (own - diagonals(at + z)) + (beside - edges(at + z)) + (x[at + z] - around);
    return 0.0625 * (dot(below, low) + dot(above, high));
}

// What the gas of cell `at` takes away from its corner o, of two axes at once.
fn outflow(at: u32, o: vec3u) -> f32 {
    let v = rounded4(vec4f(velocity_of(in_space(conserved[at])) * vec3f(reach()), 0.0)).xyz;
    return dot(v, 2.0 * vec3f(o) - 1.0);
}

// C^T V at a vertex in units of face_area(), V the velocities of the gas cells.
fn divergence(at: u32) -> f32 {
    let y = params.stride.x;
    let z = params.stride.x * params.stride.y;
    var sum = 0.0;
    for (var k = 0u; k < corner_count() / 2u; k++) {
        let o = vec3u(corner_offset(k));
        let p = vec3u(reach()) - o;
        let one = at - o.x - y * o.y - z * o.z;
        let two = at - p.x - y * p.y - z * p.z;
        sum += outflow(one, o) + outflow(two, p);
    }
    return sum / f32(1u << (DIM - 1u));
}

// Right-hand side dt C^T (V* - dt M^-1 C X*).
@compute @workgroup_size(WORKGROUP)
fn interior_setup(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = swept_slot(thread_index(group, lane));
    if slot >= params.slots { return; }
    let scale = control.dt * face_area();
    y[slot] = scale * (divergence(slot) - scale * operator_at(slot, x[slot]));
}

// y = S^-1 x + dt^2 C^T M^-1 C x; adds to the partial sums of x . y that the listed form has left. Without bodies also those of
// y . D^-1 y, of the listed vertices, too: they have their y by now.
@compute @workgroup_size(WORKGROUP)
fn interior_operator(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let scale = control.dt * face_area();
    let thread = thread_index(group, lane);
    var product = 0.0;
    var image = 0.0;
    for (var octet = first_octet(thread, params.groups, params.row); octet.at.y * params.row < params.slots; octet = next_octet(octet)) {
        let slot = element_in(octet, thread, params.row, params.slots);
        if slot >= params.slots { continue; }
        if !has(cells[slot], INTERIOR) {
            if !SOLIDS {
                let listed = y[slot];
                image += listed * listed * inverse_diagonal[slot];
            }
            continue;
        }
        let here = x[slot];
        let value = stiffness[slot] * here + scale * scale * operator_at(slot, here);
        y[slot] = value;
        product += here * value;
        if !SOLIDS { image += value * value * inverse_diagonal[slot]; }
    }
    let sum = workgroup_sum4(lane, vec4f(product, image, 0.0, 0.0));
    if lane == 0u { partials[PARTIALS * BLOCK_DOTS + thread / WORKGROUP] += sum; }
}
