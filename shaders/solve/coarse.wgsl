// The coarse levels of the preconditioner. In 2D two spaces: hat functions, and hat functions with the sign (-1)^(i+j), which the
// pressure operator cannot tell from them. In 3D it sees nothing of what alternates along two axes, whatever it does along the third:
// hat functions, and per pair of axes hats along these two alone, with that sign. A coarse vertex lies on every other vertex of the
// level below it along the axes that its space coarsens.

// A space on one level; a level with all its spaces and those of the level below.
// Generated from src/state/coarse.rs by scripts/generate.
struct Grid {
    count: vec3u,               // Vertices along the axes
    first: u32,                 // Place of the first one
    halves: vec3u,              // 1 along the axes that the space coarsens
    wraps: u32,                 // Axes whose ends meet, as bits
}

struct Level {
    own: array<Grid, SPACES>,   // One per space
    below: array<Grid, SPACES>, // The same of the level below
    length: u32,                // Entries of all spaces
    number: u32,                // From 1, the finest coarse level
}
// End of what is generated.

// Threads of the kernels of a level. Needs the binding pcg.
fn level_threads(number: u32) -> u32 { return pcg.level_groups[number] * WORKGROUP; }

fn space_count() -> u32 { return select(2u, 4u, DIM == 3u); }

// Which space an entry belongs to, among those of one level.
fn space_of(place: u32) -> u32 {
    var space = 0u;
    for (var k = 1u; k < space_count(); k++) { space += u32(place >= level.own[k].first); }
    return space;
}

fn vertex_of(grid: Grid, at: u32) -> vec3u {
    let row = at / grid.count.x;
    let layer = row / grid.count.y;
    return vec3u(at - row * grid.count.x, row - layer * grid.count.y, layer);
}

fn place_of(grid: Grid, v: vec3u) -> u32 { return grid.first + v.x + grid.count.x * (v.y + grid.count.y * v.z); }

// The vertices of the level below at -1, 0 and 1 from a coarse vertex along an axis, with their weights; 0 for those that there are not.
struct Below { at: vec3u, weight: vec3f }

fn below(own: Grid, fine: Grid, v: vec3u, a: u32) -> Below {
    let halves = i32(own.halves[a]);
    let at = (1 + halves) * i32(v[a]) + vec3i(-1, 0, 1);
    let n = i32(fine.count[a]);
    let round = ((own.wraps >> a) & 1u) == 1u;
    let there = vec3<bool>(round) | ((at >= vec3i(0)) & (at < vec3i(n)));
    let beside = 0.5 * f32(halves);
    return Below(vec3u(select(vec3i(0), at + select(vec3i(0), vec3i(n), at < vec3i(0)), there)),
        select(vec3f(0.0), vec3f(beside, 1.0, beside), there));
}

// P^T of one space at a coarse vertex, of what `value_below` finds on the level below.
fn gathered(own: Grid, fine: Grid, v: vec3u) -> vec2f {
    let x = below(own, fine, v, 0u);
    let y = below(own, fine, v, 1u);
    let z = below(own, fine, v, 2u);
    let reach = own.halves;
    var sum = vec2f(0.0);
    for (var k = 1u - reach.z; k <= 1u + reach.z; k++) {
        for (var j = 1u - reach.y; j <= 1u + reach.y; j++) {
            for (var i = 1u - reach.x; i <= 1u + reach.x; i++) {
                sum += x.weight[i] * y.weight[j] * z.weight[k] * value_below(fine, vec3u(x.at[i], y.at[j], z.at[k]));
            }
        }
    }
    return sum;
}

fn slot_of_vertex(v: vec3u) -> u32 {
    return v.x + 1u + params.stride.x * (v.y + 1u + params.stride.y * (v.z + u32(DIM > 2u)));
}

// Whether the slot's pressure is shared: where gas, interface and body have their own, the coarse levels do not act.
fn takes_part(slot: u32) -> bool {
    if SOLIDS { if extra[slot] != NO_EXTRA { return false; } }
    return inverse_diagonal[slot] > 0.0;
}
