// coupled_solve, B1B0 deep inside the gas: the whole operator of a vertex at once, forces and their transpose, without storing
// node velocities. A node between the vertices u gives its vertex v
//   (C^T M^-1 C x)_v = 1 / (M 4^(DIM-1)) sum over u of (axes on which u and v lie on the same side - axes on which not) x_u.
// Reads x, inverse node masses (last third of energy), stiffness, diagonal. Writes right-hand side and diagonal, or product.
#include "shared/index.wgsl"
#include "shared/cell.wgsl"
#include "shared/gas.wgsl"
#include "shared/control.wgsl"
#include "shared/reduce4.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;
@group(0) @binding(5) var<storage, read> x: array<f32>;
@group(0) @binding(6) var<storage, read> stiffness: array<f32>;
@group(0) @binding(7) var<storage, read_write> y: array<f32>;
@group(0) @binding(8) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(9) var<storage, read_write> inverse_diagonal: array<f32>;

fn inverse_mass(at: u32) -> f32 { return energy[2u * params.slots + at]; }

// The four values around `at` in a plane, at (-x, -y), (+x, -y), (-x, +y), (+x, +y).
fn diagonals(at: u32) -> vec4f {
    let y = params.stride.x;
    return vec4f(x[at - 1u - y], x[at + 1u - y], x[at - 1u + y], x[at + 1u + y]);
}

// Inverse masses of the four nodes around a vertex in the layer of node `at`, in the same order.
fn masses(at: u32) -> vec4f {
    let y = params.stride.x;
    return vec4f(inverse_mass(at - 1u - y), inverse_mass(at - y), inverse_mass(at - 1u), inverse_mass(at));
}

// Values along x and y around `at` that a corner shares an edge with, summed per diagonal direction.
fn edges(at: u32) -> vec4f {
    let y = params.stride.x;
    return x[at - y] * vec4f(1.0, 1.0, 0.0, 0.0) + x[at + y] * vec4f(0.0, 0.0, 1.0, 1.0)
        + x[at - 1u] * vec4f(1.0, 0.0, 1.0, 0.0) + x[at + 1u] * vec4f(0.0, 1.0, 0.0, 1.0);
}

// C^T M^-1 C x at a vertex with value `own`, in units of face_area()^2, and the sum of the inverse masses around it.
fn operator_at(at: u32, own: f32) -> vec2f {
    if DIM == 1u {
        let low = inverse_mass(at - 1u);
        let high = inverse_mass(at);
        return vec2f(low * (own - x[at - 1u]) + high * (own - x[at + 1u]), low + high);
    }
    let above = masses(at);
    if DIM == 2u { return vec2f(0.5 * dot(above, own - diagonals(at)), dot(above, vec4f(1.0))); }
    let z = params.stride.x * params.stride.y;
    let below = masses(at - z);
    // Differences, so that a constant pressure moves nothing: its terms do not leave their rounding behind.
    let beside = edges(at);
    let around = diagonals(at);
    let low = 3.0 * (own - diagonals(at - z)) + (beside - edges(at - z)) + (x[at - z] - around);
    let high = 3.0 * (own - diagonals(at + z)) + (beside - edges(at + z)) + (x[at + z] - around);
    return vec2f(0.0625 * (dot(below, low) + dot(above, high)), dot(below + above, vec4f(1.0)));
}

// C^T V at a vertex in units of face_area(), V the velocities of the gas cells.
fn divergence(at: u32) -> f32 {
    let y = params.stride.x;
    let z = params.stride.x * params.stride.y;
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let o = vec3u(corner_offset(k));
        let v = velocity_of(conserved[at - o.x - y * o.y - z * o.z]);
        sum += dot(v * vec3f(reach()), 2.0 * vec3f(o) - 1.0);
    }
    return sum / f32(1u << (DIM - 1u));
}

// Right-hand side dt C^T (V* - dt M^-1 C X*) and inverse diagonal.
@compute @workgroup_size(WORKGROUP)
fn interior_setup(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots || !has(cells[slot], INTERIOR) { return; }
    let scale = control.dt * face_area();
    let of_pressure = operator_at(slot, x[slot]);
    y[slot] = scale * (divergence(slot) - scale * of_pressure.x);
    let square = f32(DIM) / f32(1u << (2u * (DIM - 1u)));
    inverse_diagonal[slot] = 1.0 / (stiffness[slot] + scale * scale * square * of_pressure.y);
}

// y = S^-1 x + dt^2 C^T M^-1 C x; adds to the partial sums of x . y that the listed form has left. Without bodies also those of
// y . D^-1 y, of the listed vertices, too: they have their y by now.
@compute @workgroup_size(WORKGROUP)
fn interior_operator(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                     @builtin(local_invocation_index) lane: u32) {
    let scale = control.dt * face_area();
    var product = 0.0;
    var image = 0.0;
    for (var slot = thread_index(group, groups, lane); slot < params.slots; slot += groups.x * groups.y * WORKGROUP) {
        if !has(cells[slot], INTERIOR) {
            if !SOLIDS { image += y[slot] * y[slot] * inverse_diagonal[slot]; }
            continue;
        }
        let own = x[slot];
        let value = stiffness[slot] * own + scale * scale * operator_at(slot, own).x;
        y[slot] = value;
        product += own * value;
        if !SOLIDS { image += value * value * inverse_diagonal[slot]; }
    }
    let sum = workgroup_sum4(lane, vec4f(product, image, 0.0, 0.0));
    if lane == 0u { partials[thread_index(group, groups, 0u) / WORKGROUP] += sum; }
}
