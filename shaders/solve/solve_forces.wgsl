// coupled_solve, first half of the operator: velocity change per unit time W = M^-1 C x at every node.
// Reads x, cells, masses. Writes work: gas nodes, then solid nodes; w keeps the inverse mass of the gas node.
#include "shared/system.wgsl"
#include "solve/mixed.wgsl"

override BODIES_ONLY: bool = false; // leaves out what gas alone asks for

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> x: array<f32>;
@group(0) @binding(4) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(5) var<storage, read> inertia: array<f32>;
@group(0) @binding(6) var<storage, read> energy: array<f32>;

// B2B1 in a plane where only gas and the sides of the domain are around; x and y alike, so that what is symmetric stays so to the last
// bit. Differences from the highest value in the middle, so that a constant pressure moves nothing.
fn plane_force(slot: u32, c: vec3i) -> vec3f {
    let ex = wide_entries_of_node(0u, c.x, false);
    let ey = wide_entries_of_node(1u, c.y, false);
    var highest = x[vertex_below(c)];
    for (var k = 1u; k < corner_count(); k++) {
        highest = max(highest, x[vertex_below(c + corner_offset(k))]);
    }
    var lines: mat4x4f;
    for (var j = 0u; j < 4u; j++) {
        let at = slot + params.stride.x * j - params.stride.x;
        lines[j] = vec4f(x[at - 1u], x[at], x[at + 1u], x[at + 2u]) - highest;
    }
    let columns = transpose(lines);
    var slopes: array<vec4f, 2>;
    for (var j = 0u; j < 4u; j++) {
        slopes[0][j] = paired(ex.slope * lines[j]);
        slopes[1][j] = paired(ey.slope * columns[j]);
    }
    return vec3f(paired(slopes[0] * ey.mean), paired(slopes[1] * ex.mean), 0.0);
}

// B2B1 where only gas, or only solid, and the sides of the domain are around: a product of one-dimensional stencils, line by line.
// Only differences from the reference, so that a constant pressure moves nothing.
fn wide_force(slot: u32, c: vec3i, solid: bool, reference: f32) -> vec3f {
    let ex = wide_entries_of_node(0u, c.x, solid);
    let ey = wide_entries_of_node(1u, c.y, solid);
    let ez = wide_entries_of_node(2u, c.z, solid);
    var force = vec3f(0.0);
    for (var k = -reach().z; k <= 2 * reach().z; k++) {
        for (var j = -reach().y; j <= 2 * reach().y; j++) {
            let at = u32(i32(slot) + i32(params.stride.x) * (j + i32(params.stride.y) * k));
            let line = vec4f(value_at(at - 1u, solid), value_at(at, solid), value_at(at + 1u, solid), value_at(at + 2u, solid)) - reference;
            let mean = dot(ex.mean, line);
            force += vec3f(dot(ex.slope, line) * ey.mean[j + 1] * ez.mean[k + 1],
                mean * vec2f(ey.slope[j + 1] * ez.mean[k + 1], ey.mean[j + 1] * ez.slope[k + 1]));
        }
    }
    return force;
}

// The nearest vertex at or below a node.
fn vertex_below(c: vec3i) -> u32 { return slot_of(clamp(c, vec3i(0), vec3i(params.cells) * reach())); }

fn value_at(slot: u32, solid: bool) -> f32 {
    if solid { return x[ghost_index(slot)]; }
    return x[slot];
}

// (mean, slope along x, slope along y) of a layer of vertices; x and y alike, so that what is symmetric stays so to the last bit.
fn narrow_layer(at: u32, ex: vec3f, ey: vec3f) -> vec3f {
    let low = vec2f(x[at], x[at + 1u]);
    if DIM == 1u { return vec3f(dot(ex.xy, low), ex.z * (low.y - low.x), 0.0); }
    let high = vec2f(x[at + params.stride.x], x[at + params.stride.x + 1u]);
    return vec3f(ey.x * dot(ex.xy, low) + ey.y * dot(ex.xy, high), ex.z * (ey.x * (low.y - low.x) + ey.y * (high.y - high.x)),
        ey.z * (ex.x * (high.x - low.x) + ex.y * (high.y - low.y)));
}

// Only gas and the sides of the domain around the node.
fn regular_force(slot: u32, c: vec3i) -> vec3f {
    if QUADRATIC && DIM == 2u { return plane_force(slot, c); }
    if QUADRATIC { return wide_force(slot, c, false, x[vertex_below(c)]); }
    let ex = narrow_entry(0u, c.x);
    let ey = narrow_entry(1u, c.y);
    let low = narrow_layer(slot, ex, ey);
    if DIM < 3u { return vec3f(low.yz, 0.0); }
    let ez = narrow_entry(2u, c.z);
    let high = narrow_layer(slot + params.stride.x * params.stride.y, ex, ey);
    return vec3f(ez.x * low.yz + ez.y * high.yz, ez.z * (high.x - low.x));
}

