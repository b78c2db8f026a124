// Fixed-corotated solid: psi = mu |F - R|^2 + lambda/2 (J - 1)^2, R the rotation of F. [Stomakhin et al. 2012]
#include "materials/neo_hookean.wgsl"

// F F^T = U diag((1 + stretch)^2) U^T.
struct Stretched {
    stretch: vec3f,
    axes: mat3x3f,
}

fn stretch_fixed_corotated(h: mat3x3f) -> Stretched {
    let eigen = symmetric_eigen(strain_neo_hookean(h));
    let square = max(eigen.values, vec3f(-1.0));
    // sqrt(1 + x) - 1 without cancellation
    return Stretched(square / (vec3f(1.0) + sqrt(vec3f(1.0) + square)), eigen.vectors);
}

// Kirchhoff stress tau = 2 mu (F - R) F^T + lambda (J - 1) J I.
fn stress_fixed_corotated(h: mat3x3f, m: MaterialParams) -> mat3x3f {
    let s = stretch_fixed_corotated(h);
    let grown = swelling(h);
    let principal = 2.0 * m.mu * s.stretch * (vec3f(1.0) + s.stretch) + vec3f(m.lambda * grown * (1.0 + grown));
    return s.axes * diagonal(principal) * transpose(s.axes);
}

// Elastic: everything stays.
fn return_fixed_corotated(h: mat3x3f, hardened: f32, m: MaterialParams) -> PlasticReturn {
    return PlasticReturn(h, 0.0);
}

// Energy per reference volume [J m^-3].
fn energy_fixed_corotated(h: mat3x3f, m: MaterialParams) -> f32 {
    let s = stretch_fixed_corotated(h);
    let grown = swelling(h);
    return m.mu * dot(s.stretch, s.stretch) + 0.5 * m.lambda * grown * grown;
}

// As in neo_hookean.wgsl: rho c^2 = 2 mu b + lambda J^2.
fn wave_speed_fixed_corotated(h: mat3x3f, m: MaterialParams, density: f32) -> f32 {
    let volume = 1.0 + swelling(h);
    let square = 1.0 + largest_row_sum(strain_neo_hookean(h));
    return sqrt((2.0 * m.mu * max(square, 1.0) + m.lambda * max(volume * volume, 1.0)) / density);
}
