// coupled_solve, write-back to the solid: V = V* - dt M^-1 (G Q + H h) [eq. 36], and the change of the ghost pressure.
// What light nodes leave is a share of the solve's whole kick, with what of it only takes back the reaction [elastic_reaction.wgsl].
#include "shared/system.wgsl"
#include "solid/light_node.wgsl"

override ASIDE: bool;   // the reaction was set aside

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> pressure: array<f32>;
@group(0) @binding(5) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> inertia: array<f32>;
@group(0) @binding(9) var<storage, read> elastic: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> ghost: array<f32>;   // Q* before, Q - Q* after

@compute @workgroup_size(WORKGROUP)
fn solid_kick(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let word = cells[slot];
    if has(word, NODE_SOLID) && node[slot].w > 0.0 {
        node[slot] = vec4f(node[slot].xyz - control.dt * work[part(SOLID_NODE, slot)].xyz, node[slot].w);
    }
    if has(word, VERTEX_SOLID) { ghost[slot] = pressure[ghost_index(slot)] - ghost[slot]; }
}

// What a light node leaves of its kick.
fn leave(slot: u32) {
    var left = vec3f(0.0);
    if has(cells[slot], NODE_SOLID) {
        var kick = work[part(SOLID_NODE, slot)].xyz;
        if ASIDE { kick += elastic[part(REACTION, slot)].xyz; }
        left = -control.dt * share_left(slot) * kick;
    }
    work[part(LEFT_KICK, slot)] = vec4f(left, 0.0);
}

// Where the elastic step comes first; else the same is part of `reaction_after` [elastic_reaction.wgsl].
@compute @workgroup_size(WORKGROUP)
fn solid_kick_share(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || node[slot].w <= 0.0 || (DRIVEN && has(cells[slot], NODE_DRIVEN)) { return; }
    node[slot] = vec4f(node[slot].xyz + gain_around(slot, block_size()), node[slot].w);
}

// Whether a particle may look at a vertex in this step: it is near enough to give one of the nodes around the vertex mass.
fn has_particles_near(v: vec3i) -> bool {
    var mass = 0.0;
    for (var k = 0u; k < corner_count(); k++) { mass += node[slot_of(v - corner_offset(k))].w; }
    return mass > 0.0;
}

// Particles in GAS cells: a vertex without a solid cell takes the mean change of the solid vertices in its 5^DIM block.
fn spread_change(slot: u32) {
    if has(cells[slot], VERTEX_SOLID) { return; }
    let v = cell_of(slot);
    if !is_vertex(v) { return; }
    var sum = 0.0;
    var count = 0.0;
    let width = select(vec3i(-1), 2 * reach(), has_particles_near(v));  // -1: no turn of the loops
    for (var z = -width.z; z <= width.z; z++) {
        for (var y = -width.y; y <= width.y; y++) {
            for (var x = -width.x; x <= width.x; x++) {
                let near = v + vec3i(x, y, z);
                if !is_vertex(near) || !has(cells[slot_of(near)], VERTEX_SOLID) { continue; }
                sum += ghost[slot_of(near)];
                count += 1.0;
            }
        }
    }
    ghost[slot] = select(0.0, sum / count, count > 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn solid_kick_left(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    leave(slot);
    spread_change(slot);
}