// Kinds of the 3^DIM cells around a node in the order of block_offset(). Beyond the ring: closed. `count`: block_size() or 0.
fn kinds_of_block(c: vec3i, count: u32) -> Kinds {
    var kinds: Kinds;
    for (var k = 0u; k < count; k++) {
        let near = mirrored(c + block_offset(k));
        var kind = WALL;
        if in_ring(near) { kind = kind_of(cells[slot_of(near)]); }
        add_kind(&kinds, kind, k);
    }
    return kinds;
}

// Rows of the block around the line of vertices at (y, z) of the node; none beyond the block.
fn rows_of_block(block: u32, y: i32, z: i32) -> vec4u {
    let end = reach();
    let row_y = vec2u(select(0u, 7u, y > -end.y), select(0u, 7u, y <= end.y));
    let row_z = vec2u(select(0u, 7u, z > -end.z), select(0u, 7u, z <= end.z));
    let place = 3 * (y + end.y) + 9 * (z + end.z);
    return (vec4u(block) >> (vec4u(place + vec4i(-12, -9, -3, 0)) & vec4u(31u))) & row_y.xyxy & row_z.xxyy;
}

// Unknowns of the vertices at -1 .. 2 along x: those of the gas, of bodies, and h.
struct Unknowns { gas: vec4f, solid: vec4f, h: vec4f }

fn vertex_slot(v: vec3i) -> u32 { return slot_of(mirrored_vertex(v)); }

fn unknowns_at(first: vec3i) -> Unknowns {
    let at = vec4u(vertex_slot(first), vertex_slot(first + vec3i(1, 0, 0)), vertex_slot(first + vec3i(2, 0, 0)),
        vertex_slot(first + vec3i(3, 0, 0)));
    let own = vec4f(x[at.x], x[at.y], x[at.z], x[at.w]);
    var line = Unknowns(own, own, own);
    if !SOLIDS { return line; }
    let place = vec4u(extra[at.x], extra[at.y], extra[at.z], extra[at.w]);
    let apart = place != vec4u(NO_EXTRA);
    for (var turn = 0u; turn < when(any(apart)); turn++) {
        let h = select(at, apart_h(0u) + place, apart);
        let q = select(at, apart_q(0u) + place, apart);
        line.h = vec4f(x[h.x], x[h.y], x[h.z], x[h.w]);
        line.solid = vec4f(x[q.x], x[q.y], x[q.z], x[q.w]);
    }
    return line;
}

// Weights of the faces between cells of one kind and another: along x at the two vertices, across y and z per cell.
struct Faces { x: vec2f, y: vec3f, z: vec3f }

fn faces_between(own: mat3x4f, other: mat3x4f, weights: Weights, y: Step, z: Step) -> Faces {
    return Faces(0.5 * vec2f(dot(weights.x, own[0] * other[1] - own[1] * other[0]),
            dot(weights.x, own[1] * other[2] - own[2] * other[1])),
        y.face * vec3f(dot(z.mean, faces_y(own[0], other[0])), dot(z.mean, faces_y(own[1], other[1])),
            dot(z.mean, faces_y(own[2], other[2]))),
        z.face * vec3f(dot(y.mean, faces_z(own[0], other[0])), dot(y.mean, faces_z(own[1], other[1])),
            dot(y.mean, faces_z(own[2], other[2]))));
}

fn columns_of(rows: vec4u) -> mat3x4f { return mat3x4f(column(rows, 0u), column(rows, 1u), column(rows, 2u)); }

fn mean_of(entries: Split, u: vec4f) -> vec3f { return entries.mean_above.xyz * u.xyz + entries.mean_below.yzw * u.yzw; }

// What a line of vertices does to a node through the elements of one kind: `u` acts on the elements and, at sides of the domain and
// obstacles, on the faces of gas; `h` on the faces between gas and body.
fn line_force(own: vec4u, body: vec4u, closed: vec4u, c: vec3i, line: vec3i, u: vec4f, h: vec4f, solid: bool) -> vec3f {
    let quadratic = solid || QUADRATIC;
    let along_x = entries_of_node(0u, quadratic, c.x);
    let y = step_at(entries_of_node(1u, quadratic, c.y), line.y);
    let z = step_at(entries_of_node(2u, quadratic, c.z), line.z);
    let weights = weights_of(y, z);
    let elements = columns_of(own);
    let shared_faces = faces_between(elements, columns_of(body), weights, y, z);
    var bare: Faces;
    if !solid { bare = faces_between(elements, columns_of(closed), weights, y, z); }
    let slope = along_x.slope_above.xyz * u.xyz + along_x.slope_below.yzw * u.yzw;
    let mean = mean_of(along_x, u);
    let film = mean_of(along_x, h);
    return vec3f(dot(weights.x * elements, slope) + dot(bare.x, u.yz) + dot(shared_faces.x, h.yz),
        dot(weights.y * elements + bare.y, mean) + dot(shared_faces.y, film),
        dot(weights.z * elements + bare.z, mean) + dot(shared_faces.z, film));
}

