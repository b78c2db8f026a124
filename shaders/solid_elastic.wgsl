// Elastic force before the pressure solve, for the two forms of the coupling that want it there.
// Shared volume: the solve starts from V + dt f / M, so that it knows what holds the pressure of the gas; afterwards the part of the
// acceleration that is not elastic is spread evenly over the elastic sub-steps. A body at rest under load then stays at rest.
// Coupling last: V + dt f / M at the walls is what the solve starts from, and the solved velocity moves the particles.
// [Cao et al. 2022, section 2.8 and fig. 14]
#include "shared/index.wgsl"
#include "shared/cell.wgsl"
#include "shared/control.wgsl"
#include "shared/grid_wall.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> work: array<vec4f>;        // second half: elastic force at the start of the step
@group(0) @binding(4) var<storage, read_write> node: array<vec4f>;
// Elastic acceleration before the solve, what else accelerates after it; second half, with a shared volume: velocity of the particles.
@group(0) @binding(5) var<storage, read_write> elastic: array<vec4f>;
@group(0) @binding(6) var<storage, read> inertia: array<f32>;

// Nodes without mass, and those that are driven, have no forces.
fn is_free(slot: u32) -> bool { return node[slot].w > 0.0 && !(DRIVEN && has(cells[slot], NODE_DRIVEN)); }

@compute @workgroup_size(WORKGROUP)
fn elastic_start(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots { return; }
    let mass = node[slot].w;
    // A predictor takes the masses of the solve, a step the true ones.
    let weight = select(mass, inertia[slot], SHARED_VOLUME);
    elastic[slot] = vec4f(select(vec3f(0.0), work[params.slots + slot].xyz / weight, mass > 0.0), 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn elastic_before(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots || !is_free(slot) { return; }
    let v = node[slot].xyz + control.dt * elastic[slot].xyz;
    if SHARED_VOLUME {
        elastic[params.slots + slot] = node[slot];
        node[slot] = vec4f(v, node[slot].w);
    } else {
        node[slot] = vec4f(velocity_at_wall(cell_of(slot), v), node[slot].w);
    }
}

// Shared volume, after the solve: the particles' velocity again, and all of the acceleration but the elastic one.
@compute @workgroup_size(WORKGROUP)
fn elastic_after(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots || !is_free(slot) { return; }
    let before = elastic[params.slots + slot];
    elastic[slot] = vec4f((node[slot].xyz - before.xyz) / control.dt - elastic[slot].xyz, before.w);
    node[slot] = before;
}

// More than this times the acceleration goes to no node whose mass moves on to others within a step.
const MOST_SPREAD = 2.0;

// Shared volume: the share of a sub-step. It is the impulse that is given evenly: as the body moves, nodes at its surface gain and lose
// mass from sub-step to sub-step.
@compute @workgroup_size(WORKGROUP)
fn elastic_spread(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots || !is_free(slot) { return; }
    let share = min(elastic[slot].w / node[slot].w, MOST_SPREAD) * control.dt / f32(control.substeps);
    node[slot] = vec4f(node[slot].xyz + share * elastic[slot].xyz, node[slot].w);
}

// Coupling last: what is left of the only sub-step.
@compute @workgroup_size(WORKGROUP)
fn elastic_walls(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots || !is_free(slot) { return; }
    node[slot] = vec4f(velocity_at_wall(cell_of(slot), node[slot].xyz), node[slot].w);
}
