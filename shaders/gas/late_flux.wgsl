// fluid_update, before it: gas that follows the bodies, as their slots get it; fluid_momentum takes it from the cells.
// Reads node, the kick of the solve, the advected gas. Writes what slots of bodies owe.
#include "gas/late_share.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(5) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> energy: array<f32>;
@group(0) @binding(7) var<storage, read> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> work: array<vec4f>;    // second half: kick of the solve per time

@compute @workgroup_size(WORKGROUP)
fn late_flux(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = swept_slot(thread_index(group, lane));
    if slot >= params.slots || kind_of(cells[slot]) != SOLID || !has(cells[slot], NODE_GAS) { return; }
    let c = cell_of(slot);
    var flow = vec4f(0.0);
    var heat = 0.0;
    var species = vec2f(0.0);   // density and energy of the second gas
    for (var face = 0u; face < 2u * DIM; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;
        let other = select(c - axis(n), c + axis(n), up);
        if !inside(other) || kind_of(cells[slot_of(other)]) != GAS { continue; }
        let share = late_share(other, n, !up);
        flow += share * conserved[slot_of(other)];
        heat += share * energy[slot_of(other)];
        if SPECIES {
            let there = gas_at(slot_of(other));
            species += share * vec2f(there.species.x, energy_share_of(there.species.y) * there.energy);
        }
    }
    conserved[slot] += flow;
    energy[slot] += heat;
    if SPECIES {
        energy[part(SPECIES_DENSITY, slot)] += species.x;
        energy[part(SPECIES_VOLUME, slot)] += species.y;
    }
}
