// Elastoplastic metal: neo-Hookean elasticity, perfectly plastic flow above a yield stress, in logarithmic strain.
#include "materials/neo_hookean.wgsl"

fn stress_von_mises(f: mat3x3f, m: MaterialParams) -> mat3x3f {
    return stress_neo_hookean(f, m);
}

// Elastic part of F after plastic flow. With F F^T = U diag(s^2) U^T and e = ln s, the deviator of e is cut back to the length
// yield_stress / (2 mu); its trace, the volume, stays. F' = U diag(s'_i / s_i) U^T F keeps the rotation of F.
// The deviator divides by 3 in every dimension: plane strain has a third principal axis with e = 0.
fn return_von_mises(f: mat3x3f, m: MaterialParams) -> PlasticReturn {
    // an inverted F has no logarithmic strain; the caller reports it
    if determinant(f) <= 0.0 {
        return PlasticReturn(f, 0.0);
    }
    let eigen = symmetric_eigen(strain_neo_hookean(f));
    // rounding can push a strongly flattened axis below zero
    let stretch_squared = max(vec3f(1.0) + eigen.values, vec3f(1e-12));
    let strain = 0.5 * log(stretch_squared);
    let deviator = strain - vec3f((strain.x + strain.y + strain.z) / 3.0);
    let size = length(deviator);
    let limit = m.yield_stress / (2.0 * m.mu);
    if size <= limit {
        return PlasticReturn(f, 0.0);
    }
    let change = exp((limit / size - 1.0) * deviator);
    let kept = eigen.vectors * diagonal(change) * transpose(eigen.vectors) * f;
    return PlasticReturn(kept, sqrt(2.0 / 3.0) * (size - limit));
}

fn energy_von_mises(f: mat3x3f, m: MaterialParams) -> f32 {
    return energy_neo_hookean(f, m);
}

fn wave_speed_von_mises(m: MaterialParams, density: f32) -> f32 {
    return wave_speed_neo_hookean(m, density);
}
