// Transpose of the forces: C^T of a node field, at one vertex. Needs the bindings cells, extra and work.

#include "shared/domain.wgsl"
#include "solve/mixed.wgsl"

// Rows of one vertex: its own unknown, and h and Q where they are apart.
struct Rows { own: f32, h: f32, q: f32 }

// The transpose of plane_force.
fn plane_rows(slot: u32, v: vec3i) -> f32 {
    let ex = wide_entries_of_vertex(0u, v.x, false);
    let ey = wide_entries_of_vertex(1u, v.y, false);
    var lines: array<mat4x4f, 2>;
    for (var j = 0u; j < 4u; j++) {
        let at = part(GAS_NODE, slot + params.stride.x - params.stride.x * j);
        let line = transpose(mat4x2f(work[at + 1u].xy, work[at].xy, work[at - 1u].xy, work[at - 2u].xy));
        lines[0][j] = line[0];
        lines[1][j] = line[1];
    }
    let columns = transpose(lines[1]);
    var slopes: array<vec4f, 2>;
    for (var j = 0u; j < 4u; j++) {
        slopes[0][j] = paired(ex.slope * lines[0][j]);
        slopes[1][j] = paired(ey.slope * columns[j]);
    }
    return rounded(paired(slopes[0] * ey.mean)) + rounded(paired(slopes[1] * ex.mean));
}

// The transpose of wide_force. `nodes`: GAS_NODE or SOLID_NODE.
fn wide_rows(slot: u32, v: vec3i, nodes: u32, solid: bool) -> f32 {
    let ex = wide_entries_of_vertex(0u, v.x, solid);
    let ey = wide_entries_of_vertex(1u, v.y, solid);
    let ez = wide_entries_of_vertex(2u, v.z, solid);
    var sum = 0.0;
    for (var k = -reach().z; k <= 2 * reach().z; k++) {
        for (var j = -reach().y; j <= 2 * reach().y; j++) {
            // The node (i, j, k) below the vertex sees it at the offset (i, j, k).
            let at = part(nodes, u32(i32(slot) - i32(params.stride.x) * (j + i32(params.stride.y) * k)));
            let a = work[at + 1u].xyz;
            let b = work[at].xyz;
            let c = work[at - 1u].xyz;
            let d = work[at - 2u].xyz;
            let mean = ex.mean.x * a.yz + ex.mean.y * b.yz + ex.mean.z * c.yz + ex.mean.w * d.yz;
            sum += dot(ex.slope, vec4f(a.x, b.x, c.x, d.x)) * ey.mean[j + 1] * ez.mean[k + 1]
                + mean.x * ey.slope[j + 1] * ez.mean[k + 1] + mean.y * ey.mean[j + 1] * ez.slope[k + 1];
        }
    }
    return sum;
}

// Sum over a layer of nodes, and its mean z velocity: the transpose of the forces' narrow_layer, x and y alike, too.
fn narrow_layer(slot: u32, v: vec3i) -> vec2f {
    let at = part(GAS_NODE, slot);
    let x_low = narrow_entry(0u, v.x - 1);
    let x_high = narrow_entry(0u, v.x);
    let a = work[at - 1u].xyz;
    let b = work[at].xyz;
    if DIM == 1u { return vec2f(x_low.z * a.x - x_high.z * b.x, 0.0); }
    let y_low = narrow_entry(1u, v.y - 1);
    let y_high = narrow_entry(1u, v.y);
    let c = work[at - params.stride.x - 1u].xyz;
    let d = work[at - params.stride.x].xyz;
    let along_x = x_low.z * (y_low.y * c.x + y_high.x * a.x) - x_high.z * (y_low.y * d.x + y_high.x * b.x);
    let along_y = y_low.z * (x_low.y * c.y + x_high.x * d.y) - y_high.z * (x_low.y * a.y + x_high.x * b.y);
    return vec2f(rounded(along_x) + rounded(along_y), y_low.y * (x_low.y * c.z + x_high.x * d.z) + y_high.x * (x_low.y * a.z + x_high.x * b.z));
}

fn regular_rows(slot: u32, v: vec3i) -> f32 {
    if QUADRATIC && DIM == 2u { return plane_rows(slot, v); }
    if QUADRATIC { return wide_rows(slot, v, GAS_NODE, false); }
    let above = narrow_layer(slot, v);
    if DIM < 3u { return above.x; }
    let below = narrow_layer(slot - params.stride.x * params.stride.y, v);
    let low = narrow_entry(2u, v.z - 1);
    let high = narrow_entry(2u, v.z);
    return low.y * below.x + high.x * above.x + low.z * below.y - high.z * above.y;
}

// Velocity of a node that sees more than its own cell; cut_rows has the others.
fn velocity_at(nodes: u32, j: vec3i) -> vec3f {
    let slot = slot_of(j);
    if CUT && nodes == GAS_NODE && beside_obstacle(slot, cells[slot]) { return vec3f(0.0); }
    return work[part(nodes, slot)].xyz;
}

