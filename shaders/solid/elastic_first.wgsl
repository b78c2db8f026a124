// elastic_first: the elastic step before the pressure solve, `numerics.paper.coupling = "last"`. V + dt f / M at the walls is what the solve starts
// from, and the solved velocity moves the particles. [Cao et al. 2022, section 2.8 and fig. 14]
// Reads the elastic force of the present stress. Writes node velocity.
#include "shared/index.wgsl"
#include "solid/grid_wall.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> work: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> elastic: array<vec4f>;

// Nodes without mass, and those that are driven, have no forces.
fn is_free(slot: u32) -> bool { return node[slot].w > 0.0 && !(DRIVEN && has(cells[slot], NODE_DRIVEN)); }

@compute @workgroup_size(WORKGROUP)
fn elastic_start(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let mass = node[slot].w;
    elastic[part(ELASTIC_ACCELERATION, slot)] = vec4f(select(vec3f(0.0), work[part(ELASTIC_FORCE, slot)].xyz / mass, mass > 0.0), 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn elastic_before(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || !is_free(slot) { return; }
    let v = node[slot].xyz + control.dt * elastic[part(ELASTIC_ACCELERATION, slot)].xyz;
    node[slot] = vec4f(velocity_at_wall(cell_of(slot), v), node[slot].w);
}

// What is left of the only sub-step.
@compute @workgroup_size(WORKGROUP)
fn elastic_walls(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || !is_free(slot) { return; }
    node[slot] = vec4f(velocity_at_wall(cell_of(slot), node[slot].xyz), node[slot].w);
}
