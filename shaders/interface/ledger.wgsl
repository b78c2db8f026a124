// interface, the ledger: what happens to the gas of cells that a body covers or uncovers.
// A SOLID slot of the gas state keeps the gas of the cell it covers plus all fluxes through its faces: owed gas, not pressurised.
// `owed` is what a GAS cell still owes (negative: it was filled with more than it holds). Gas plus owed gas is conserved.
// A GAS cell settles what it owes if it can stand that, so much per step that its state changes little, and passes the rest on to its gas
// neighbours. A SOLID cell at the surface holds as much as it covered, and gives it off through its faces while the body goes on to the
// next cell; what is beyond goes to its gas neighbours. A buried one passes all that it has back to the surface, if that is next to it,
// or to all its neighbours: through the body gas would leak to its lee.
#include "shared/index.wgsl"
#include "shared/gas_at.wgsl"
#include "interface/owed_species.wgsl"

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> energy: array<f32>;
@group(0) @binding(4) var<storage, read_write> owed_flow: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> owed_energy: array<f32>;
@group(0) @binding(6) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(7) var<storage, read> ghost: array<f32>;
@group(0) @binding(8) var<storage, read> node: array<vec4f>;

// Largest relative change of density and internal energy that a cell settles in one step.
const SETTLED_PER_STEP = 0.1;

// Share of its entropy p / rho^gamma that a cell keeps when it settles what it owes, once it is colder than all gas of the start.
const KEPT_ENTROPY = 0.9999;

// What a SOLID cell at the surface holds at most, in gas of the density beside it.
const HELD_AT_SURFACE = 1.1;

// Owed gas of either sign meets on its way, and what is left of their mass, momentum and energy need not belong together. `left` is the
// share of density and internal energy that a cell must keep were all settled. It may be negative: what is owed may exceed what
// the cell holds, for the rest goes on to its neighbours before it is due. (Below a density of zero its energy bounds nothing.)
// `speed` is the largest change of velocity per step, in speeds of sound.
struct Bounds { left: f32, speed: f32 }
const IN_THE_OPEN = Bounds(-0.5, 0.3);
// Two faces or more without gas behind them: a pocket, which what it hands on comes back to. It would be drained, or driven by momentum that
// came without mass.
const ENCLOSED = Bounds(0.25, 0.1);

struct Sum { flow: vec4f, energy: f32, species: vec2f, count: f32 }

// What a SOLID slot holds of the second gas. One that has just been covered has the volume fraction of its gas still.
fn covered_species(slot: u32) -> vec2f {
    if SPECIES && previous_kind_of(cells[slot]) == GAS { return summed_species(gas_at(slot)); }
    return species_now(slot);
}

fn add_if_old_gas(sum: ptr<function, Sum>, c: vec3i) {
    if !inside(c) { return; }
    let slot = slot_of(c);
    if previous_kind_of(cells[slot]) != GAS { return; }
    (*sum).flow += conserved[slot];
    (*sum).energy += energy[slot];
    (*sum).species += summed_species(gas_at(slot));
    (*sum).count += 1.0;
}

// Mean of the cells that were gas before: face neighbours, else the 3^DIM block, else the 5^DIM block.
fn fill_from_neighbours(c: vec3i) -> Sum {
    var sum: Sum;
    for (var a = 0u; a < DIM; a++) {
        add_if_old_gas(&sum, c - axis(a));
        add_if_old_gas(&sum, c + axis(a));
    }
    if sum.count > 0.0 { return sum; }
    for (var far = 1; far <= 2; far++) {
        let r = far * reach();
        for (var z = -r.z; z <= r.z; z++) {
            for (var y = -r.y; y <= r.y; y++) {
                for (var x = -r.x; x <= r.x; x++) { add_if_old_gas(&sum, c + vec3i(x, y, z)); }
            }
        }
        if sum.count > 0.0 { return sum; }
    }
    return sum;
}

// A pocket with no gas around: gas at the ghost pressure, isentropic from the ambient state, moving with the solid.
fn trapped_gas(c: vec3i, slot: u32) -> Gas {
    var pressure = 0.0;
    for (var k = 0u; k < corner_count(); k++) { pressure += ghost[slot_of(c + corner_offset(k))]; }
    pressure = max(pressure / f32(corner_count()), 1e-3 * params.ambient_pressure);
    let density = params.ambient_density * pow(pressure / params.ambient_pressure, 1.0 / gamma_of(params.ambient_volume));
    return gas_from_primitive(density, node[slot].xyz, pressure, vec2f(density * params.ambient_share, params.ambient_volume), 0.0);
}

// At the start bodies cover no gas.
@compute @workgroup_size(WORKGROUP)
fn ledger_start(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || kind_of(cells[slot]) != SOLID { return; }
    conserved[slot] = vec4f(0.0);
    energy[slot] = 0.0;
    hold_species(slot, vec2f(0.0));
}

