// Advective fluxes f = u_n U through a face between cells b and c, with a and d one cell further out: third order, and first
// order with the same splitting, which the limiter falls back to.
// Local Lax-Friedrichs splitting f+- = (u_n +- alpha) U / 2, alpha the largest |u_n| of the stencil: the pressure part of the
// Euler flux is the solve's, so sound needs no dissipation here. [Cao et al. 2022, section 2.3; Shu & Osher 1988]
// Without a z axis the energy travels in the place of the z momentum, which is zero.

// heat: internal energy by the mean of both sides, the part that two solves per step take from the solve instead [shared/ars.wgsl].
struct Fluxes { high: Gas, low: Gas, heat: f32 }

fn central_heat(b: Gas, c: Gas, velocity: f32) -> f32 { return 0.5 * velocity * (internal_energy(b) + internal_energy(c)); }

fn packed(gas: Gas) -> vec4f { return select(gas.flow, vec4f(gas.flow.xyz, gas.energy), vec4<bool>(DIM < 3u)); }

fn unpacked(flux: vec4f, energy: f32) -> Gas {
    if DIM < 3u { return Gas(vec4f(flux.xyz, 0.0), flux.w); }
    return Gas(flux, energy);
}

// Cells a, b, c, d along an axis, and which weights their values at the face have [shared/reconstruct.wgsl].
struct Stencil { a: Gas, b: Gas, c: Gas, d: Gas, even: f32 }

// With one velocity `carried` for the face: a value from each side of the state itself, and dissipation by `alpha`, at least upwind.
fn carried_fluxes(s: Stencil, carried: f32, alpha: f32) -> Fluxes {
    let spread = max(alpha, abs(carried));
    let up = 0.5 * (carried + spread);
    let down = 0.5 * (carried - spread);
    var out: Fluxes;
    let flow = weno3_from_both(s.even, up, down, packed(s.a), packed(s.b), packed(s.c), packed(s.d));
    var energy = 0.0;
    if DIM == 3u {
        energy = weno3_from_both(s.even, up, down, vec4f(s.a.energy), vec4f(s.b.energy), vec4f(s.c.energy), vec4f(s.d.energy)).x;
    }
    out.high = unpacked(flow, energy);
    if ARS { out.heat = central_heat(s.b, s.c, carried); }
    if LIMITER { out.low = Gas(up * s.b.flow + down * s.c.flow, up * s.b.energy + down * s.c.energy); }
    return out;
}

fn face_fluxes_of(n: u32, s: Stencil) -> Fluxes {
    let speed = vec4f(s.a.flow[n + 1u] / s.a.flow.x, s.b.flow[n + 1u] / s.b.flow.x,
        s.c.flow[n + 1u] / s.c.flow.x, s.d.flow[n + 1u] / s.d.flow.x);
    let alpha = max(max(abs(speed.x), abs(speed.y)), max(abs(speed.z), abs(speed.w)));
    let up = 0.5 * (speed + alpha);
    let down = 0.5 * (speed - alpha);
    var out: Fluxes;
    let flow = weno3(s.even, up.x * packed(s.a), up.y * packed(s.b), up.z * packed(s.c), up.w * packed(s.d))
        + weno3(s.even, down.w * packed(s.d), down.z * packed(s.c), down.y * packed(s.b), down.x * packed(s.a));
    var energy = 0.0;
    if DIM == 3u {
        let e = vec4f(s.a.energy, s.b.energy, s.c.energy, s.d.energy);
        let rising = up * e;
        let falling = down * e;
        energy = weno3(s.even, vec4f(rising.x), vec4f(rising.y), vec4f(rising.z), vec4f(rising.w)).x
            + weno3(s.even, vec4f(falling.w), vec4f(falling.z), vec4f(falling.y), vec4f(falling.x)).x;
    }
    out.high = unpacked(flow, energy);
    if ARS { out.heat = central_heat(s.b, s.c, (s.b.flow[n + 1u] + s.c.flow[n + 1u]) / (s.b.flow.x + s.c.flow.x)); }
    if LIMITER { out.low = Gas(up.y * s.b.flow + down.z * s.c.flow, up.y * s.b.energy + down.z * s.c.energy); }
    return out;
}
