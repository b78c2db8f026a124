// Pressures of faces, and their power. Needs the bindings cells, extra, pressure, control, node and work.
#include "shared/open_side.wgsl"
#include "shared/system.wgsl"

// -- Pressure --

// Mean pressures of the faces of gas cells: what the gas update takes as the force there.

// Slots of the vertices of a face across axis n whose low corner is `low`; along an inactive axis each is met twice.
fn face_vertices(low: vec3i, n: u32) -> vec4u {
    let a = axis((n + 1u) % 3u) * reach();
    let b = axis((n + 2u) % 3u) * reach();
    return vec4u(slot_of(low), slot_of(low + a), slot_of(low + b), slot_of(low + a + b));
}

// Where these vertices keep the pressure between gas and body.
fn interface_indices(at: vec4u) -> vec4u {
    return vec4u(interface_index(at.x), interface_index(at.y), interface_index(at.z), interface_index(at.w));
}

// Pressure of the face of GAS cell c across axis n: mean of its vertices; for B2B1 inside the gas the finite-element mean,
// p * (1,4,1)/6 along the axis and (1,11,11,1)/24 across, without which short waves grow for c dt > 2 dx.
fn face_pressure(c: vec3i, n: u32, up: bool, beyond: u32) -> f32 {
    let low = select(c, c + axis(n), up);
    let between_gas = beyond == GAS || is_image(select(c - axis(n), c + axis(n), up));
    if QUADRATIC && between_gas && wide_face_is_gas(low, n) { return wide_face_pressure(low, n); }
    if CUT && beyond != SOLID { return open_part_pressure(c, n, up); }
    var at = face_vertices(low, n);
    for (var turn = 0u; turn < when(SOLIDS && beyond == SOLID); turn++) { at = interface_indices(at); }
    return mean2(mean2(pressure[at.x], pressure[at.y]), mean2(pressure[at.z], pressure[at.w]));
}

fn wide_range(n: u32) -> array<vec3i, 2> {
    return array<vec3i, 2>(select(-reach(), vec3i(-1), along(n)), select(2 * reach(), vec3i(1), along(n)));
}

fn wide_face_is_gas(low: vec3i, n: u32) -> bool {
    let range = wide_range(n);
    for (var z = range[0].z; z <= range[1].z; z++) {
        for (var y = range[0].y; y <= range[1].y; y++) {
            for (var x = range[0].x; x <= range[1].x; x++) {
                let v = mirrored_vertex(low + vec3i(x, y, z));
                if !is_vertex(v) || !has(cells[slot_of(v)], VERTEX_GAS) { return false; }
            }
        }
    }
    return true;
}

// (1, 4, 1) / 6 of the vertices along axis n, by differences from `reference`.
fn face_line(middle: vec3i, n: u32, reference: f32) -> f32 {
    let below = pressure[slot_of(mirrored_vertex(middle - axis(n)))] - reference;
    let above = pressure[slot_of(mirrored_vertex(middle + axis(n)))] - reference;
    return rounded((below + above) / 6.0) + rounded(2.0 / 3.0 * (pressure[slot_of(mirrored_vertex(middle))] - reference));
}

// (1, 11, 11, 1) / 24 across; an inactive axis has one layer.
fn across_weights(a: u32) -> vec4f { return select(vec4f(0.0, 1.0, 0.0, 0.0), vec4f(1.0, 11.0, 11.0, 1.0) / 24.0, a < DIM); }

// By differences, so that a constant pressure stays constant, from the highest in the middle, and from both ends alike.
fn wide_face_pressure(low: vec3i, n: u32) -> f32 {
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    let at = face_vertices(low, n);
    let reference = max(max(pressure[at.x], pressure[at.y]), max(pressure[at.z], pressure[at.w]));
    var rows: vec4f;
    for (var k = -reach()[b]; k <= 2 * reach()[b]; k++) {
        var lines: vec4f;
        for (var j = -reach()[a]; j <= 2 * reach()[a]; j++) {
            lines = select(lines, vec4f(face_line(low + j * axis(a) + k * axis(b), n, reference)), vec4i(-1, 0, 1, 2) == vec4i(j));
        }
        rows = select(rows, vec4f(paired(lines * across_weights(a))), vec4i(-1, 0, 1, 2) == vec4i(k));
    }
    return reference + paired(rows * across_weights(b));
}

// Mean pressure of the low face of a cell deep inside the gas.
fn interior_face(at: u32, n: u32) -> f32 {
    if QUADRATIC { return wide_face_pressure(cell_of(at), n); }
    let t = across(n);
    if DIM == 1u { return pressure[at]; }
    if DIM == 2u { return mean2(pressure[at], pressure[at + t.x + t.y]); }
    return 0.25 * (pressure[at] + pressure[at + t.x] + pressure[at + t.y] + pressure[at + t.x + t.y]);
}

// -- Power --

// Power between gas and body through the faces of the interface.

// Means of the low and the high vertex of an axis on the node of a body at an offset from the cell between them.
fn means_of(a: u32, offset: i32) -> vec2f {
    if a >= DIM { return vec2f(1.0, 0.0); }
    return vec2f(mean_entry(true, offset, false), mean_entry(true, offset, true));
}

// Velocity of a node of a body after the solve; the mean of that and of the one that it came with, without its reaction to the
// load [elastic_reaction.wgsl]. With SHARED_VOLUME the solve starts from a predicted velocity, and the prediction is no motion.
fn body_velocity(at: u32, n: u32) -> f32 {
    return node[at][n] - select(0.5, 1.0, SHARED_VOLUME) * control.dt * work[part(SOLID_NODE, at)][n];
}

// Power through a face between gas and solid: what the solid receives.
fn interface_power(c: vec3i, n: u32, up: bool) -> f32 {
    let beyond = select(c - axis(n), c + axis(n), up);
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    let at = interface_indices(face_vertices(select(c, beyond, up), n));
    let p = vec4f(pressure[at.x], pressure[at.y], pressure[at.z], pressure[at.w]);
    var power = 0.0;
    for (var k = -reach()[b]; k <= reach()[b]; k++) {
        let mean_b = means_of(b, k);
        for (var j = -reach()[a]; j <= reach()[a]; j++) {
            let mean_a = means_of(a, j);
            let mean = dot(mean_b, vec2f(dot(mean_a, p.xy), dot(mean_a, p.zw)));
            let away = j * axis(a) + k * axis(b);
            // A face takes a half from each of the nodes across it.
            power += 0.5 * mean * (body_velocity(slot_of(c + away), n) + body_velocity(slot_of(beyond + away), n));
        }
    }
    return power;
}
