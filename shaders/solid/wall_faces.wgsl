// Walls of the domain in the elastic sub-steps. A wall lies halfway between two nodes, where a quadratic B-spline is 1/2 at both: the
// velocity at the wall is their mean. One-sided: what of it goes outward is stopped, by one impulse on both nodes, and rubs; a body that
// sticks stops. (A wall that stops the node beyond it alone leaves the body beside it half a cell that gives way.)
// Needs grid_wall, given and the bindings cells, work, node.

// Which way walls lie beside a cell of the domain: -1, 0, 1 along each axis.
fn ways_to_walls(c: vec3i) -> vec3i {
    var ways = vec3i(0);
    for (var a = 0u; a < DIM; a++) {
        if c[a] == 0 && stops_at(2u * a) { ways = select(ways, vec3i(-1), along(a)); }
        if c[a] == i32(params.cells[a]) - 1 && stops_at(2u * a + 1u) { ways = select(ways, vec3i(1), along(a)); }
    }
    return ways;
}

fn is_beyond_wall(c: vec3i) -> bool {
    for (var a = 0u; a < DIM; a++) {
        if c[a] < 0 && stops_at(2u * a) { return true; }
        if c[a] >= i32(params.cells[a]) && stops_at(2u * a + 1u) { return true; }
    }
    return false;
}

// Node k of the block of a cell beside walls and its images beyond them, by bits; the cell itself where there is none.
fn node_of_block(slot: u32, ways: vec3i, k: u32) -> u32 {
    var at = i32(slot);
    for (var a = 0u; a < DIM; a++) { at += select(0, ways[a] * i32(step_of(a)), ((k >> a) & 1u) == 1u); }
    return u32(at);
}

fn in_block(ways: vec3i, k: u32) -> bool {
    for (var a = 0u; a < DIM; a++) {
        if ((k >> a) & 1u) == 1u && ways[a] == 0 { return false; }
    }
    return true;
}

fn is_driven(slot: u32) -> bool { return DRIVEN && has(cells[slot], NODE_DRIVEN); }

// What a node gives way by an impulse of 1; nothing without mass, or where it is driven.
fn mobility(slot: u32) -> f32 {
    let mass = node[slot].w;
    return select(0.0, 1.0 / max(mass, 1e-37), mass > 0.0 && !is_driven(slot));
}

fn moving(node_there: vec4f) -> vec3f { return select(vec3f(0.0), node_there.xyz, node_there.w > 0.0); }

// Impulse on each of two nodes that stops their mean, whose double is given, outward; along the wall friction has its share. [Coulomb]
fn impulse_at_wall(double: vec3f, mobility: f32, a: u32, way: i32, friction: f32) -> vec3f {
    if friction >= 0.5 * STICK { return -double / mobility; }
    let outward = max(f32(way) * double[a], 0.0);
    let slip = select(double, vec3f(0.0), along(a));
    let rubbing = min(friction * outward / max(length(slip), 1e-30), 1.0);
    return -(select(vec3f(0.0), vec3f(f32(way) * outward), along(a)) + rubbing * slip) / mobility;
}

// Lets a wall act on the two nodes beside it across an axis; what it gives, with their velocities at the start of the sub-step.
fn stop_between(near: u32, beyond: u32, a: u32, way: i32, near_before: vec3f, beyond_before: vec3f) -> vec4f {
    let here = node[near];
    let there = node[beyond];
    let mobilities = vec2f(mobility(near), mobility(beyond));
    let sum = mobilities.x + mobilities.y;
    if there.w <= 0.0 || sum == 0.0 { return vec4f(0.0); }
    let word = cells[beyond];
    var friction = 0.0;
    if FRICTION && kind_of(word) == WALL { friction = friction_of(word); }
    let impulse = impulse_at_wall(moving(here) + moving(there), sum, a, way, friction);
    let change_here = impulse * mobilities.x;
    let change_there = impulse * mobilities.y;
    node[near] = vec4f(here.xyz + change_here, here.w);
    node[beyond] = vec4f(there.xyz + change_there, there.w);
    return given_to(here.w, change_here, near_before, here.xyz + change_here) + given_to(there.w, change_there, beyond_before, there.xyz + change_there);
}
