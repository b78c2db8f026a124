// The second gas among what is owed: amounts that add up. These are its mass, and its share of the energy: from both follows the volume
// fraction of what parts become together. Owed gas of the same pressure changes none, and where fractions are even they stay so.
// Needs the bindings energy and owed_energy, and gas_at.

// How far the mass of one of two gases may fall below 0 when a cell settles what it owes, over that of both.
const SETTLED_SLACK = 1e-6;

fn owed_species(slot: u32) -> vec2f {
    if !SPECIES { return vec2f(0.0); }
    return vec2f(owed_energy[part(OWED_SPECIES_MASS, slot)], owed_energy[part(OWED_SPECIES_ENERGY, slot)]);
}

fn owe_species(slot: u32, species: vec2f) {
    if !SPECIES { return; }
    owed_energy[part(OWED_SPECIES_MASS, slot)] = species.x;
    owed_energy[part(OWED_SPECIES_ENERGY, slot)] = species.y;
}

// Explosive that has not burned goes with the density of the second gas.
fn unburned_with(unburned: f32, before: f32, density: f32) -> f32 { return unburned * clamp(density / max(before, 1e-30), 0.0, 1.0); }

fn hold_species(slot: u32, species: vec2f) {
    if !SPECIES { return; }
    if PRODUCTS { energy[part(UNBURNED, slot)] = unburned_with(energy[part(UNBURNED, slot)], energy[part(SPECIES_DENSITY, slot)], species.x); }
    energy[part(SPECIES_DENSITY, slot)] = species.x;
    energy[part(SPECIES_VOLUME, slot)] = species.y;
}

// Density and energy of the second gas in a GAS cell.
fn summed_species(gas: Gas) -> vec2f {
    if !SPECIES { return vec2f(0.0); }
    return vec2f(gas.species.x, energy_share_of(gas.species.y) * gas.energy);
}

// Gas of a density, momentum, energy and sums of the second gas, in the place of another.
fn gas_of_sums(flow: vec4f, total: f32, sums: vec2f, before: Gas) -> Gas {
    if !SPECIES { return Gas(flow, total, vec2f(0.0), 0.0); }
    let share = clamp(sums.y / max(total, 1e-30), 0.0, 1.0);
    let volumes = vec2f(share * (params.species_gamma - 1.0), (1.0 - share) * (params.gamma - 1.0));
    return Gas(flow, total, vec2f(sums.x, volumes.x / (volumes.x + volumes.y)),
        unburned_with(before.unburned, before.species.x, sums.x));
}

// Least p / rho^gamma that settling may leave.
fn least_entropy_of(phi: f32) -> f32 {
    if SPECIES && phi > 0.5 { return params.species_least_entropy; }
    return params.least_entropy;
}

// Whether settling has taken more of one gas than there was.
fn lacks_a_gas(gas: Gas) -> bool {
    let slack = SETTLED_SLACK * gas.flow.x;
    return SPECIES && (gas.species.x < -slack || gas.species.x > gas.flow.x + slack);
}
