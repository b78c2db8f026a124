// Fixed-corotated solid: psi = mu |F - R|^2 + lambda/2 (J - 1)^2, R the rotation of F. [Stomakhin et al. 2012]
#include "materials/neo_hookean.wgsl"

// F F^T = U diag((1 + stretch)^2) U^T.
struct Stretched {
    stretch: vec3f,
    axes: mat3x3f,
}

fn stretch_fixed_corotated(f: mat3x3f) -> Stretched {
    let eigen = symmetric_eigen(strain_neo_hookean(f));
    let square = max(eigen.values, vec3f(-1.0));
    // sqrt(1 + x) - 1 without cancellation
    return Stretched(square / (vec3f(1.0) + sqrt(vec3f(1.0) + square)), eigen.vectors);
}

// Kirchhoff stress tau = 2 mu (F - R) F^T + lambda (J - 1) J I.
fn stress_fixed_corotated(f: mat3x3f, m: MaterialParams) -> mat3x3f {
    let s = stretch_fixed_corotated(f);
    let h = f - IDENTITY;
    let swelling = trace(h) + nonlinear_volume(h);
    let principal = 2.0 * m.mu * s.stretch * (vec3f(1.0) + s.stretch) + vec3f(m.lambda * swelling * (1.0 + swelling));
    return s.axes * diagonal(principal) * transpose(s.axes);
}

// Elastic: everything stays.
fn return_fixed_corotated(f: mat3x3f, hardened: f32, m: MaterialParams) -> PlasticReturn {
    return PlasticReturn(f, 0.0);
}

// Energy per reference volume [J m^-3].
fn energy_fixed_corotated(f: mat3x3f, m: MaterialParams) -> f32 {
    let s = stretch_fixed_corotated(f);
    let h = f - IDENTITY;
    let swelling = trace(h) + nonlinear_volume(h);
    return m.mu * dot(s.stretch, s.stretch) + 0.5 * m.lambda * swelling * swelling;
}

fn wave_speed_fixed_corotated(m: MaterialParams, density: f32) -> f32 {
    return wave_speed_neo_hookean(m, density);
}
