// Value at the face between c and d of six cells in a row, from upstream, by the WENO method in two forms:
// - where the gas is compressed (`even` 0), third order from b, c and d: linear weights 1/3 and 2/3 over (beta + epsilon)^2, beta the
//   square of the difference of a two-point sub-stencil [Jiang & Shu 1996]. Shocks need it;
// - elsewhere (`even` 1), fifth order from a to e: three parabolas with the linear weights 0.1, 0.6 and 0.3, times
//   1 + (tau / (beta + epsilon))^2, tau the difference of the outer two beta. It keeps waves and contacts [Borges et al. 2008].
// All differences are relative to the largest of the values, so that neither the unit system nor float32's range changes the scheme.
// Needs ARS, in_first(), carried_heat() and the bindings control and energy.

// Differences below its root, 2.6 % of a value, count as smooth where the gas is compressed [docs/notes/reconstruction.md].
const WENO_EPSILON = 7e-4;
// The same elsewhere: 0.1 %.
const EVEN_EPSILON = 1e-6;
// The third-order form takes over up to where the velocity falls from one cell to the next by this part of the speed of sound.
const STEEP = 0.1;
// Least speed of the dissipation in a shock, over that of sound. The solve captures shocks without dissipation of its own, and a shock
// that the gas does not cross along this axis would get none: waves would trail it. B2B1 with one velocity for the faces needs more [docs/notes/reconstruction.md].
fn shock_spread() -> f32 { return select(0.6, 1.2, QUADRATIC && CONSISTENT); }

// Cells a to f along an axis, the face between c and d, and what that face takes from them:
//   even     share of the fifth-order form, 1 without compression
//   level    share of density, velocity and internal energy among what is reconstructed, 1 where the velocity neither falls nor rises
//   spread   least speed of the dissipation
struct Stencil { a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas, even: f32, level: f32, spread: f32 }

// Of four cells, where others beyond them are no gas. Where two gases meet, their contact must keep its pressure there, too.
fn narrow(b: Gas, c: Gas, d: Gas, e: Gas) -> Stencil {
    let phi = vec4f(b.species.y, c.species.y, d.species.y, e.species.y);
    let most = max(max(phi.x, phi.y), max(phi.z, phi.w));
    let least = min(min(phi.x, phi.y), min(phi.z, phi.w));
    return Stencil(b, b, c, d, e, e, 0.0, select(0.0, 1.0, SPECIES && most - least > PURE), 0.0);
}

