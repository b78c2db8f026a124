// Walls of the solid grid: a node beyond a wall may not move outward, and what the wall stops rubs against it: the velocity along the
// wall loses the friction's share of what the wall takes across. A body that sticks stops. Needs the binding cells.

fn stops_at(side: u32) -> bool { return ((params.wall_sides >> side) & 1u) == 1u; }

// Whether the obstacle ends beside a slot, below or above along an axis.
fn ends_at(slot: u32, a: u32) -> vec2<bool> {
    return vec2<bool>(kind_of(cells[slot - step_of(a)]) != WALL, kind_of(cells[slot + step_of(a)]) != WALL);
}

fn stopped_at_wall(c: vec3i, v: vec3f) -> vec3f {
    var out = v;
    let slot = slot_of(c);
    let here = kind_of(cells[slot]) == WALL;
    // In a flat surface the obstacle goes on along it: what it stops is the way across. Deep inside it stops everything.
    var surface = false;
    for (var a = 0u; a < DIM; a++) { surface = surface || (here && inside(c) && any(ends_at(slot, a))); }
    for (var a = 0u; a < DIM; a++) {
        if c[a] < 0 {
            if stops_at(2u * a) { out = select(out, max(out, vec3f(0.0)), along(a)); }
        } else if c[a] >= i32(params.cells[a]) {
            if stops_at(2u * a + 1u) { out = select(out, min(out, vec3f(0.0)), along(a)); }
        } else if here && inside(c) {
            // Inside an obstacle: outward is where the wall ends.
            let ends = ends_at(slot, a);
            if surface && !any(ends) { continue; }
            if !ends.y { out = select(out, min(out, vec3f(0.0)), along(a)); }
            if !ends.x { out = select(out, max(out, vec3f(0.0)), along(a)); }
        }
    }
    return out;
}

fn velocity_at_wall(c: vec3i, v: vec3f) -> vec3f {
    let out = stopped_at_wall(c, v);
    let word = cells[slot_of(c)];
    if FRICTION && kind_of(word) == WALL { return rubbed(v, out, friction_of(word)); }
    return out;
}

// Components of a velocity that a wall stops; all of them where a body sticks.
fn held_at_wall(c: vec3i, v: vec3f) -> vec3<bool> {
    let word = cells[slot_of(c)];
    if FRICTION && kind_of(word) == WALL && friction_of(word) >= 0.5 * STICK { return vec3<bool>(true); }
    return stopped_at_wall(c, v) != v;
}

// `v` before and `stopped` after the wall. [Coulomb]
fn rubbed(v: vec3f, stopped: vec3f, friction: f32) -> vec3f {
    if friction >= 0.5 * STICK { return vec3f(0.0); }
    let push = length(v - stopped);
    let speed = length(stopped);
    return stopped * max(1.0 - friction * push / max(speed, 1e-30), 0.0);
}
