// Which slots a thread has, and what is special there: gas that rests, obstacles that cut cells, open sides.
// Needs the bindings cells and extra.
#include "shared/index.wgsl"

// -- Sweep --

// Which slots has a thread? Deep inside the gas (INTERIOR) every stencil is the same; the others stand in a list, without those that periodic
// sides repeat. A kernel over both takes the slot deep inside that its thread has, then its slots of the list:
//     let own = interior_slot(thread);
//     if own < params.slots { .. }
//     on_list = true;
//     let next = one_listed(thread);   // and the same with it
//     for (var k = first_listed(thread); k < among(); k = next_listed(k)) { let slot = listed_slot(k); .. }
// A GPU runs both at once. For a CPU it is compiled once for each kind, as an octet of threads computes what any of them needs.
// Kernels whose results only listed slots read go over the frontier in place of the interior: slots deep inside the gas whose nodes listed
// vertices rest on. Marches pass columns of slots of every kind: their kernels ask for INTERIOR themselves.
// src/stage/sweep.rs binds the forms. OVER_SLOTS: all; OVER_INTERIOR, OVER_LISTED, OVER_BOTH; OVER_FRONTIER, OVER_NEAR: it and the list;
// OVER_MARCHES: columns of params.march slots, OVER_WHOLE: they and the list.
override SWEEP: u32;

// Whether the slot in hand is one of the list: kernels over both say it before they call what differs.
var<private> on_list: bool;

fn is_listed() -> bool { return SWEEP == OVER_LISTED || on_list; }

// The slot deep inside the gas that a thread has, or of the frontier; params.slots if none.
fn interior_slot(thread: u32) -> u32 {
    if SWEEP == OVER_NEAR || SWEEP == OVER_FRONTIER {
        if thread >= extra[part(LENGTHS, LENGTH_FRONTIER)] { return params.slots; }
        // The frontier fills the list of slots from its end, which is where the lengths begin.
        return extra[part(LENGTHS, 0u) - 1u - thread];
    }
    if SWEEP == OVER_LISTED || thread >= params.slots { return params.slots; }
    return select(params.slots, thread, has(cells[thread], INTERIOR));
}

fn listed() -> u32 {
    if SWEEP == OVER_INTERIOR || SWEEP == OVER_FRONTIER || SWEEP == OVER_MARCHES { return 0u; }
    return extra[part(LENGTHS, LENGTH_LISTED)];
}

fn listed_slot(place: u32) -> u32 { return extra[part(LISTED_SLOTS, place)]; }

// The slot of the list that a thread has, where each has one; params.slots if none.
fn one_listed(thread: u32) -> u32 {
    if SWEEP == OVER_BOTH || SWEEP == OVER_WHOLE || thread >= listed() { return params.slots; }
    return listed_slot(thread);
}

// Slots of the list that threads over both take in turns.
fn among() -> u32 {
    if SWEEP == OVER_BOTH || SWEEP == OVER_WHOLE { return listed(); }
    return 0u;
}

// Places of the list that a thread over both takes. Groups far from each other take neighbouring ones: a CPU's threads have groups that lie
// together, and each of them shall have its share of the list.
fn first_listed(thread: u32) -> u32 {
    let group = thread / WORKGROUP;
    let apart = list_groups();
    if group >= LIST_PARTS * apart { return NO_EXTRA; }
    return (LIST_PARTS * (group % apart) + group / apart) * WORKGROUP + thread % WORKGROUP;
}

fn list_groups() -> u32 { return groups_apart(select(params.slots, marches(), SWEEP == OVER_WHOLE)); }

fn next_listed(place: u32) -> u32 { return place + LIST_PARTS * list_groups() * WORKGROUP; }

// Threads of a sweep over one kind; beyond them none has a slot.
fn swept_threads() -> u32 {
    if SWEEP == OVER_LISTED { return listed(); }
    return params.slots;
}

// Slot of a thread, of a column the first one; params.slots if it has none.
fn swept_slot(thread: u32) -> u32 {
    if SWEEP == OVER_MARCHES || SWEEP == OVER_WHOLE {
        let slot = corner_of(thread / COLUMN_BLOCK) + thread % COLUMN_BLOCK;
        let column = thread / COLUMN_BLOCK % blocks_across() * COLUMN_BLOCK + thread % COLUMN_BLOCK;
        return select(params.slots, slot, column < columns());
    }
    if thread >= swept_threads() { return params.slots; }
    if SWEEP == OVER_LISTED { return listed_slot(thread); }
    if SWEEP == OVER_INTERIOR && !has(cells[thread], INTERIOR) { return params.slots; }
    return thread;
}

