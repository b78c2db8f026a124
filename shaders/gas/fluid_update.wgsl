// fluid_update: momentum and energy of the gas from the solved pressure, by local gradients. [Kwatra et al. 2009; eqs. 14, 3]
// Reads pressure, cells, nodes. Writes gas. On return momentum and energy are final; each face gives one cell what it takes
// from the other, so their sums are conserved. WALL and GHOST slots collect the impulse and work that leaves through them.
#include "gas/cut_carrier.wgsl"
#include "gas/late_share.wgsl"
#include "shared/parting.wgsl"
#include "gas/floor.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> pressure: array<f32>;
@group(0) @binding(5) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> energy: array<f32>;
@group(0) @binding(7) var<storage, read> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> work: array<vec4f>;

// Loss of momentum of a cluster next to an obstacle: the pressure gradient over its gas.
fn cut_impulse(slot: u32) -> vec3f {
    var force = vec3f(0.0);
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        let c = cell_of(at);
        for (var k = 1u; k < corner_count(); k++) {
            force += (pressure[slot_of(c + corner_offset(k))] - pressure[at]) * cut_slope(at, corner_offset(k));
        }
    }
    return -force / cluster_share(slot);
}

fn interior_impulse(slot: u32) -> vec3f {
    var impulse = vec3f(0.0);
    for (var n = 0u; n < DIM; n++) { impulse[n] = interior_face(slot, n) - interior_face(slot + step_of(n), n); }
    return impulse;
}

fn flow_at(slot: u32) -> vec4f { return conserved[slot]; }

// Velocity of the face between two GAS cells.
fn face_velocity(n: u32, low: u32, high: u32, a: vec4f, b: vec4f) -> f32 {
    if CONSISTENT {
        if near_obstacle(cells[low], cells[high]) { return cut_velocity(cell_of(low), n) - given_back() * (node[high].w - node[low].w); }
        return carried_velocity(n, node[low], a.x, node[high], b.x);
    }
    return (a[n + 1u] + b[n + 1u]) / (a.x + b.x);
}

// With two solves the new face velocity also carries the internal energy that was there at the start of the step [shared/state.wgsl].
fn carried_along(low: u32, high: u32) -> f32 {
    if !ARS { return 0.0; }
    return 0.5 * (energy[part(START_HEAT, low)] + energy[part(START_HEAT, high)]);
}

fn interior_heat(slot: u32, here: vec4f) -> f32 {
    var heat = 0.0;
    var own = vec4f(0.0);
    if CONSISTENT { own = node[slot]; }
    for (var n = 0u; n < DIM; n++) {
        let low = slot - step_of(n);
        let high = slot + step_of(n);
        var below: f32;
        var above: f32;
        if CONSISTENT {
            below = carried_velocity(n, node[low], conserved[low].x, own, here.x);
            above = carried_velocity(n, own, here.x, node[high], conserved[high].x);
        } else {
            below = (conserved[low][n + 1u] + here[n + 1u]) / (conserved[low].x + here.x);
            above = (here[n + 1u] + conserved[high][n + 1u]) / (here.x + conserved[high].x);
        }
        let p = vec2f(interior_face(slot, n), interior_face(high, n));
        let shift = vec2f(shift_between(p.x, low, slot, n), shift_between(p.y, slot, high, n));
        heat += rounded((p.x + carried_along(low, slot)) * below - (p.y + carried_along(slot, high)) * above) + rounded(shift.x - shift.y);
    }
    return heat + heat_at_vertices(cell_of(slot), slot);
}

fn push_interior(slot: u32) { conserved[slot] += vec4f(0.0, interior_impulse(slot) * control.dt / params.spacing); }

// Calls with c in GAS; slots of other kinds see the same face from the other side.
fn push_listed(slot: u32) {
    let kind = kind_of(cells[slot]);
    if kind == SOLID { return; }
    let c = cell_of(slot);
    if kind == GAS && beside_obstacle(slot, cells[slot]) {
        conserved[slot] += vec4f(0.0, cut_impulse(slot) * control.dt / params.spacing);
        return;
    }
    var impulse = vec3f(0.0);
    for (var n = 0u; n < DIM; n++) {
        for (var side = 0u; side < 2u; side++) {
            let up = side == 1u;
            let other = select(c - axis(n), c + axis(n), up);
            let own = kind == GAS;
            if !own && (!inside(other) || kind_of(cells[slot_of(other)]) != GAS) { continue; }
            let near = select(other, c, own);
            impulse[n] += select(1.0, -1.0, up) * aperture(slot_of(near), n, up == own)
                * face_pressure(near, n, up == own, neighbour_kind(near, n, up == own));
        }
    }
    if LATE_FLUX && kind == GAS && has(cells[slot], NODE_SOLID) {
        let left = 1.0 - late_share_of(c);
        conserved[slot] *= left;
        energy[slot] *= left;
        if SPECIES { energy[part(SPECIES_DENSITY, slot)] *= left; }
        if PRODUCTS { energy[part(UNBURNED, slot)] *= left; }
    }
    if any(impulse != vec3f(0.0)) {
        conserved[slot] += vec4f(0.0, impulse * control.dt / params.spacing);
    }
}

