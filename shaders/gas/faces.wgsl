// Fluxes through the faces of gas_advection: of any slot inside the domain by the seven cells around it in a row, and what the faces deep
// inside the gas need. Every state is read once per axis: in software a load takes as long as dozens of products.
// Needs ARS, in_first(), source(), the bindings cells and node, flux and cut_carrier.

fn flow_at(slot: u32) -> vec4f { return source(slot).flow; }

fn is_open(word: u32) -> bool { return kind_of(word) == GAS || kind_of(word) == GHOST; }

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

fn chosen(a: Gas, b: Gas, first: bool) -> Gas {
    return Gas(select(b.flow, a.flow, first), select(b.energy, a.energy, first), select(b.species, a.species, first), select(b.unburned, a.unburned, first));
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
    out.high_order = sum_of(carried, here, 1.0 - blocked, out.high_order);
    out.first_order = sum_of(carried, here, 1.0 - blocked, out.first_order);
    out.volume = carried + (1.0 - blocked) * out.volume;
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
// span of one solve. Of two gases: what they take of the density of the second and of the first, and of their
// volume fractions; phi: volume fraction of the cell, which a face that lets volume in does not change.
struct Change {
    high_order: Gas,
    first_order: Gas,
    velocity: vec3f,
    lost_density: f32,
    lost_energy: f32,
    slip: vec3f,
    heat: f32,
    phi: f32,
    lost_species: vec4f,
}

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
    let species = rounded4(vec4f(b.high_order.species, b.first_order.species));
    return Change(Gas(a.high_order.flow + high, a.high_order.energy + rest.x, a.high_order.species + species.xy,
            a.high_order.unburned + rounded(b.high_order.unburned)),
        Gas(a.first_order.flow + low, a.first_order.energy + slip.w, a.first_order.species + species.zw,
            a.first_order.unburned + rounded(b.first_order.unburned)), a.velocity,
        a.lost_density + rest.z, a.lost_energy + rest.w, a.slip + slip.xyz, a.heat + rest.y, a.phi, a.lost_species + b.lost_species);
}

fn times(share: f32, gas: Gas) -> Gas { return Gas(share * gas.flow, share * gas.energy, share * gas.species, share * gas.unburned); }

fn scaled(c: Change, share: f32) -> Change {
    return Change(times(share, c.high_order), times(share, c.first_order), c.velocity,
        share * c.lost_density, share * c.lost_energy, share * c.slip, share * c.heat, c.phi, share * c.lost_species);
}

// What a change is relative to.
fn relate(change: ptr<function, Change>, here: Gas) {
    (*change).velocity = velocity_of(here.flow);
    (*change).phi = here.species.y;
}

// Adds what a face passes. `share`: of the high-order part, that the cells of the face allow; below 0 there is none of it, and 1 + share of
// the first-order flux. `sign`: 1 where the flux along +axis enters the cell, -1 where it leaves, times the open share of the face.
fn add_face(change: ptr<function, Change>, f: Fluxes, share: f32, sign: f32) {
    let scale = sign * stage_span() / params.spacing;
    let high = max(share, 0.0);
    let first = 1.0 + min(share, 0.0);
    let flow = select(first * (f.first_order.flow + high * (f.high_order.flow - f.first_order.flow)), f.high_order.flow, share == 1.0);
    let total = select(first * (f.first_order.energy + high * (f.high_order.energy - f.first_order.energy)), f.high_order.energy, share == 1.0);
    var implicit = 0.0;
    if ARS {
        // The solve carries this part, over its own share of the step.
        (*change).heat += sign * control.dt / params.spacing * f.heat;
        if in_second() { implicit = f.heat; }
        if in_third() { implicit = (1.0 - ARS_SHARE) * f.heat; }
    }
    let through = scale * flow;
    (*change).high_order.flow += vec4f(whole(through.x, f.unit), through.yzw);
    (*change).high_order.energy += scale * (total - implicit);
    (*change).first_order.flow += scale * f.first_order.flow;
    (*change).first_order.energy += scale * (f.first_order.energy - implicit);
    var heat = f.high_order.energy - f.first_order.energy;
    if PRODUCTS { heat -= params.chemical_energy * (f.high_order.unburned - f.first_order.unburned); }
    add_excess(change, scale * (f.high_order.flow - f.first_order.flow), scale * heat);
    if SPECIES { add_species(change, f, vec2f(first, high), scale); }
}

