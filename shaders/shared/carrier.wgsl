// Velocity that carries the gas through a face between two GAS cells, from their carriers (see carrier.wgsl) and densities. The
// mean of two cells damps short compression waves; a share of the difference of the divergences gives that back: a quarter, with which
// shocks stay smooth (a little less with B2B1, where they ring). It vanishes where the divergence does, so nothing that the solve
// calls free of divergence is compressed.
// Two solves per step see sound to second order in time. They have the share with which the face's divergence is the one that the solve
// itself sees, or, in short steps, the third that makes sound along an axis one of fourth order in space (of B2B1 0.16, beyond which single
// precision shows behind strong shocks). The solve then is told of the surplus beforehand [intermediate_pressure.wgsl]: without, waves of some eight cells grow.

// The share with which the divergence would be the one that the solve itself sees.
fn seen_share() -> f32 { return select(0.25, 1.0 / 12.0, QUADRATIC && ARS); }

fn given_back() -> f32 {
    if FOURTH { return select(1.0 / 3.0, 0.16, QUADRATIC); }
    return select(seen_share(), 0.23, QUADRATIC && !ARS);
}

// Speed of the dissipation at such a face: upwind, and where the carriers part, as in a rarefaction, the larger of both.
fn carrier_spread(low: f32, high: f32) -> f32 { return select(0.0, max(abs(low), abs(high)), high > low); }

fn carried_velocity(n: u32, low: vec4f, low_density: f32, high: vec4f, high_density: f32) -> f32 {
    return (low_density * low[n] + high_density * high[n]) / (low_density + high_density) - given_back() * (high.w - low.w);
}
