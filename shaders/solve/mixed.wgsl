// Stencils between gas and body: every vertex, or node, once, and the elements that it shares with the other by their kinds.
// Cells come as bits, one word per kind; rows of cells along x, four of which lie around a line of vertices or nodes along x, in the order
// y below and z below, y above and z below, y below and z above, both above. Needs the binding cells.

// Cells of one kind each, one bit per cell.
struct Kinds { gas: u32, solid: u32, closed: u32 }

fn add_kind(kinds: ptr<function, Kinds>, kind: u32, place: u32) {
    (*kinds).gas |= u32(kind == GAS) << place;
    (*kinds).solid |= u32(kind == SOLID) << place;
    (*kinds).closed |= u32(kind == WALL || kind == GHOST) << place;
}

// One axis of the two elements beside a vertex: entries of the nodes at k = vertex - node = -1 .. 2. An inactive axis has the one above.
struct Split { mean_below: vec4f, mean_above: vec4f, slope_below: vec4f, slope_above: vec4f, face: vec4f }

fn split_entries(a: u32, quadratic: bool) -> Split {
    let none = vec4f(0.0);
    if a >= DIM { return Split(none, vec4f(0.0, 1.0, 0.0, 0.0), none, none, none); }
    let face = vec4f(0.0, 0.5, 0.5, 0.0);
    if quadratic {
        return Split(vec4f(0.0, 3.0, 8.0, 1.0) / 24.0, vec4f(1.0, 8.0, 3.0, 0.0) / 24.0,
            vec4f(0.0, -2.0, 1.0, 1.0) / 6.0, vec4f(-1.0, -1.0, 2.0, 0.0) / 6.0, face);
    }
    return Split(vec4f(0.0, 0.125, 0.375, 0.0), vec4f(0.0, 0.375, 0.125, 0.0),
        vec4f(0.0, -0.5, 0.5, 0.0), vec4f(0.0, -0.5, 0.5, 0.0), face);
}

// The same where the vertex at `v` is fixed and nodes differ: what an image beyond a plane of symmetry has goes to its node, of what is across
// the plane with the other sign.
fn with_images(entries: Split, a: u32, v: i32) -> Split {
    if !MIRRORED || a >= DIM { return entries; }
    let own = own_nodes(a, vec4i(v) - vec4i(-1, 0, 1, 2));
    let images = vec2f(f32(mirrors(2u * a) * i32(v == 1)), f32(mirrors(2u * a + 1u) * i32(v == i32(params.cells[a]) - 1)));
    return Split(own * folded(entries.mean_below, images), own * folded(entries.mean_above, images),
        own * folded(entries.slope_below, -images), own * folded(entries.slope_above, -images), own * folded(entries.face, -images));
}

// Entries that gas has at a vertex `v`, where what a node beyond a side that joins nodes had goes to the one before it.
fn gas_entries_of_vertex(a: u32, quadratic: bool, v: i32) -> Split {
    var entries = split_entries(a, quadratic);
    if JOINED && !quadratic && a < DIM {
        let low = entries.mean_above.z * f32(joins(2u * a) * i32(v == 0));
        let high = entries.mean_below.y * f32(joins(2u * a + 1u) * i32(v == i32(params.cells[a])));
        entries.mean_above += vec4f(0.0, low, -low, 0.0);
        entries.mean_below += vec4f(0.0, -high, high, 0.0);
    }
    return with_images(entries, a, v);
}

// The same of the vertices of node `j`; what lies beyond a plane of symmetry is there as images.
fn entries_of_node(a: u32, quadratic: bool, j: i32) -> Split {
    var entries = split_entries(a, quadratic);
    if JOINED && !quadratic && a < DIM {
        let low = entries.mean_above.z * f32(joins(2u * a));
        let high = entries.mean_below.y * f32(joins(2u * a + 1u));
        let n = i32(params.cells[a]);
        entries.mean_above += vec4f(0.0, low * f32(j == 0), -low * f32(j == -1), 0.0);
        entries.mean_below += vec4f(0.0, -high * f32(j == n), high * f32(j == n - 1), 0.0);
    }
    return entries;
}

fn folded(entry: vec4f, images: vec2f) -> vec4f { return entry + vec4f(0.0, images.y * entry.x, images.x * entry.w, 0.0); }

// The same of one k: below, above.
struct Step { mean: vec2f, slope: vec2f, face: f32 }

fn step_at(entries: Split, k: i32) -> Step {
    return Step(vec2f(entry_at(entries.mean_below, k), entry_at(entries.mean_above, k)),
        vec2f(entry_at(entries.slope_below, k), entry_at(entries.slope_above, k)), entry_at(entries.face, k));
}

// By comparisons: software keeps what is indexed by a variable in memory.
fn entry_at(entry: vec4f, k: i32) -> f32 { return select(select(entry.x, entry.y, k == 0), select(entry.z, entry.w, k == 2), k >= 1); }

// Products of the entries along y and z in the four rows.
struct Weights { x: vec4f, y: vec4f, z: vec4f }

fn weights_of(y: Step, z: Step) -> Weights {
    return Weights(y.mean.xyxy * z.mean.xxyy, y.slope.xyxy * z.mean.xxyy, y.mean.xyxy * z.slope.xxyy);
}

// Whether the cells at place i of the four rows are of a kind.
fn column(rows: vec4u, i: u32) -> vec4f { return vec4f((rows >> vec4u(i)) & vec4u(1u)); }

// +1 where a cell has one of the other kind above it, -1 where below: y and z faces of four cells around a line.
fn faces_y(own: vec4f, other: vec4f) -> vec2f { return own.xz * other.yw - own.yw * other.xz; }
fn faces_z(own: vec4f, other: vec4f) -> vec2f { return own.xy * other.zw - own.zw * other.xy; }

// Kinds of the cells around a vertex: the one below it along x, y and z at place 0, above them at 7. `count`: corner_count() or 0.
fn kinds_beside(v: vec3i, count: u32) -> Kinds {
    var kinds: Kinds;
    for (var k = 0u; k < count; k++) { add_kind(&kinds, kind_of(cells[slot_of(mirrored(v - corner_offset(k)))]), 7u - k); }
    return kinds;
}

// The two cells along x in each of the four rows.
fn columns_beside(bits: u32) -> mat2x4f {
    let rows = vec4u(bits) >> vec4u(0u, 2u, 4u, 6u);
    return mat2x4f(column(rows, 0u), column(rows, 1u));
}

// Places of the cells below and above along y, and along z.
const BELOW = vec2u(0x33u, 0x0fu);
const ABOVE = vec2u(0xccu, 0xf0u);

// Whether the nodes at k = vertex - node along y and z belong to one of these cells.
fn touches(bits: u32, y: i32, z: i32) -> bool {
    let k = vec2i(y, z);
    let near = select(vec2u(0u), BELOW, k >= vec2i(0)) | select(vec2u(0u), ABOVE, k <= vec2i(1));
    return (bits & near.x & near.y) != 0u;
}
