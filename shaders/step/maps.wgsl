// maps: the largest pressure, the impulse and the largest plastic strain of each place since the start, in scenes that ask for them.
// map_gas: after every step: reads gas, cells; writes the first three numbers of a slot's map.
// map_particles: after every step: reads particles; raises the fourth.
#include "shared/index.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;
@group(0) @binding(5) var<storage, read> position: array<vec4f>;
@group(0) @binding(6) var<storage, read> affine: array<vec4f>;
@group(0) @binding(7) var<storage, read> deformation: array<vec4f>;
// Four words per slot, bits of floats: largest pressure; integral over time of what is above the ambient pressure, and what that has lost
// to rounding; largest plastic strain, which is not negative, so that its bits have its order.
@group(0) @binding(8) var<storage, read_write> maps: array<atomic<u32>>;

fn kept(at: u32) -> f32 { return bitcast<f32>(atomicLoad(&maps[at])); }
fn keep(at: u32, value: f32) { atomicStore(&maps[at], bitcast<u32>(value)); }

@compute @workgroup_size(WORKGROUP)
fn map_gas(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || kind_of(cells[slot]) != GAS { return; }
    let p = pressure_of(gas_at(slot));
    let at = 4u * slot;
    if p > kept(at) { keep(at, p); }
    // Many small terms: the sum keeps what each addition loses. [Kahan 1965]
    let term = max(p - params.ambient_pressure, 0.0) * control.duration - kept(at + 2u);
    let before = kept(at + 1u);
    let sum = rounded(before + term);
    keep(at + 2u, rounded(sum - before) - term);
    keep(at + 1u, sum);
}

@compute @workgroup_size(WORKGROUP)
fn map_particles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles { return; }
    // What has left the domain, and what has broken: there the number is another.
    if deformation[3u * p + 1u].w == 0.0 || deformation[3u * p + 2u].w == 1.0 { return; }
    let strain = affine[3u * p + 1u].w;
    if strain > 0.0 { atomicMax(&maps[4u * slot_of(cell_at(position[p].xyz)) + 3u], bitcast<u32>(strain)); }
}
