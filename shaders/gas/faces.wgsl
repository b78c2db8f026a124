// Fluxes through the faces of gas_advection: of any slot inside the domain by the seven cells around it in a row, and what the faces deep
// inside the gas need. Every state is read once per axis: in software a load takes as long as dozens of products.
// Needs ARS and RUNGE_KUTTA, source(), the bindings cells and node, flux and cut_carrier.

fn flow_at(slot: u32) -> vec4f { return source(slot).flow; }

fn is_open(word: u32) -> bool { return kind_of(word) == GAS || kind_of(word) == GHOST; }

// What a plane of symmetry across axis n makes of a state.
fn image(n: u32, gas: Gas) -> Gas {
    var out = gas;
    out.flow = select(gas.flow, -gas.flow, vec4<bool>(false, along(n)));
    return out;
}

// What stands at a place of a row: word and gas of the cell there; beyond a plane of symmetry, of the cell that it is the image of; beyond
// any other side, the word of the ring's slot and the gas of the last cell, which row_around replaces by that beyond the side.
struct Seen { word: u32, gas: Gas }

fn seen(slot: u32, c: vec3i, n: u32, offset: i32) -> Seen {
    let count = i32(params.cells[n]);
    let place = place_along(n, c[n] + offset);
    let s = i32(step_of(n));
    let word = cells[u32(i32(slot) + (clamp(place, -1, count) - c[n]) * s)];
    let gas = source(u32(i32(slot) + (clamp(place, 0, count - 1) - c[n]) * s));
    if is_reflected(n, c[n] + offset) { return Seen(word, image(n, gas)); }
    return Seen(word, gas);
}

// Seven cells in a row along an axis, d being the slot itself.
struct Row { a: Seen, b: Seen, c: Seen, d: Seen, e: Seen, f: Seen, g: Seen }

fn row_around(slot: u32, c: vec3i, n: u32) -> Row {
    let own = Seen(cells[slot], source(slot));
    var row = Row(seen(slot, c, n, -3), seen(slot, c, n, -2), seen(slot, c, n, -1), own,
        seen(slot, c, n, 1), seen(slot, c, n, 2), seen(slot, c, n, 3));
    let count = i32(params.cells[n]);
    let below = vec2<bool>(place_along(n, c[n] - 2) < 0, place_along(n, c[n] - 1) < 0);
    let above = vec2<bool>(place_along(n, c[n] + 2) >= count, place_along(n, c[n] + 1) >= count);
    if below.x {
        row.b.gas = beyond_side(n, -1.0, select(row.b.word, row.c.word, below.y), chosen(row.d.gas, row.c.gas, below.y));
        row.c.gas = chosen(row.b.gas, row.c.gas, below.y);
    }
    if above.x {
        row.f.gas = beyond_side(n, 1.0, select(row.f.word, row.e.word, above.y), chosen(row.d.gas, row.e.gas, above.y));
        row.e.gas = chosen(row.f.gas, row.e.gas, above.y);
    }
    return row;
}

fn beyond_side(n: u32, outward: f32, word: u32, here: Gas) -> Gas {
    if kind_of(word) != GHOST { return here; }
    return gas_beyond(opening_of(word), n, outward, here);
}

// The row as the face below the slot sees it, or the one above: a to f, the face between c and d; g counts no more.
fn row_at_face(row: Row, up: bool) -> Row {
    return Row(nearer(row.a, row.b, up), nearer(row.b, row.c, up), nearer(row.c, row.d, up), nearer(row.d, row.e, up),
        nearer(row.e, row.f, up), nearer(row.f, row.g, up), row.g);
}

fn nearer(low: Seen, high: Seen, up: bool) -> Seen { return Seen(select(low.word, high.word, up), chosen(high.gas, low.gas, up)); }

// The cells across a face. One that is closed has the state across the face; where the outer ones hold no gas, the inner ones stand for them.
fn stencil_at(r: Row, n: u32) -> Stencil {
    let low = is_open(r.c.word);
    let high = is_open(r.d.word);
    let c = chosen(r.c.gas, r.d.gas, low);
    let d = chosen(r.d.gas, r.c.gas, high);
    let b = chosen(r.b.gas, c, low && is_open(r.b.word));
    let e = chosen(r.e.gas, d, high && is_open(r.e.word));
    var all_gas = kind_of(r.a.word | r.b.word | r.c.word | r.d.word | r.e.word | r.f.word) == GAS;
    if CUT { all_gas = all_gas && has(r.b.word & r.c.word & r.d.word & r.e.word, NODE_INTERIOR); }
    if !all_gas { return narrow(b, c, d, e); }
    return wide(n, r.a.gas, b, c, d, e, r.f.gas);
}

