// The pressure system without a matrix: forces F = C X at the velocity nodes of gas and solid, and their transpose.
// Unknowns: one value per vertex (P, or Q inside solids, or the shared pressure); vertices in the extra list carry h and Q
// apart behind the grid. C = [K; B; H]: element gradients, faces to walls and open sides on P itself, faces between gas and
// solid on h. [Cao et al. 2022, eqs. 34-37]
// Needs the bindings cells and extra.
#include "shared/domain.wgsl"

fn interface_index(slot: u32) -> u32 {
    if SOLIDS { let at = extra[slot]; if at != NO_EXTRA { return apart_h(at); } }
    return slot;
}
fn ghost_index(slot: u32) -> u32 {
    if SOLIDS { let at = extra[slot]; if at != NO_EXTRA { return apart_q(at); } }
    return slot;
}

fn neighbour_kind(c: vec3i, n: u32, up: bool) -> u32 {
    return kind_of(cells[slot_of(select(c - axis(n), c + axis(n), up))]);
}

// Kinds of the 2^DIM cells around a vertex, two bits each, in the order of corner_offset(): cell k lies at v - corner_offset(k).
fn kinds_around_vertex(v: vec3i) -> u32 {
    var kinds = 0u;
    for (var k = 0u; k < corner_count(); k++) { kinds |= kind_of(cells[slot_of(mirrored(v - corner_offset(k)))]) << (2u * k); }
    return kinds;
}

fn corner_index(corner: vec3i) -> u32 { return u32(corner.x + 2 * corner.y + 4 * corner.z); }

// Kind of the cell beyond the face, across axis n, that the element at `corner` has on the vertex' side.
fn kind_across(kinds: u32, corner: vec3i, n: u32) -> u32 {
    let other = select(corner, 1 - corner, along(n));
    return (kinds >> (2u * corner_index(other))) & 3u;
}

// Kinds of the 3^DIM cells around a node, two bits each, in the order of block_offset(). Beyond the ring: WALL.
fn kinds_around_node(c: vec3i) -> vec2u {
    var kinds = vec2u(0u);
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        var kind = WALL;
        if in_ring(near) { kind = kind_of(cells[slot_of(near)]); }
        if k < 16u { kinds.x |= kind << (2u * k); } else { kinds.y |= kind << (2u * (k - 16u)); }
    }
    return kinds;
}

fn kind_in_block(kinds: vec2u, offset: vec3i) -> u32 {
    let place = offset + reach();
    let k = u32(place.x + 3 * place.y + 9 * place.z);
    return (select(kinds.y, kinds.x, k < 16u) >> (2u * (k & 15u))) & 3u;
}

// Vertices of a B2B1 node, 4 per axis, as offsets from its own.
fn wide_count() -> u32 { return 1u << (2u * DIM); }
fn wide_offset(k: u32) -> vec3i { return vec3i(vec3u(k & 3u, (k >> 2u) & 3u, k >> 4u)) - reach(); }

// -- Elements --

// The two element pairs on one cell: 3 velocity nodes per axis (offsets -1, 0, +1), 2 vertices per axis (low, high).
// mean_entry = int N_v N_i on the unit cell; on inactive axes the mean is 1.
// A face takes 1/2 from each of the two nodes across it. [Cao et al. 2022, section 2.6; Fang et al. 2020]

fn mean_entry(quadratic: bool, node: i32, high: bool) -> f32 {
    if quadratic {
        if node == 0 { return 1.0 / 3.0; }
        return select(1.0 / 24.0, 1.0 / 8.0, (node > 0) == high);
    }
    if node == 0 { return 3.0 / 8.0; }
    return select(0.0, 1.0 / 8.0, (node > 0) == high);
}

// Share of an element's mass that a node gets: product over the active axes of int N_i.
fn mass_entry(quadratic: bool, node: vec3i) -> f32 {
    var share = 1.0;
    for (var a = 0u; a < DIM; a++) {
        share *= mean_entry(quadratic, node[a], false) + mean_entry(quadratic, node[a], true);
    }
    return share;
}

