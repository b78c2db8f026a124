// mpm_grid_update: how do the nodes move?
// Reads the elastic force of this sub-step and the impulse that is spread over the step. Writes node velocity, and where something breaks
// the mean driver of fracture in place of the mass, which nothing reads any more in this sub-step. On return nothing moves out through a
// wall: at a side of the domain the mean of the nodes on both sides of it, in an obstacle each node.
// V += dt_s (a + f / M) with the true mass, a from the solve [elastic_reaction.wgsl]; wall rules are one-sided, nothing is glued.
// [Cao et al. 2022, step 6]
#include "solid/grid_wall.wgsl"
#include "solid/given.wgsl"
#include "solid/wall_faces.wgsl"
#include "solid/spread_impulse.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> work: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(5) var<storage, read> elastic: array<vec4f>;

// Velocity of a node by its own share of the impulse, and by what those around could not take.
fn spread_kick(slot: u32, mass: f32) -> vec3f {
    let push = elastic[part(TO_SPREAD, slot)];
    var kick = min(push.w / mass, MOST_SPREAD) * substep_time() * push.xyz;
    let c = cell_of(slot);
    for (var k = 0u; k < select(block_size(), 0u, control.substep <= 1u); k++) {
        let near = c + block_offset(k);
        if in_ring(near) { kick += elastic[part(PASSED_ON, slot_of(near))].xyz; }
    }
    return kick;
}

// Mean driver of fracture, or else the mass.
fn last_of(slot: u32, mass: f32) -> f32 { return select(mass, work[part(ELASTIC_FORCE, slot)].w / mass, FRACTURE); }

// Velocity of a node at the end of the sub-step before walls.
fn free_velocity(slot: u32, here: vec4f) -> vec3f {
    return here.xyz + spread_kick(slot, here.w) + substep_time() * work[part(ELASTIC_FORCE, slot)].xyz / here.w;
}

// Moves a node beside walls, and those beyond: one thread, since each depends on the others. What walls give.
fn move_block(slot: u32, ways: vec3i) -> vec4f {
    var before: array<vec3f, 8>;
    for (var k = 0u; k < corner_count(); k++) {
        let at = node_of_block(slot, ways, k);
        let here = node[at];
        before[k] = here.xyz;
        if in_block(ways, k) && here.w > 0.0 && !is_driven(at) { node[at] = vec4f(free_velocity(at, here), here.w); }
    }
    var given = vec4f(0.0);
    for (var a = 0u; a < DIM; a++) {
        for (var k = 0u; k < corner_count(); k++) {
            let other = k | (1u << a);
            if other == k || ways[a] == 0 || !in_block(ways, k) { continue; }
            given += stop_between(node_of_block(slot, ways, k), node_of_block(slot, ways, other), a, ways[a], before[k], before[other]);
        }
    }
    for (var k = 0u; k < corner_count(); k++) {
        let at = node_of_block(slot, ways, k);
        let here = node[at];
        if !in_block(ways, k) || here.w <= 0.0 { continue; }
        // Only the first lies inside, where obstacles are.
        let v = select(here.xyz, velocity_at_wall(cell_of(at), here.xyz), k == 0u && !is_driven(at));
        node[at] = vec4f(v, last_of(at, here.w));
        given += given_to(here.w, v - here.xyz, before[k], v);
    }
    return given;
}

@compute @workgroup_size(WORKGROUP)
fn mpm_grid_update(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var given = vec4f(0.0);
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        let c = cell_of(slot);
        if is_beyond_wall(c) { continue; } // the thread of the node before the wall moves it
        let here = node[slot];
        let ways = ways_to_walls(c);
        let beside = any(ways != vec3i(0));
        for (var turn = 0u; turn < when(beside); turn++) { given += move_block(slot, ways); }
        if beside || here.w <= 0.0 { continue; }
        if is_driven(slot) {
            node[slot].w = last_of(slot, here.w);
            continue;
        }
        let free = free_velocity(slot, here);
        let v = velocity_at_wall(c, free);
        node[slot] = vec4f(v, last_of(slot, here.w));
        given += given_to(here.w, v - free, here.xyz, v);
    }
    add_given(group_index(group), lane, given, false);
}
