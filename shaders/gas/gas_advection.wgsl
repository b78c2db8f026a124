// gas_advection: where does the gas carry itself? [docs/method/gas_advection.md]
// Reads gas, cells, node velocities. Writes the advected state. On return mass is conserved; no pressure work has been done yet.
// TVD-RK2: U1 = U0 + dt L(U0); U* = (U0 + U1 + dt L(U1)) / 2. [Cao et al. 2022, eqs. 10-12 and section 2.3; Shu & Osher 1988]
// What the stages of the Runge-Kutta scheme do. With ARS (shared/state.wgsl) one comes before the first of two solves, two before the second:
//   scheme, stage         carries                        adds to                         writes
//   TVD-RK2, 0            U0: conserved                  U0                              U1: HALFWAY
//   TVD-RK2, 1            U1: HALFWAY                    U1, and halves the sum with U0  U*: ADVECTED
//   ARS, 0                U0: conserved                  U0                              ADVECTED, KEPT, COLD_ENERGY; of U0 START
//   ARS, 1                U1, after a solve: conserved   START + 1.71 (U1 - KEPT)        V: HALFWAY
//   ARS, 2                V: HALFWAY                     START + 2.41 (U1 - KEPT)        ADVECTED, COLD_ENERGY
// Slots that are not GAS collect what passes through their faces: owed gas in SOLID cells, outflow in GHOST slots. So the sum
// over all slots is conserved. A closed face passes R v_n U + (1 - R) (flux with everything behind it copied from this side).
#include "shared/domain.wgsl"
#include "gas/flux.wgsl"
#include "gas/faces.wgsl"
#include "gas/cut_carrier.wgsl"

// Stage of the scheme: 0, 1, and with ARS 2; or BY_UNIFORM: one kernel for all, which costs little where slots are few.
override RUNGE_KUTTA: u32;
const BY_UNIFORM = 3u;

// What a dispatch of such a kernel does: a stage, or (limited: 1) its correction by the limiter.
struct Advection { stage: u32, limited: u32 }

fn in_first() -> bool { return RUNGE_KUTTA == 0u || (RUNGE_KUTTA == BY_UNIFORM && advection.stage == 0u); }
fn in_second() -> bool { return RUNGE_KUTTA == 1u || (RUNGE_KUTTA == BY_UNIFORM && advection.stage == 1u); }
fn in_third() -> bool { return RUNGE_KUTTA == 2u || (RUNGE_KUTTA == BY_UNIFORM && advection.stage == 2u); }
fn this_stage() -> u32 { return select(select(0u, 1u, in_second()), 2u, in_third()); }

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> energy: array<f32>;
@group(0) @binding(6) var<storage, read> node: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> theta: array<f32>;       // share of the high-order flux a cell allows; below 0: of the first-order flux
@group(0) @binding(8) var<storage, read> extra: array<u32>;
@group(0) @binding(9) var<uniform> advection: Advection;

// Two parts of a slot, of the second gas; 0 without one.
fn species_at(density: u32, volume: u32, slot: u32) -> vec2f {
    if !SPECIES { return vec2f(0.0); }
    return vec2f(energy[part(density, slot)], energy[part(volume, slot)]);
}

fn unburned_at(which: u32, slot: u32) -> f32 { if PRODUCTS { return energy[part(which, slot)]; } return 0.0; }

// What velocity carries of the internal energy at one pressure: G rho c^2 - p.
fn carried_heat(gas: Gas) -> f32 {
    if !PRODUCTS { return internal_energy(gas); }
    return internal_energy(gas) - cold_energy_of(gas) + cold_stiffness_of(gas) / grueneisen_of(gas.species.y);
}

// State of a slot at the start of the stage's solve.
fn start(slot: u32) -> Gas { return Gas(in_space(conserved[slot]), energy[slot], species_at(SPECIES_DENSITY, SPECIES_VOLUME, slot), unburned_at(UNBURNED, slot)); }

// State of a slot that this stage carries, see the table above.
fn source(slot: u32) -> Gas {
    let halfway = (ARS && in_third()) || (!ARS && in_second());
    var flow: vec4f;
    if halfway { flow = work[part(HALFWAY_FLOW, slot)]; } else { flow = conserved[slot]; }
    let species = species_at(select(SPECIES_DENSITY, HALFWAY_SPECIES_DENSITY, halfway), select(SPECIES_VOLUME, HALFWAY_SPECIES_VOLUME, halfway), slot);
    let unburned = unburned_at(select(UNBURNED, HALFWAY_UNBURNED, halfway), slot);
    return Gas(in_space(flow), energy[select(slot, part(HALFWAY_ENERGY, slot), halfway)], species, unburned);
}

