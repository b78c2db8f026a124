// Advective fluxes f = u_n U through a face between cells b and c, with a and d one cell further out.
// Local Lax-Friedrichs splitting f+- = (u_n +- alpha) U / 2, alpha the largest |u_n| of the stencil: the pressure part of the
// Euler flux is the solve's, so sound needs no dissipation here. [Cao et al. 2022, section 2.3; Shu & Osher 1988]

fn flux_weno(n: u32, a: Gas, b: Gas, c: Gas, d: Gas) -> Gas {
    let ua = a.flow[n + 1u] / a.flow.x;
    let ub = b.flow[n + 1u] / b.flow.x;
    let uc = c.flow[n + 1u] / c.flow.x;
    let ud = d.flow[n + 1u] / d.flow.x;
    let alpha = max(max(abs(ua), abs(ub)), max(abs(uc), abs(ud)));
    if alpha == 0.0 { return Gas(vec4f(0.0), 0.0); }
    let flow = weno3_vector((ua + alpha) * a.flow, (ub + alpha) * b.flow, (uc + alpha) * c.flow)
        + weno3_vector((ud - alpha) * d.flow, (uc - alpha) * c.flow, (ub - alpha) * b.flow);
    let energy = weno3((ua + alpha) * a.energy, (ub + alpha) * b.energy, (uc + alpha) * c.energy)
        + weno3((ud - alpha) * d.energy, (uc - alpha) * c.energy, (ub - alpha) * b.energy);
    return Gas(0.5 * flow, 0.5 * energy);
}

// First-order form of the same splitting: what the limiter falls back to.
fn flux_first_order(n: u32, a: Gas, b: Gas, c: Gas, d: Gas) -> Gas {
    let ub = b.flow[n + 1u] / b.flow.x;
    let uc = c.flow[n + 1u] / c.flow.x;
    let alpha = max(max(abs(a.flow[n + 1u] / a.flow.x), abs(ub)), max(abs(uc), abs(d.flow[n + 1u] / d.flow.x)));
    return Gas(0.5 * ((ub + alpha) * b.flow + (uc - alpha) * c.flow),
        0.5 * ((ub + alpha) * b.energy + (uc - alpha) * c.energy));
}
