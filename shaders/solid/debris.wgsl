// debris: which debris is dropped?
// Reads particles and their cells. Takes out broken particles of materials that ask for it where no whole one is in their cell or beside it:
// they count as gone, and their mass turns negative, so that sums can tell them from what has left through a side.
#include "shared/index.wgsl"
#include "materials/law.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> position: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> deformation: array<vec4f>;
@group(0) @binding(4) var<storage, read> affine: array<vec4f>;
@group(0) @binding(5) var<storage, read> order: array<u32>;
@group(0) @binding(6) var<storage, read> cell_start: array<u32>;

fn is_broken_particle(p: u32) -> bool { return deformation[3u * p + 2u].w >= 1.0; }

// Whether a particle of the block of cells around a place is whole, by the cells of the last sort.
fn whole_is_near(c: vec3i) -> bool {
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        if !inside(near) { continue; }
        let slot = slot_of(near);
        let end = cell_start[slot + 1u];
        for (var i = cell_start[slot]; i < end; i++) {
            if !is_broken_particle(order[i]) { return true; }
        }
    }
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn debris_drop(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles || deformation[3u * p + 1u].w != 1.0 || !is_broken_particle(p) { return; }
    if materials[material_index(affine[3u * p + 2u].w)].debris == 0u || whole_is_near(cell_at(position[p].xyz)) { return; }
    position[p].w = -position[p].w;
    deformation[3u * p + 1u].w = 0.0;
    atomicStore(&control.unsorted, 1u);
    atomicAdd(&control.escaped, 1u);
}