// dt L(U) of a slot inside the domain; of all cells that share its state together.
fn change_of(slot: u32, limited: bool) -> Change {
    var change: Change;
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) { add_faces(&change, at, limited, at == slot); }
    if CUT { change = scaled(change, 1.0 / cluster_share(slot)); }
    return change;
}

// Adds what passes the faces of a slot if it is GAS, else those that it shares with GAS cells. `gives`: and gives slots of the ring what passes
// towards them.
fn add_faces(change: ptr<function, Change>, slot: u32, limited: bool, gives: bool) {
    let c = cell_of(slot);
    let is_gas = kind_of(cells[slot]) == GAS;
    if is_gas { relate(change, source(slot)); }
    // Slots without gas around them, as deep inside a body, have nothing to do.
    let axes = select(0u, DIM, has(cells[slot], NODE_GAS));
    for (var n = 0u; n < axes; n++) {
        let row = row_around(slot, c, n);
        var along: Change;
        along.velocity = (*change).velocity;
        along.phi = (*change).phi;
        for (var side = 0u; side < 2u; side++) {
            let up = side == 1u;
            let other = select(c - axis(n), c + axis(n), up);
            let r = row_at_face(row, up);
            if !is_gas && !(inside(other) && kind_of(select(r.c.word, r.d.word, up)) == GAS) { continue; }
            var share = 1.0;
            if limited { share = min(theta[slot], theta[slot_of(other)]); }
            var f = face_fluxes(slot, c, n, up, r);
            if SPECIES && !is_gas { f = with_owed(f, energy_share_of(chosen(r.d.gas, r.c.gas, up).species.y)); }
            let sign = select(1.0, -1.0, up) * aperture(select(slot_of(other), slot, is_gas), n, up == is_gas);
            add_face(&along, f, share, sign);
            if is_gas && gives && !inside(other) { give(slot_of(other), with_owed(f, 0.0), share, -sign); }
        }
        *change = plus(*change, along);
    }
}

// Gives a slot of the ring what passes through the side; it has no other face.
fn give(slot: u32, f: Fluxes, share: f32, sign: f32) {
    var change: Change;
    add_face(&change, f, share, sign);
    write_result(slot, start_of(slot, source(slot)), change);
}

// Fluxes deep inside the gas, through the face above slot `low`.
fn interior_fluxes(n: u32, low: u32, stencil: Stencil) -> Fluxes {
    let held = heat_between(stencil, low, low + step_of(n));
    if !CONSISTENT { return face_fluxes_of(n, stencil, held); }
    let below = node[low];
    let above = node[low + step_of(n)];
    let carried = carried_velocity(n, below, stencil.c.flow.x, above, stencil.d.flow.x);
    return carried_fluxes(stencil, carried, carrier_spread(below[n], above[n]), held);
}

// What passes both faces of a slot across one axis, deep inside the gas.
fn axis_change(slot: u32, word: u32, n: u32, here: Gas) -> Change {
    var change: Change;
    relate(&change, here);
    let s = step_of(n);
    let a = source(max(slot, 3u * s) - 3u * s);
    let b = source(slot - 2u * s);
    let c = source(slot - s);
    let e = source(slot + s);
    let f = source(slot + 2u * s);
    let g = source(min(slot + 3u * s, params.slots - 1u));
    let low = stencil_inside(n, is_wide(word, n, false), ends_in_image(word, n, false), false, a, b, c, here, e, f);
    let high = stencil_inside(n, is_wide(word, n, true), false, ends_in_image(word, n, true), b, c, here, e, f, g);
    add_face(&change, interior_fluxes(n, slot - s, low), 1.0, 1.0);
    add_face(&change, interior_fluxes(n, slot, high), 1.0, -1.0);
    return change;
}

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

// Ends the stage for a slot: says how much of the change the limiter allows unless it is `limited` already, and writes what follows.
fn finish(slot: u32, here: Gas, change: Change, limited: bool) {
    let before = start_of(slot, here);
    for (var turn = 0u; turn < when(!limited); turn++) {
        var share = 1.0;
        if kind_of(cells[slot]) == GAS { share = allowed_share(before, change); }
        theta[slot] = share;
        if share < 1.0 { atomicAdd(&control.limited[this_stage()], 1u); }
    }
    write_result(slot, before, change);
}

