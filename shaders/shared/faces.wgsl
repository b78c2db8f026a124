// Fluxes through the faces of gas_advection: of any slot by cell coordinates, and what the faces deep inside the gas need.
// Needs ARS and SECOND, source(), the bindings cells and node, and reconstruct, flux, boundary, carrier, cut and cut_carrier.

fn flow_at(slot: u32) -> vec4f { return source(slot).flow; }

fn is_open(word: u32) -> bool { return kind_of(word) == GAS || kind_of(word) == GHOST; }

// Word of a slot; beyond a plane of symmetry of what it is the image of.
fn word_at(c: vec3i) -> u32 { return cells[slot_of(nearest_ring(mirrored(c)))]; }

// What a plane of symmetry across axis n makes of a state.
fn image(n: u32, gas: Gas) -> Gas {
    var out = gas;
    out.flow[n + 1u] = -gas.flow[n + 1u];
    return out;
}

// State of a GAS cell, or of the image of one, reached along axis n; of the nearest cell beyond other sides.
fn gas_at(c: vec3i, n: u32) -> Gas {
    let here = source(slot_of(nearest_inside(mirrored(c))));
    if is_image(c) { return image(n, here); }
    return here;
}

// The same of an open slot.
fn open_gas(c: vec3i, n: u32) -> Gas {
    let here = gas_at(c, n);
    if inside(mirrored(c)) { return here; }
    return gas_beyond(opening_of(cells[slot_of(nearest_ring(c))]), n, select(1.0, -1.0, c[n] < 0), here);
}

// Its carrier; beyond an outlet that of the nearest cell.
fn open_carrier(c: vec3i, n: u32) -> vec4f {
    var here = node[slot_of(nearest_inside(c))];
    if is_image(c) {
        here[n] = -here[n];
    } else if !inside(c) {
        let opening = opening_of(word_at(c));
        if prescribes(opening) { return vec4f(velocity_of(opening.flow), 0.0); }
    }
    return here;
}

// Whether the cells a to f of a face, `low` being c, or what they are images of, hold gas alone; with cut cells those around them, too.
fn all_gas(low: vec3i, n: u32) -> bool {
    if MIRRORED == 0u && PERIODIC == 0u {
        if low[n] < 2 || low[n] + 3 >= i32(params.cells[n]) { return false; }
        let s = step_of(n);
        let at = max(slot_of(low), 2u * s);
        let inner = vec4u(cells[at - s], cells[at], cells[at + s], cells[at + 2u * s]);
        let outer = cells[at - 2u * s] | cells[at + 3u * s];
        if CUT && !has(inner.x & inner.y & inner.z & inner.w, NODE_INTERIOR) { return false; }
        return kind_of(inner.x | inner.y | inner.z | inner.w | outer) == GAS;
    }
    for (var k = -2; k <= 3; k++) {
        let at = mirrored(low + k * axis(n));
        if !inside(at) || kind_of(cells[slot_of(at)]) != GAS { return false; }
        if CUT && k > -2 && k < 3 && !has(cells[slot_of(at)], NODE_INTERIOR) { return false; }
    }
    return true;
}

// The cells across the face between `near` and its neighbour; where the outer ones hold no gas, the inner ones stand for them.
fn stencil_at(near: vec3i, n: u32, up: bool, here: Gas, next: Gas, open: bool) -> Stencil {
    let behind = select(near + axis(n), near - axis(n), up);
    let beyond = select(near - 2 * axis(n), near + 2 * axis(n), up);
    let has_first = is_open(word_at(behind));
    let has_last = open && is_open(word_at(beyond));
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
    return wide(n, gas_at(low - 2 * axis(n), n), b, c, d, e, gas_at(low + 3 * axis(n), n));
}

// What passes a plane of symmetry: momentum across it, as the dissipation has it. All else is zero but for rounding.
fn reflected(n: u32, f: Fluxes) -> Fluxes {
    let normal = vec4f(0.0, vec3f(axis(n)));
    return Fluxes(Gas(normal * f.high.flow, 0.0), Gas(normal * f.low.flow, 0.0), 0.0, 0.0);
}

// Fluxes by the carrier through the face between `near` and `far`. Without bodies only open faces pass anything, and planes of symmetry.
fn carried_face(near: vec3i, far: vec3i, n: u32, up: bool) -> Fluxes {
    var out: Fluxes;
    let far_word = word_at(far);
    if !is_open(far_word) { return out; }
    let stencil = stencil_at(near, n, up, source(slot_of(near)), open_gas(far, n), true);
    let own = node[slot_of(near)];
    let other = open_carrier(far, n);
    let low = select(other, own, up);
    let high = select(own, other, up);
    let reflects = is_image(far);
    var carried = select(other[n], 0.0, reflects);
    if kind_of(far_word) == GAS && !reflects {
        if near_obstacle(slot_of(near), slot_of(far)) { carried = cut_velocity(min(near, far), n) - given_back() * (high.w - low.w); }
        else { carried = carried_velocity(n, low, stencil.c.flow.x, high, stencil.d.flow.x); }
    }
    out = carried_fluxes(stencil, carried, carrier_spread(low[n], high[n]));
    if reflects { return reflected(n, out); }
    out.heat *= f32(kind_of(far_word) == GAS);
    return out;
}

// Both fluxes through the face between `near` (a GAS cell, on the low side if `up`) and its neighbour, along +axis.
fn face_fluxes(near: vec3i, n: u32, up: bool) -> Fluxes {
    let far = select(near - axis(n), near + axis(n), up);
    if CONSISTENT { return carried_face(near, far, n, up); }
    let near_slot = slot_of(near);
    let here = source(near_slot);
    let far_word = word_at(far);
    let open = is_open(far_word);
    var next = here;
    if open { next = open_gas(far, n); }
    var out = face_fluxes_of(n, stencil_at(near, n, up, here, next, open));
    if is_image(far) { return reflected(n, out); }
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

// Six cells around the face above a slot, if it or the one above is INTERIOR: only the outermost can be images, of b and of e.
fn stencil_above(n: u32, low: u32, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> Stencil {
    let s = step_of(n);
    let last = params.slots - 1u;
    let below = cells[low - min(low, 2u * s)];
    let above = cells[min(low + 3u * s, last)];
    var is_wide = low >= 2u * s && (kind_of(below) == GAS || holds_image(below)) && (kind_of(above) == GAS || holds_image(above));
    if CUT { is_wide = has(cells[low - min(low, s)] & cells[min(low + 2u * s, last)], NODE_INTERIOR); }
    if !is_wide { return narrow(b, c, d, e); }
    var first = a;
    var end = f;
    if holds_image(below) { first = image(n, b); }
    if holds_image(above) { end = image(n, e); }
    return wide(n, first, b, c, d, e, end);
}
