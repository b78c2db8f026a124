// elastic_reaction: which part of the elastic force bears the load of a node?
// The load L of a node is the acceleration by the pressures before the solve, by films and by gravity. The reaction e = -alpha L is what the
// elastic force has against it, alpha = -(r . L) / (L . L), where r = f0 / M - (V . grad) V is the elastic acceleration as a fixed grid sees
// it. The solve starts from V + dt e, so a body that bears its load is at rest in it, whatever its mass and the step. The elastic force
// that turns or shakes a body is none of the solve's business: on a fixed grid it would look like a compression.
// After the solve the acceleration but for e is given as an impulse, evenly over the elastic sub-steps, which bring the elastic force itself.
// With a shared volume e is the whole elastic acceleration: there the solve must know the law's volumetric part.
// Reads the elastic force of the present stress, the forces of X*, node. Writes node: what enters the solve, then the velocity of the
// particles again; elastic: see below.
#include "solid/grid_wall.wgsl"
#include "solid/spread_impulse.wgsl"
#include "solid/light_node.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> elastic: array<vec4f>;
@group(0) @binding(6) var<storage, read> inertia: array<f32>;

// More than this times the load is never taken for the reaction to it.
const MOST_REACTION = 2.0;

// A node of a body has all of its own velocity from this share of the mass around it on.
const OWN_MASS = 1e-4;

// Nodes without mass, and those that are driven, have no forces.
fn is_free(slot: u32) -> bool { return node[slot].w > 0.0 && !(DRIVEN && has(cells[slot], NODE_DRIVEN)); }

// Velocity of a node, and its mass. A node of a body moves with the nodes around it as far as it has no mass of its own: as particles leave,
// its velocity would lose its digits first, then be 0, and the solve, which takes velocities by volume, would see a wall.
fn velocity_with_around(slot: u32) -> vec4f {
    let own = node[slot];
    let word = cells[slot];
    if !has(word, NODE_SOLID) || (DRIVEN && has(word, NODE_DRIVEN)) { return own; }
    var around = vec4f(0.0);
    for (var k = 0u; k < block_size(); k++) {
        let near = cell_of(slot) + block_offset(k);
        if !in_ring(near) { continue; }
        let other = node[slot_of(near)];
        around += other.w * vec4f(other.xyz, 1.0);
    }
    let lacking = OWN_MASS * around.w - own.w;
    if lacking <= 0.0 { return own; }
    return vec4f((own.w * own.xyz + lacking * around.xyz / around.w) / (own.w + lacking), own.w);
}

@compute @workgroup_size(WORKGROUP)
fn reaction_start(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    elastic[part(NODE_FORCE, slot)] = vec4f(work[part(ELASTIC_FORCE, slot)].xyz, 0.0);
    elastic[part(START_VELOCITY, slot)] = velocity_with_around(slot);
}

// Nodes of bodies with next to no mass of their own. What has all of its mass, or is driven, stays as it is.
@compute @workgroup_size(WORKGROUP)
fn reaction_fill(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || !has(cells[slot], NODE_SOLID) { return; }
    node[slot] = elastic[part(START_VELOCITY, slot)];
}

// Velocity of the particles at a node of the ring, and its mass.
fn start_of(c: vec3i) -> vec4f {
    if !in_ring(c) { return vec4f(0.0); }
    return elastic[part(START_VELOCITY, slot_of(c))];
}

// (V . grad) V: central differences, one-sided at the edge of a body. A lighter node counts by its mass: what has none has no velocity.
fn carried_away(c: vec3i, own: vec4f) -> vec3f {
    var sum = vec3f(0.0);
    for (var n = 0u; n < DIM; n++) {
        let above = start_of(c + axis(n));
        let below = start_of(c - axis(n));
        let weight = min(vec2f(above.w, below.w) / own.w, vec2f(1.0));
        let change = weight.x * (above.xyz - own.xyz) + weight.y * (own.xyz - below.xyz);
        sum += own[n] * change / (max(weight.x + weight.y, 1.0) * params.spacing);
    }
    return sum;
}

