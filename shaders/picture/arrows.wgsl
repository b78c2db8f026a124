// Velocity arrows of a 2D picture.
// sample_arrows: reads conserved, cells; writes arrows: velocity at the middle of each of view.arrows places, and 1 for gas.

#include "picture/view.wgsl"

@group(0) @binding(1) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> arrows: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn sample_arrows(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= view.arrows.x * view.arrows.y { return; }
    let part = (vec2f(f32(i % view.arrows.x), f32(i / view.arrows.x)) + 0.5) / vec2f(view.arrows);
    let cell = vec2i(part * vec2f(view.cells.xy));
    let slot = slot_of(vec3i(cell, 0));
    let state = conserved[slot];
    arrows[i] = vec4f(state.yz / state.x, 0.0, f32(kind_of(cells[slot]) == KIND_GAS));
}
