// The coarse levels of the preconditioner with two spaces, in 2D: hat functions, and hat functions with the sign (-1)^(i+j), which the
// pressure operator cannot tell from them. A coarse vertex lies on every other vertex of the level below it.

struct Level {
    count: vec2u,           // vertices along x and y
    wraps: vec2u,           // 1: the ends meet
    fine_count: vec2u,      // vertices of the level below
    first: u32,             // place in `levels`
    fine_first: u32,
    number: u32,            // 1 is the finest coarse level
}

fn level_length() -> u32 { return level.count.x * level.count.y; }

fn coarse_place(at: u32) -> vec2u {
    let row = at / level.count.x;
    return vec2u(at - row * level.count.x, row);
}

// The nine vertices of the level below under a coarse vertex, three per axis, with their weights; 0 for those that there are not.
struct Below { x: vec3u, y: vec3u, weight_x: vec3f, weight_y: vec3f }

fn below(place: vec2u) -> Below {
    let x = vec3i(2 * i32(place.x)) + vec3i(-1, 0, 1);
    let y = vec3i(2 * i32(place.y)) + vec3i(-1, 0, 1);
    let n = vec2i(level.fine_count);
    let round = level.wraps == vec2u(1u);
    let there_x = vec3<bool>(round.x) | ((x >= vec3i(0)) & (x < vec3i(n.x)));
    let there_y = vec3<bool>(round.y) | ((y >= vec3i(0)) & (y < vec3i(n.y)));
    let weight = vec3f(0.5, 1.0, 0.5);
    return Below(vec3u(select(vec3i(0), x + select(vec3i(0), vec3i(n.x), x < vec3i(0)), there_x)),
        vec3u(select(vec3i(0), y + select(vec3i(0), vec3i(n.y), y < vec3i(0)), there_y)),
        select(vec3f(0.0), weight, there_x), select(vec3f(0.0), weight, there_y));
}

// The coarse vertices at a place and beyond it along x, along y, along both.
fn square(place: vec2u) -> vec4u {
    let beyond = select(place + vec2u(1u), vec2u(0u), place + vec2u(1u) >= level.count);
    let low = level.first + level.count.x * place.y;
    let high = level.first + level.count.x * beyond.y;
    return vec4u(low + place.x, low + beyond.x, high + place.x, high + beyond.x);
}

fn slot_of_vertex(v: vec2u) -> u32 { return v.x + 1u + params.stride.x * (v.y + 1u); }

// (-1)^(i+j).
fn alternating(v: vec2u) -> f32 { return select(1.0, -1.0, ((v.x + v.y) & 1u) == 1u); }

// Whether the slot's pressure is shared: where gas, interface and body have their own, the coarse levels do not act.
fn takes_part(slot: u32) -> bool {
    if SOLIDS { if extra[slot] != NO_EXTRA { return false; } }
    return inverse_diagonal[slot] > 0.0;
}
