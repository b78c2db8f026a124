// Plastic flow in logarithmic strain, for all laws that yield: a cylinder around the axis of pressure (metals), or a cone (soil).
// |dev tau| <= yield_stress + hardening * (equivalent plastic strain) - friction * tr(tau), with tau linear in the logarithmic strain.
#include "materials/neo_hookean.wgsl"

// F F^T = U diag(exp(2 strain)) U^T.
struct Logarithmic {
    strain: vec3f,
    axes: mat3x3f,
}

fn logarithmic_strain(h: mat3x3f) -> Logarithmic {
    let eigen = symmetric_eigen(strain_neo_hookean(h));
    // rounding can push a strongly flattened axis below zero
    let stretch = max(eigen.values, vec3f(1e-12 - 1.0));
    return Logarithmic(0.5 * vec3f(log_one_plus(stretch.x), log_one_plus(stretch.y), log_one_plus(stretch.z)), eigen.vectors);
}

// F' = U diag(exp(change)) U^T F keeps the rotation of F.
fn stretched(h: mat3x3f, l: Logarithmic, change: vec3f) -> mat3x3f {
    let growth = vec3f(exp_minus_one(change.x), exp_minus_one(change.y), exp_minus_one(change.z));
    let stretch = l.axes * diagonal(growth) * transpose(l.axes);
    return h + stretch + stretch * h;
}

// Elastic part of a deformation after plastic flow: the deviator of the strain is cut back, its trace, the volume, stays; soil beyond the tip
// of its cone opens instead. The deviator divides by 3 in every dimension: plane strain has a third principal axis.
fn plastic_flow(h: mat3x3f, hardened: f32, m: MaterialParams) -> PlasticReturn {
    // an inverted F has no logarithmic strain; the caller reports it
    if swelling(h) <= -1.0 { return PlasticReturn(h, 0.0); }
    let l = logarithmic_strain(h);
    let volume = l.strain.x + l.strain.y + l.strain.z;
    let deviator = l.strain - vec3f(volume / 3.0);
    let size = length(deviator);
    let bulk = 3.0 * m.lambda + 2.0 * m.mu;     // tr(tau) over the trace of the strain
    let share = sqrt(2.0 / 3.0);                // equivalent plastic strain over the length of a deviator
    let limit = (m.yield_stress + m.hardening * hardened - m.friction * bulk * volume) / (2.0 * m.mu);
    if limit < 0.0 {
        let tip = m.yield_stress / (m.friction * bulk);
        return PlasticReturn(stretched(h, l, vec3f(tip / 3.0) - l.strain), share * size);
    }
    if size <= limit { return PlasticReturn(h, 0.0); }
    let excess = (size - limit) / (1.0 + share * m.hardening / (2.0 * m.mu));
    return PlasticReturn(stretched(h, l, -excess / size * deviator), share * excess);
}