// -- Gas that rests --

// Rows of the blocks of columns, as still.wgsl marks them: row k of a block is its COLUMN_BLOCK slots at place k of the march. The binding extra
// holds a word per block: bit k tells that gas moves near row k before the solve.

fn block_rows(block: u32) -> u32 { return extra[params.still_at + block]; }

// Rows of a thread's column to compute: the first, and the one after the last. `all`: whatever moves.
fn moving_rows(thread: u32, all: bool) -> vec2u {
    if all { return vec2u(0u, params.march); }
    let rows = block_rows(thread / COLUMN_BLOCK);
    return select(vec2u(0u), vec2u(countTrailingZeros(rows), 32u - countLeadingZeros(rows)), rows != 0u);
}

// Whether nothing moves near a slot before the solve.
fn is_still(slot: u32) -> bool {
    let row = slot / columns();
    let rows = block_rows(row / params.march * blocks_across() + slot % columns() / COLUMN_BLOCK);
    return ((rows >> (row % params.march)) & 1u) == 0u;
}

// -- Cut cells --

// Cut cells: the surface of an obstacle leaves gas in a part of them. Small parts share one state with a neighbour, their cluster:
// what changes one of them changes all by the same amount. Mirror of src/state/cut.rs.
// Without bodies the first block of extra holds the number of a slot's entry, counted from 1, and the table stands behind the lists. With bodies
// the block stands before the table, behind the number of entries, and CUT_NEAR marks slots with an obstacle around them. Cells that a
// body comes near have no entry any more [interface/whole_cells.wgsl].

fn cut_number(slot: u32) -> u32 { return extra[cut_place(slot)]; }

fn cut_entry(slot: u32) -> u32 {
    if CUT { return cut_number(slot) & ~CUT_NEAR; }
    return 0u;
}

fn cut_word(entry: u32, field: u32) -> u32 { return extra[params.table_at + (entry - 1u) * CUT_WIDTH + field]; }
fn cut_value(entry: u32, field: u32) -> f32 { return bitcast<f32>(cut_word(entry, field)); }
fn cut_vector(entry: u32, field: u32) -> vec3f {
    return vec3f(cut_value(entry, field), cut_value(entry, field + 1u), cut_value(entry, field + 2u));
}

// A field of a slot, as bits; of one that is not cut another value.
fn cut_field(slot: u32, field: u32, without: u32) -> u32 {
    let entry = cut_entry(slot);
    if entry == 0u { return without; }
    return cut_word(entry, field);
}
fn share_of(slot: u32, field: u32) -> f32 { return bitcast<f32>(cut_field(slot, field, bitcast<u32>(1.0))); }

// Gas in a GAS cell, and in all cells that share its state, in cells.
fn gas_share(slot: u32) -> f32 { return share_of(slot, CUT_SHARE); }
fn cluster_share(slot: u32) -> f32 { return share_of(slot, CUT_CLUSTER_SHARE); }

// The slots of a cluster in order, the same for each of them; NO_EXTRA after the last.
fn cluster_first(slot: u32) -> u32 { return cut_field(slot, CUT_FIRST, slot); }
fn cluster_next(slot: u32) -> u32 { return cut_field(slot, CUT_NEXT, NO_EXTRA); }

// Whose face is that of a GAS cell? A cell that is whole for a body's sake has the one of the cut cell beyond.
struct CutFace { entry: u32, face: u32 }
fn cut_face(slot: u32, n: u32, up: bool) -> CutFace {
    let entry = cut_entry(slot);
    if !CUT || !SOLIDS || entry != 0u { return CutFace(entry, 2u * n + u32(up)); }
    return CutFace(cut_entry(slot_of(cell_of(slot) + select(-1, 1, up) * axis(n))), 2u * n + u32(!up));
}

// Open share of a face of a GAS cell.
fn aperture(slot: u32, n: u32, up: bool) -> f32 {
    let at = cut_face(slot, n, up);
    if at.entry == 0u { return 1.0; }
    return cut_value(at.entry, CUT_APERTURE + at.face);
}

