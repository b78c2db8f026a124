// coupled_solve, preparation: the Jacobi diagonal D = S^-1 + dt^2 sum over nodes |coefficient|^2 / M. All coefficients of one
// vertex on one node are summed before they are squared. Unused unknowns get the inverse 0 and stay 0.
#include "shared/system.wgsl"
#include "solve/mixed.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> work: array<vec4f>;        // w: inverse masses of gas and solid nodes
@group(0) @binding(5) var<storage, read> stiffness: array<f32>;
@group(0) @binding(6) var<storage, read_write> inverse_diagonal: array<f32>;

fn inverse(d: f32) -> f32 { return select(0.0, 1.0 / d, d > 0.0); }

// Sum of |coefficient|^2 / M over the nodes, where only gas, or only solid, and the sides of the domain are around.
fn wide_square(v: vec3i, nodes: u32, solid: bool) -> f32 {
    let ex = wide_entries_of_vertex(0u, v.x, solid);
    let ey = wide_entries_of_vertex(1u, v.y, solid);
    let ez = wide_entries_of_vertex(2u, v.z, solid);
    var layers: vec4f;
    for (var z = -reach().z; z <= 2 * reach().z; z++) {
        var terms: mat4x4f;
        for (var k = 0u; k < min(wide_count(), 16u); k++) {
            let offset = vec3i(wide_offset(k).xy, z);
            if !in_ring(v - offset) { continue; }
            let at = offset + vec3i(1);
            let entry = vec3f(ex.slope[at.x] * ey.mean[at.y] * ez.mean[at.z], ex.mean[at.x] * ey.slope[at.y] * ez.mean[at.z],
                ex.mean[at.x] * ey.mean[at.y] * ez.slope[at.z]);
            terms[at.y][at.x] = rounded(work[part(nodes, slot_of(v - offset))].w * dot(entry, entry));
        }
        layers[z + 1] = plane_sum(terms);
    }
    return paired(layers);
}

// Sum over a plane of terms, pairs across its middle first, that is the same for all its mirror images.
fn plane_sum(terms: mat4x4f) -> f32 {
    let outer = terms[0] + terms[3].wzyx;
    let inner = terms[1] + terms[2].wzyx;
    return ((outer.x + outer.w) + (inner.y + inner.z)) + ((outer.y + inner.x) + (outer.z + inner.w));
}

fn regular_square(v: vec3i) -> f32 {
    if QUADRATIC { return wide_square(v, GAS_NODE, false); }
    var sum = 0.0;
    for (var k = 0u; k < corner_count() / 2u; k++) {
        sum += narrow_square(v, corner_offset(k)) + narrow_square(v, reach() - corner_offset(k));
    }
    return sum;
}

fn narrow_square(v: vec3i, corner: vec3i) -> f32 {
    let ex = narrow_pair(0u, v.x, corner.x);
    let ey = narrow_pair(1u, v.y, corner.y);
    let ez = narrow_pair(2u, v.z, corner.z);
    let entry = vec3f(ex.y * ey.x * ez.x, ex.x * ey.y * ez.x, ex.x * ey.x * ez.y);
    return rounded(work[part(GAS_NODE, slot_of(v - corner))].w * dot(entry, entry));
}

// Whether cut_square has a node of a vertex.
fn sees_one_cell(j: vec3i) -> bool { return !SOLIDS || beside_obstacle(slot_of(j), cells[slot_of(j)]); }

// The same near an obstacle; the coefficients on one cluster add up first.
fn cut_square(v: vec3i) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let j = v - corner_offset(k);
        if !sees_one_cell(j) { continue; }
        let own = coefficient(j, v);
        for (var l = 0u; l < corner_count(); l++) {
            let other = v - corner_offset(l);
            if !sees_one_cell(other) { continue; }
            if cluster_first(slot_of(other)) != cluster_first(slot_of(j)) { continue; }
            sum += work[part(GAS_NODE, slot_of(j))].w * dot(own, coefficient(other, v));
        }
    }
    return sum;
}

struct Squares { own: f32, h: f32, q: f32 }

// Coefficients of a vertex on a line of four nodes along x.
struct Coefficients { x: vec4f, y: vec4f, z: vec4f }

fn plus(a: Coefficients, b: Coefficients) -> Coefficients { return Coefficients(a.x + b.x, a.y + b.y, a.z + b.z); }

// Sum of |coefficient|^2 / M.
fn square_of(c: Coefficients, inverse_mass: vec4f) -> f32 { return dot(inverse_mass, c.x * c.x + c.y * c.y + c.z * c.z); }

// Through the elements of one kind; through the faces between these and cells of another. What mixed_rows multiplies velocities by.
fn of_elements(along_x: Split, elements: mat2x4f, weights: Weights) -> Coefficients {
    let x = weights.x * elements;
    let y = weights.y * elements;
    let z = weights.z * elements;
    return Coefficients(x.x * along_x.slope_below + x.y * along_x.slope_above, y.x * along_x.mean_below + y.y * along_x.mean_above,
        z.x * along_x.mean_below + z.y * along_x.mean_above);
}

