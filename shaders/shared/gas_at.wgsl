// The gas of a slot as it stands.
// Needs the bindings conserved and energy.
#include "shared/state.wgsl"

// Two parts of a slot, of the second gas; 0 without one.
fn species_at(density: u32, volume: u32, slot: u32) -> vec2f {
    if !SPECIES { return vec2f(0.0); }
    return vec2f(energy[part(density, slot)], energy[part(volume, slot)]);
}

// Density and volume fraction of the second gas.
fn species_now(slot: u32) -> vec2f { return species_at(SPECIES_DENSITY, SPECIES_VOLUME, slot); }

fn unburned_at(slot: u32) -> f32 {
    if !PRODUCTS { return 0.0; }
    return energy[part(UNBURNED, slot)];
}

fn gas_at(slot: u32) -> Gas { return Gas(in_space(conserved[slot]), energy[slot], species_now(slot), unburned_at(slot)); }

// rho c^2 over the pressure.
fn gamma_at(slot: u32, pressure: f32) -> f32 {
    if !SPECIES { return params.gamma; }
    if PRODUCTS { return stiffness_ratio(gas_at(slot), pressure); }
    return gamma_of(energy[part(SPECIES_VOLUME, slot)]);
}
