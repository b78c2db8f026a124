// One index space for cells, nodes and vertices: the grid with one ring of slots around it on every active axis.
// Cell c, the velocity node at its centre and the vertex at its low corner share slot_of(c). Along a periodic axis c stands for
// c modulo the number of cells: cells, nodes and vertices alike; the ring beyond it stays unused.
#include "shared/state.wgsl"

fn reach() -> vec3i { return vec3i(1, i32(DIM > 1u), i32(DIM > 2u)); }

fn periodic_axes() -> vec3<bool> { return (vec3u(PERIODIC) & vec3u(1u, 2u, 4u)) != vec3u(0u); }

fn wrapped(c: vec3i) -> vec3i {
    if PERIODIC == 0u { return c; }
    let n = vec3i(params.cells);
    return select(c, (c + n) % n, periodic_axes());
}

fn slot_of(c: vec3i) -> u32 {
    let r = vec3u(wrapped(c) + reach());
    return r.x + params.stride.x * (r.y + params.stride.y * r.z);
}

fn cell_of(slot: u32) -> vec3i {
    let row = slot / params.stride.x;
    let layer = row / params.stride.y;
    return vec3i(vec3u(slot - row * params.stride.x, row - layer * params.stride.y, layer)) - reach();
}

fn axis(a: u32) -> vec3i { return vec3i(i32(a == 0u), i32(a == 1u), i32(a == 2u)); }

// Which component belongs to an axis. Components are set through it: one with an index that is not known when a kernel is compiled
// (`v[a] = x`) forces older compilers to unroll, and slows all down.
fn along(a: u32) -> vec3<bool> { return vec3u(0u, 1u, 2u) == vec3u(a); }

// A term as it is, rounded on its own: no driver may reorder or fuse it with what it is added to. Sums of two such terms, one per axis,
// keep what is symmetric in x and y so, to the last bit. NaN becomes the lowest number: what it is added to may look
// like a number, so kernels that find faults must see momentum or density, which NaN reaches in the next step at the latest.
fn rounded(term: f32) -> f32 { return max(term, -3.4e38); }
fn rounded4(terms: vec4f) -> vec4f { return max(terms, vec4f(-3.4e38)); }

// Sum of four terms along a line, the same from both ends.
fn paired(terms: vec4f) -> f32 {
    let t = rounded4(terms);
    return (t.x + t.w) + (t.y + t.z);
}

// Slot distance of neighbours along an axis.
fn step_of(a: u32) -> u32 {
    if a == 0u { return 1u; }
    if a == 1u { return params.stride.x; }
    return params.stride.x * params.stride.y;
}

// Whether low <= c < high along every axis that is not periodic.
fn within(c: vec3i, low: vec3i, high: vec3i) -> bool {
    if PERIODIC == 0u { return all(c >= low) && all(c < high); }
    return all(((c >= low) & (c < high)) | periodic_axes());
}
fn inside(c: vec3i) -> bool { return within(c, vec3i(0), vec3i(params.cells)); }
fn in_ring(c: vec3i) -> bool { return within(c, -reach(), vec3i(params.cells) + reach()); }
fn is_vertex(v: vec3i) -> bool { return within(v, vec3i(0), vec3i(params.cells) + reach()); }
fn nearest_inside(c: vec3i) -> vec3i { return select(clamp(c, vec3i(0), vec3i(params.cells) - vec3i(1)), c, periodic_axes()); }
fn nearest_ring(c: vec3i) -> vec3i {
    return select(clamp(c, -reach(), vec3i(params.cells) + reach() - vec3i(1)), c, periodic_axes());
}

// 1 where a side is a plane of symmetry.
fn mirrors(side: u32) -> i32 {
    if !MIRRORED { return 0; }
    return i32((params.sides >> side) & 1u);
}

// 1 where a node beyond a side has the velocity of the cell before it, and so is no node of its own.
fn joins(side: u32) -> i32 {
    if !JOINED { return 0; }
    return i32((params.sides >> (8u + side)) & 1u);
}

