// Compressible neo-Hookean rubber: psi = mu/2 (tr(F F^T) - 3) - mu ln J + lambda/2 (ln J)^2, J = det F.
// Laws take the displacement gradient h = F - I, which single precision resolves where F is near I: a strain below 6e-8 has no F.
// It is 3x3 in every dimension, with 0 on inactive axes (plane strain).
#include "materials/law.wgsl"

// F F^T - I.
fn strain_neo_hookean(h: mat3x3f) -> mat3x3f { return h + transpose(h) + h * transpose(h); }

// What J - 1 has besides the trace of h: its second invariant and its determinant.
fn nonlinear_volume(h: mat3x3f) -> f32 {
    let minors = h[0].x * h[1].y - h[0].y * h[1].x + h[0].x * h[2].z - h[0].z * h[2].x + h[1].y * h[2].z - h[1].z * h[2].y;
    return minors + determinant(h);
}

// J - 1.
fn swelling(h: mat3x3f) -> f32 { return trace(h) + nonlinear_volume(h); }

// 2 (artanh z - z), z = x / (2 + x), for |x| < 1/4: the terms left out are below 1e-9 of ln(1 + x).
fn tail_of_logarithm(x: f32) -> f32 {
    let z = x / (2.0 + x);
    let square = z * z;
    return 2.0 * z * square * (1.0 / 3.0 + square * (1.0 / 5.0 + square * (1.0 / 7.0)));
}

// ln(1 + x) = 2 artanh(x / (2 + x)), accurate for small x.
fn log_one_plus(x: f32) -> f32 {
    if abs(x) < 0.25 { return 2.0 * x / (2.0 + x) + tail_of_logarithm(x); }
    return log(1.0 + x);
}

// exp(y) - 1 - y, accurate for small y.
fn exponential_rest(y: f32) -> f32 {
    if abs(y) < 0.1 { return 0.5 * y * y * (1.0 + y / 3.0 * (1.0 + y / 4.0 * (1.0 + y / 5.0))); }
    return exp(y) - 1.0 - y;
}

// exp(y) - 1, accurate for small y.
fn exp_minus_one(y: f32) -> f32 { return y + exponential_rest(y); }

// x - ln(1 + x), accurate for small x.
fn excess_over_logarithm(x: f32) -> f32 {
    if abs(x) < 0.25 { return x * x / (2.0 + x) - tail_of_logarithm(x); }
    return x - log(1.0 + x);
}

// Kirchhoff stress tau = mu (F F^T - I) + lambda ln J I. An inverted F (J <= 0) has none; the caller reports it.
fn stress_neo_hookean(h: mat3x3f, m: MaterialParams) -> mat3x3f {
    let grown = swelling(h);
    if grown <= -1.0 { return mat3x3f(); }
    return m.mu * strain_neo_hookean(h) + m.lambda * log_one_plus(grown) * IDENTITY;
}

// Elastic: everything stays.
fn return_neo_hookean(h: mat3x3f, hardened: f32, m: MaterialParams) -> PlasticReturn { return PlasticReturn(h, 0.0); }

// Energy per reference volume [J m^-3]. The parts of tr(F F^T - I) / 2 and ln J that are linear in H cancel:
// what is left is |H|^2 / 2 - (J - 1 - tr H) + (J - 1 - ln J).
fn energy_neo_hookean(h: mat3x3f, m: MaterialParams) -> f32 {
    let nonlinear = nonlinear_volume(h);
    let grown = trace(h) + nonlinear;
    if grown <= -1.0 { return 0.0; }
    let square = dot(h[0], h[0]) + dot(h[1], h[1]) + dot(h[2], h[2]);
    let logarithm = log_one_plus(grown);
    let distortion = 0.5 * square - nonlinear + excess_over_logarithm(grown);
    return m.mu * distortion + 0.5 * m.lambda * logarithm * logarithm;
}

// Pressure wave along the longest axis of a body deformed by I + h, rho the density at rest [m s^-1]: rho c^2 is the second derivative of
// the energy by the logarithm of a stretch less its first, lambda (1 - ln J) + mu (1 + b), b the largest eigenvalue of F F^T, here
// the bound of Gershgorin, which is exact along the axes of the grid. At rest lambda + 2 mu.
fn wave_speed_neo_hookean(h: mat3x3f, m: MaterialParams, density: f32) -> f32 {
    let grown = max(swelling(h), -0.999999);
    let bulk = m.lambda * max(1.0 - log_one_plus(grown), 0.0);
    return sqrt((bulk + m.mu * (2.0 + largest_row_sum(strain_neo_hookean(h)))) / density);
}

// Bound of the eigenvalues of a symmetric matrix. [Gershgorin 1931]
fn largest_row_sum(a: mat3x3f) -> f32 {
    let x = a[0].x + abs(a[0].y) + abs(a[0].z);
    let y = a[1].y + abs(a[1].z) + abs(a[1].x);
    let z = a[2].z + abs(a[2].x) + abs(a[2].y);
    return max(x, max(y, z));
}