// Density and volume fraction of the second gas: phi' = phi - dt (div(phi u) - phi div u).
fn add_species(change: ptr<function, Change>, f: Fluxes, share: vec2f, scale: f32) {
    let beyond = f.high_order.species - f.first_order.species;
    let carried = vec2f(0.0, (*change).phi * f.volume);
    let reached = select(f.first_order.species + share.y * beyond, f.high_order.species, share.y == 1.0);
    let through = scale * (share.x * (reached - carried));
    (*change).high_order.species += vec2f(whole(through.x, f.unit), through.y);
    (*change).first_order.species += scale * (f.first_order.species - carried);
    (*change).high_order.unburned += scale * share.x * mix(f.first_order.unburned, f.high_order.unburned, share.y);
    (*change).first_order.unburned += scale * f.first_order.unburned;
    let excess = scale * vec3f(beyond, f.high_order.flow.x - f.first_order.flow.x);
    (*change).lost_species += max(vec4f(-excess.x, excess.x - excess.z, -excess.y, excess.y), vec4f(0.0));
}

// -1 + the largest share, by halves, of the first-order change that leaves KEPT of what is there.
fn drained_share(before: Gas, change: Change) -> f32 {
    let least = KEPT * internal_energy(before);
    var share = 0.5;
    for (var k = 0; k < 12; k++) {
        let flow = before.flow + share * change.first_order.flow;
        let total = before.energy + share * change.first_order.energy;
        if flow.x > KEPT * before.flow.x && internal_energy(Gas(flow, total, before.species, before.unburned)) > least { return share - 1.0; }
        share *= 0.5;
    }
    return -1.0;
}

// How far densities of gases and volume fractions may fall below 0, over the density and 1.
const SPECIES_SLACK = 1e-6;

// Largest share of the high-order change that leaves of both gases density and volume.
fn species_share(low: Gas, change: Change) -> f32 {
    let density = low.flow.x;
    let held = vec4f(low.species.x, density - low.species.x, low.species.y, 1.0 - low.species.y);
    let room = max(held + SPECIES_SLACK * vec4f(density, density, 1.0, 1.0), vec4f(0.0)) / max(change.lost_species, vec4f(1e-30));
    return min(min(room.x, room.y), min(room.z, room.w));
}

// Largest share of the high-order change that keeps density and internal energy above KEPT of the first-order update.
// Where bodies recede on several sides even that would drain the cell: then -1 + the share of the first-order change that
// leaves KEPT of what is there.
fn allowed_share(before: Gas, change: Change) -> f32 {
    let low = Gas(before.flow + change.first_order.flow, before.energy + change.first_order.energy, before.species + change.first_order.species,
        before.unburned + change.first_order.unburned);
    if !(low.flow.x > KEPT * before.flow.x) || !(internal_energy(low) > 0.0) {
        if ARS && !in_first() { return 0.0; }    // `before` is no state of the gas here, its own change is behind it
        return drained_share(before, change);
    }
    let slip = low.flow.yzw - low.flow.x * change.velocity;
    // rho e = E - v m + rho v^2 / 2 - |m - rho v|^2 / (2 rho) for every v; with v fixed only the last part is not linear.
    let least = KEPT * internal_energy(low);
    let available = internal_energy(low) + 0.5 * dot(slip, slip) / low.flow.x;
    var share = min(1.0, (1.0 - KEPT) * low.flow.x / max(change.lost_density, 1e-30));
    if SPECIES { share = min(share, species_share(low, change)); }
    for (var k = 0; k < 12; k++) {
        let slips = abs(slip) + share * change.slip;
        let density = low.flow.x - share * change.lost_density;
        if available - share * change.lost_energy - 0.5 * dot(slips, slips) / density >= least { return share; }
        share *= 0.5;
    }
    return 0.0;
}
