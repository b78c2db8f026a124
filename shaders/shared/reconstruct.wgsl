// Third-order WENO value at the face between b and c, from the cells a, b, c and d, a being the farthest upstream.
// Two-point sub-stencils with linear weights 1/3 and 2/3, the square of whose difference beta says how rough they are, in two forms:
// - where the gas is compressed (`evenness` 0): weights over (beta + epsilon)^2 [Jiang & Shu 1996], which shocks need;
// - elsewhere (`evenness` 1): weights times 1 + (tau / (beta + epsilon))^2, tau the square of the third difference of all four cells,
//   which keep the linear weights, and so waves and contacts, as long as the four cells lie on a parabola [Borges et al. 2008].
// All differences are relative to the largest of the four values, so that neither the unit system nor float32's range changes the scheme.

// Differences below its root, 2.6 % of a value, count as smooth where the gas is compressed [docs/method.md].
const WENO_EPSILON = 7e-4;
// The same elsewhere: 1.4 %.
const EVEN_EPSILON = 2e-4;
// The first form takes over up to where the velocity falls from one cell to the next by this part of the speed of sound.
const STEEP = 0.1;

// Share of the second form at a face with normal n.
fn evenness(n: u32, a: Gas, b: Gas, c: Gas, d: Gas) -> f32 {
    let ua = a.flow[n + 1u] / a.flow.x;
    let ub = b.flow[n + 1u] / b.flow.x;
    let uc = c.flow[n + 1u] / c.flow.x;
    let ud = d.flow[n + 1u] / d.flow.x;
    let drop = max(max(ua - ub, ub - uc), max(uc - ud, 0.0)) / STEEP;
    let energy = 0.5 * (internal_energy(b) / b.flow.x + internal_energy(c) / c.flow.x);
    let sound = params.gamma * (params.gamma - 1.0) * energy;
    return max(1.0 - drop * drop / max(sound, 1e-30), 0.0);
}

// One over the largest of four values.
fn unit_of(a: vec4f, b: vec4f, c: vec4f, d: vec4f) -> vec4f {
    return 1.0 / max(max(max(abs(a), abs(b)), max(abs(c), abs(d))), vec4f(1e-30));
}

// Weight of the sub-stencil that extrapolates, whose roughness is `outer`; that of the one across the face is `inner`.
fn outer_weight(even: f32, outer: vec4f, inner: vec4f, tau: vec4f) -> vec4f {
    let steep_outer = (inner + WENO_EPSILON) * (inner + WENO_EPSILON);
    let steep_inner = 2.0 * (outer + WENO_EPSILON) * (outer + WENO_EPSILON);
    let p = (outer + EVEN_EPSILON) * (outer + EVEN_EPSILON);
    let q = (inner + EVEN_EPSILON) * (inner + EVEN_EPSILON);
    let even_outer = q * (p + tau * tau);
    let even_inner = 2.0 * p * (q + tau * tau);
    return mix(steep_outer / (steep_outer + steep_inner), even_outer / (even_outer + even_inner), even);
}

fn weno3(even: f32, a: vec4f, b: vec4f, c: vec4f, d: vec4f) -> vec4f {
    let unit = unit_of(a, b, c, d);
    let outer = (b - a) * unit;
    let inner = (c - b) * unit;
    let third = (d - c) * unit - 2.0 * inner + outer;
    let weight = outer_weight(even, outer * outer, inner * inner, third * third);
    return 0.5 * (b + c + weight * ((b - a) - (c - b)));
}

// `up` times the value from the side of a and b, and `down` times that from the side of d and c.
fn weno3_from_both(even: f32, up: f32, down: f32, a: vec4f, b: vec4f, c: vec4f, d: vec4f) -> vec4f {
    let unit = unit_of(a, b, c, d);
    let low = (b - a) * unit;
    let inner = (c - b) * unit;
    let high = (d - c) * unit;
    let third = high - 2.0 * inner + low;
    let low_weight = outer_weight(even, low * low, inner * inner, third * third);
    let high_weight = outer_weight(even, high * high, inner * inner, third * third);
    return 0.5 * ((up + down) * (b + c) + up * low_weight * ((b - a) - (c - b)) + down * high_weight * ((c - b) - (d - c)));
}
