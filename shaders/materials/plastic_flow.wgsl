// Plastic flow in logarithmic strain, for all laws that yield: a cylinder around the axis of pressure (metals), or a cone (soil).
// |dev tau| <= yield_stress + hardening * (equivalent plastic strain) - friction * tr(tau), with tau linear in the logarithmic strain.
// Metals may follow strain, rate and temperature instead. [Johnson & Cook 1983]
#include "materials/neo_hookean.wgsl"

override JOHNSON_COOK: bool = false; // some metal flows by strain, rate and temperature

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
    if follows_rate(m) { return flow_by_rate(h, hardened, m, l, deviator); }
    if size <= limit { return PlasticReturn(h, 0.0); }
    let excess = (size - limit) / (1.0 + share * m.hardening / (2.0 * m.mu));
    return PlasticReturn(stretched(h, l, -excess / size * deviator), share * excess);
}

fn follows_rate(m: MaterialParams) -> bool { return JOHNSON_COOK && m.flow.x > 0.0; }

// A metal `heated` of the way to melting, for the plastic strain of `time`: its reference rate becomes a strain.
fn heated_metal(m: MaterialParams, heated: f32, time: f32) -> MaterialParams {
    var hot = m;
    let left = 1.0 - select(0.0, pow(min(heated, 1.0), m.flow.w), heated > 0.0);
    hot.yield_stress *= left;
    hot.hardening *= left;
    hot.flow.z *= time;
    return hot;
}

// Length of the deviator of stress at which a metal flows by a plastic strain `step` on top of `hardened`, and its slope with the step.
fn flow_stress(m: MaterialParams, hardened: f32, step: f32) -> vec2f {
    let strain = max(hardened + step, 1e-12);
    let grown = m.hardening * pow(strain, m.flow.x);
    let fast = 1.0 + m.flow.y * log(max(step / m.flow.z, 1.0));
    let slope = m.flow.x * grown / strain * fast;
    let gain = select(0.0, m.flow.y / max(step, m.flow.z), step > m.flow.z);
    return vec2f((m.yield_stress + grown) * fast, slope + (m.yield_stress + grown) * gain);
}

const FLOW_TURNS = 24u;

// The cut-back of a deviator by a flow stress that grows with the step: Newton's method between bounds that close in.
fn flow_by_rate(h: mat3x3f, hardened: f32, m: MaterialParams, l: Logarithmic, deviator: vec3f) -> PlasticReturn {
    let size = length(deviator);
    let share = sqrt(2.0 / 3.0);
    var low = 0.0;
    var high = size - flow_stress(m, hardened, 0.0).x / (2.0 * m.mu);
    if high <= 0.0 { return PlasticReturn(h, 0.0); }
    var excess = 0.5 * high;
    for (var turn = 0u; turn < FLOW_TURNS; turn++) {
        let flow = flow_stress(m, hardened, share * excess) / (2.0 * m.mu);
        let over = size - excess - flow.x;
        if over > 0.0 { low = excess; } else { high = excess; }
        let next = excess + over / (1.0 + share * flow.y);
        excess = select(0.5 * (low + high), next, next >= low && next <= high);
    }
    return PlasticReturn(stretched(h, l, -excess / size * deviator), share * excess);
}
