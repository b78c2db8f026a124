// p2g: what do the solids look like on the grid?
// Gather form: each node sums the particles of the 3^DIM cells around it, in the order of the sort.
// Reads particles, order. Writes node (velocity, mass). On return the sums of mass and momentum are the particles'.
// With WITH_FORCE it leaves the elastic force [N] in the second half of work.
#include "shared/index.wgsl"
#include "shared/bspline.wgsl"
#include "shared/particle.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> affine: array<vec4f>;
@group(0) @binding(4) var<storage, read> stress: array<vec4f>;
@group(0) @binding(5) var<storage, read> order: array<u32>;
@group(0) @binding(6) var<storage, read> cell_start: array<u32>;
@group(0) @binding(7) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> work: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn p2g_gather(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
              @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    var momentum = vec4f(0.0);
    var force = vec3f(0.0);
    for (var k = 0u; k < block_size(); k++) {
        let offset = block_offset(k);
        if !inside(c + offset) { continue; }
        let source = slot_of(c + offset);
        let end = cell_start[source + 1u];
        for (var i = cell_start[source]; i < end; i++) {
            let p = order[i];
            let share = share_of(p, spline_at(position[p].xyz), -offset);
            momentum += share.momentum;
            force += share.force;
        }
    }
    if WITH_MASS {
        node[slot] = vec4f(select(vec3f(0.0), momentum.xyz / momentum.w, momentum.w > 0.0), momentum.w);
    }
    if WITH_FORCE { work[params.slots + slot] = vec4f(force, 0.0); }
}
