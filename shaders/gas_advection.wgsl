// gas_advection: where does the gas carry itself?
// Reads gas, cells, node velocities. Writes the advected state. On return mass is conserved; no pressure work has been done yet.
// TVD-RK2: U1 = U0 + dt L(U0); U* = (U0 + U1 + dt L(U1)) / 2. [Cao et al. 2022, eqs. 10-12 and section 2.3; Shu & Osher 1988]
// ARS: one stage before each of the two solves, see shared/ars.wgsl.
// Slots that are not GAS collect what passes through their faces: owed gas in SOLID cells, outflow in GHOST slots. So the sum
// over all slots is conserved. A closed face passes R v_n U + (1 - R) (flux with everything behind it copied from this side).
#include "shared/index.wgsl"
#include "shared/listed.wgsl"
#include "shared/cell.wgsl"
#include "shared/gas.wgsl"
#include "shared/boundary.wgsl"
#include "shared/control.wgsl"
#include "shared/ars.wgsl"
#include "shared/reconstruct.wgsl"
#include "shared/flux.wgsl"
#include "shared/limiter.wgsl"
#include "shared/carrier.wgsl"
#include "shared/cut.wgsl"
#include "shared/cut_carrier.wgsl"
#include "shared/still.wgsl"

override SECOND: bool;  // stage of the Runge-Kutta scheme

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> work: array<vec4f>;      // U1, U*; with ARS a third part: the kept state
@group(0) @binding(5) var<storage, read_write> energy: array<f32>;      // now, U1, U*; with ARS U* without the central heat in place of U1, and the kept state
@group(0) @binding(6) var<storage, read> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> extra: array<u32>;
@group(0) @binding(7) var<storage, read_write> theta: array<f32>;       // share of the high-order flux a cell allows; below 0: of the first-order flux
@group(0) @binding(12) var<storage, read> still: array<u32>;

fn source(slot: u32) -> Gas {
    if SECOND && !ARS { return Gas(work[slot], energy[params.slots + slot]); }
    return Gas(conserved[slot], energy[slot]);
}

fn flow_at(slot: u32) -> vec4f { return source(slot).flow; }

fn is_open(word: u32) -> bool { return kind_of(word) == GAS || kind_of(word) == GHOST; }

// State of an open slot, reached along axis n.
fn open_gas(c: vec3i, n: u32) -> Gas {
    let here = source(slot_of(nearest_inside(c)));
    if inside(c) { return here; }
    return gas_beyond(opening_of(cells[slot_of(nearest_ring(c))]), n, select(1.0, -1.0, c[n] < 0), here);
}

// Carrier of an open slot; beyond an outlet that of the nearest cell.
fn open_carrier(c: vec3i) -> vec4f {
    if !inside(c) {
        let opening = opening_of(cells[slot_of(nearest_ring(c))]);
        if opening.rule <= RULE_SUBSONIC { return vec4f(velocity_of(opening.flow), 0.0); }
    }
    return node[slot_of(nearest_inside(c))];
}

// The four cells across the face between `near` and its neighbour; where the outer ones hold no gas, the inner ones stand for them.
fn stencil_at(near: vec3i, n: u32, up: bool, here: Gas, next: Gas, open: bool) -> Stencil {
    let behind = select(near + axis(n), near - axis(n), up);
    let beyond = select(near - 2 * axis(n), near + 2 * axis(n), up);
    let has_first = is_open(cells[slot_of(behind)]);
    let has_last = open && is_open(cells[slot_of(nearest_ring(beyond))]);
    var first = here;
    var last = next;
    if has_first { first = open_gas(behind, n); }
    if has_last { last = open_gas(beyond, n); }
    var out = Stencil(chosen(first, last, up), chosen(here, next, up), chosen(next, here, up), chosen(last, first, up), 0.0);
    if has_first && has_last { out.even = evenness(n, out.a, out.b, out.c, out.d); }
    return out;
}

// Fluxes by the carrier through the face between `near` and `far`. Without bodies only open faces pass anything.
fn carried_face(near: vec3i, far: vec3i, n: u32, up: bool) -> Fluxes {
    var out: Fluxes;
    let far_word = cells[slot_of(far)];
    if !is_open(far_word) { return out; }
    let stencil = stencil_at(near, n, up, source(slot_of(near)), open_gas(far, n), true);
    let own = node[slot_of(near)];
    let other = open_carrier(far);
    let low = select(other, own, up);
    let high = select(own, other, up);
    var carried = other[n];
    if kind_of(far_word) == GAS {
        if near_obstacle(slot_of(near), slot_of(far)) { carried = cut_velocity(min(near, far), n) - 0.25 * (high.w - low.w); }
        else { carried = carried_velocity(n, low, stencil.b.flow.x, high, stencil.c.flow.x); }
    }
    out = carried_fluxes(stencil, carried, carrier_spread(low[n], high[n]));
    out.heat *= f32(kind_of(far_word) == GAS);
    return out;
}

