// intermediate_pressure: which pressure does the advected gas have, and how stiff is what it meets?
// Reads the advected state, cells, fill, ghost. Writes the gas state (now = advected, with gravity), the cell pressure of the
// predictor, the vertex pressures X* and the vertex stiffness S^-1. On return every gas cell has positive density and
// pressure, or the step is flagged. [Cao et al. 2022, eqs. 9, 17, 22, 24]
#include "shared/domain.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> work: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> energy: array<f32>;
@group(0) @binding(6) var<storage, read_write> fill: array<vec2f>;  // y of gas cells: 1 / (rho c^2), c^2 = gamma p* / rho
@group(0) @binding(7) var<storage, read> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> extra: array<u32>;

fn advected(slot: u32) -> Gas {
    let species = species_at(ADVECTED_SPECIES_DENSITY, ADVECTED_SPECIES_VOLUME, slot);
    let flow = in_space(work[part(ADVECTED_FLOW, slot)]);
    return Gas(flow, energy[part(ADVECTED_ENERGY, slot)], species, left_unburned(slot, flow.x, species.x));
}

// What has not burned when the solve ends: a detonation passes a cell at its own speed, whatever the gas does. Its products burn on where
// there is air, with a rate, until it is used up.
fn left_unburned(slot: u32, both: f32, density: f32) -> f32 {
    if !PRODUCTS { return 0.0; }
    let span = select(control.dt, control.duration, ARS && control.stage == 1u);
    let burned = clamp((control.time + span - energy[part(BURN_TIME, slot)]) * params.burn_rate, 0.0, 1.0);
    let own = max(density, 0.0);
    let held = clamp(energy[part(ADVECTED_UNBURNED, slot)], 0.0, (1.0 - burned + params.fuel) * own);
    if params.fuel == 0.0 { return held; }
    let rest = max(held - params.fuel * own, 0.0);
    let kept = params.fuel * max(own - max(both - own, 0.0) / params.air_needed, 0.0);
    let fuel = held - rest;
    return rest + min(fuel, kept + (fuel - kept) * exp(-span * params.afterburn_rate));
}

// Whether products are denser than their law allows. Where they are a trace, their volume may be gone before their mass.
fn too_dense(gas: Gas) -> bool {
    return PRODUCTS && gas.species.y > PURE && gas.species.x > params.densest * gas.species.y;
}

// Velocity beyond a face: the neighbour's, or what the boundary prescribes.
fn face_velocity(c: vec3i, n: u32, up: bool, here: Gas) -> f32 {
    let far = select(c - axis(n), c + axis(n), up);
    let slot = slot_of(far);
    let kind = kind_of(cells[slot]);
    let own = here.flow[n + 1u] / here.flow.x;
    if kind == GAS {
        let other = advected(slot);
        return (here.flow[n + 1u] + other.flow[n + 1u]) / (here.flow.x + other.flow.x);
    }
    if kind == WALL { return 0.0; }
    if SOLIDS && kind == SOLID {
        let a = node[slot_of(c)];
        let b = node[slot];
        return (a.w * a[n] + b.w * b[n]) / max(a.w + b.w, 1e-30);
    }
    let opening = opening_of(cells[slot]);
    if prescribes(opening) { return opening.flow[n + 1u] / opening.flow.x; }
    return own;
}

// Consistent predictor: conservative advection of E already compresses the gas; the solve must not do it twice. Inside shocks
// (strong compression) the viscosity that this removes is kept.
const COMPRESSION_SWITCH = 30.0;
// Share of the pressure before that a solve with ARS starts from at least.
const LEAST_STARTED = 0.1;

// Difference of the divergence across the open faces of a cluster.
fn cut_divergence(slot: u32, own: f32) -> f32 {
    var sum = 0.0;
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        for (var face = 0u; face < 2u * DIM; face++) {
            let n = face / 2u;
            let up = (face & 1u) == 1u;
            let other = slot_of(cell_of(at) + select(-axis(n), axis(n), up));
            if kind_of(cells[other]) == GAS { sum += aperture(at, n, up) * (node[other].w - own); }
        }
    }
    return sum;
}

