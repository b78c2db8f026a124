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
    // Three neighbours along x lie side by side in `order`; the ring around the grid holds no particles.
    for (var z = -reach().z; z <= reach().z; z++) {
        for (var y = -reach().y; y <= reach().y; y++) {
            let row = c + vec3i(0, y, z);
            if any(row.yz < vec2i(0)) || any(row.yz >= vec2i(params.cells.yz)) { continue; }
            let middle = u32(i32(slot) + i32(params.stride.x) * (y + i32(params.stride.y) * z));
            let end = cell_start[min(middle + 2u, params.slots)];
            for (var i = cell_start[max(middle, 1u) - 1u]; i < end; i++) {
                let p = order[i];
                let s = spline_at(position[p].xyz);
                let share = share_of(p, s, c - s.base);
                momentum += share.momentum;
                force += share.force;
            }
        }
    }
    if WITH_MASS {
        node[slot] = vec4f(select(vec3f(0.0), momentum.xyz / momentum.w, momentum.w > 0.0), momentum.w);
    }
    if WITH_FORCE { work[params.slots + slot] = vec4f(force, 0.0); }
}