// What a line of nodes gives to a vertex through the faces between cells of one kind and another: the transpose of faces_between.
fn rows_of_faces(own: mat2x4f, other: mat2x4f, weights: Weights, y: Step, z: Step, ends: f32, mean_y: vec2f, mean_z: vec2f) -> f32 {
    return 0.5 * ends * dot(weights.x, own[0] * other[1] - own[1] * other[0])
        + y.face * (mean_y.x * dot(z.mean, faces_y(own[0], other[0])) + mean_y.y * dot(z.mean, faces_y(own[1], other[1])))
        + z.face * (mean_z.x * dot(y.mean, faces_z(own[0], other[0])) + mean_z.y * dot(y.mean, faces_z(own[1], other[1])));
}

// The transpose of line_force, over all lines of nodes: rows of the element's own pressure, and of h. The bounds of the loops depend on
// `own` so that no driver unrolls them.
fn mixed_rows(v: vec3i, own: u32, body: u32, closed: u32, nodes: u32, quadratic: bool) -> vec2f {
    let along_x = gas_entries_of_vertex(0u, quadratic, v.x);
    let elements = columns_beside(own);
    let bodies = columns_beside(body);
    let sides = columns_beside(closed);
    let last = select(vec3i(-2), select(reach(), 2 * reach(), quadratic), own != 0u);
    let first = select(vec3i(0), -reach(), quadratic);
    var rows = vec2f(0.0);
    for (var k = first.z; k <= last.z; k++) {
        let z = step_at(gas_entries_of_vertex(2u, quadratic, v.z), k);
        for (var j = first.y; j <= last.y; j++) {
            let y = step_at(gas_entries_of_vertex(1u, quadratic, v.y), j);
            for (var turn = 0u; turn < when(touches(own, j, k)); turn++) {
                let at = v - vec3i(0, j, k);
                let b = velocity_at(nodes, at);
                let c = velocity_at(nodes, at - vec3i(1, 0, 0));
                var a = vec3f(0.0);
                var d = vec3f(0.0);
                if quadratic {
                    a = velocity_at(nodes, at + vec3i(1, 0, 0));
                    d = velocity_at(nodes, at - vec3i(2, 0, 0));
                }
                let velocity = transpose(mat4x3f(a, b, c, d));
                let slope = vec2f(dot(along_x.slope_below, velocity[0]), dot(along_x.slope_above, velocity[0]));
                let mean_y = vec2f(dot(along_x.mean_below, velocity[1]), dot(along_x.mean_above, velocity[1]));
                let mean_z = vec2f(dot(along_x.mean_below, velocity[2]), dot(along_x.mean_above, velocity[2]));
                let weights = weights_of(y, z);
                rows += vec2f(dot(weights.x * elements, slope) + dot(weights.y * elements, mean_y) + dot(weights.z * elements, mean_z)
                    + rows_of_faces(elements, sides, weights, y, z, b.x + c.x, mean_y, mean_z),
                    rows_of_faces(elements, bodies, weights, y, z, b.x + c.x, mean_y, mean_z));
            }
        }
    }
    return rows;
}

// The vertex near an obstacle; with bodies the nodes that see their own cell alone.
fn cut_rows(v: vec3i) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let j = v - corner_offset(k);
        if SOLIDS && !beside_obstacle(slot_of(j), cells[slot_of(j)]) { continue; }
        sum += dot(work[part(GAS_NODE, slot_of(j))].xyz, coefficient(j, v));
    }
    return sum;
}

// C^T W at a vertex, in units of face_area().
fn gather_rows(slot: u32, word: u32) -> Rows {
    var rows: Rows;
    let v = cell_of(slot);
    let regular = !is_listed() || has(word, VERTEX_REGULAR);
    for (var turn = 0u; turn < when(regular); turn++) { rows.own = regular_rows(slot, v); }
    if !is_listed() { return rows; }
    for (var turn = 0u; turn < when(CUT && has(word, VERTEX_GAS) && !regular); turn++) { rows.own = cut_rows(v); }
    if CUT && !SOLIDS { return rows; }
    let deep = SOLIDS && has(word, VERTEX_DEEP);
    let mixed = has(word, VERTEX_GAS | VERTEX_SOLID) && !regular && !deep;
    for (var turn = 0u; turn < when(deep); turn++) { rows.own = wide_rows(slot, v, SOLID_NODE, true); }
    let kinds = kinds_beside(v, select(0u, corner_count(), mixed));
    let gas = mixed_rows(v, kinds.gas, kinds.solid, kinds.closed, GAS_NODE, QUADRATIC);
    rows.own += gas.x;
    rows.h = gas.y;
    if SOLIDS {
        let solid = mixed_rows(v, kinds.solid, kinds.gas, 0u, SOLID_NODE, true);
        rows.h += solid.y;
        rows.q = solid.x;
        if interface_index(slot) == slot { rows = Rows(rows.own + rows.h + rows.q, 0.0, 0.0); }
    }
    return rows;
}
