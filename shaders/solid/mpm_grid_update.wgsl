// mpm_grid_update: how do the nodes move?
// Reads the elastic force of this sub-step and the impulse that is spread over the step. Writes node velocity, and where something breaks
// the mean driver of fracture in place of the mass, which nothing reads any more in this sub-step. On return no node moves out
// through a wall.
// V += dt_s (a + f / M) with the true mass, a from the solve [elastic_reaction.wgsl]; wall rules are one-sided, nothing is glued.
// [Cao et al. 2022, step 6]
#include "solid/grid_wall.wgsl"
#include "solid/given.wgsl"
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

@compute @workgroup_size(WORKGROUP)
fn mpm_grid_update(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var given = vec4f(0.0);
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        let here = node[slot];
        if here.w <= 0.0 { continue; }
        let last = select(here.w, work[part(ELASTIC_FORCE, slot)].w / here.w, FRACTURE);
        if DRIVEN && has(cells[slot], NODE_DRIVEN) {
            node[slot].w = last;
            continue;
        }
        let free = here.xyz + spread_kick(slot, here.w) + substep_time() * work[part(ELASTIC_FORCE, slot)].xyz / here.w;
        let v = velocity_at_wall(cell_of(slot), free);
        node[slot] = vec4f(v, last);
        given += given_to(here.w, v - free, here.xyz, v);
    }
    add_given(group_index(group), lane, given, false);
}
