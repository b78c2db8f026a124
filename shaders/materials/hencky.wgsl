// Metal in logarithmic strain e = ln(F F^T) / 2: psi = mu tr(e^2) + lambda/2 (tr e)^2, so that the cut-back of the strain is exact.
#include "materials/plastic_flow.wgsl"

// Kirchhoff stress tau = 2 mu e + lambda tr(e) I. An inverted F has none; the caller reports it.
fn stress_hencky(h: mat3x3f, m: MaterialParams) -> mat3x3f {
    if swelling(h) <= -1.0 { return mat3x3f(); }
    let l = logarithmic_strain(h);
    let principal = 2.0 * m.mu * l.strain + vec3f(m.lambda * (l.strain.x + l.strain.y + l.strain.z));
    return l.axes * diagonal(principal) * transpose(l.axes);
}

fn return_hencky(h: mat3x3f, hardened: f32, m: MaterialParams) -> PlasticReturn { return plastic_flow(h, hardened, m); }

// Energy per reference volume [J m^-3].
fn energy_hencky(h: mat3x3f, m: MaterialParams) -> f32 {
    if swelling(h) <= -1.0 { return 0.0; }
    let strain = logarithmic_strain(h).strain;
    let volume = strain.x + strain.y + strain.z;
    return m.mu * dot(strain, strain) + 0.5 * m.lambda * volume * volume;
}

// As in neo_hookean.wgsl: rho c^2 = lambda + 2 mu - tau, tau the least principal stress.
fn wave_speed_hencky(h: mat3x3f, m: MaterialParams, density: f32) -> f32 {
    if swelling(h) <= -1.0 { return sqrt((m.lambda + 2.0 * m.mu) / density); }
    let strain = logarithmic_strain(h).strain;
    let least = min(strain.x, min(strain.y, strain.z));
    let stress = 2.0 * m.mu * least + m.lambda * (strain.x + strain.y + strain.z);
    return sqrt(max(m.lambda + 2.0 * m.mu - stress, m.mu) / density);
}
