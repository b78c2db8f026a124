// Advective fluxes f = u_n U through the face between cells c and d of a stencil [shared/reconstruct.wgsl]: high order, and first
// order with the same splitting, which the limiter falls back to.
// Local Lax-Friedrichs splitting f+- = (u_n +- alpha) U / 2, alpha the largest |u_n| of the stencil: the pressure part of the
// Euler flux is the solve's, so sound needs no dissipation here; shocks do, see reconstruct.wgsl. [Cao et al. 2022, section 2.3; Shu & Osher 1988]
// Without a z axis the energy travels in the place of the z momentum, which is zero.
#include "shared/whole.wgsl"

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
    return 0.5 * (energy[ARS_HEAT * params.slots + low] + energy[ARS_HEAT * params.slots + high]);
}

fn packed(gas: Gas) -> vec4f { return select(gas.flow, vec4f(gas.flow.xyz, gas.energy), vec4<bool>(DIM < 3u)); }

fn unpacked(flux: vec4f, energy: f32) -> Gas {
    if DIM < 3u { return Gas(vec4f(flux.xyz, 0.0), flux.w); }
    return Gas(flux, energy);
}

// With one velocity `carried` for the face: a value from each side of the state itself, and dissipation by `alpha`, at least upwind.
// `held`: see heat_between.
fn carried_fluxes(s: Stencil, carried: f32, alpha: f32, held: f32) -> Fluxes {
    let spread = max(max(alpha, s.spread), abs(carried));
    let up = 0.5 * (carried + spread);
    let down = 0.5 * (carried - spread);
    var out: Fluxes;
    let flow = weno_from_both(s.even, up, down, packed(s.a), packed(s.b), packed(s.c), packed(s.d), packed(s.e), packed(s.f));
    var energy = 0.0;
    if DIM == 3u {
        energy = weno_from_both(s.even, up, down, vec4f(s.a.energy), vec4f(s.b.energy), vec4f(s.c.energy), vec4f(s.d.energy),
            vec4f(s.e.energy), vec4f(s.f.energy)).x;
    }
    out.high = unpacked(flow, energy);
    out.unit = unit_between(s.c, s.d);
    out.heat = held * carried;
    if LIMITER { out.low = Gas(up * s.c.flow + down * s.d.flow, up * s.c.energy + down * s.d.energy); }
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
    if LIMITER { out.low = Gas(u.z * s.c.flow + y.x * s.d.flow, u.z * s.c.energy + y.x * s.d.energy); }
    return out;
}