@compute @workgroup_size(WORKGROUP)
fn ledger_uncover(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let word = cells[slot];
    if kind_of(word) != GAS || previous_kind_of(word) != SOLID { return; }
    let c = cell_of(slot);
    let sum = fill_from_neighbours(c);
    let count = max(sum.count, 1.0);
    var filled = gas_of_sums(sum.flow / count, sum.energy / count, sum.species / count, gas_at(slot));
    if sum.count == 0.0 { filled = trapped_gas(c, slot); }
    owed_flow[slot] += (conserved[slot] - filled.flow) * cell_volume();
    owed_energy[slot] += (energy[slot] - filled.energy) * cell_volume();
    owe_species(slot, owed_species(slot) + (species_now(slot) - summed_species(filled)) * cell_volume());
    conserved[slot] = filled.flow;
    energy[slot] = filled.energy;
    hold_species(slot, filled.species);
}

fn neighbours_of_kind(c: vec3i, kind: u32) -> u32 {
    var count = 0u;
    for (var a = 0u; a < DIM; a++) {
        let slot = slot_of(c);
        if inside(c - axis(a)) { count += u32(kind_of(cells[slot - step_of(a)]) == kind); }
        if inside(c + axis(a)) { count += u32(kind_of(cells[slot + step_of(a)]) == kind); }
    }
    return count;
}

// Gas with a part of what is owed.
fn with_part(gas: Gas, slot: u32, part: f32) -> Gas {
    let each = part / cell_volume();
    return gas_of_sums(gas.flow + each * owed_flow[slot], gas.energy + each * owed_energy[slot], summed_species(gas) + each * owed_species(slot), gas);
}

fn at_surface(slot: u32) -> bool { return kind_of(cells[slot]) == SOLID && neighbours_of_kind(cell_of(slot), GAS) > 0u; }

// SOLID neighbours of a slot that have gas beside them.
fn surface_neighbours(slot: u32) -> u32 {
    let c = cell_of(slot);
    var count = 0u;
    for (var a = 0u; a < DIM; a++) {
        if inside(c - axis(a)) { count += u32(at_surface(slot - step_of(a))); }
        if inside(c + axis(a)) { count += u32(at_surface(slot + step_of(a))); }
    }
    return count;
}

// Density of the gas beside a slot.
fn density_beside(slot: u32) -> f32 {
    var sum = vec2f(0.0);
    for (var a = 0u; a < DIM; a++) {
        for (var side = 0u; side < 2u; side++) {
            let other = select(slot - step_of(a), slot + step_of(a), side == 1u);
            if kind_of(cells[other]) == GAS { sum += vec2f(1.0, conserved[other].x); }
        }
    }
    return sum.y / max(sum.x, 1.0);
}

// Part of what it owes that a gas cell with so many gas neighbours settles now.
fn settled_part(slot: u32, gas_neighbours: u32) -> f32 {
    let gas = Gas(conserved[slot], energy[slot], species_now(slot), unburned_at(slot));
    let before = internal_energy(gas);
    let all = with_part(gas, slot, 1.0);
    var bounds = ENCLOSED;
    if gas_neighbours + 1u >= 2u * DIM { bounds = IN_THE_OPEN; }
    if all.flow.x < bounds.left * gas.flow.x || internal_energy(all) < bounds.left * before { return 0.0; }
    // Settling takes the entropy not below what the floor keeps, nor further down where it is there: the floor would give it back.
    let gamma = gamma_of(gas.species.y);
    let coldest = min(KEPT_ENTROPY * pressure_of(gas) / pow(gas.flow.x, gamma), least_entropy_of(gas.species.y));
    let kick = bounds.speed * bounds.speed * gamma * grueneisen_of(gas.species.y) * before / gas.flow.x;
    var part = min(1.0, SETTLED_PER_STEP * gas.flow.x / max(abs(all.flow.x - gas.flow.x), 1e-30));
    for (var k = 0; k < 12; k++) {
        let some = with_part(gas, slot, part);
        let change = some.flow.yzw / some.flow.x - gas.flow.yzw / gas.flow.x;
        let cools = pressure_of(some) < coldest * pow(some.flow.x, gamma);
        if lacks_a_gas(some) { part *= 0.5; continue; }
        if abs(internal_energy(some) - before) <= SETTLED_PER_STEP * before && dot(change, change) <= kick && !cools { return part; }
        part *= 0.5;
    }
    return 0.0;
}

// Who gets what a slot hands on: its GAS neighbours, its SOLID ones at the surface, or all that are SOLID.
const TO_GAS = 0.0;
const TO_SURFACE = 1.0;
const TO_SOLID = 2.0;

struct Handed { flow: vec4f, energy: f32, species: vec2f, receivers: f32 }

fn handed_by_gas(slot: u32, c: vec3i) -> Handed {
    let count = neighbours_of_kind(c, GAS);
    if count == 0u { return Handed(vec4f(0.0), 0.0, vec2f(0.0), TO_GAS); }
    let each = (1.0 - settled_part(slot, count)) / f32(count);
    return Handed(each * owed_flow[slot], each * owed_energy[slot], each * owed_species(slot), TO_GAS);
}