@compute @workgroup_size(WORKGROUP)
fn fluid_momentum(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { push_interior(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { push_listed(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { push_listed(listed_slot(k)); }
}

// What passes a face of GAS cell c: p u.
fn face_power(c: vec3i, slot: u32, here: vec4f, n: u32, up: bool) -> f32 {
    let beyond = neighbour_kind(c, n, up);
    if beyond == WALL { return 0.0; }
    if SOLIDS {
        var power = 0.0;
        for (var turn = 0u; turn < when(beyond == SOLID); turn++) { power = interface_power(c, n, up); }
        if beyond == SOLID { return power; }
    }
    let p = face_pressure(c, n, up, beyond);
    let far = slot_of(select(c - axis(n), c + axis(n), up));
    if beyond == GAS {
        let there = in_space(conserved[far]);
        let velocity = face_velocity(n, select(far, slot, up), select(slot, far, up), select(there, here, up), select(here, there, up));
        return (p + carried_along(slot, far)) * velocity + shift_between(p, select(far, slot, up), select(slot, far, up), n);
    }
    // Open: the velocity that the solve saw, with which gas is carried there, too.
    let face = OpenFace(energy[part(OPEN_VELOCITY, far)], energy[part(OPEN_PRESSURE, far)]);
    if CONSISTENT && face.reference > 0.0 { return p * (node[slot][n] + node[far][n]); }
    var density = here.x;   // that of the solve: gas that followed a body has left since
    if LATE_FLUX && has(cells[slot], NODE_SOLID) { density /= 1.0 - late_share_of(c); }
    let y = admittance_of(opening_of(cells[far]), face, gamma_at(slot, energy[part(PREDICTED_PRESSURE, slot)]), density, energy[part(PREDICTED_PRESSURE, slot)]);
    return p * (face.velocity + select(-1.0, 1.0, up) * y * (p - face.reference));
}

// Power through the faces of a slot; of one that is not its `own`, through those it shares with GAS cells. `gives`: to slots of the ring
// what passes towards them.
fn heat_of(slot: u32, own: bool, gives: bool) -> f32 {
    let c = cell_of(slot);
    let here = in_space(conserved[slot]);
    var heat = 0.0;
    for (var n = 0u; n < DIM; n++) {
        var along = 0.0;
        for (var side = 0u; side < 2u; side++) {
            let up = side == 1u;
            let sign = select(1.0, -1.0, up);
            let other = select(c - axis(n), c + axis(n), up);
            if !own && (!inside(other) || kind_of(cells[slot_of(other)]) != GAS) { continue; }
            let near = select(other, c, own);
            var state = here;
            if !own { state = conserved[slot_of(near)]; }
            let power = sign * aperture(slot_of(near), n, up == own) * face_power(near, slot_of(near), state, n, up == own);
            along += power;
            if own && gives && !inside(other) { energy[slot_of(other)] -= power * control.dt / params.spacing; }
        }
        heat += rounded(along);
    }
    if own { heat += heat_at_vertices(c, slot); }
    return heat;
}

// Least ratio of the pressure of the predictor to that of the advected state, and a hair less [intermediate_pressure.wgsl]; with two solves
// less by what the solve does not see.
fn least_predicted() -> f32 { return select(0.98, 0.5, ARS); }

// Whether the floor may have to act on a cell deep inside the gas: never false where it would, for the pressure of the predictor tells
// nearly what internal energy there was before.
fn may_be_cold(slot: u32, flow: vec4f, total: f32) -> bool {
    let species = species_now(slot);
    var before = energy[part(PREDICTED_PRESSURE, slot)] / (least_predicted() * grueneisen_of(species.y));
    if PRODUCTS { before += cold_energy_of(gas_at(slot)); }
    let own = total - chemical_energy_of(gas_at(slot));
    return is_unsound(flow.x, own) || own - kinetic_energy(flow) < least_energy(flow.x, species, own, before);
}

fn heat_interior(slot: u32) {
    let flow = in_space(conserved[slot]);
    let total = energy[slot] + interior_heat(slot, flow) * control.dt / params.spacing;
    if may_be_cold(slot, flow, total) { atomicStore(&control.cold, 1u); }
    energy[slot] = total;
}

fn heat_listed(slot: u32) {
    let kind = kind_of(cells[slot]);
    if kind == WALL || kind == SOLID { return; }
    var heat = 0.0;
    // A slot of the ring has its part from the cell before it.
    for (var turn = 0u; turn < when(inside(cell_of(slot))); turn++) {
        for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) { heat += heat_of(at, kind == GAS, at == slot); }
    }
    heat /= cluster_share(slot);
    if heat != 0.0 { energy[slot] += heat * control.dt / params.spacing; }
}

@compute @workgroup_size(WORKGROUP)
fn fluid_energy(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { heat_interior(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { heat_listed(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { heat_listed(listed_slot(k)); }
}