// The cell whose velocity the node of a cell has.
fn joined(c: vec3i) -> vec3i {
    if !JOINED { return c; }
    let low = vec3i(joins(0u), joins(2u), joins(4u)) == vec3i(1);
    let high = vec3i(joins(1u), joins(3u), joins(5u)) == vec3i(1);
    let last = vec3i(params.cells) - vec3i(1);
    return select(select(c, last, high & (c > last)), vec3i(0), low & (c < vec3i(0)));
}
fn is_joined(c: vec3i) -> bool { return JOINED && any(joined(c) != c); }

// What stands for a place beyond planes of symmetry; `gap` is that between the image of the first place and the first: 1 for cells, 0 for vertices.
fn before_sides(c: vec3i, gap: i32) -> vec3i {
    if !MIRRORED { return c; }
    let low = vec3i(mirrors(0u), mirrors(2u), mirrors(4u)) == vec3i(1);
    let high = vec3i(mirrors(1u), mirrors(3u), mirrors(5u)) == vec3i(1);
    let last = vec3i(params.cells) - vec3i(gap);
    return select(select(c, 2 * last + vec3i(gap) - c, high & (c > last)), -vec3i(gap) - c, low & (c < vec3i(0)));
}

// What a cell, or a vertex, beyond such a side is the image of.
fn mirrored(c: vec3i) -> vec3i { return before_sides(c, 1); }
fn mirrored_vertex(v: vec3i) -> vec3i { return before_sides(v, 0); }

// The same of a place along one axis; along a periodic one what it stands for.
fn place_along(n: u32, j: i32) -> i32 {
    let count = i32(params.cells[n]);
    if PERIODIC != 0u && ((PERIODIC >> n) & 1u) == 1u { return (j + count) % count; }
    if !MIRRORED { return j; }
    if j < 0 && mirrors(2u * n) == 1 { return -1 - j; }
    if j >= count && mirrors(2u * n + 1u) == 1 { return 2 * count - 1 - j; }
    return j;
}

fn is_reflected(n: u32, j: i32) -> bool {
    return MIRRORED && ((j < 0 && mirrors(2u * n) == 1) || (j >= i32(params.cells[n]) && mirrors(2u * n + 1u) == 1));
}

fn is_image(c: vec3i) -> bool { return MIRRORED && any(mirrored(c) != c); }

// Whether a slot lies beyond a periodic side: it stands for one at the other end and holds nothing.
fn is_alias(c: vec3i) -> bool { return !away_from_seam(c, 0, 0); }

// Whether c + first .. c + last stay clear of the ends of the periodic axes, where neighbours are no neighbours in memory.
fn away_from_seam(c: vec3i, first: i32, last: i32) -> bool {
    if PERIODIC == 0u { return true; }
    return all(((c + first >= vec3i(0)) & (c + last < vec3i(params.cells))) | !periodic_axes());
}

// Enumerations of the 3^DIM block (offsets -1..1) and of the 2^DIM corners (offsets 0..1), x fastest.
fn block_size() -> u32 { if DIM == 1u { return 3u; } if DIM == 2u { return 9u; } return 27u; }
fn block_offset(k: u32) -> vec3i { return vec3i(vec3u(k % 3u, (k / 3u) % 3u, k / 9u)) - reach(); }
fn corner_count() -> u32 { return 1u << DIM; }
fn corner_offset(k: u32) -> vec3i { return vec3i(vec3u(k & 1u, (k >> 1u) & 1u, k >> 2u)); }

fn cell_volume() -> f32 { return face_area() * params.spacing; }
fn face_area() -> f32 {
    if DIM == 1u { return 1.0; }
    if DIM == 2u { return params.spacing; }
    return params.spacing * params.spacing;
}
// Cell that holds a position, or the nearest one.
fn cell_at(position: vec3f) -> vec3i { return nearest_inside(vec3i(floor((position - params.origin) / params.spacing))); }

