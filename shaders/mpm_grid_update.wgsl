// mpm_grid_update: how do the nodes move?
// Reads the elastic force of this sub-step. Writes node velocity. On return no node moves out through a wall.
// V += dt_s f / M with the true mass; wall rules are one-sided, nothing is glued. [Cao et al. 2022, step 6]
#include "shared/index.wgsl"
#include "shared/cell.wgsl"
#include "shared/control.wgsl"
#include "shared/grid_wall.wgsl"
#include "shared/given.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> work: array<vec4f>;        // second half: elastic force
@group(0) @binding(4) var<storage, read_write> node: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn mpm_grid_update(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                   @builtin(local_invocation_index) lane: u32) {
    let time = control.dt / f32(control.substeps);
    var given = vec4f(0.0);
    for (var slot = thread_index(group, groups, lane); slot < params.slots; slot += groups.x * groups.y * WORKGROUP) {
        let here = node[slot];
        if here.w <= 0.0 || (DRIVEN && has(cells[slot], NODE_DRIVEN)) { continue; }
        let free = here.xyz + time * work[params.slots + slot].xyz / here.w;
        let v = velocity_at_wall(cell_of(slot), free);
        node[slot] = vec4f(v, here.w);
        given += given_to(here.w, v - free, here.xyz, v);
    }
    add_given(thread_index(group, groups, 0u) / WORKGROUP, lane, given, false);
}