// Coefficient of one vertex of a face of an element, across axis n, on one node: 1/2 across, means along the face.
fn face_entry(quadratic: bool, n: u32, node: vec3i, corner: vec3i) -> f32 {
    var entry = 0.5;
    for (var a = 0u; a < DIM; a++) {
        if a != n { entry *= mean_entry(quadratic, node[a], corner[a] == 1); }
    }
    return entry;
}

// Assembled B2B1 stencil of one axis where only gas, or only solid, and the sides of the domain are around: a product over the axes.
// Entries of the vertices at -1 .. 2 of a node, whose places are `v`: from the two cells of each, as far as these lie inside.
// Inside: (-1, -3, 3, 1)/6 along, (1, 11, 11, 1)/24 across. For gas the weak walls and open sides act on P itself. At a plane of symmetry
// a vertex has both its cells, the first one before it stands for its image, too, and no node beyond is of its own.
struct AxisEntries { slope: vec4f, mean: vec4f }

// 1 where nodes of an axis lie before its planes of symmetry.
fn own_nodes(a: u32, node: vec4i) -> vec4f {
    let low = vec4<bool>(mirrors(2u * a) == 0);
    let high = vec4<bool>(mirrors(2u * a + 1u) == 0);
    return vec4f(((node >= vec4i(0)) | low) & ((node < vec4i(i32(params.cells[a]))) | high));
}

fn wide_entries(a: u32, v: vec4i, solid: bool) -> AxisEntries {
    if a >= DIM { return AxisEntries(vec4f(0.0), vec4f(0.0, 1.0, 0.0, 0.0)); }
    let n = vec4i(i32(params.cells[a]));
    let low = mirrors(2u * a);
    let high = mirrors(2u * a + 1u);
    let below = vec4f((v >= vec4i(1 - low)) & (v <= n));
    let above = vec4f((v >= vec4i(0)) & (v < n + high));
    let sides = select(vec4f(v == n) * f32(1 - high) - vec4f(v == vec4i(0)) * f32(1 - low), vec4f(0.0), solid);
    var entries = AxisEntries((below * vec4f(0.0, -2.0, 1.0, 1.0) + above * vec4f(-1.0, -1.0, 2.0, 0.0)) / 6.0
        + vec4f(0.0, 0.5, 0.5, 0.0) * sides, (below * vec4f(0.0, 3.0, 8.0, 1.0) + above * vec4f(1.0, 8.0, 3.0, 0.0)) / 24.0);
    if !MIRRORED { return entries; }
    let own = own_nodes(a, v - vec4i(-1, 0, 1, 2));
    let images = vec2f(f32(low) * f32(v.z == 1), f32(high) * f32(v.y == n.x - 1));
    entries.slope += vec4f(0.0, images.y, -images.x, 0.0) / 6.0;
    entries.mean += vec4f(0.0, images.y, images.x, 0.0) / 24.0;
    return AxisEntries(own * entries.slope, own * entries.mean);
}

fn wide_entries_of_node(a: u32, j: i32, solid: bool) -> AxisEntries {
    return wide_entries(a, vec4i(j) + vec4i(-1, 0, 1, 2), solid);
}

// A vertex sees the nodes at 1 .. -2 of it in this order.
fn wide_entries_of_vertex(a: u32, v: i32, solid: bool) -> AxisEntries { return wide_entries(a, vec4i(v), solid); }