// -- Neighbours across a face --

// The B1B0 stencils deep inside the gas, one axis after the other: no table, no loop. A pair of neighbours gives its difference
// along the axis it spans and its mean along every other.

fn mean2(a: f32, b: f32) -> f32 { return 0.5 * (a + b); }

// Steps from a slot along the two axes across axis n; 0 for inactive axes, whose only layer is then met twice.
fn across(n: u32) -> vec2u {
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    return vec2u(select(0u, step_of(a), a < DIM), select(0u, step_of(b), b < DIM));
}

// -- Words of slots --

// The word of a slot: kind of the cell, kind one step ago, and what is known of its node and vertex.
// Bits 0..1 kind, 2..3 previous kind, then the flags; bits 16..31 hold the blocked fraction R as a 16-bit share, in GHOST slots
// the place of their rule, in WALL slots the friction of the bodies there, in thousandths, or without bodies IMAGE beyond a plane of
// symmetry, in INTERIOR slots what they know of the cells around their faces.

const IMAGE = 0x10000u;

fn kind_of(word: u32) -> u32 { return word & 3u; }
// Whether the node has gas and body, or gas and obstacle, around it.
fn is_mixed(word: u32) -> bool {
    return has(word, NODE_GAS | NODE_SOLID) && !has(word, NODE_REGULAR) && !(SOLIDS && has(word, NODE_DEEP));
}
// Place of a slot's number among the cut cells, in extra: without bodies in the first block, else before the table [shared/domain.wgsl].
fn cut_place(slot: u32) -> u32 { return select(slot, params.table_at + slot - part(1u, 0u), SOLIDS); }

// Whether the word of a slot, in a scene with bodies, is that of a cell that an obstacle cuts: gas with all of its faces blocked, which no
// particle makes of gas [interface/interface_mark.wgsl].
fn is_cut_word(word: u32) -> bool { return CUT && kind_of(word) == GAS && !has(word, INTERIOR) && (word >> 16u) == 0xffffu; }

fn previous_kind_of(word: u32) -> u32 { return (word >> 2u) & 3u; }
fn has(word: u32, flag: u32) -> bool { return (word & flag) != 0u; }
fn blocked_of(word: u32) -> f32 { return f32(word >> 16u) / 65535.0; }
fn word_with_blocked(word: u32, fraction: f32) -> u32 {
    return (word & 0xffffu) | (u32(clamp(fraction, 0.0, 1.0) * 65535.0 + 0.5) << 16u);
}

// What INTERIOR slots know of the six cells around their two faces across each axis, below and above: from bit 16 whether all hold gas or are
// images, from bit 22 whether the outermost one, three cells away, is an image.
const WIDE_SHIFT = 16u;
const END_SHIFT = 22u;

fn is_wide(word: u32, n: u32, up: bool) -> bool { return has(word, 1u << (WIDE_SHIFT + 2u * n + u32(up))); }
fn ends_in_image(word: u32, n: u32, up: bool) -> bool { return MIRRORED && has(word, 1u << (END_SHIFT + 2u * n + u32(up))); }

// Whether the slot stands for the image of the cell before it; see is_image().
fn holds_image(word: u32) -> bool { return MIRRORED && kind_of(word) == WALL && has(word, IMAGE); }

fn friction_of(word: u32) -> f32 { return 1e-3 * f32(word >> 16u); }
fn word_with_friction(word: u32, friction: f32) -> u32 {
    return (word & 0xffffu) | (u32(1e3 * min(friction, STICK) + 0.5) << 16u);
}

// -- Groups over both kinds of slots --

// A kernel over both kinds of slots (shared/domain.wgsl) has LIST_PARTS times as many groups: enough for as many threads.
fn groups_apart(threads: u32) -> u32 { return (groups_of(threads) + LIST_PARTS - 1u) / LIST_PARTS; }