// What the divergence of the carrier falls short of its mean around a cell, summed over the faces between GAS cells: as much of it as the
// faces have back [shared/state.wgsl] adds to the divergence.
fn carried_shortfall(slot: u32, own: f32) -> f32 {
    if is_listed() && CUT { return cut_divergence(slot, own) / cluster_share(slot); }
    var sum = 0.0;
    for (var n = 0u; n < DIM; n++) {
        var along = 0.0;
        for (var side = 0u; side < 2u; side++) {
            var other = select(slot - step_of(n), slot + step_of(n), side == 1u);
            if is_listed() && PERIODIC != 0u { other = slot_of(cell_of(slot) + select(-1, 1, side == 1u) * axis(n)); }
            if !is_listed() || kind_of(cells[other]) == GAS { along += node[other].w - own; }
        }
        sum += along;
    }
    return sum;
}

// Velocity difference of the faces of a cell, summed over the axes.
fn plain_divergence(c: vec3i, slot: u32, here: Gas) -> f32 {
    var sum = 0.0;
    for (var n = 0u; n < DIM; n++) {
        if is_listed() {
            for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
                let member = cell_of(at);
                sum += (aperture(at, n, true) * face_velocity(member, n, true, here)
                    - aperture(at, n, false) * face_velocity(member, n, false, here)) / cluster_share(slot);
            }
            continue;
        }
        let low = work[part(ADVECTED_FLOW, slot - step_of(n))];
        let high = work[part(ADVECTED_FLOW, slot + step_of(n))];
        sum += (here.flow[n + 1u] + high[n + 1u]) / (here.flow.x + high.x)
            - (low[n + 1u] + here.flow[n + 1u]) / (low.x + here.flow.x);
    }
    return sum;
}

fn predicted(c: vec3i, slot: u32, here: Gas, p: f32) -> f32 {
    if !PREDICTOR { return p; }
    var change: f32;
    var unseen = 0.0;
    if CONSISTENT {
        let own = node[slot].w;
        let shortfall = carried_shortfall(slot, own);
        change = own - given_back() * shortfall;
        if FOURTH { unseen = (seen_share() - given_back()) * shortfall; }
    } else { change = plain_divergence(c, slot, here); }
    change = change * control.dt / params.spacing;
    let smooth_share = select(max(0.0, 1.0 - COMPRESSION_SWITCH * abs(change)), 1.0, change >= 0.0);
    // without what is unseen never below 0.99 p
    let ratio = stiffness_ratio(here, p);
    if PRODUCTS { change *= ratio - grueneisen_of(here.species.y); }
    return p * (1.0 + smooth_share * change - ratio * unseen * control.dt / params.spacing);
}

// The solve changes neither of the two.
fn keep_species(slot: u32, here: Gas) {
    if !SPECIES { return; }
    energy[part(SPECIES_DENSITY, slot)] = here.species.x;
    energy[part(SPECIES_VOLUME, slot)] = here.species.y;
    if PRODUCTS { energy[part(UNBURNED, slot)] = here.unburned; }
}

fn predict(slot: u32) {
    let here = advected(slot);
    if kind_of(cells[slot]) != GAS {
        conserved[slot] = here.flow;
        energy[slot] = here.energy;
        keep_species(slot, here);
        return;
    }
    var p = pressure_of(here);
    if too_dense(here) { atomicAdd(&control.dense, 1u); }
    // The start of a second solve is no state of the gas: behind very strong shocks it may lack internal energy. Every such cell is counted.
    if ARS {
        let least = LEAST_STARTED * pressure_of(gas_at(slot));
        if p < least {
            p = least;
            atomicAdd(&control.raised, 1u);
        }
    }
    if here.flow.x <= 0.0 || p <= 0.0 || is_broken(p) {
        atomicMin(&control.fault, (STAGE_GAS_ADVECTION << 27u) | slot);
    }
    fill[slot].y = 1.0 / (stiffness_ratio(here, p) * p);
    var total = here.energy;
    if ARS { total = energy[part(COLD_ENERGY, slot)]; }     // what the solve carries anew is not in it
    energy[part(PREDICTED_PRESSURE, slot)] = predicted(cell_of(slot), slot, here, p);
    // Gravity: the work of the mean momentum.
    let pull = control.dt * here.flow.x * params.gravity;
    keep_species(slot, here);
    conserved[slot] = here.flow + vec4f(0.0, pull);
    energy[slot] = total + control.dt * dot(here.flow.yzw + 0.5 * pull, params.gravity);
}

@compute @workgroup_size(WORKGROUP)
fn pressure_star(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { predict(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { predict(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { predict(listed_slot(k)); }
}
