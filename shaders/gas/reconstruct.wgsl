// Value at the face between c and d of six cells in a row, from upstream, by the WENO method in two forms:
// - where the gas is compressed (`even` 0), third order from b, c and d: linear weights 1/3 and 2/3 over (beta + epsilon)^2, beta the
//   square of the difference of a two-point sub-stencil [Jiang & Shu 1996]. Shocks need it;
// - elsewhere (`even` 1), fifth order from a to e: three parabolas with the linear weights 0.1, 0.6 and 0.3, times
//   1 + (tau / (beta + epsilon))^2, tau the difference of the outer two beta. It keeps waves and contacts [Borges et al. 2008].
// All differences are relative to the largest of the values, so that neither the unit system nor float32's range changes the scheme.
// Needs ARS, STAGE and the binding control.

// Differences below its root, 2.6 % of a value, count as smooth where the gas is compressed [docs/notes/reconstruction.md].
const WENO_EPSILON = 7e-4;
// The same elsewhere: 0.1 %.
const EVEN_EPSILON = 1e-6;
// The first form takes over up to where the velocity falls from one cell to the next by this part of the speed of sound.
const STEEP = 0.1;
// Least speed of the dissipation in a shock, over that of sound. The solve captures shocks without dissipation of its own, and a shock
// that the gas does not cross along this axis would get none: waves would trail it. B2B1 with one velocity for the faces needs more [docs/notes/reconstruction.md].
fn shock_spread() -> f32 { return select(0.6, 1.2, QUADRATIC && CONSISTENT); }

// Cells a to f along an axis, the face between c and d, the share of the second form there, how even the velocity is (0 to 1), and the
// least speed of the dissipation.
struct Stencil { a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas, even: f32, level: f32, spread: f32 }

// Of four cells, where others beyond them are no gas.
fn narrow(b: Gas, c: Gas, d: Gas, e: Gas) -> Stencil { return Stencil(b, b, c, d, e, e, 0.0, 0.0, 0.0); }

fn wide(n: u32, a: Gas, b: Gas, c: Gas, d: Gas, e: Gas, f: Gas) -> Stencil {
    let sound = sound_between(c, d);
    let share = steepness(n, 1.0, sound, a, b, c, d, e, f);
    let parting = steepness(n, -1.0, sound, a, b, c, d, e, f);
    let spread = min(shock_spread() * share * sound, most_spread());
    return Stencil(a, b, c, d, e, f, 1.0 - share, (1.0 - share) * (1.0 - parting), spread);
}

// [s] over which the fluxes of the stage pass.
fn stage_span() -> f32 {
    if !ARS || STAGE == 0u { return control.dt; }
    return select(ARS_MIDDLE, ARS_LAST, STAGE == 2u) * control.dt;
}

// A third of a cell per stage: with all three axes in a shock, the most that is stable.
fn most_spread() -> f32 { return params.spacing / (3.0 * max(stage_span(), 1e-30)); }

fn sound_between(c: Gas, d: Gas) -> f32 {
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
