// Walls of the domain in the elastic sub-steps. A wall lies halfway between two nodes, where a quadratic B-spline is 1/2 at both: the velocity at
// the wall is their mean. One-sided: what of it goes outward is stopped, by one impulse on both nodes. (A wall that stops the node beyond it alone
// leaves the body beside it half a cell that gives way.) Needs grid_wall, given and the bindings cells, work, node.

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

// Stops the mean of two nodes along an axis; what the wall gives, with their velocities at the start of the sub-step.
fn stop_between(near: u32, beyond: u32, a: u32, way: i32, near_before: vec3f, beyond_before: vec3f) -> vec4f {
    let here = node[near];
    let there = node[beyond];
    let outward = f32(way) * (select(0.0, here[a], here.w > 0.0) + select(0.0, there[a], there.w > 0.0));
    let mobilities = vec2f(mobility(near), mobility(beyond));
    if outward <= 0.0 || there.w <= 0.0 || mobilities.x + mobilities.y == 0.0 { return vec4f(0.0); }
    let impulse = -f32(way) * outward / (mobilities.x + mobilities.y);
    let changes = impulse * mobilities;
    let change_here = select(vec3f(0.0), vec3f(changes.x), along(a));
    let change_there = select(vec3f(0.0), vec3f(changes.y), along(a));
    node[near] = vec4f(here.xyz + change_here, here.w);
    node[beyond] = vec4f(there.xyz + change_there, there.w);
    return given_to(here.w, change_here, near_before, here.xyz + change_here) + given_to(there.w, change_there, beyond_before, there.xyz + change_there);
}