// Mean of the linear shape function of a corner of a face over the face's open part.
fn face_shape(slot: u32, n: u32, up: bool, corner: vec3i) -> f32 {
    let at = cut_face(slot, n, up);
    if at.entry == 0u { return 1.0 / f32(1u << (DIM - 1u)); }
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    let middle = cut_vector(at.entry, CUT_MIDDLE + 3u * at.face);
    let side = 2.0 * vec3f(corner) - 1.0;
    if DIM == 1u { return 1.0; }
    if DIM == 2u { return 0.5 + side[1u - n] * middle[1u - n]; }
    return 0.25 + 0.5 * (side[a] * middle[a] + side[b] * middle[b]) + side[a] * side[b] * middle[n];
}

// -- Open sides --

// The gas beyond open sides. Each GHOST slot of the ring names its rule in its word; walls have no rule. From a rule follow the state beyond,
// which advection reads, and the velocity of the face as the pressure system sees it, u = u0 + (p - p0) / Z along the outward normal.
// Z = rho c lets sound pass: what a wave would do beyond the side, the face does [Poinsot and Lele 1992]. Where Z is infinite, the velocity is
// prescribed. 1 / Z adds to the diagonal, so the system stays symmetric positive definite.
// RULES_USED names the rules of the scene, so that the others cost nothing.

@group(0) @binding(14) var<uniform> openings: array<Opening, MAX_OPENINGS>;

fn opening_of(word: u32) -> Opening { return openings[word >> RULE_SHIFT]; }

fn any_used(first: u32, last: u32) -> bool { return (RULES_USED & ((2u << last) - (1u << first))) != 0u; }
fn follows(o: Opening, rule: u32) -> bool { return any_used(rule, rule) && o.rule == rule; }
// Whether the velocity beyond is that of the opening.
fn prescribes(o: Opening) -> bool { return any_used(RULE_FIXED, RULE_SUBSONIC) && o.rule <= RULE_SUBSONIC; }

// Pressure of gas that has left a reservoir without losses, at a speed. [Liepmann and Roshko 1957, section 2.10]
fn reservoir_pressure(o: Opening, speed: f32) -> f32 {
    let gamma = gamma_of(o.species_volume);
    let square = gamma * o.pressure / o.flow.x;
    let ratio = 1.0 - 0.5 * (gamma - 1.0) * speed * speed / square;
    return o.pressure * pow(max(ratio, 0.0), gamma / (gamma - 1.0));
}

// Speed into the domain; that of sound at most, which no reservoir exceeds.
fn inflow_speed(o: Opening, outward_velocity: f32) -> f32 {
    let gamma = gamma_of(o.species_volume);
    let critical = sqrt(2.0 / (gamma + 1.0) * gamma * o.pressure / o.flow.x);
    return clamp(-outward_velocity, 0.0, critical);
}

fn species_beyond(o: Opening) -> vec2f { return vec2f(o.species_density, o.species_volume); }

// The state of an opening as it stands.
fn prescribed_gas(o: Opening) -> Gas { return Gas(o.flow, o.energy, species_beyond(o), 0.0); }

// The gas of an opening where its pressure has become another without losses.
fn incoming_gas(o: Opening, velocity: vec3f, pressure: f32) -> Gas {
    let density = o.flow.x * pow(pressure / o.pressure, 1.0 / gamma_of(o.species_volume));
    return gas_from_primitive(density, velocity, pressure, vec2f(o.species_density * density / o.flow.x, o.species_volume), 0.0);
}

// Least speed of sound behind a wave into the far gas, over that of the far gas.
const LEAST_SOUND = 0.1;

// The far gas as it is where gas of this entropy has its pressure: what leaves pushes gas of its own entropy before it.
fn far_density(o: Opening, gamma: f32, density: f32, pressure: f32) -> f32 {
    return density * pow(o.pressure / pressure, 1.0 / gamma);
}

// Speed of sound over that at the far pressure where a simple wave that runs outward has brought gas of a density there to velocity u:
// u_in + 2 c / (gamma - 1) stays. [Liepmann and Roshko 1957, section 3.9]
fn sound_from_afar(o: Opening, n: u32, outward: f32, gamma: f32, density: f32, u: f32) -> f32 {
    let gain = outward * (u - o.flow[n + 1u] / o.flow.x) / sound_speed(gamma, density, o.pressure);
    return max(1.0 + 0.5 * (gamma - 1.0) * gain, LEAST_SOUND);
}

