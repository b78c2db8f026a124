// interface, the ledger: what happens to the gas of cells that a body covers or uncovers.
// A SOLID slot of the gas state keeps the gas of the cell it covers plus all fluxes through its faces, by sides [interface/sides.wgsl].
// `owed` is what a GAS cell still owes (negative: it was filled with more than it holds). Gas plus owed gas is conserved.
// A GAS cell settles what it owes if it can stand that, so much per step that its state changes little, and passes the rest on to its gas
// neighbours. A SOLID cell at the surface holds as much as it covered, and gives it off through its faces while the body goes on to the
// next cell; what is beyond goes to its gas neighbours on that side. Gas of a side that has none any more goes on in its direction: through
// the body it would leak to its lee.
#include "shared/index.wgsl"
#include "shared/gas_at.wgsl"
#include "interface/owed_species.wgsl"
#include "interface/sides.wgsl"
#include "interface/uncovered.wgsl"

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> energy: array<f32>;
@group(0) @binding(4) var<storage, read_write> owed_flow: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> owed_energy: array<f32>;
@group(0) @binding(6) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(7) var<storage, read> ghost: array<f32>;
@group(0) @binding(8) var<storage, read> node: array<vec4f>;
@group(0) @binding(9) var<storage, read_write> control: Control;

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

// What a SOLID slot holds of the second gas. One that has just been covered has the volume fraction of its gas still.
fn covered_species(slot: u32) -> vec2f {
    if SPECIES && previous_kind_of(cells[slot]) == GAS { return summed_species(gas_at(slot)); }
    return species_now(slot);
}

// At the start bodies cover no gas.
@compute @workgroup_size(WORKGROUP)
fn ledger_start(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    // Nor do obstacles where bodies make them whole.
    if CUT && kind_of(cells[slot]) == GAS {
        owed_flow[slot] = vec4f(0.0);
        owed_energy[slot] = 0.0;
        owe_species(slot, vec2f(0.0));
    }
    if kind_of(cells[slot]) != SOLID { return; }
    conserved[slot] = vec4f(0.0);
    energy[slot] = 0.0;
    hold_species(slot, vec2f(0.0));
}