// What passes a plane of symmetry: momentum across it, as the dissipation has it. All else is zero but for rounding.
fn reflected(n: u32, f: Fluxes) -> Fluxes {
    let normal = vec4f(0.0, vec3f(axis(n)));
    return Fluxes(Gas(normal * f.high_order.flow, 0.0), Gas(normal * f.first_order.flow, 0.0), 0.0, 0.0);
}

// Slot on the other side of a face.
fn slot_beside(slot: u32, c: vec3i, n: u32, up: bool) -> u32 {
    return u32(i32(slot) + (place_along(n, c[n] + select(-1, 1, up)) - c[n]) * i32(step_of(n)));
}

// Carrier of the neighbour of a GAS slot inside the domain; beyond an outlet that of the face.
fn carrier_beside(slot: u32, c: vec3i, n: u32, offset: i32, word: u32) -> vec4f {
    let place = place_along(n, c[n] + offset);
    let nearest = clamp(place, 0, i32(params.cells[n]) - 1);
    var here = node[u32(i32(slot) + (nearest - c[n]) * i32(step_of(n)))];
    if is_reflected(n, c[n] + offset) {
        here = vec4f(select(here.xyz, -here.xyz, along(n)), here.w);
    } else if place != nearest && kind_of(word) == GHOST {
        let opening = opening_of(word);
        if prescribes(opening) { return vec4f(velocity_of(opening.flow), 0.0); }
        here += vec4f(node[slot_beside(slot, c, n, offset > 0)].xyz, 0.0);
    }
    return here;
}

// Fluxes by the carrier through a face of a GAS slot. Without bodies only open faces pass anything, and planes of symmetry.
fn carried_face(slot: u32, c: vec3i, n: u32, up: bool, r: Row) -> Fluxes {
    var out: Fluxes;
    if !is_open(r.c.word) || !is_open(r.d.word) { return out; }
    let word = select(r.c.word, r.d.word, up);
    let own = node[slot];
    let other = carrier_beside(slot, c, n, select(-1, 1, up), word);
    let low = select(other, own, up);
    let high = select(own, other, up);
    let stencil = stencil_at(r, n);
    let reflects = is_reflected(n, c[n] + select(-1, 1, up));
    var carried = select(other[n], 0.0, reflects);
    if kind_of(word) == GAS && !reflects {
        if near_obstacle(r.c.word, r.d.word) { carried = cut_velocity(select(c - axis(n), c, up), n) - given_back() * (high.w - low.w); }
        else { carried = carried_velocity(n, low, stencil.c.flow.x, high, stencil.d.flow.x); }
    }
    out = carried_fluxes(stencil, carried, carrier_spread(low[n], high[n]), heat_between(stencil, slot, slot_beside(slot, c, n, up)));
    if reflects { return reflected(n, out); }
    if kind_of(word) != GAS { out.heat = 0.0; }
    return out;
}

// Both fluxes through the face below a slot inside the domain, or the one above, along +axis; one of its cells is GAS.
fn face_fluxes(slot: u32, c: vec3i, n: u32, up: bool, r: Row) -> Fluxes {
    if CONSISTENT { return carried_face(slot, c, n, up, r); }
    let stencil = stencil_at(r, n);
    var out = face_fluxes_of(n, stencil, heat_between(stencil, slot, slot_beside(slot, c, n, up)));
    if is_reflected(n, c[n] + select(-1, 1, up)) { return reflected(n, out); }
    if kind_of(r.c.word | r.d.word) != GAS { out.heat = 0.0; }
    if is_open(r.c.word) && is_open(r.d.word) { return out; }
    // Closed face: mirrored about the velocity of the wall, to first order its velocity times this side's state.
    let from_low = kind_of(r.c.word) == GAS;
    let here = chosen(r.c.gas, r.d.gas, from_low);
    let wall = select(r.c.word, r.d.word, from_low);
    var blocked = 1.0;
    var wall_velocity = 0.0;
    if SOLIDS && kind_of(wall) == SOLID {
        blocked = blocked_of(wall);
        let a = node[slot];
        let b = node[select(slot - step_of(n), slot + step_of(n), up)];
        wall_velocity = (a.w * a[n] + b.w * b[n]) / max(a.w + b.w, 1e-30);
    }
    let carried = blocked * wall_velocity;
    out.high_order = Gas(carried * here.flow + (1.0 - blocked) * out.high_order.flow, carried * here.energy + (1.0 - blocked) * out.high_order.energy);
    out.first_order = Gas(carried * here.flow + (1.0 - blocked) * out.first_order.flow, carried * here.energy + (1.0 - blocked) * out.first_order.energy);
    return out;
}