// Both fluxes through the face between `near` (a GAS cell, on the low side if `up`) and its neighbour, along +axis.
fn face_fluxes(near: vec3i, n: u32, up: bool) -> Fluxes {
    let far = select(near - axis(n), near + axis(n), up);
    if CONSISTENT { return carried_face(near, far, n, up); }
    let near_slot = slot_of(near);
    let here = source(near_slot);
    let far_word = cells[slot_of(far)];
    let open = is_open(far_word);
    var next = here;
    if open { next = open_gas(far, n); }
    var out = face_fluxes_of(n, stencil_at(near, n, up, here, next, open));
    out.heat *= f32(kind_of(far_word) == GAS);
    if open { return out; }
    // Closed face: mirrored about the velocity of the wall, to first order its velocity times this side's state.
    var blocked = 1.0;
    var wall_velocity = 0.0;
    if SOLIDS && kind_of(far_word) == SOLID {
        blocked = blocked_of(far_word);
        let a = node[near_slot];
        let b = node[slot_of(far)];
        wall_velocity = (a.w * a[n] + b.w * b[n]) / max(a.w + b.w, 1e-30);
    }
    let carried = blocked * wall_velocity;
    out.high = Gas(carried * here.flow + (1.0 - blocked) * out.high.flow, carried * here.energy + (1.0 - blocked) * out.high.energy);
    out.low = Gas(carried * here.flow + (1.0 - blocked) * out.low.flow, carried * here.energy + (1.0 - blocked) * out.low.energy);
    return out;
}

// `sign`: 1 into the cell, -1 out of it; times the open share of the face.
fn add_face(change: ptr<function, Change>, f: Fluxes, part: f32, sign: f32) {
    let scale = sign * control.dt * select(1.0, ARS_SECOND, ARS && SECOND) / params.spacing;
    let blend = max(part, 0.0);
    let drain = 1.0 + min(part, 0.0);
    let flow = select(drain * (f.low.flow + blend * (f.high.flow - f.low.flow)), f.high.flow, part == 1.0);
    let heat = select(drain * (f.low.energy + blend * (f.high.energy - f.low.energy)), f.high.energy, part == 1.0);
    var implicit = 0.0;
    if ARS {
        // The solve carries this part, over its own share of the step.
        (*change).heat += sign * control.dt / params.spacing * f.heat;
        if SECOND { implicit = (1.0 - 1.0 / ARS_SECOND) * f.heat; }
    }
    (*change).high.flow += scale * flow;
    (*change).high.energy += scale * (heat - implicit);
    if LIMITER {
        (*change).low.flow += scale * f.low.flow;
        (*change).low.energy += scale * (f.low.energy - implicit);
        add_excess(change, scale * (f.high.flow - f.low.flow), scale * (f.high.energy - f.low.energy));
    }
}

// dt L(U) of a slot; of all cells that share its state together.
fn change_of(slot: u32, limited: bool) -> Change {
    var change: Change;
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) { add_faces(&change, at, limited); }
    if CUT { change = scaled(change, 1.0 / cluster_share(slot)); }
    return change;
}

// What passes the faces of a slot if it is GAS, else those it shares with GAS cells.
fn add_faces(change: ptr<function, Change>, slot: u32, limited: bool) {
    let c = cell_of(slot);
    let is_gas = kind_of(cells[slot]) == GAS;
    if LIMITER && is_gas { (*change).velocity = velocity_of(source(slot).flow); }
    // Slots without gas around them, as deep inside a body, have nothing to do.
    let axes = select(0u, DIM, has(cells[slot], NODE_GAS));
    for (var n = 0u; n < axes; n++) {
        for (var side = 0u; side < 2u; side++) {
            let up = side == 1u;
            let other = select(c - axis(n), c + axis(n), up);
            if !is_gas && (!inside(other) || kind_of(cells[slot_of(other)]) != GAS) { continue; }
            var part = 1.0;
            if limited { part = min(theta[slot], theta[slot_of(other)]); }
            let near = select(other, c, is_gas);
            let f = face_fluxes(near, n, up == is_gas);
            add_face(change, f, part, select(1.0, -1.0, up) * aperture(slot_of(near), n, up == is_gas));
        }
    }
}

// Fluxes deep inside the gas, through the face above slot b.
fn interior_fluxes(n: u32, b_slot: u32, a: Gas, b: Gas, c: Gas, d: Gas) -> Fluxes {
    let stencil = Stencil(a, b, c, d, evenness(n, a, b, c, d));
    if !CONSISTENT { return face_fluxes_of(n, stencil); }
    let low = node[b_slot];
    let high = node[b_slot + step_of(n)];
    return carried_fluxes(stencil, carried_velocity(n, low, b.flow.x, high, c.flow.x), carrier_spread(low[n], high[n]));
}