// Reaction of a free node of a body, before walls. What a node has less than the inertia of the solve bears nothing.
fn reaction_of(slot: u32, here: vec3f) -> vec3f {
    let force = elastic[part(NODE_FORCE, slot)].xyz;
    if SHARED_VOLUME { return force / inertia[slot]; }
    let start = elastic[part(START_VELOCITY, slot)];
    let load = (here - start.xyz) / control.dt - work[part(SOLID_NODE, slot)].xyz;
    let size = dot(load, load);
    if size == 0.0 { return vec3f(0.0); }
    let seen = (force - start.w * carried_away(cell_of(slot), start)) / inertia[slot];
    return -clamp(-dot(seen, load) / size, 0.0, MOST_REACTION) * load;
}

// Between the forces of X* and the velocities that enter the solve.
@compute @workgroup_size(WORKGROUP)
fn reaction_before(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let here = node[slot];
    if !is_free(slot) || !(SHARED_VOLUME || has(cells[slot], NODE_SOLID)) || control.dt <= 0.0 {
        elastic[part(REACTION, slot)] = vec4f(0.0);
        return;
    }
    let v = here.xyz + control.dt * reaction_of(slot, here.xyz);
    // What a wall stops is borne by the wall.
    let stopped = select(velocity_at_wall(cell_of(slot), v), v, SHARED_VOLUME);
    elastic[part(REACTION, slot)] = vec4f((stopped - here.xyz) / control.dt, 0.0);
    node[slot] = vec4f(stopped, here.w);
}

// After the solve: the power of the pressures counts no reaction, so node and the kick of the solve go without it; their sum is the same.
@compute @workgroup_size(WORKGROUP)
fn reaction_aside(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || !has(cells[slot], NODE_SOLID) || node[slot].w <= 0.0 { return; }
    let e = elastic[part(REACTION, slot)].xyz;
    node[slot] = vec4f(node[slot].xyz - control.dt * e, node[slot].w);
    work[part(SOLID_NODE, slot)] -= vec4f(e, 0.0);
}

// After the kick of the solve, with what light nodes around have left of it: what is not elastic of the acceleration, and the velocity of
// the particles. Explicit sub-steps start from it. An implicit step looks for its own from there, where no particle is turned inside out;
// it keeps the kicked velocity.
@compute @workgroup_size(WORKGROUP)
fn reaction_after(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let start = elastic[part(START_VELOCITY, slot)];
    let gain = gain_around(slot, select(0u, block_size(), is_free(slot)));
    let here = node[slot] + vec4f(gain, 0.0);
    elastic[part(PASSED_ON, slot)] = vec4f(0.0);
    if !is_free(slot) || control.dt <= 0.0 {
        elastic[part(select(TO_SPREAD, KICKED_VELOCITY, IMPLICIT), slot)] = vec4f(select(vec3f(0.0), here.xyz, IMPLICIT), 0.0);
        return;
    }
    let e = elastic[part(REACTION, slot)].xyz;
    if IMPLICIT {
        elastic[part(KICKED_VELOCITY, slot)] = vec4f(here.xyz - control.dt * e, 0.0);
        node[slot] = vec4f(start.xyz, here.w);
        return;
    }
    elastic[part(TO_SPREAD, slot)] = vec4f((here.xyz - start.xyz) / control.dt - e, here.w);
    node[slot] = vec4f(start.xyz, here.w);
}

// As a body moves, nodes at its surface lose mass from sub-step to sub-step: what one can no longer take of its impulse goes to the free
// nodes around it, as a velocity.
@compute @workgroup_size(WORKGROUP)
fn reaction_left(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let push = elastic[part(TO_SPREAD, slot)];
    let left = push.w - MOST_SPREAD * select(0.0, node[slot].w, is_free(slot));
    let c = cell_of(slot);
    var around = 0.0;
    for (var k = 0u; k < select(0u, block_size(), left > 0.0); k++) {
        let near = c + block_offset(k);
        if in_ring(near) && is_free(slot_of(near)) { around += node[slot_of(near)].w; }
    }
    let share = select(0.0, left / around, around > 0.0);
    elastic[part(PASSED_ON, slot)] = vec4f(share * substep_time() * push.xyz, 0.0);
}
