// gas_advection: what a stage of the Runge-Kutta scheme starts from, and what it writes; the table in gas/gas_advection.wgsl.
// Needs ARS, in_first() and the other stages, in_space(), species_at(), unburned_at(), carried_heat() and the bindings conserved, work, energy.

// The state that the change of this stage is added to.
fn start_of(slot: u32, here: Gas) -> Gas {
    if !ARS || in_first() { return here; }
    // Density is never the solve's: it starts from that of U0 to the last bit.
    let factor = select(ARS_MIDDLE, ARS_RETURNED, in_third());
    let gained = in_space(conserved[slot]) - in_space(work[part(KEPT_FLOW, slot)]);
    return Gas(in_space(work[part(START_FLOW, slot)]) + factor * gained,
        energy[part(START_ENERGY, slot)] + factor * (energy[slot] - energy[part(KEPT_ENERGY, slot)]), species_at(START_SPECIES_DENSITY, START_SPECIES_VOLUME, slot),
        unburned_at(START_UNBURNED, slot));
}

fn write_species(density: u32, volume: u32, unburned: u32, slot: u32, species: vec3f) {
    if !SPECIES { return; }
    energy[part(density, slot)] = species.x;
    energy[part(volume, slot)] = species.y;
    if PRODUCTS { energy[part(unburned, slot)] = species.z; }
}

fn write_result(slot: u32, before: Gas, all: Change) {
    let change = all.high_order;
    let species = vec3f(before.species + change.species, before.unburned + change.unburned);
    if ARS && !in_second() {
        write_species(ADVECTED_SPECIES_DENSITY, ADVECTED_SPECIES_VOLUME, ADVECTED_UNBURNED, slot, species);
        work[part(ADVECTED_FLOW, slot)] = before.flow + change.flow;
        energy[part(ADVECTED_ENERGY, slot)] = before.energy + change.energy;
        energy[part(COLD_ENERGY, slot)] = before.energy + change.energy - all.heat;
        if in_third() { return; }
        write_species(START_SPECIES_DENSITY, START_SPECIES_VOLUME, START_UNBURNED, slot, vec3f(before.species, before.unburned));
        work[part(START_FLOW, slot)] = before.flow;
        work[part(KEPT_FLOW, slot)] = before.flow + change.flow;
        energy[part(START_ENERGY, slot)] = before.energy;
        energy[part(KEPT_ENERGY, slot)] = before.energy + change.energy - all.heat;
        energy[part(START_HEAT, slot)] = carried_heat(before);
    } else if !ARS && in_second() {
        let start = vec3f(species_at(SPECIES_DENSITY, SPECIES_VOLUME, slot), unburned_at(UNBURNED, slot));
        write_species(ADVECTED_SPECIES_DENSITY, ADVECTED_SPECIES_VOLUME, ADVECTED_UNBURNED, slot, 0.5 * (start + species));
        work[part(ADVECTED_FLOW, slot)] = 0.5 * (in_space(conserved[slot]) + before.flow + change.flow);
        energy[part(ADVECTED_ENERGY, slot)] = 0.5 * (energy[slot] + before.energy + change.energy);
    } else {
        write_species(HALFWAY_SPECIES_DENSITY, HALFWAY_SPECIES_VOLUME, HALFWAY_UNBURNED, slot, species);
        work[part(HALFWAY_FLOW, slot)] = before.flow + change.flow;
        energy[part(HALFWAY_ENERGY, slot)] = before.energy + change.energy;
    }
}