// The same for B1B0, whose nodes rest on two vertices per axis only: means of the low and the high vertex of node j, and s where
// their slopes are -s and s. Beyond a plane of symmetry, or a side that joins nodes, no node is of its own: the one before it has its share.
fn narrow_entry(a: u32, j: i32) -> vec3f {
    if a >= DIM { return vec3f(1.0, 0.0, 0.0); }
    let n = i32(params.cells[a]);
    let own = f32(j >= 0 && j < n);
    let low = mirrors(2u * a) | joins(2u * a);
    let high = mirrors(2u * a + 1u) | joins(2u * a + 1u);
    return vec3f(0.375 * own + 0.125 * f32(j >= 1 - low && j <= n - high), 0.375 * own + 0.125 * f32(j >= low - 1 && j < n + high - 1), own);
}

// (mean, slope) of a vertex on the node below (corner 1) or above it (corner 0).
fn narrow_pair(a: u32, v: i32, corner: i32) -> vec2f {
    let entry = narrow_entry(a, v - corner);
    return select(vec2f(entry.x, -entry.z), entry.yz, corner == 1);
}

// Node of an element that its face across axis n, on the side `up`, rests on: the element's own layer and the one beyond.
fn face_holds(node: vec3i, n: u32, up: bool) -> bool { return node[n] == 0 || node[n] == select(-1, 1, up); }

// -- Obstacles --

// The pressure system at obstacles: the velocity is constant in the gas of a cell, so a cell feels the integral of the pressure
// gradient over its gas, and no pressure acts through the surface. A cluster moves as one.

// Whether a node has obstacles around it, and no body; it then sees its own cell alone.
fn beside_obstacle(slot: u32, word: u32) -> bool {
    if !CUT || has(word, NODE_REGULAR) { return false; }
    return !SOLIDS || (!has(word, NODE_SOLID) && cut_number(slot) >= CUT_NEAR);
}

// Coefficient of a vertex on a node next to it, in units of face_area().
fn coefficient(j: vec3i, v: vec3i) -> vec3f {
    let slot = slot_of(j);
    let word = cells[slot];
    if has(word, NODE_REGULAR) {
        let ex = narrow_pair(0u, v.x, v.x - j.x);
        let ey = narrow_pair(1u, v.y, v.y - j.y);
        let ez = narrow_pair(2u, v.z, v.z - j.z);
        return vec3f(ex.y * ey.x * ez.x, ex.x * ey.y * ez.x, ex.x * ey.x * ez.y);
    }
    if !inside(j) || kind_of(word) != GAS { return vec3f(0.0); }
    return cut_slope(slot, v - j);
}

// What a corner of a cell has to say at a place, in cells from the centre.
fn shape_at(place: vec3f, corner: vec3i) -> f32 {
    var value = 1.0;
    for (var a = 0u; a < DIM; a++) { value *= 0.5 + select(-place[a], place[a], corner[a] == 1); }
    return value;
}

// Share of a corner in the gas of its cell, and the integral of the gradient of its shape function over that gas, in units
// of face_area().
fn gas_at_corner(slot: u32, corner: vec3i) -> f32 {
    let entry = cut_entry(slot);
    if entry == 0u { return 1.0 / f32(corner_count()); }
    return cut_value(entry, CUT_SHARE) * shape_at(cut_vector(entry, CUT_CENTER), corner);
}

fn cut_slope(slot: u32, corner: vec3i) -> vec3f {
    let side = 2.0 * vec3f(corner) - 1.0;
    let entry = cut_entry(slot);
    var share = 1.0;
    var center = vec3f(0.0);
    var mixed = vec3f(0.0);
    if entry != 0u {
        share = cut_value(entry, CUT_SHARE);
        center = cut_vector(entry, CUT_CENTER);
        mixed = cut_vector(entry, CUT_MIXED);
    }
    let half = 0.5 + side * center;
    if DIM == 1u { return vec3f(share * side.x, 0.0, 0.0); }
    if DIM == 2u { return share * vec3f(side.xy * half.yx, 0.0); }
    // mean of (1/2 + s y)(1/2 + t z)
    let t = side.yzx;
    let u = side.zxy;
    return share * side * (0.25 + 0.5 * (t * center.yzx + u * center.zxy) + t * u * mixed);
}