// -- Columns --

// Blocks of columns along the last axis, COLUMN_BLOCK next to each other and params.march slots long: what a marching kernel takes one
// column per thread, so that neighbouring threads do the same.

fn columns() -> u32 { return params.slots / params.stride[DIM - 1u]; }

fn blocks_across() -> u32 { return (columns() + COLUMN_BLOCK - 1u) / COLUMN_BLOCK; }

fn layers() -> u32 { return (params.stride[DIM - 1u] + params.march - 1u) / params.march; }

// Threads that march along the last axis.
fn marches() -> u32 { return blocks_across() * COLUMN_BLOCK * layers(); }

// Slot at the corner of a block.
fn corner_of(block: u32) -> u32 {
    return (block / blocks_across()) * params.march * columns() + (block % blocks_across()) * COLUMN_BLOCK;
}

// Columns of cells along the last axis, in colors: of three next to each other along an axis each has another one.

// Columns along x and y.
fn columns_across() -> vec2u {
    return vec2u(select(1u, params.cells.x, DIM > 1u), select(1u, params.cells.y, DIM > 2u));
}

// The same for one color.
fn columns_of_color() -> vec2u { return (columns_across() + 2u) / 3u; }

// Marches over the columns of one color, the ring's layers included.
fn color_marches() -> u32 {
    let columns = columns_of_color();
    return columns.x * columns.y * layers();
}

// In vectors of unknowns, behind P of every vertex: h, then Q, of the vertices that carry them apart.
fn apart_h(place: u32) -> u32 { return part(APART, place); }
fn apart_q(place: u32) -> u32 { return part(APART, params.extra_capacity + place); }
fn unknowns() -> u32 { return part(APART, 2u * params.extra_capacity); }

// -- Ledger --

// Where owed_flow and owed_energy have the entry of a slot. With bodies or obstacles every slot has its own place. Else only slots of
// the ring have one, in their order, and what the energy floor takes from gas goes to control.borrowed.
override RING_LEDGER: bool;

// Slots of the ring.
fn ring_count() -> u32 { return params.slots - params.cells.x * params.cells.y * params.cells.z; }

// Place of a slot, with RING_LEDGER of one in the ring.
fn ledger_place(slot: u32) -> u32 {
    if !RING_LEDGER { return slot; }
    let c = cell_of(slot);
    let n = params.cells;
    let before = vec3u(clamp(c, vec3i(0), vec3i(n)));           // cells with a smaller index along each axis
    let level = (c >= vec3i(0)) & (c < vec3i(n));
    let in_row = select(0u, before.x, level.y);
    let in_layer = select(0u, before.y * n.x + in_row, level.z);
    return slot - before.z * n.y * n.x - in_layer;
}

// Where a part of owed_energy begins.
fn ledger_part(k: u32) -> u32 { return k * select(params.slots, ring_count(), RING_LEDGER); }

// Mass and momentum, and energy, that count as one in control.borrowed: about those of ambient gas in a cell.
fn borrowed_unit() -> vec2f {
    return cell_volume() * vec2f(sqrt(params.ambient_pressure * params.ambient_density), params.ambient_pressure);
}

// -- Whole units --

// Density that goes from cell to cell in whole units of the last place of the denser one: what one gives up is then, to the last bit,
// what the other takes.

const LAST_PLACE = 1.1920928955078125e-7;   // 2^-23

fn power_of_two(density: f32) -> f32 { return bitcast<f32>(bitcast<u32>(density) & 0x7f800000u); }

// Of a power of two, exactly: a division may be off by some units in the last place.
fn inverse_of_power(unit: f32) -> f32 { return bitcast<f32>(0x7f000000u - bitcast<u32>(unit)); }

// A unit below the smallest normal number is none.
fn whole(density: f32, unit: f32) -> f32 {
    if bitcast<u32>(unit) < 0x00800000u { return density; }
    return round(density * inverse_of_power(unit)) * unit;
}