fn wide(n: u32, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> Stencil {
    let sound = sound_between(c, d);
    let share = steepness(n, 1.0, sound, a, b, c, d, e, f);
    let parting = steepness(n, -1.0, sound, a, b, c, d, e, f);
    let spread = min(shock_spread() * share * sound, most_spread());
    return Stencil(a, b, c, d, e, f, 1.0 - share, (1.0 - share) * (1.0 - parting), spread);
}

// [s] over which the fluxes of the stage pass.
fn stage_span() -> f32 {
    if !ARS || in_first() { return control.dt; }
    return select(ARS_MIDDLE, ARS_LAST, in_third()) * control.dt;
}

// A third of a cell per stage: with all three axes in a shock, the most that is stable.
fn most_spread() -> f32 { return params.spacing / (3.0 * max(stage_span(), 1e-30)); }

fn sound_between(c: Gas, d: Gas) -> f32 {
    if SPECIES {
        let p = vec2f(pressure_of(c), pressure_of(d));
        let square = stiffness_ratio(c, p.x) * p.x / c.flow.x + stiffness_ratio(d, p.y) * p.y / d.flow.x;
        return sqrt(max(0.5 * square, 1e-30));
    }
    let energy = 0.5 * (internal_energy(c) / c.flow.x + internal_energy(d) / d.flow.x);
    return sqrt(max(params.gamma * (params.gamma - 1.0) * energy, 1e-30));
}

fn velocity_along(n: u32, gas: Gas) -> f32 { return gas.flow[n + 1u] / gas.flow.x; }

// How far a face with normal n is from even gas: 0 to 1, in a shock with `sign` 1, where gas parts with -1.
fn steepness(n: u32, sign: f32, sound: f32, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> f32 {
    let ub = velocity_along(n, b);
    let uc = velocity_along(n, c);
    let ud = velocity_along(n, d);
    let ue = velocity_along(n, e);
    let ends = sign * vec2f(velocity_along(n, a) - ub, ue - velocity_along(n, f));
    let inner = sign * vec3f(ub - uc, uc - ud, ud - ue);
    let drop = max(max(max(inner.x, inner.y), max(inner.z, max(ends.x, ends.y))), 0.0) / (STEEP * sound);
    return min(drop * drop, 1.0);
}

fn largest(b: vec4f, c: vec4f, d: vec4f, e: vec4f) -> vec4f { return max(max(abs(b), abs(c)), max(abs(d), abs(e))); }

fn square(x: vec4f) -> vec4f { return x * x; }

// Third order: what the value differs from c by, of the differences c - b and d - c.
fn third(unit: vec4f, low: vec4f, high: vec4f) -> vec4f {
    let outer = square(low * unit) + WENO_EPSILON;
    let inner = square(high * unit) + WENO_EPSILON;
    let weight = inner * inner / (inner * inner + 2.0 * outer * outer);
    return 0.5 * (high + weight * (low - high));
}

fn even_weight(linear: f32, tau: vec4f, beta: vec4f) -> vec4f {
    let ratio = tau / (beta + EVEN_EPSILON);
    return linear + linear * square(ratio);
}

// beta of a parabola: of its second difference and twice its slope.
fn smoothness(curved: vec4f, sloped: vec4f) -> vec4f { return 13.0 / 12.0 * square(curved) + 0.25 * square(sloped); }

// Fifth order: the same of b - a, c - b, d - c and e - d.
fn fifth(unit: vec4f, p: vec4f, q: vec4f, r: vec4f, s: vec4f) -> vec4f {
    let low = smoothness((q - p) * unit, (3.0 * q - p) * unit);
    let middle = smoothness((r - q) * unit, (q + r) * unit);
    let high = smoothness((s - r) * unit, (3.0 * r - s) * unit);
    let tau = abs(high - low);
    let u = even_weight(1.0, tau, low);
    let v = even_weight(6.0, tau, middle);
    let w = even_weight(3.0, tau, high);
    return (u * (5.0 * q - 2.0 * p) + v * (q + 2.0 * r) + w * (4.0 * r - s)) / (6.0 * (u + v + w));
}

fn step_to_face(even: f32, unit: vec4f, p: vec4f, q: vec4f, r: vec4f, s: vec4f) -> vec4f {
    return mix(third(unit, q, r), fifth(unit, p, q, r, s), even);
}

fn weno(even: f32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f) -> vec4f {
    let unit = 1.0 / max(max(largest(b, c, d, e), abs(a)), vec4f(1e-30));
    return c + step_to_face(even, unit, b - a, c - b, d - c, e - d);
}

// What the values of six cells are at a face: from the side of a, and from that of f.
struct Sides { low: vec4f, high: vec4f }

fn weno_from_both(even: f32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> Sides {
    let unit = 1.0 / max(max(largest(b, c, d, e), max(abs(a), abs(f))), vec4f(1e-30));
    return Sides(c + step_to_face(even, unit, b - a, c - b, d - c, e - d), d + step_to_face(even, unit, e - f, d - e, c - d, b - c));
}

// Advective fluxes f = u_n U through the face between cells c and d of a stencil [above]: high order, and first
// order with the same splitting, which the limiter falls back to.
// Local Lax-Friedrichs splitting f+- = (u_n +- alpha) U / 2, alpha the largest |u_n| of the stencil: the pressure part of the
// Euler flux is the solve's, so sound needs no dissipation here; shocks do, see shock_spread(). [Cao et al. 2022, section 2.3; Shu & Osher 1988]
// Without a z axis the energy travels in the place of the z momentum, which is zero.

// heat: of the energy flux, the part that the solve carries where there are two per step [shared/state.wgsl]; internal energy at the start of
// the step times the velocity of the face.
// unit: density that passes in a stage is a multiple of it, see whole().
// volume: velocity of the face, with which a volume fraction of 1 is carried.
struct Fluxes { high_order: Gas, first_order: Gas, heat: f32, unit: f32, volume: f32 }

// At most this part of the thinner cell, 2^-14, beside which more would count.
const THIN_SHARE = 6.103515625e-5;

// Two units of the last place, so that the mean of two stages is whole, too.
fn unit_between(c: Gas, d: Gas) -> f32 {
    return min(2.0 * LAST_PLACE * power_of_two(max(c.flow.x, d.flow.x)), THIN_SHARE * power_of_two(min(c.flow.x, d.flow.x)));
}

// Internal energy at the face between two slots at the start of the step, by the mean of both.
fn heat_between(s: Stencil, low: u32, high: u32) -> f32 {
    if !ARS { return 0.0; }
    if in_first() { return 0.5 * (carried_heat(s.c) + carried_heat(s.d)); }
    return 0.5 * (energy[part(START_HEAT, low)] + energy[part(START_HEAT, high)]);
}

fn packed(gas: Gas) -> vec4f { return select(gas.flow, vec4f(gas.flow.xyz, gas.energy), vec4<bool>(DIM < 3u)); }

// What does not fit beside the flow.
fn packed_rest(gas: Gas) -> vec4f { return vec4f(gas.energy, gas.unburned, gas.species); }

fn unpacked(flux: vec4f, rest: vec4f) -> Gas {
    if DIM < 3u { return Gas(vec4f(flux.xyz, 0.0), flux.w, rest.zw, rest.y); }
    return Gas(flux, rest.x, rest.zw, rest.y);
}

// Density, velocity and internal energy in the places of a state, and back. Of two gases: density, velocity, pressure, mass fraction and
// volume fraction; with products the density of each gas in its own volume, for the pressure is not linear in them.
fn primitive_of(gas: Gas) -> Gas {
    let flow = vec4f(gas.flow.x, velocity_of(gas.flow));
    if PRODUCTS {
        let parts = max(vec2f(gas.species.x, gas.flow.x - gas.species.x), vec2f(0.0)) + TRACE * gas.flow.x;
        let densities = parts / (max(vec2f(gas.species.y, 1.0 - gas.species.y), vec2f(0.0)) + TRACE);
        return Gas(vec4f(densities.y, flow.yzw), pressure_of(gas), vec2f(densities.x, gas.species.y), gas.unburned / max(gas.species.x, 1e-30));
    }
    if SPECIES { return Gas(flow, pressure_of(gas), vec2f(gas.species.x / gas.flow.x, gas.species.y), 0.0); }
    return Gas(flow, internal_energy(gas), vec2f(0.0), 0.0);
}
fn conserved_of(primitive: Gas) -> Gas {
    let velocity = primitive.flow.yzw;
    if PRODUCTS {
        let own = primitive.species.y * primitive.species.x;
        let both = own + (1.0 - primitive.species.y) * primitive.flow.x;
        return gas_from_primitive(both, velocity, primitive.energy, vec2f(own, primitive.species.y), clamp(primitive.unburned, 0.0, 1.0 + params.fuel) * own);
    }
    let density = primitive.flow.x;
    let flow = vec4f(density, density * velocity);
    let kinetic = 0.5 * density * dot(velocity, velocity);
    if !SPECIES { return Gas(flow, primitive.energy + kinetic, vec2f(0.0), 0.0); }
    let phi = primitive.species.y;
    return Gas(flow, primitive.energy / grueneisen_of(phi) + kinetic, vec2f(density * primitive.species.x, phi), 0.0);
}

// Both values of a state at a face.
struct Values { low: Gas, high: Gas }

fn values_at(even: f32, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> Values {
    let flow = weno_from_both(even, packed(a), packed(b), packed(c), packed(d), packed(e), packed(f));
    var rest = Sides(vec4f(0.0), vec4f(0.0));
    if DIM == 3u || SPECIES {
        rest = weno_from_both(even, packed_rest(a), packed_rest(b), packed_rest(c), packed_rest(d), packed_rest(e), packed_rest(f));
    }
    return Values(unpacked(flow.low, rest.low), unpacked(flow.high, rest.high));
}

// A face value on the way from that of its cell, as far as densities, pressure and volumes of both gases keep a tenth of what they are there.
// At the foot of a jump by a factor of a thousand they would be negative.
fn kept_from(own: Gas, face: Gas) -> Gas {
    let here = vec4f(own.flow.x, own.energy, own.species.x, own.species.y + TRACE);
    let there = vec4f(face.flow.x, face.energy, face.species.x, face.species.y + TRACE);
    let room = 0.9 * max(here, vec4f(0.0)) / max(here - there, vec4f(1e-30));
    let other = 0.9 * max(1.0 + TRACE - own.species.y, 0.0) / max(face.species.y - own.species.y, 1e-30);
    let share = min(min(min(room.x, room.y), min(room.z, room.w)), min(other, 1.0));
    return Gas(mix(own.flow, face.flow, share), mix(own.energy, face.energy, share), mix(own.species, face.species, share), face.unburned);
}

fn sum_of(up: f32, low: Gas, down: f32, high: Gas) -> Gas {
    return Gas(up * low.flow + down * high.flow, up * low.energy + down * high.energy, up * low.species + down * high.species,
        up * low.unburned + down * high.unburned);
}

// With one velocity `carried` for the face: a value from each side of the state itself, and dissipation by `alpha`, at least upwind.
// Density, velocity and internal energy have weights of their own, so that a contact keeps its pressure; in shocks, and where gas
// parts, the conserved variables have, which follow them better. `held`: see heat_between.
fn carried_fluxes(s: Stencil, carried: f32, alpha: f32, held: f32) -> Fluxes {
    let spread = max(max(alpha, s.spread), abs(carried));
    let up = 0.5 * (carried + spread);
    let down = 0.5 * (carried - spread);
    var out: Fluxes;
    var primitive = values_at(s.even, primitive_of(s.a), primitive_of(s.b), primitive_of(s.c), primitive_of(s.d), primitive_of(s.e), primitive_of(s.f));
    if PRODUCTS { primitive = Values(kept_from(primitive_of(s.c), primitive.low), kept_from(primitive_of(s.d), primitive.high)); }
    out.high_order = sum_of(up, conserved_of(primitive.low), down, conserved_of(primitive.high));
    if s.level < 1.0 {
        let values = values_at(s.even, s.a, s.b, s.c, s.d, s.e, s.f);
        let steep = sum_of(up, values.low, down, values.high);
        out.high_order = Gas(mix(steep.flow, out.high_order.flow, s.level), mix(steep.energy, out.high_order.energy, s.level),
            mix(steep.species, out.high_order.species, s.level), mix(steep.unburned, out.high_order.unburned, s.level));
    }
    out.unit = unit_between(s.c, s.d);
    out.heat = held * carried;
    out.volume = carried;
    out.first_order = sum_of(up, s.c, down, s.d);
    return out;
}

// The same of two gases: the mean of both cells carries all, so that a contact keeps its pressure.
fn mean_fluxes(n: u32, s: Stencil, held: f32) -> Fluxes {
    let behind = max(max(abs(velocity_along(n, s.a)), abs(velocity_along(n, s.b))), abs(velocity_along(n, s.c)));
    let ahead = max(max(abs(velocity_along(n, s.d)), abs(velocity_along(n, s.e))), abs(velocity_along(n, s.f)));
    let mean = (s.c.flow[n + 1u] + s.d.flow[n + 1u]) / (s.c.flow.x + s.d.flow.x);
    return carried_fluxes(s, mean, max(behind, ahead), held);
}

// With the velocities of the cells, split by local Lax-Friedrichs [above].
fn face_fluxes_of(n: u32, s: Stencil, held: f32) -> Fluxes {
    if SPECIES { return mean_fluxes(n, s, held); }
    let behind = vec3f(velocity_along(n, s.a), velocity_along(n, s.b), velocity_along(n, s.c));
    let ahead = vec3f(velocity_along(n, s.d), velocity_along(n, s.e), velocity_along(n, s.f));
    let most = max(abs(behind), abs(ahead));
    let alpha = max(max(most.x, s.spread), max(most.y, most.z));
    let u = 0.5 * (behind + alpha);
    let v = 0.5 * (ahead + alpha);
    let x = 0.5 * (behind - alpha);
    let y = 0.5 * (ahead - alpha);
    var out: Fluxes;
    let flow = weno(s.even, u.x * packed(s.a), u.y * packed(s.b), u.z * packed(s.c), v.x * packed(s.d), v.y * packed(s.e))
        + weno(s.even, y.z * packed(s.f), y.y * packed(s.e), y.x * packed(s.d), x.z * packed(s.c), x.y * packed(s.b));
    var energy = 0.0;
    if DIM == 3u {
        let near = vec3f(s.a.energy, s.b.energy, s.c.energy);
        let far = vec3f(s.d.energy, s.e.energy, s.f.energy);
        let p = u * near;
        let q = v * far;
        let r = x * near;
        let t = y * far;
        energy = weno(s.even, vec4f(p.x), vec4f(p.y), vec4f(p.z), vec4f(q.x), vec4f(q.y)).x
            + weno(s.even, vec4f(t.z), vec4f(t.y), vec4f(t.x), vec4f(r.z), vec4f(r.y)).x;
    }
    out.high_order = unpacked(flow, vec4f(energy));
    out.unit = unit_between(s.c, s.d);
    if ARS { out.heat = held * (s.c.flow[n + 1u] + s.d.flow[n + 1u]) / (s.c.flow.x + s.d.flow.x); }
    out.first_order = Gas(u.z * s.c.flow + y.x * s.d.flow, u.z * s.c.energy + y.x * s.d.energy, vec2f(0.0), 0.0);
    return out;
}

// What a plane of symmetry across axis n makes of a state.
fn image(n: u32, gas: Gas) -> Gas {
    var out = gas;
    out.flow = select(gas.flow, -gas.flow, vec4<bool>(false, along(n)));
    return out;
}

// What passes a plane of symmetry: momentum across it, as the dissipation has it. All else is zero but for rounding.
fn reflected(n: u32, f: Fluxes) -> Fluxes {
    let normal = vec4f(0.0, vec3f(axis(n)));
    return Fluxes(Gas(normal * f.high_order.flow, 0.0, vec2f(0.0), 0.0), Gas(normal * f.first_order.flow, 0.0, vec2f(0.0), 0.0), 0.0, 0.0, 0.0);
}

// What collects gas gets the energy of the second one, of which there is a sum [interface/ledger.wgsl]: a share of that which passes.
fn with_owed(f: Fluxes, share: f32) -> Fluxes {
    var out = f;
    out.high_order.species.y = share * f.high_order.energy;
    out.first_order.species.y = share * f.first_order.energy;
    return out;
}