fn pressure_from_afar(o: Opening, gamma: f32, sound: f32) -> f32 { return o.pressure * pow(sound, 2.0 * gamma / (gamma - 1.0)); }

// What comes in from afar below the speed of sound brings its entropy and its velocity along the face, passes the face as fast as the
// gas there, and has the pressure that this takes. With the far velocity, advection would not let in what the pressure system
// moves; with the pressure of the cell, cells along the side would take turns in pressure, which no vertex sees.
fn gas_from_afar(o: Opening, n: u32, outward: f32, here: Gas) -> Gas {
    let u = here.flow[n + 1u] / here.flow.x;
    if outward * u >= 0.0 { return here; }
    let p = pressure_of(here);
    let gamma = stiffness_ratio(here, p);
    if outward * u <= -sound_speed(gamma, here.flow.x, p) { return prescribed_gas(o); }
    let sound = sound_from_afar(o, n, outward, gamma, far_density(o, gamma, here.flow.x, p), u);
    let velocity = select(velocity_of(o.flow), vec3f(u), along(n));
    let p_beyond = pressure_from_afar(o, gamma, sound);
    return incoming_gas(o, velocity, p_beyond);
}

// State beyond a face next to `here`, across axis n, outward = -1 or 1.
fn gas_beyond(o: Opening, n: u32, outward: f32, here: Gas) -> Gas {
    if follows(o, RULE_FIXED) { return prescribed_gas(o); }
    if follows(o, RULE_SUBSONIC) {
        var heat = internal_energy(here);
        if SPECIES { heat = pressure_of(here) / grueneisen_of(o.species_volume) + reference_energy(prescribed_gas(o)); }
        return Gas(o.flow, heat + kinetic_energy(o.flow), species_beyond(o), 0.0);
    }
    if follows(o, RULE_TOTAL) {
        let speed = inflow_speed(o, outward * here.flow[n + 1u] / here.flow.x);
        let pressure = reservoir_pressure(o, speed);
        let u = select(vec3f(0.0), vec3f(-outward * speed), along(n));
        return incoming_gas(o, u, pressure);
    }
    if follows(o, RULE_ATTENUATED) {
        return Gas(mix(here.flow, o.flow, o.share), mix(here.energy, o.energy, o.share), mix(here.species, species_beyond(o), o.share), (1.0 - o.share) * here.unburned);
    }
    if follows(o, RULE_FAR) { return gas_from_afar(o, n, outward, here); }
    return here;
}

// Velocity that the node beyond an open face has.
fn velocity_beyond(o: Opening, here: vec4f) -> vec3f {
    if prescribes(o) { return velocity_of(o.flow); }
    if follows(o, RULE_ATTENUATED) { return velocity_of(mix(here, o.flow, o.share)); }
    return velocity_of(here);
}

// -- What carries the gas --

// Velocity that carries the gas through a face between two GAS cells, from their carriers (see gas/carrier.wgsl) and densities. The
// mean of two cells damps short compression waves; a share of the difference of the divergences gives that back: a quarter, with which
// shocks stay smooth (a little less with B2B1, where they ring). It vanishes where the divergence does, so nothing that the solve
// calls free of divergence is compressed.
// Two solves per step see sound to second order in time. They have the share with which the face's divergence is the one that the solve
// itself sees, or, in short steps, the third that makes sound along an axis one of fourth order in space (of B2B1 0.16, beyond which single
// precision shows behind strong shocks). The solve then is told of the surplus beforehand [intermediate_pressure.wgsl]: without, waves of some eight cells grow.

// The share with which the divergence would be the one that the solve itself sees.
fn seen_share() -> f32 { return select(0.25, 1.0 / 12.0, QUADRATIC && ARS); }

fn given_back() -> f32 {
    if FOURTH { return select(1.0 / 3.0, 0.16, QUADRATIC); }
    return select(seen_share(), 0.23, QUADRATIC && !ARS);
}

// Speed of the dissipation at such a face: upwind, and where the carriers part, as in a rarefaction, the larger of both.
fn carrier_spread(low: f32, high: f32) -> f32 { return select(0.0, max(abs(low), abs(high)), high > low); }

fn carried_velocity(n: u32, low: vec4f, low_density: f32, high: vec4f, high_density: f32) -> f32 {
    return (low_density * low[n] + high_density * high[n]) / (low_density + high_density) - given_back() * (high.w - low.w);
}
