// The gas of a slot as it stands.
// Needs the bindings conserved and energy.

// Density and volume fraction of the second gas, the part that holds the first of both and the one behind it.
fn species_at(first: u32, slot: u32) -> vec2f {
    if !SPECIES { return vec2f(0.0); }
    return vec2f(energy[part(first, slot)], energy[part(first + 1u, slot)]);
}

fn gas_at(slot: u32) -> Gas { return Gas(in_space(conserved[slot]), energy[slot], species_at(SPECIES_DENSITY, slot)); }

fn gamma_at(slot: u32) -> f32 {
    if !SPECIES { return params.gamma; }
    return gamma_of(energy[part(SPECIES_VOLUME, slot)]);
}
