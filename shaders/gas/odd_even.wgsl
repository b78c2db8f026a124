// odd_even: the mode of alternating cells, which pressures at vertices do not see and the solve leaves alone. Around every vertex
// whose cells are all GAS the alternating mean of the state is found, and a share of it is taken from each cell with its sign:
// what one cell loses its neighbours gain. A vertex takes nothing where a cell would not stand it: in strong shocks what alternates is the
// shock. At vertices of a body's surface gas cells mix instead: between shards no flux of momentum would take a velocity into a wall from
// a cell, for closed faces have none. Reads gas, cells. Writes gas, by way of work.
#include "shared/domain.wgsl"
#include "shared/gas_at.wgsl"

override FILTER: f32;   // share of the mode that one step removes

// A cell keeps at least this part of density and internal energy, even if all of its vertices take as much as one does. Both are concave
// functions of the state, so it keeps it whatever the others take.
const KEPT = 0.5;

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> energy: array<f32>;
@group(0) @binding(5) var<storage, read> extra: array<u32>;

fn sign_of(corner: vec3i) -> f32 { return f32(1 - 2 * ((corner.x + corner.y + corner.z) & 1)); }

fn gas_beside(v: vec3i, corner: u32) -> Gas {
    let slot = slot_of(v - reach() + corner_offset(corner));
    return Gas(conserved[slot], energy[slot], species_now(slot), unburned_at(slot));
}

// Whether of each of two gases KEPT is left, by density and by volume.
fn has_both(gas: Gas, left: Gas) -> bool {
    if !SPECIES { return true; }
    let before = vec4f(gas.species, gas.flow.x - gas.species.x, 1.0 - gas.species.y);
    let after = vec4f(left.species, left.flow.x - left.species.x, 1.0 - left.species.y);
    return all(after >= KEPT * before);
}

// Whether a cell with one sign can give that much at all of its vertices.
fn stands(gas: Gas, taken: Gas, sign: f32) -> bool {
    let all = sign * f32(corner_count());
    let left = Gas(gas.flow - all * taken.flow, gas.energy - all * taken.energy, gas.species - all * taken.species, gas.unburned);
    return left.flow.x >= KEPT * gas.flow.x && internal_energy(left) >= KEPT * internal_energy(gas) && has_both(gas, left);
}

// What the filter takes from a cell beside a vertex, up to the sign: positive for the one below it on all axes or an even number of
// cells away.
fn taken_at(v: vec3i) -> Gas {
    let nothing = Gas(vec4f(0.0), 0.0, vec2f(0.0), 0.0);
    var sum = nothing;
    var densest = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - reach() + corner_offset(k);
        if !inside(c) || kind_of(cells[slot_of(c)]) != GAS || cut_entry(slot_of(c)) != 0u { return nothing; }
        let sign = sign_of(corner_offset(k));
        let gas = gas_beside(v, k);
        sum.flow += sign * gas.flow;
        densest = max(densest, gas.flow.x);
        sum.energy += sign * gas.energy;
        sum.species += sign * gas.species;
    }
    let share = FILTER / f32(corner_count() * corner_count());
    let flow = share * sum.flow;
    let unit = LAST_PLACE * power_of_two(densest);
    let species = share * sum.species;
    let taken = Gas(vec4f(whole(flow.x, unit), flow.yzw), share * sum.energy, vec2f(whole(species.x, unit), species.y), 0.0);
    for (var k = 0u; k < corner_count(); k++) {
        if !stands(gas_beside(v, k), taken, sign_of(corner_offset(k))) { return nothing; }
    }
    return taken;
}

// Whether a cell at a vertex is gas with gas beside it there.
fn mixes(v: vec3i, c: vec3i) -> bool {
    if kind_of(cells[slot_of(c)]) != GAS { return false; }
    for (var n = 0u; n < DIM; n++) {
        let other = select(c - axis(n), c + axis(n), v[n] > c[n]);
        if kind_of(cells[slot_of(other)]) == GAS { return true; }
    }
    return false;
}

// Cells that mix at a vertex; none where there is no body.
fn mixing_count(v: vec3i) -> f32 {
    var count = 0.0;
    var bodies = false;
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - corner_offset(k);
        bodies = bodies || kind_of(cells[slot_of(c)]) == SOLID;
        count += f32(mixes(v, c));
    }
    return select(0.0, count, bodies);
}

// What a cell takes from the others at a vertex: towards the mean, by pairs, so that what one gives is what the other takes.
fn mixed_at(v: vec3i, c: vec3i, slot: u32) -> Gas {
    var sum = Gas(vec4f(0.0), 0.0, vec2f(0.0), 0.0);
    let count = mixing_count(v);
    if count == 0.0 || !mixes(v, c) { return sum; }
    let share = FILTER / (f32(corner_count()) * count);
    for (var k = 0u; k < corner_count(); k++) {
        let other = v - corner_offset(k);
        if !mixes(v, other) { continue; }
        let at = slot_of(other);
        let flow = share * (conserved[at] - conserved[slot]);
        let unit = LAST_PLACE * power_of_two(max(conserved[at].x, conserved[slot].x));
        sum.flow += vec4f(whole(flow.x, unit), flow.yzw);
        sum.energy += share * (energy[at] - energy[slot]);
        let species = share * (species_now(at) - species_now(slot));
        sum.species += vec2f(whole(species.x, unit), species.y);
    }
    return sum;
}

@compute @workgroup_size(WORKGROUP)
fn odd_even_find(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    var change = Gas(vec4f(0.0), 0.0, vec2f(0.0), 0.0);
    if kind_of(cells[slot]) == GAS {
        let c = cell_of(slot);
        for (var k = 0u; k < corner_count(); k++) {
            let corner = corner_offset(k);
            let taken = taken_at(c + corner);
            let sign = sign_of(reach() - corner);
            change.flow -= sign * taken.flow;
            change.energy -= sign * taken.energy;
            change.species -= sign * taken.species;
            if SOLIDS {
                let mixed = mixed_at(c + corner, c, slot);
                change.flow += mixed.flow;
                change.energy += mixed.energy;
                change.species += mixed.species;
            }
        }
    }
    work[part(FILTER_FLOW, slot)] = change.flow;
    if SPECIES {
        energy[part(FILTER_SPECIES_DENSITY, slot)] = change.species.x;
        energy[part(FILTER_SPECIES_VOLUME, slot)] = change.species.y;
    }
    if inside(cell_of(slot)) {
        energy[part(FILTER_ENERGY, slot)] = change.energy;
    } else {
        // What an open face was told belongs to the gas before the filter: the next carrier has none of it, as at the start.
        energy[part(OPEN_PRESSURE, slot)] = 0.0;
    }
}

@compute @workgroup_size(WORKGROUP)
fn odd_even_remove(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    conserved[slot] += work[part(FILTER_FLOW, slot)];
    energy[slot] += select(0.0, energy[part(FILTER_ENERGY, slot)], inside(cell_of(slot)));
    if SPECIES {
        energy[part(SPECIES_DENSITY, slot)] += energy[part(FILTER_SPECIES_DENSITY, slot)];
        energy[part(SPECIES_VOLUME, slot)] += energy[part(FILTER_SPECIES_VOLUME, slot)];
    }
}
