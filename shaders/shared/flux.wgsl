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

// The same with one velocity `carried` for the face: a value from each side of the state itself, and dissipation by `alpha`,
// at least upwind.
fn carried_fluxes(a: Gas, b: Gas, c: Gas, d: Gas, carried: f32, alpha: f32) -> Fluxes {
    let spread = max(alpha, abs(carried));
    let up = 0.5 * (carried + spread);
    let down = 0.5 * (carried - spread);
    var out: Fluxes;
    let flow = up * weno3_vector(packed(a), packed(b), packed(c)) + down * weno3_vector(packed(d), packed(c), packed(b));
    var energy = 0.0;
    if DIM == 3u { energy = up * weno3(a.energy, b.energy, c.energy) + down * weno3(d.energy, c.energy, b.energy); }
    out.high = unpacked(flow, energy);
    if ARS { out.heat = central_heat(b, c, carried); }
    if LIMITER { out.low = Gas(up * b.flow + down * c.flow, up * b.energy + down * c.energy); }
    return out;
}

fn face_fluxes_of(n: u32, a: Gas, b: Gas, c: Gas, d: Gas) -> Fluxes {
    let ua = a.flow[n + 1u] / a.flow.x;
    let ub = b.flow[n + 1u] / b.flow.x;
    let uc = c.flow[n + 1u] / c.flow.x;
    let ud = d.flow[n + 1u] / d.flow.x;
    let alpha = max(max(abs(ua), abs(ub)), max(abs(uc), abs(ud)));
    let b_up = (ub + alpha) * packed(b);
    let b_down = (ub - alpha) * packed(b);
    let c_up = (uc + alpha) * packed(c);
    let c_down = (uc - alpha) * packed(c);
    let flow = weno3_vector((ua + alpha) * packed(a), b_up, c_up) + weno3_vector((ud - alpha) * packed(d), c_down, b_down);
    var out: Fluxes;
    if ARS { out.heat = central_heat(b, c, (b.flow[n + 1u] + c.flow[n + 1u]) / (b.flow.x + c.flow.x)); }
    if DIM < 3u {
        out.high = unpacked(0.5 * flow, 0.0);
        if LIMITER { out.low = unpacked(0.5 * (b_up + c_down), 0.0); }
        return out;
    }
    let energy = weno3((ua + alpha) * a.energy, (ub + alpha) * b.energy, (uc + alpha) * c.energy)
        + weno3((ud - alpha) * d.energy, (uc - alpha) * c.energy, (ub - alpha) * b.energy);
    out.high = Gas(0.5 * flow, 0.5 * energy);
    if LIMITER { out.low = Gas(0.5 * (b_up + c_down), 0.5 * ((ub + alpha) * b.energy + (uc - alpha) * c.energy)); }
    return out;
}
