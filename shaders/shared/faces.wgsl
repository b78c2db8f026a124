// Fluxes through the faces of gas_advection: of any slot by cell coordinates, and what the faces deep inside the gas need.
// Needs ARS and SECOND, source(), the bindings cells and node, and reconstruct, flux, boundary, carrier, cut and cut_carrier.

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

// Whether three cells on each side of the face above `low` hold gas alone; with cut cells those around them, too.
fn all_gas(low: vec3i, n: u32) -> bool {
    for (var k = -2; k <= 3; k++) {
        let at = low + k * axis(n);
        if !inside(at) || kind_of(cells[slot_of(at)]) != GAS { return false; }
        if CUT && k > -2 && k < 3 && !has(cells[slot_of(at)], NODE_INTERIOR) { return false; }
    }
    return true;
}

// The cells across the face between `near` and its neighbour; where the outer ones hold no gas, the inner ones stand for them.
fn stencil_at(near: vec3i, n: u32, up: bool, here: Gas, next: Gas, open: bool) -> Stencil {
    let behind = select(near + axis(n), near - axis(n), up);
    let beyond = select(near - 2 * axis(n), near + 2 * axis(n), up);
    let has_first = is_open(cells[slot_of(behind)]);
    let has_last = open && is_open(cells[slot_of(nearest_ring(beyond))]);
    var first = here;
    var last = next;
    if has_first { first = open_gas(behind, n); }
    if has_last { last = open_gas(beyond, n); }
    let b = chosen(first, last, up);
    let c = chosen(here, next, up);
    let d = chosen(next, here, up);
    let e = chosen(last, first, up);
    let low = select(near - axis(n), near, up);
    if !all_gas(low, n) { return narrow(b, c, d, e); }
    return wide(n, source(slot_of(low - 2 * axis(n))), b, c, d, e, source(slot_of(low + 3 * axis(n))));
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
        if near_obstacle(slot_of(near), slot_of(far)) { carried = cut_velocity(min(near, far), n) - given_back() * (high.w - low.w); }
        else { carried = carried_velocity(n, low, stencil.c.flow.x, high, stencil.d.flow.x); }
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

// Whether three cells on each side of the face above a slot hold gas alone, if it or the one above is INTERIOR.
fn is_wide(low: u32, s: u32) -> bool {
    let last = params.slots - 1u;
    if CUT { return has(cells[low - min(low, s)] & cells[min(low + 2u * s, last)], NODE_INTERIOR); }
    return low >= 2u * s && kind_of(cells[low - min(low, 2u * s)]) == GAS && kind_of(cells[min(low + 3u * s, last)]) == GAS;
}

fn stencil_above(n: u32, low: u32, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> Stencil {
    if is_wide(low, step_of(n)) { return wide(n, a, b, c, d, e, f); }
    return narrow(b, c, d, e);
}