// Six cells around a face deep inside the gas. `all_gas`: whether all hold gas or are images; only the outermost can be, of b and of e.
fn stencil_inside(n: u32, all_gas: bool, low_image: bool, high_image: bool, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> Stencil {
    if !all_gas { return narrow(b, c, d, e); }
    var first = a;
    var end = f;
    if low_image { first = image(n, b); }
    if high_image { end = image(n, e); }
    return wide(n, first, b, c, d, e, end);
}

// Positivity limiter: every cell names the largest share of the high-order part that its faces may carry, and a face carries the least of
// its two cells. So a cell must stand every mix of shares below its own. Density and internal energy are concave functions of the state,
// which makes the worst mix a sum over the faces. [Zhang & Shu 2010; Hu, Adams & Shu 2013; Kuzmin 2020]

// A cell must keep this share of what the first-order update leaves of density and internal energy.
const KEPT = 0.1;

// dt L(U) of both orders, of the high order with each face's share of it, and the worst that the high-order parts of the faces can do to a
// GAS cell: density and internal energy that they take, and momentum that they bring, relative to `velocity`. heat: that of Fluxes, over the
// span of one solve.
struct Change { high_order: Gas, first_order: Gas, velocity: vec3f, lost_density: f32, lost_energy: f32, slip: vec3f, heat: f32 }

// Adds the high-order part of a face, its flux less that of first order, to the worst.
fn add_excess(change: ptr<function, Change>, flow: vec4f, energy: f32) {
    let velocity = (*change).velocity;
    let slip = flow.yzw - flow.x * velocity;
    (*change).lost_density += max(-flow.x, 0.0);
    (*change).lost_energy += max(0.5 * dot(velocity, flow.yzw + slip) - energy, 0.0);
    (*change).slip += abs(slip);
}

// Adds what passes along another axis.
fn plus(a: Change, b: Change) -> Change {
    let high = rounded4(b.high_order.flow);
    let rest = rounded4(vec4f(b.high_order.energy, b.heat, b.lost_density, b.lost_energy));
    let low = rounded4(b.first_order.flow);
    let slip = rounded4(vec4f(b.slip, b.first_order.energy));
    return Change(Gas(a.high_order.flow + high, a.high_order.energy + rest.x), Gas(a.first_order.flow + low, a.first_order.energy + slip.w), a.velocity,
        a.lost_density + rest.z, a.lost_energy + rest.w, a.slip + slip.xyz, a.heat + rest.y);
}

fn scaled(c: Change, share: f32) -> Change {
    return Change(Gas(share * c.high_order.flow, share * c.high_order.energy), Gas(share * c.first_order.flow, share * c.first_order.energy), c.velocity,
        share * c.lost_density, share * c.lost_energy, share * c.slip, share * c.heat);
}

// -1 + the largest share, by halves, of the first-order change that leaves KEPT of what is there.
fn drained_share(before: Gas, change: Change) -> f32 {
    let least = KEPT * internal_energy(before);
    var share = 0.5;
    for (var k = 0; k < 12; k++) {
        let flow = before.flow + share * change.first_order.flow;
        let total = before.energy + share * change.first_order.energy;
        if flow.x > KEPT * before.flow.x && internal_energy(Gas(flow, total)) > least { return share - 1.0; }
        share *= 0.5;
    }
    return -1.0;
}

// Largest share of the high-order change that keeps density and internal energy above KEPT of the first-order update.
// Where bodies recede on several sides even that would drain the cell: then -1 + the share of the first-order change that
// leaves KEPT of what is there.
fn allowed_share(before: Gas, change: Change) -> f32 {
    let low = Gas(before.flow + change.first_order.flow, before.energy + change.first_order.energy);
    if !(low.flow.x > KEPT * before.flow.x) || !(internal_energy(low) > 0.0) {
        if ARS && RUNGE_KUTTA > 0u { return 0.0; }    // `before` is no state of the gas here, its own change is behind it
        return drained_share(before, change);
    }
    let slip = low.flow.yzw - low.flow.x * change.velocity;
    // rho e = E - v m + rho v^2 / 2 - |m - rho v|^2 / (2 rho) for every v; with v fixed only the last part is not linear.
    let least = KEPT * internal_energy(low);
    let available = internal_energy(low) + 0.5 * dot(slip, slip) / low.flow.x;
    var share = min(1.0, (1.0 - KEPT) * low.flow.x / max(change.lost_density, 1e-30));
    for (var k = 0; k < 12; k++) {
        let slips = abs(slip) + share * change.slip;
        let density = low.flow.x - share * change.lost_density;
        if available - share * change.lost_energy - 0.5 * dot(slips, slips) / density >= least { return share; }
        share *= 0.5;
    }
    return 0.0;
}