// Whether nothing passes through the faces of a slot: its state is then the same in all Runge-Kutta stages. Clusters of cut cells reach
// further, and the second of two solves starts from what the first has moved.
fn stays(slot: u32) -> bool { return !CUT && !(ARS && !in_first()) && is_still(slot); }

// Ends the stage for a slot that nothing passes.
fn stay(slot: u32) { theta[slot] = 1.0; write_result(slot, start(slot), Change()); }

// Whether a slot of the ring gets what passes through the side from the cell before it.
fn is_served(c: vec3i) -> bool {
    let near = nearest_inside(c);
    let steps = abs(near - c);
    return steps.x + steps.y + steps.z == 1 && kind_of(cells[slot_of(near)]) == GAS && !stays(slot_of(near));
}

// Whether the faces of a slot carry less than the full flux.
fn carries_less(slot: u32) -> bool {
    var least = theta[slot];
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        let member = cell_of(at);
        for (var n = 0u; n < DIM; n++) {
            if in_ring(member - axis(n)) { least = min(least, theta[slot_of(member - axis(n))]); }
            if in_ring(member + axis(n)) { least = min(least, theta[slot_of(member + axis(n))]); }
        }
    }
    return least < 1.0;
}

// One slot of the list. Limited, if the limiter acted somewhere: any slot whose faces carry less than the full flux, once more.
@compute @workgroup_size(WORKGROUP)
fn advect_listed(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let limited = advection.limited == 1u;
    var slot = thread_index(group, lane);
    if !limited { slot = swept_slot(slot); }
    if slot >= params.slots || (limited && atomicLoad(&control.limited[this_stage()]) == 0u) { return; }
    let c = cell_of(slot);
    let beyond = !inside(c);
    let still = stays(slot);
    var computed = !still && !beyond;
    if limited {
        if !computed || is_alias(c) { return; }
        computed = carries_less(slot);
    } else if beyond {
        theta[slot] = 1.0;
        if !is_served(c) { write_result(slot, start_of(slot, source(slot)), Change()); }
    } else if still {
        stay(slot);
    }
    for (var turn = 0u; turn < when(computed); turn++) { finish(slot, source(slot), change_of(slot, limited), limited); }
}

// A column of params.march slots along the last axis: each state there is read once, each face computed once. `moving`: the places of the
// column where something moves, first and one after the last. Slots that are not INTERIOR lie in columns, too: what is written there is
// overwritten by advect_listed, which runs afterwards.
@compute @workgroup_size(WORKGROUP)
fn advect_interior(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let n = DIM - 1u;
    let s = step_of(n);
    let thread = thread_index(group, lane);
    let first = swept_slot(thread);
    let last = params.slots - 1u;
    if first > last { return; }
    let moving = moving_rows(thread, CUT || (ARS && !in_first()));
    for (var k = 0u; k < params.march; k++) {
        if first + k * s <= last && (k < moving.x || k >= moving.y) { stay(first + k * s); }
    }
    if moving.x == moving.y { return; }
    let begin = first + moving.x * s;
    let end = min(first + moving.y * s, params.slots);
    let below = max(begin, s) - s;
    var b = source(max(begin, 2u * s) - 2u * s);
    var c = source(below);
    var here = source(begin);
    var e = source(min(begin + s, last));
    var f = source(min(begin + 2u * s, last));
    var word = cells[begin];
    let a = source(max(begin, 3u * s) - 3u * s);
    var low = interior_fluxes(n, below, stencil_inside(n, is_wide(word, n, false), ends_in_image(word, n, false), false, a, b, c, here, e, f));
    for (var slot = begin; slot < end; slot += s) {
        let g = source(min(slot + 3u * s, last));
        // Of a face below an INTERIOR slot that slot knows, too.
        let next = cells[min(slot + s, last)];
        let known = has(word, INTERIOR);
        let all_gas = select(is_wide(next, n, false), is_wide(word, n, true), known);
        let low_image = !known && ends_in_image(next, n, false);
        let high = interior_fluxes(n, slot, stencil_inside(n, all_gas, low_image, known && ends_in_image(word, n, true), b, c, here, e, f, g));
        if known {
            var change: Change;
            relate(&change, here);
            var along = change;
            add_face(&along, low, 1.0, 1.0);
            add_face(&along, high, 1.0, -1.0);
            change = plus(change, along);
            for (var m = 0u; m < n; m++) { change = plus(change, axis_change(slot, word, m, here)); }
            finish(slot, here, change, false);
        }
        low = high;
        word = next;
        b = c;
        c = here;
        here = e;
        e = f;
        f = g;
    }
}