// The same through both faces across one axis, far from walls, bodies and open sides, where nothing has to be asked.
fn add_axis(change: ptr<function, Change>, slot: u32, n: u32, here: Gas) {
    let s = step_of(n);
    let b = source(slot - s);
    let c = source(slot + s);
    add_face(change, interior_fluxes(n, slot - s, source(slot - 2u * s), b, here, c), 1.0, 1.0);
    add_face(change, interior_fluxes(n, slot, b, here, c, source(slot + 2u * s)), 1.0, -1.0);
}

// The state that the change of this stage is added to.
fn start_of(slot: u32, here: Gas) -> Gas {
    if !ARS || !SECOND { return here; }
    return Gas(here.flow + ARS_KEPT * (here.flow - work[2u * params.slots + slot]),
        here.energy + ARS_KEPT * (here.energy - energy[3u * params.slots + slot]));
}

fn write_result(slot: u32, before: Gas, all: Change) {
    let change = all.high;
    if ARS {
        work[params.slots + slot] = before.flow + change.flow;
        energy[params.slots + slot] = before.energy + change.energy - all.heat;
        energy[2u * params.slots + slot] = before.energy + change.energy;
        if SECOND { return; }
        work[2u * params.slots + slot] = before.flow + ARS_CHANGE * change.flow;
        energy[3u * params.slots + slot] = before.energy + ARS_CHANGE * (change.energy - all.heat);
    } else if SECOND {
        work[params.slots + slot] = 0.5 * (conserved[slot] + before.flow + change.flow);
        energy[2u * params.slots + slot] = 0.5 * (energy[slot] + before.energy + change.energy);
    } else {
        work[slot] = before.flow + change.flow;
        energy[params.slots + slot] = before.energy + change.energy;
    }
}

fn finish(slot: u32, here: Gas, change: Change) {
    let before = start_of(slot, here);
    if LIMITER {
        var share = 1.0;
        if kind_of(cells[slot]) == GAS { share = allowed_share(before, change); }
        theta[slot] = share;
        if share < 1.0 { atomicAdd(&control.limited, 1u); }
    }
    write_result(slot, before, change);
}

// One slot of the list.
@compute @workgroup_size(WORKGROUP)
fn advect_listed(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) lane: u32) {
    let slot = listed_slot(thread_index(group, groups, lane));
    if slot >= params.slots { return; }
    finish(slot, source(slot), change_of(slot, false));
}

// A column of params.march slots along the last axis: each state there is read once, each face computed once.
@compute @workgroup_size(WORKGROUP)
fn advect_interior(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                   @builtin(local_invocation_index) lane: u32) {
    let n = DIM - 1u;
    let s = step_of(n);
    let thread = thread_index(group, groups, lane);
    let first = march_start(thread);
    let last = params.slots - 1u;
    if first > last { return; }
    if !(ARS && SECOND) && is_still(thread) {
        for (var slot = first; slot < min(first + params.march * s, params.slots); slot += s) {
            if LIMITER { theta[slot] = 1.0; }
            write_result(slot, Gas(conserved[slot], energy[slot]), Change());
        }
        return;
    }
    var a = source(max(first, 2u * s) - 2u * s);
    var b = source(max(first, s) - s);
    var here = source(first);
    var c = source(min(first + s, last));
    var low = interior_fluxes(n, max(first, s) - s, a, b, here, c);
    for (var k = 0u; k < params.march; k++) {
        let slot = first + k * s;
        if slot > last { break; }
        let d = source(min(slot + 2u * s, last));
        let high = interior_fluxes(n, slot, b, here, c, d);
        if has(cells[slot], INTERIOR) {
            var change: Change;
            if LIMITER { change.velocity = velocity_of(here.flow); }
            add_face(&change, low, 1.0, 1.0);
            add_face(&change, high, 1.0, -1.0);
            for (var m = 0u; m < n; m++) { add_axis(&change, slot, m, here); }
            finish(slot, here, change);
        }
        low = high;
        b = here;
        here = c;
        c = d;
    }
}

// Only where the limiter acted somewhere: the slots whose faces carry less than the full flux once more.
@compute @workgroup_size(WORKGROUP)
fn advect_limited(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    if is_alias(c) { return; }
    var least = theta[slot];
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        let member = cell_of(at);
        for (var n = 0u; n < DIM; n++) {
            if in_ring(member - axis(n)) { least = min(least, theta[slot_of(member - axis(n))]); }
            if in_ring(member + axis(n)) { least = min(least, theta[slot_of(member + axis(n))]); }
        }
    }
    if least == 1.0 { return; }
    write_result(slot, start_of(slot, source(slot)), change_of(slot, true));
}
