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
    if MIRRORED == 0u { return entries; }
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
