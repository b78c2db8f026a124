// Dust as pictures show it.
// evaluate_dust: reads dust, cells; writes field, NO_VALUE where there is no gas.
// pack_dust: reads dust, cells; writes how much of it is there, behind the cubes' places in the black-body ramp and their soot.
#include "picture/view.wgsl"
#include "picture/packing.wgsl"

@group(0) @binding(1) var<storage, read> dust: array<f32>;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> field: array<f32>;
@group(0) @binding(4) var<storage, read_write> glow: array<vec2u>;

@compute @workgroup_size(WORKGROUP)
fn evaluate_dust(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= cell_count() { return; }
    let slot = slot_of(cell_of(i));
    field[i] = select(NO_VALUE, dust[slot], kind_of(cells[slot]) == KIND_GAS);
}

@compute @workgroup_size(WORKGROUP)
fn pack_dust(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= cube_count() { return; }
    let cube = cube_of(i);
    var fractions = array<f32, 8>();
    for (var corner = 0u; corner < 8u; corner++) {
        let slot = slot_of(clamp(corner_cell(cube, corner), vec3i(0), vec3i(view.cells) - 1));
        fractions[corner] = select(-1.0, depth_fraction(view.dust * dust[slot] * view.spacing), kind_of(cells[slot]) == KIND_GAS);
    }
    glow[dust_place(i)] = packed_corners(fractions);
}
