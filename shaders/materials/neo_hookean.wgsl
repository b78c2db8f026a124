// Compressible neo-Hookean rubber: psi = mu/2 (tr(F F^T) - 3) - mu ln J + lambda/2 (ln J)^2, J = det F.
// F is 3x3 in every dimension, with 1 on inactive axes (plane strain).
#include "shared/material.wgsl"
#include "shared/matrix.wgsl"

// F F^T - I from the displacement gradient H = F - I: exact where F is near I and the difference would cancel.
fn strain_neo_hookean(f: mat3x3f) -> mat3x3f {
    let h = f - IDENTITY;
    return h + transpose(h) + h * transpose(h);
}

// Kirchhoff stress tau = mu (F F^T - I) + lambda ln J I. An inverted F (J <= 0) has none; the caller reports it.
fn stress_neo_hookean(f: mat3x3f, m: MaterialParams) -> mat3x3f {
    let volume = determinant(f);
    if volume <= 0.0 {
        return mat3x3f();
    }
    return m.mu * strain_neo_hookean(f) + m.lambda * log(volume) * IDENTITY;
}

// Elastic: everything stays.
fn return_neo_hookean(f: mat3x3f, m: MaterialParams) -> PlasticReturn {
    return PlasticReturn(f, 0.0);
}

// Energy per reference volume [J m^-3].
fn energy_neo_hookean(f: mat3x3f, m: MaterialParams) -> f32 {
    let volume = determinant(f);
    if volume <= 0.0 {
        return 0.0;
    }
    let swelling = log(volume);
    return 0.5 * m.mu * trace(strain_neo_hookean(f)) - m.mu * swelling + 0.5 * m.lambda * swelling * swelling;
}

// Pressure wave at rest, sqrt((lambda + 2 mu) / rho) [m s^-1].
fn wave_speed_neo_hookean(m: MaterialParams, density: f32) -> f32 {
    return sqrt((m.lambda + 2.0 * m.mu) / density);
}
