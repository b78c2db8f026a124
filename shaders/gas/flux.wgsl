// Advective fluxes f = u_n U through the face between cells c and d of a stencil [shared/reconstruct.wgsl]: high order, and first
// order with the same splitting, which the limiter falls back to.
// Local Lax-Friedrichs splitting f+- = (u_n +- alpha) U / 2, alpha the largest |u_n| of the stencil: the pressure part of the
// Euler flux is the solve's, so sound needs no dissipation here; shocks do, see reconstruct.wgsl. [Cao et al. 2022, section 2.3; Shu & Osher 1988]
// Without a z axis the energy travels in the place of the z momentum, which is zero.
#include "shared/arrays.wgsl"
#include "gas/whole.wgsl"

// heat: the part of the energy's that two solves per step take from the solve instead [shared/ars.wgsl].
// unit: density that passes in a stage is a multiple of it, see whole.wgsl.
struct Fluxes { high: Gas, low: Gas, heat: f32, unit: f32 }

// At most this part of the thinner cell, 2^-14, beside which more would count.
const THIN_SHARE = 6.103515625e-5;

// Two units of the last place, so that the mean of two stages is whole, too.
fn unit_between(c: Gas, d: Gas) -> f32 {
    return min(2.0 * LAST_PLACE * power_of_two(max(c.flow.x, d.flow.x)), THIN_SHARE * power_of_two(min(c.flow.x, d.flow.x)));
}

// Internal energy at the face between two slots at the start of the step, by the mean of both.
fn heat_between(s: Stencil, low: u32, high: u32) -> f32 {
    if !ARS { return 0.0; }
    if STAGE == 0u { return 0.5 * (internal_energy(s.c) + internal_energy(s.d)); }
    return 0.5 * (energy[part(START_HEAT, low)] + energy[part(START_HEAT, high)]);
}

fn packed(gas: Gas) -> vec4f { return select(gas.flow, vec4f(gas.flow.xyz, gas.energy), vec4<bool>(DIM < 3u)); }

fn unpacked(flux: vec4f, energy: f32) -> Gas {
    if DIM < 3u { return Gas(vec4f(flux.xyz, 0.0), flux.w); }
    return Gas(flux, energy);
}

// Density, velocity and internal energy, and back.
fn parts_of(gas: Gas) -> Gas { return Gas(vec4f(gas.flow.x, velocity_of(gas.flow)), internal_energy(gas)); }
fn whole_of(parts: Gas) -> Gas {
    let velocity = parts.flow.yzw;
    return Gas(vec4f(parts.flow.x, parts.flow.x * velocity), parts.energy + 0.5 * parts.flow.x * dot(velocity, velocity));
}

// Both values of a state at a face.
struct Values { low: Gas, high: Gas }

fn values_at(even: f32, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> Values {
    let flow = weno_from_both(even, packed(a), packed(b), packed(c), packed(d), packed(e), packed(f));
    var energy = Sides(vec4f(0.0), vec4f(0.0));
    if DIM == 3u {
        energy = weno_from_both(even, vec4f(a.energy), vec4f(b.energy), vec4f(c.energy), vec4f(d.energy), vec4f(e.energy), vec4f(f.energy));
    }
    return Values(unpacked(flow.low, energy.low.x), unpacked(flow.high, energy.high.x));
}

fn sum_of(up: f32, low: Gas, down: f32, high: Gas) -> Gas {
    return Gas(up * low.flow + down * high.flow, up * low.energy + down * high.energy);
}

// With one velocity `carried` for the face: a value from each side of the state itself, and dissipation by `alpha`, at least upwind.
// Density, velocity and internal energy have weights of their own, so that a contact keeps its pressure; in shocks, and where gas
// parts, the conserved variables have, which follow them better. `held`: see heat_between.
fn carried_fluxes(s: Stencil, carried: f32, alpha: f32, held: f32) -> Fluxes {
    let spread = max(max(alpha, s.spread), abs(carried));
    let up = 0.5 * (carried + spread);
    let down = 0.5 * (carried - spread);
    var out: Fluxes;
    let parts = values_at(s.even, parts_of(s.a), parts_of(s.b), parts_of(s.c), parts_of(s.d), parts_of(s.e), parts_of(s.f));
    out.high = sum_of(up, whole_of(parts.low), down, whole_of(parts.high));
    if s.level < 1.0 {
        let values = values_at(s.even, s.a, s.b, s.c, s.d, s.e, s.f);
        let steep = sum_of(up, values.low, down, values.high);
        out.high = Gas(mix(steep.flow, out.high.flow, s.level), mix(steep.energy, out.high.energy, s.level));
    }
    out.unit = unit_between(s.c, s.d);
    out.heat = held * carried;
    out.low = sum_of(up, s.c, down, s.d);
    return out;
}

fn face_fluxes_of(n: u32, s: Stencil, held: f32) -> Fluxes {
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
    out.high = unpacked(flow, energy);
    out.unit = unit_between(s.c, s.d);
    if ARS { out.heat = held * (s.c.flow[n + 1u] + s.d.flow[n + 1u]) / (s.c.flow.x + s.d.flow.x); }
    out.low = Gas(u.z * s.c.flow + y.x * s.d.flow, u.z * s.c.energy + y.x * s.d.energy);
    return out;
}
