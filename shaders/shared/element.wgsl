// The two element pairs on one cell: 3 velocity nodes per axis (offsets -1, 0, +1), 2 vertices per axis (low, high).
// gradient_entry = -int N_v dN_i, mean_entry = int N_v N_i on the unit cell; on inactive axes the mean is 1.
// A face takes 1/2 from each of the two nodes across it. [Cao et al. 2022, section 2.6; Fang et al. 2020]

fn gradient_entry(quadratic: bool, node: i32, high: bool) -> f32 {
    if quadratic {
        if node == 0 { return select(-1.0 / 6.0, 1.0 / 6.0, high); }
        if node < 0 { return select(1.0 / 3.0, 1.0 / 6.0, high); }
        return select(-1.0 / 6.0, -1.0 / 3.0, high);
    }
    if node == 0 { return select(-0.5, 0.5, high); }
    if node < 0 { return select(0.5, 0.0, high); }
    return select(0.0, -0.5, high);
}

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

// Gradient coefficients of one vertex (corner) of an element on one of its nodes, all axes; times face_area() in physical units.
fn element_entry(quadratic: bool, node: vec3i, corner: vec3i) -> vec3f {
    var mean = vec3f(1.0);
    var slope = vec3f(0.0);
    for (var a = 0u; a < DIM; a++) {
        mean[a] = mean_entry(quadratic, node[a], corner[a] == 1);
        slope[a] = gradient_entry(quadratic, node[a], corner[a] == 1);
    }
    return vec3f(slope.x * mean.y * mean.z, mean.x * slope.y * mean.z, mean.x * mean.y * slope.z);
}

// Coefficient of one vertex of a face of an element, across axis n, on one node: 1/2 across, means along the face.
fn face_entry(quadratic: bool, n: u32, node: vec3i, corner: vec3i) -> f32 {
    var entry = 0.5;
    for (var a = 0u; a < DIM; a++) {
        if a != n { entry *= mean_entry(quadratic, node[a], corner[a] == 1); }
    }
    return entry;
}

// Assembled stencil where only gas and the sides of the domain are around: a product over the axes. Slope and mean of vertex v
// on node j along one axis: its two elements, and the face term at a side (weak walls and open sides act on P itself).
// Inside: B1B0 (-1, 1) along, (1, 1)/2 across; B2B1 (-1, -3, 3, 1)/6 along, (1, 11, 11, 1)/24 across.
fn axis_entry(a: u32, j: i32, v: i32) -> vec2f {
    if a >= DIM { return vec2f(0.0, 1.0); }
    let n = i32(params.cells[a]);
    let below = j - v + 1;
    let above = j - v;
    var entry = vec2f(0.0);
    if v >= 1 && v <= n && abs(below) <= 1 {
        entry += vec2f(gradient_entry(QUADRATIC, below, true), mean_entry(QUADRATIC, below, true));
    }
    if v >= 0 && v < n && abs(above) <= 1 {
        entry += vec2f(gradient_entry(QUADRATIC, above, false), mean_entry(QUADRATIC, above, false));
    }
    if v == 0 && (above == 0 || above == -1) { entry.x -= 0.5; }
    if v == n && (below == 0 || below == 1) { entry.x += 0.5; }
    return entry;
}

// The entries of the candidates at v - j = first .. first + 3, for a fixed node (sign 1) or a fixed vertex (sign -1) at `at`.
struct AxisEntries { slope: vec4f, mean: vec4f }

fn axis_entries(a: u32, at: i32, node_fixed: bool) -> AxisEntries {
    var entries: AxisEntries;
    for (var k = 0; k < 4; k++) {
        if !QUADRATIC && (k == 0 || k == 3) { continue; }
        let offset = k - 1;
        let entry = select(axis_entry(a, at - offset, at), axis_entry(a, at, at + offset), node_fixed);
        entries.slope[k] = entry.x;
        entries.mean[k] = entry.y;
    }
    return entries;
}

// Whether a node and a corner of an element are coupled at all: B1B0 couples a node to the vertices on its own side only.
fn coupled(quadratic: bool, node: vec3i, corner: vec3i) -> bool {
    return quadratic || all(abs(2 * node - 2 * corner + reach()) <= vec3i(1));
}

// Node of an element that its face across axis n, on the side `up`, rests on: the element's own layer and the one beyond.
fn face_holds(node: vec3i, n: u32, up: bool) -> bool { return node[n] == 0 || node[n] == select(-1, 1, up); }