// Force on the gas of a cluster next to an obstacle. Differences, so that a constant pressure moves nothing.
fn cut_force(slot: u32) -> vec3f {
    var force = vec3f(0.0);
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        let c = cell_of(at);
        let own = x[at];
        for (var k = 1u; k < corner_count(); k++) {
            force += (x[slot_of(c + corner_offset(k))] - own) * cut_slope(at, corner_offset(k));
        }
    }
    return force;
}

struct Forces { gas: vec3f, solid: vec3f }

// Sum over the lines of vertices around a node between gas and body; `count`: block_size(), or 0 elsewhere. The bounds of the loops
// depend on it so that no driver unrolls them: in software the unrolled form takes twice as long. Lines without cells around them, as
// beyond the ring, have no weight. Only differences from the references: the faces of the elements close, but for a body's at walls, where
// the film presses [solid_predictor.wgsl].
fn mixed_force(c: vec3i, count: u32, gas_reference: f32, solid_reference: f32) -> Forces {
    var forces: Forces;
    let kinds = kinds_of_block(c, count);
    let last = select(vec3i(-2), 2 * reach(), count > 0u);
    for (var z = -reach().z; z <= last.z; z++) {
        for (var y = -reach().y; y <= last.y; y++) {
            let gas = rows_of_block(kinds.gas, y, z);
            let solid = rows_of_block(kinds.solid, y, z);
            let near = !BODIES_ONLY && (QUADRATIC || (y >= 0 && y <= 1 && z >= 0 && z <= 1));
            let by_gas = near && any(gas != vec4u(0u));
            let line = vec3i(-1, y, z);
            let unknowns = unknowns_at(c + line);
            for (var turn = 0u; turn < when(by_gas); turn++) {
                forces.gas += line_force(gas, solid, rows_of_block(kinds.closed, y, z), c, line, unknowns.gas - gas_reference,
                    unknowns.h - gas_reference, false);
            }
            if SOLIDS {
                forces.solid += line_force(solid, gas, vec4u(0u), c, line, unknowns.solid - solid_reference, unknowns.h - solid_reference, true);
            }
        }
    }
    return forces;
}

fn interior_forces(slot: u32) {
    var inverse_mass = 0.0;
    if QUADRATIC { inverse_mass = work[part(GAS_NODE, slot)].w; } else { inverse_mass = energy[part(INVERSE_MASS, slot)]; }
    work[part(GAS_NODE, slot)] = vec4f(regular_force(slot, cell_of(slot)) * face_area() * inverse_mass, inverse_mass);
}

fn listed_forces(slot: u32) {
    let word = cells[slot];
    let c = cell_of(slot);
    let inverse_mass = work[part(GAS_NODE, slot)].w;
    let regular = !BODIES_ONLY && has(word, NODE_REGULAR);
    if beside_obstacle(slot, word) {
        var force = vec3f(0.0);
        if kind_of(word) == GAS && inside(c) { force = cut_force(slot); }
        if !BODIES_ONLY { work[part(GAS_NODE, slot)] = vec4f(force * face_area() * inverse_mass, inverse_mass); }
        return;
    }
    let deep = SOLIDS && has(word, NODE_DEEP);
    let below = vertex_below(c);
    var solid_reference = 0.0;
    if SOLIDS { solid_reference = select(x[ghost_index(below)], 0.0, has(word, NODE_FILM)); }
    var forces = mixed_force(c, select(0u, block_size(), is_mixed(word)), x[below], solid_reference);
    for (var turn = 0u; turn < when(regular); turn++) { forces.gas = regular_force(slot, c); }
    if !BODIES_ONLY { work[part(GAS_NODE, slot)] = vec4f(forces.gas * face_area() * inverse_mass, inverse_mass); }
    if !SOLIDS || !has(word, NODE_SOLID) { return; }
    for (var turn = 0u; turn < when(deep); turn++) { forces.solid = wide_force(slot, c, true, solid_reference); }
    let inverse = select(1.0 / inertia[slot], 0.0, DRIVEN && has(word, NODE_DRIVEN));
    work[part(SOLID_NODE, slot)] = vec4f(forces.solid * face_area() * inverse, inverse);
}

@compute @workgroup_size(WORKGROUP)
fn solve_forces(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { interior_forces(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { listed_forces(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { listed_forces(listed_slot(k)); }
}
