// fluid_update, last part: the energy floor, kinetic energy first. At closed faces the interface pressure changes momentum
// without energy, so a cell squeezed between faces may hold more kinetic than total energy. Its momentum is scaled until a tenth
// of the internal energy before the pressure step is left, and the entropy of no gas that was there; the ledger takes the momentum.
// Only if the total energy itself is below that floor is energy borrowed from the ledger. Every floored cell is counted.
// Deep inside the gas it runs only if fluid_energy has found a cell that may need it.
// What has crossed the boundary goes from the slot where it was collected to the ledger, where all of it is.
#include "shared/domain.wgsl"
#include "gas/floor.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> fill: array<vec2f>;       // y: 1 / (gamma p*)
@group(0) @binding(4) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> energy: array<f32>;
@group(0) @binding(6) var<storage, read_write> owed_flow: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> owed_energy: array<f32>;
@group(0) @binding(8) var<storage, read> extra: array<u32>;

// Adds what a step brought to what crossed before, per cell volume, and leaves what float32 could not add: it comes with the next
// step. Thousands of equal parts, as those of an inlet, would else be cut short by the same amount each. (A driver that reorders sums
// would leave nothing; the sums then drift as without.)
fn keep_crossed(slot: u32) {
    let place = ledger_place(slot);
    let flow = owed_flow[place];
    let total = owed_energy[place];
    owed_flow[place] = flow + conserved[slot];
    owed_energy[place] = total + energy[slot];
    conserved[slot] -= owed_flow[place] - flow;
    energy[slot] -= owed_energy[place] - total;
    if SPECIES { keep_crossed_species(slot, ledger_part(OWED_SPECIES_MASS) + place); }
}

fn keep_crossed_species(slot: u32, place: u32) {
    let before = owed_energy[place];
    owed_energy[place] = before + energy[part(SPECIES_DENSITY, slot)];
    energy[part(SPECIES_DENSITY, slot)] -= owed_energy[place] - before;
}

// Adds to one of the numbers in control.borrowed.
fn borrow(number: u32, value: f32) {
    let size = abs(value);
    let whole = u32(floor(size));
    let part = u32(fract(size) * 4294967296.0);
    if value < 0.0 {
        let old = atomicSub(&control.borrowed[2u * number], part);
        atomicSub(&control.borrowed[2u * number + 1u], whole + u32(old < part));
    } else {
        let old = atomicAdd(&control.borrowed[2u * number], part);
        atomicAdd(&control.borrowed[2u * number + 1u], whole + u32(old > ~part));
    }
}

// What a gas cell has lost.
fn ledger_loss(slot: u32, phi: f32, momentum: vec3f, heat: f32) {
    if !RING_LEDGER {
        if SPECIES { owed_energy[ledger_part(OWED_SPECIES_ENERGY) + slot] += energy_share_of(phi) * heat; }
        owed_flow[slot] += vec4f(0.0, momentum);
        owed_energy[slot] += heat;
        return;
    }
    let unit = borrowed_unit();
    for (var a = 0u; a < DIM; a++) { borrow(a, momentum[a] / unit.x); }
    borrow(3u, heat / unit.y);
}

fn floor_slot(slot: u32) {
    let kind = kind_of(cells[slot]);
    // Between two solves of a step the second still builds upon what the first collected.
    if (kind == GHOST || kind == WALL) && !(ARS && control.stage == 0u) { keep_crossed(slot); }
    if kind != GAS { return; }
    let flow = in_space(conserved[slot]);
    let silent = chemical_energy_of(gas_at(slot));
    let total = energy[slot] - silent;
    if is_unsound(flow.x, total) {
        atomicMin(&control.fault, (STAGE_FLUID_UPDATE << 27u) | slot);
        return;
    }
    let species = species_now(slot);
    let phi = species.y;
    var before = 1.0 / (gamma_of(phi) * fill[slot].y * grueneisen_of(phi));
    if PRODUCTS { before = energy[part(PREDICTED_PRESSURE, slot)] / grueneisen_of(phi) + cold_energy_of(gas_at(slot)); }
    let least = least_energy(flow.x, species, total, before);
    let kinetic = kinetic_energy(flow);
    if total - kinetic >= least { return; }
    // What the first of two solves loses counts more than once in the second [shared/state.wgsl].
    let counted = select(1.0, ARS_RETURNED, ARS && control.stage == 0u) * cell_volume() * gas_share(slot);
    atomicAdd(&control.floored, 1u);
    let left = flow.yzw * select(0.0, sqrt((total - least) / kinetic), total > least);
    ledger_loss(slot, phi, (flow.yzw - left) * counted, min(total - least, 0.0) * counted);
    energy[slot] = max(total, least) + silent;
    conserved[slot] = vec4f(flow.x, left);
}

@compute @workgroup_size(WORKGROUP)
fn fluid_floor(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    if SWEEP != OVER_LISTED && atomicLoad(&control.cold) == 1u {
        let own = interior_slot(thread);
        if own < params.slots { floor_slot(own); }
    }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { floor_slot(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { floor_slot(listed_slot(k)); }
}