fn of_faces(along_x: Split, own: mat2x4f, other: mat2x4f, weights: Weights, y: Step, z: Step) -> Coefficients {
    let below = vec2f(dot(z.mean, faces_y(own[0], other[0])), dot(y.mean, faces_z(own[0], other[0])));
    let above = vec2f(dot(z.mean, faces_y(own[1], other[1])), dot(y.mean, faces_z(own[1], other[1])));
    return Coefficients(dot(weights.x, own[0] * other[1] - own[1] * other[0]) * along_x.face,
        y.face * (below.x * along_x.mean_below + above.x * along_x.mean_above),
        z.face * (below.y * along_x.mean_below + above.y * along_x.mean_above));
}

// Inverse masses of a line of nodes, from that below the vertex on.
fn inverse_masses(v: vec3i, j: i32, k: i32, solid: bool) -> vec4f {
    var masses = vec4f(0.0);
    for (var i = 0; i < 4; i++) {
        let at = v - vec3i(i - 1, j, k);
        if !in_ring(at) { continue; }
        let slot = slot_of(at);
        if !solid {
            if CUT && beside_obstacle(slot, cells[slot]) { continue; }
            masses[i] = work[part(GAS_NODE, slot)].w;
        }
        else if has(cells[slot], NODE_SOLID) { masses[i] = work[part(SOLID_NODE, slot)].w; }
    }
    return masses;
}

// The same between gas and body; `count`: corner_count() or 0.
fn mixed_squares(v: vec3i, apart: bool, count: u32) -> Squares {
    var squares: Squares;
    let kinds = kinds_beside(v, count);
    let gas = columns_beside(kinds.gas);
    let body = columns_beside(kinds.solid);
    let sides = columns_beside(kinds.closed);
    let last = select(vec3i(-2), 2 * reach(), count > 0u);
    for (var k = -reach().z; k <= last.z; k++) {
        for (var j = -reach().y; j <= last.y; j++) {
            let x = gas_entries_of_vertex(0u, QUADRATIC, v.x);
            let y = step_at(gas_entries_of_vertex(1u, QUADRATIC, v.y), j);
            let z = step_at(gas_entries_of_vertex(2u, QUADRATIC, v.z), k);
            let weights = weights_of(y, z);
            let own = plus(of_elements(x, gas, weights), of_faces(x, gas, sides, weights, y, z));
            let film = of_faces(x, gas, body, weights, y, z);
            let masses = inverse_masses(v, j, k, false);
            if apart { squares.own += square_of(own, masses); squares.h += square_of(film, masses); }
            else { squares.own += square_of(plus(own, film), masses); }
            if !SOLIDS { continue; }
            let wide_x = split_entries(0u, true);
            let wide_y = step_at(split_entries(1u, true), j);
            let wide_z = step_at(split_entries(2u, true), k);
            let wide = weights_of(wide_y, wide_z);
            let solid = of_elements(wide_x, body, wide);
            let solid_film = of_faces(wide_x, body, gas, wide, wide_y, wide_z);
            let solid_masses = inverse_masses(v, j, k, true);
            if apart { squares.q += square_of(solid, solid_masses); squares.h += square_of(solid_film, solid_masses); }
            else { squares.own += square_of(plus(solid, solid_film), solid_masses); }
        }
    }
    return squares;
}

fn find_diagonal(slot: u32) {
    let word = cells[slot];
    if is_listed() && !has(word, VERTEX_GAS | VERTEX_SOLID) {
        inverse_diagonal[slot] = 0.0;
        return;
    }
    let scale = control.dt * face_area() * control.dt * face_area();
    let v = cell_of(slot);
    let regular = !is_listed() || has(word, VERTEX_REGULAR);
    var cut = 0.0;
    for (var turn = 0u; turn < when(CUT && is_listed() && !regular); turn++) { cut = cut_square(v); }
    if CUT && !SOLIDS && is_listed() && !regular {
        inverse_diagonal[slot] = inverse(stiffness[slot] + scale * cut);
        return;
    }
    let deep = SOLIDS && is_listed() && has(word, VERTEX_DEEP);
    let apart = interface_index(slot) != slot;
    var squares: Squares;
    if is_listed() { squares = mixed_squares(v, apart, select(corner_count(), 0u, regular || deep)); }
    for (var turn = 0u; turn < when(regular); turn++) { squares.own = regular_square(v); }
    for (var turn = 0u; turn < when(deep); turn++) { squares.own = wide_square(v, SOLID_NODE, true); }
    inverse_diagonal[slot] = inverse(stiffness[slot] + scale * (squares.own + cut));
    if apart {
        // where h has a row, the preconditioner of the surface stands in for the diagonal
        let alone = extra[slot] >= params.surface_rows;
        inverse_diagonal[interface_index(slot)] = select(0.0, inverse(scale * squares.h), alone);
        inverse_diagonal[ghost_index(slot)] = inverse(stiffness[ghost_index(slot)] + scale * squares.q);
    }
}

@compute @workgroup_size(WORKGROUP)
fn solve_diagonal(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { find_diagonal(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { find_diagonal(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { find_diagonal(listed_slot(k)); }
}