@compute @workgroup_size(WORKGROUP)
fn ledger_uncover(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let word = cells[slot];
    if previous_kind_of(word) != SOLID { return; }
    if kind_of(word) == SOLID { sort_by_sides(slot); }
    if kind_of(word) != GAS { return; }
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

// Cells that obstacles cut do not count: no body is near, and they take nothing that others owe.
fn neighbours_of_kind(c: vec3i, kind: u32) -> u32 {
    var count = 0u;
    let slot = slot_of(c);
    for (var face = 0u; face < faces_of(slot); face++) {
        let a = face / 2u;
        let up = (face & 1u) == 1u;
        if !inside(select(c - axis(a), c + axis(a), up)) { continue; }
        let word = cells[select(slot - step_of(a), slot + step_of(a), up)];
        count += u32(kind_of(word) == kind && !is_cut_word(word));
    }
    return count;
}

// Gas with a part of what is owed.
fn with_part(gas: Gas, slot: u32, part: f32) -> Gas {
    let each = part / cell_volume();
    return gas_of_sums(gas.flow + each * owed_flow[slot], gas.energy + each * owed_energy[slot], summed_species(gas) + each * owed_species(slot), gas);
}

fn at_surface(slot: u32) -> bool { return kind_of(cells[slot]) == SOLID && neighbours_of_kind(cell_of(slot), GAS) > 0u; }

// Part of what it owes that a gas cell with so many gas neighbours settles now.
fn settled_part(slot: u32, gas_neighbours: u32) -> f32 {
    if is_cut_word(cells[slot]) { return 0.0; }
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
    for (var k = 0u; k < select(0u, 12u, gas_neighbours <= 2u * DIM); k++) {
        let some = with_part(gas, slot, part);
        let change = some.flow.yzw / some.flow.x - gas.flow.yzw / gas.flow.x;
        let cools = pressure_of(some) < coldest * pow(some.flow.x, gamma);
        if lacks_a_gas(some) { part *= 0.5; continue; }
        if abs(internal_energy(some) - before) <= SETTLED_PER_STEP * before && dot(change, change) <= kick && !cools { return part; }
        part *= 0.5;
    }
    return 0.0;
}

// Whether a wall of one cell goes in this step from a slot, which opens, to the one across an axis: it moves that way, with gas behind it.
fn goes_on(slot: u32, a: u32, up: bool) -> bool {
    let ahead = select(slot - step_of(a), slot + step_of(a), up);
    let behind = cells[select(slot + step_of(a), slot - step_of(a), up)];
    let opens = kind_of(cells[slot]) == GAS && previous_kind_of(cells[slot]) == SOLID;
    let covers = kind_of(cells[ahead]) == SOLID && previous_kind_of(cells[ahead]) == GAS;
    if !opens || !covers || kind_of(behind) != GAS || previous_kind_of(behind) != GAS { return false; }
    return side_of(ahead, false, a, up) == UPPER;
}

// How many cells a wall of one cell goes to from a slot.
fn followers(slot: u32) -> u32 {
    if kind_of(cells[slot]) != GAS || previous_kind_of(cells[slot]) != SOLID { return 0u; }
    var count = 0u;
    for (var face = 0u; face < faces_of(slot); face++) { count += u32(goes_on(slot, face / 2u, (face & 1u) == 1u)); }
    return count;
}

// What a GAS cell hands to each of its GAS neighbours; where a wall has just left it, all that it owes to the cells that the wall covers now:
// it is gas from ahead.
fn handed_by_gas(slot: u32, c: vec3i) -> Handed {
    var out: Handed;
    let gas = neighbours_of_kind(c, GAS);
    let ahead = followers(slot);
    let count = select(gas, ahead, ahead > 0u);
    if count == 0u { return out; }
    var part = 0.0;
    for (var turn = 0u; turn < when(ahead == 0u); turn++) { part = settled_part(slot, gas); }
    let each = (1.0 - part) / f32(count);
    return Handed(each * owed_flow[slot], each * owed_energy[slot], each * owed_species(slot), TO_NOBODY);
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
    for (var turn = 0u; turn < when(kind == SOLID); turn++) { out = handed_by_solid(slot); }
    work[part(HANDED_FLOW, slot)] = out.flow;
    energy[part(HANDED_ENERGY, slot)] = out.energy;
    if SPECIES {
        energy[part(HANDED_SPECIES_MASS, slot)] = out.species.x;
        energy[part(HANDED_SPECIES_ENERGY, slot)] = out.species.y;
    }
    if kind == SOLID { energy[part(RECEIVERS, slot)] = f32(out.receivers); }
}

fn receivers_of(slot: u32) -> u32 { return u32(energy[part(RECEIVERS, slot)]); }

fn handed_to_each(slot: u32) -> Held {
    return Held(work[part(HANDED_FLOW, slot)], energy[part(HANDED_ENERGY, slot)], species_at(HANDED_SPECIES_MASS, HANDED_SPECIES_ENERGY, slot));
}

// Whether a SOLID neighbour across an axis hands something on to a slot of a kind; `up`: from below.
fn takes_from(slot: u32, other: u32, a: u32, up: bool, kind: u32, surface: bool) -> bool {
    let receivers = receivers_of(other);
    let whom = receivers & 3u;
    if whom == TO_NOBODY || !serves(other, receivers, a, up, kind) { return false; }
    if kind == GAS { return whom == TO_GAS; }
    if !follows(other, slot) { return false; }
    return whom == TO_SOLID || (whom == TO_SURFACE && surface);
}

// What the neighbours of a slot hand on to it: in a SOLID one, what comes from below is for the side above, and the other way round.
fn incoming(slot: u32, kind: u32) -> Books {
    var sum: Books;
    let surface = kind == SOLID && at_surface(slot);
    for (var face = 0u; face < faces_of(slot); face++) {
        let a = face / 2u;
        let up = (face & 1u) == 0u;
        let other = select(slot + step_of(a), slot - step_of(a), up);
        let kind_there = kind_of(cells[other]);
        var takes = false;
        if kind_there == GAS && kind == GAS { takes = followers(other) == 0u && !is_cut_word(cells[slot]); }
        if kind_there == GAS && kind == SOLID { takes = goes_on(other, a, up); }
        if kind_there == SOLID { takes = takes_from(slot, other, a, up, kind, surface); }
        if !takes { continue; }
        if kind == SOLID && side_of(slot, (receivers_of(slot) & TURNED) != 0u, a, up) == UPPER {
            sum.upper = sum_of_held(sum.upper, handed_to_each(other));
        } else {
            sum.lower = sum_of_held(sum.lower, handed_to_each(other));
        }
    }
    return sum;
}

fn settle_solid(slot: u32, more: Books) {
    let receivers = receivers_of(slot);
    var books = books_of(slot, receivers);
    let whom = receivers & 3u;
    if whom != TO_NOBODY {
        var left: Held;
        let from_upper = (receivers & FROM_UPPER) != 0u;
        if whom == TO_GAS {
            left = books.lower;
            if from_upper { left = books.upper; }
            left = sum_of_held(left, times(handed_to_each(slot), -counts_beside(slot, receivers).x));
        }
        if from_upper { books.upper = left; } else { books.lower = left; }
    }
    keep_books(slot, Books(sum_of_held(books.lower, more.lower), sum_of_held(books.upper, more.upper)));
}

fn settle_gas(slot: u32, more: Books) {
    var owed = Held(owed_flow[slot], owed_energy[slot], owed_species(slot));
    if followers(slot) > 0u { owed = Held(); }
    for (var turn = 0u; turn < when(!is_nothing(owed)); turn++) {
        let around = neighbours_of_kind(cell_of(slot), GAS);
        let part = settled_part(slot, around);
        if SPECIES { hold_species(slot, with_part(gas_at(slot), slot, part).species); }
        conserved[slot] += part * owed.flow / cell_volume();
        energy[slot] += part * owed.energy / cell_volume();
        owed = times(owed, 1.0 - part);
        // The rest goes on, if there is somebody to take it.
        if around > 0u && part < 1.0 { owed = Held(); }
    }
    owed = sum_of_held(owed, more.lower);
    owed_flow[slot] = owed.flow;
    owed_energy[slot] = owed.energy;
    owe_species(slot, owed.species);
}

@compute @workgroup_size(WORKGROUP)
fn ledger_settle(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let kind = kind_of(cells[slot]);
    if !inside(cell_of(slot)) { return; }
    var more: Books;
    for (var turn = 0u; turn < when(kind == GAS || kind == SOLID); turn++) { more = incoming(slot, kind); }
    for (var turn = 0u; turn < when(kind == GAS); turn++) { settle_gas(slot, more); }
    for (var turn = 0u; turn < when(kind == SOLID); turn++) { settle_solid(slot, more); }
}