fn handed_by_solid(slot: u32, c: vec3i) -> Handed {
    let flow = conserved[slot] * cell_volume() + owed_flow[slot];
    let heat = energy[slot] * cell_volume() + owed_energy[slot];
    let species = covered_species(slot) * cell_volume() + owed_species(slot);
    let gas = neighbours_of_kind(c, GAS);
    if gas > 0u {
        let part = 1.0 - HELD_AT_SURFACE * density_beside(slot) * cell_volume() / max(abs(flow.x), 1e-30);
        let each = max(part, 0.0) / f32(gas);
        return Handed(each * flow, each * heat, each * species, TO_GAS);
    }
    let surface = surface_neighbours(slot);
    let count = select(neighbours_of_kind(c, SOLID), surface, surface > 0u);
    let each = select(0.0, 1.0 / f32(max(count, 1u)), count > 0u);
    return Handed(each * flow, each * heat, each * species, select(TO_SOLID, TO_SURFACE, surface > 0u));
}

// To each of the receivers.
@compute @workgroup_size(WORKGROUP)
fn ledger_share(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let kind = kind_of(cells[slot]);
    let owes = kind == GAS && (any(owed_flow[slot] != vec4f(0.0)) || owed_energy[slot] != 0.0);
    var out: Handed;
    for (var turn = 0u; turn < when(owes); turn++) { out = handed_by_gas(slot, cell_of(slot)); }
    for (var turn = 0u; turn < when(kind == SOLID); turn++) { out = handed_by_solid(slot, cell_of(slot)); }
    work[part(HANDED_FLOW, slot)] = out.flow;
    energy[part(HANDED_ENERGY, slot)] = out.energy;
    if SPECIES {
        energy[part(HANDED_SPECIES_MASS, slot)] = out.species.x;
        energy[part(HANDED_SPECIES_ENERGY, slot)] = out.species.y;
    }
    if kind == SOLID { energy[part(RECEIVERS, slot)] = out.receivers; }
}

// What the neighbours of a slot hand on to it.
fn incoming(slot: u32, kind: u32) -> Sum {
    var sum: Sum;
    let surface = kind == SOLID && at_surface(slot);
    for (var a = 0u; a < DIM; a++) {
        for (var side = 0u; side < 2u; side++) {
            let other = select(slot - step_of(a), slot + step_of(a), side == 1u);
            let kind_there = kind_of(cells[other]);
            var takes = kind_there == GAS || kind_there == SOLID;
            if kind == SOLID {
                let receivers = energy[part(RECEIVERS, other)];
                takes = kind_there == SOLID && (receivers == TO_SOLID || (receivers == TO_SURFACE && surface));
            }
            if !takes { continue; }
            sum.flow += work[part(HANDED_FLOW, other)];
            sum.energy += energy[part(HANDED_ENERGY, other)];
            sum.species += species_at(HANDED_SPECIES_MASS, HANDED_SPECIES_ENERGY, other);
        }
    }
    return sum;
}

@compute @workgroup_size(WORKGROUP)
fn ledger_settle(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let kind = kind_of(cells[slot]);
    let c = cell_of(slot);
    if (kind != GAS && kind != SOLID) || !inside(c) { return; }
    var flow = owed_flow[slot];
    var heat = owed_energy[slot];
    var species = owed_species(slot);
    let owes = kind == GAS && (any(flow != vec4f(0.0)) || heat != 0.0);
    for (var turn = 0u; turn < when(owes); turn++) {
        let part = settled_part(slot, neighbours_of_kind(c, GAS));
        if SPECIES { hold_species(slot, with_part(gas_at(slot), slot, part).species); }
        conserved[slot] += part * flow / cell_volume();
        energy[slot] += part * heat / cell_volume();
        flow *= 1.0 - part;
        heat *= 1.0 - part;
        species *= 1.0 - part;
    }
    if kind == SOLID {
        flow += conserved[slot] * cell_volume();
        heat += energy[slot] * cell_volume();
        species += covered_species(slot) * cell_volume();
    }
    let handed_on = any(work[part(HANDED_FLOW, slot)] != vec4f(0.0)) || energy[part(HANDED_ENERGY, slot)] != 0.0;
    for (var turn = 0u; turn < when(handed_on); turn++) {
        let keeps = at_surface(slot);
        let count = f32(neighbours_of_kind(c, GAS));
        flow = select(vec4f(0.0), flow - count * work[part(HANDED_FLOW, slot)], keeps);
        heat = select(0.0, heat - count * energy[part(HANDED_ENERGY, slot)], keeps);
        species = select(vec2f(0.0), species - count * species_at(HANDED_SPECIES_MASS, HANDED_SPECIES_ENERGY, slot), keeps);
    }
    let more = incoming(slot, kind);
    flow += more.flow;
    heat += more.energy;
    species += more.species;
    if kind == SOLID {
        conserved[slot] = flow / cell_volume();
        energy[slot] = heat / cell_volume();
        hold_species(slot, species / cell_volume());
        flow = vec4f(0.0);
        heat = 0.0;
        species = vec2f(0.0);
    }
    owed_flow[slot] = flow;
    owed_energy[slot] = heat;
    owe_species(slot, species);
}
