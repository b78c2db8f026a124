// The law of the ghost pressure q of a body. [eqs. 17 to 20]
// A body starts with the ambient pressure, and has the q of its volume, q(J), as long as the solve alone moves it. Where gas and body share
// one pressure unknown q follows the gas instead: the elastic force gives the difference, so the whole stress is that of the deformation.
#include "shared/index.wgsl"
#include "materials/neo_hookean.wgsl"
#include "materials/voids.wgsl"

// Stiffness K against small changes of the volume at the ghost pressure q, dq = -K dJ / J. [eq. 17]
fn ghost_stiffness(m: MaterialParams, q: f32) -> f32 {
    return m.ghost_modulus + GHOST_STIFFENING * max(q - params.ambient_pressure, 0.0);
}

// Below this the ghost pressure of a volume grows no further: a trial may turn a particle inside out.
const LEAST_SWELLING = -0.9;

// J - 1 of a body, accurate where it is small. What flows by more than shear does not know its volume: its q tells.
fn swelling_of(m: MaterialParams, h: mat3x3f, q: f32) -> f32 {
    if keeps_volume(m.kind) { return max(swelling(h), LEAST_SWELLING); }
    let over = q - params.ambient_pressure;
    if over > 0.0 { return pow(1.0 + GHOST_STIFFENING * over / m.ghost_modulus, -1.0 / GHOST_STIFFENING) - 1.0; }
    return exp(-over / m.ghost_modulus) - 1.0;
}

// q(J), swelling = J - 1.
fn ghost_pressure_of(m: MaterialParams, swelling: f32) -> f32 {
    let logarithm = log_one_plus(swelling);
    if swelling > 0.0 { return params.ambient_pressure - m.ghost_modulus * logarithm; }
    let y = -GHOST_STIFFENING * logarithm;
    return params.ambient_pressure + m.ghost_modulus / GHOST_STIFFENING * (y + exponential_rest(y));
}

// Energy per volume at rest: minus the integral of q dJ from J = 1.
fn ghost_energy(m: MaterialParams, swelling: f32) -> f32 {
    let logarithm = log_one_plus(swelling);
    let excess = excess_over_logarithm(swelling);
    var shape = swelling * logarithm - excess;
    if swelling < 0.0 {
        const N = GHOST_STIFFENING - 1.0;
        shape = (excess + exponential_rest(-N * logarithm) / N) / GHOST_STIFFENING;
    }
    return m.ghost_modulus * shape - params.ambient_pressure * swelling;
}

// Whether the elastic force bears what q(J) has beyond q.
fn bears_volume(m: MaterialParams) -> bool { return !SHARED_VOLUME && keeps_volume(m.kind); }

// Kirchhoff stress that the elastic force bears: that of the law, and what q(J) has beyond q.
fn elastic_stress(m: MaterialParams, h: mat3x3f, q: f32) -> mat3x3f {
    let tau = kirchhoff_stress(m.kind, h, elastic_part(m));
    if !bears_volume(m) { return tau; }
    let swelling = swelling_of(m, h, q);
    return tau + (1.0 + swelling) * (q - ghost_pressure_of(m, swelling)) * IDENTITY;
}

// Fastest wave [m s^-1] by the whole stress of a body, `density` that at rest.
fn body_wave_speed(m: MaterialParams, h: mat3x3f, q: f32, density: f32) -> f32 {
    let wave = wave_speed(m.kind, h, m, density);
    // The law's own lambda has in it what the ghost pressure bears of it.
    let beyond = ghost_stiffness(m, ghost_pressure_of(m, swelling_of(m, h, q))) + m.elastic_lambda - m.lambda;
    return sqrt(wave * wave + max(beyond, 0.0) / density);
}

// -- Fracture --

// How a particle breaks. Its driver, the largest principal stress of the undamaged law, goes to the nodes, and comes back as a mean over
// some cells; damage follows the mean, so that a crack neither sees the axes of the grid nor leaves flanks behind that bear stress.
// What has broken bears no tension: its opening is taken out of the deformation, so that gas sees no volume in it, and kept as a number
// that has to be closed again before it bears pressure. [Bazant & Oh 1983; Pijaudier-Cabot & Bazant 1987; Rankine 1857]
// Stress counts from the ambient pressure on: that is what fills a crack below a cell.

// Ratio of the driver at full damage to that at the onset, at least.
const LEAST_RATIO = 1.02;
// A crack drives what is beside it by up to this much of the driver at full damage: without it flanks would bear stress for ever.
const MOST_DRIVE = 2.5;
// Damage from which on an exponential tail counts as broken.
const END_OF_TAIL = 0.999;

fn can_break(m: MaterialParams) -> bool { return FRACTURE && m.tensile_strength > 0.0; }

// The bit of a particle's word that says that it has crumbled.
const CRUMBLED = 0x80000000u;
// Logarithm of a volume by which what crumbles has opened then: its crack is half a cell wide.
const CRUMBLES = 0.3;

// Strength of a particle: the material's times the factor in the high half of the particle's word, 0 for none.
fn strength_of(m: MaterialParams, word: f32) -> f32 {
    let factor = (bitcast<u32>(word) & ~CRUMBLED) >> 16u;
    return m.tensile_strength * select(f32(factor) / f32(STRENGTH_UNIT), 1.0, factor == 0u);
}

fn ratio_of(m: MaterialParams, strength: f32) -> f32 { return max(m.toughness / (strength * strength), LEAST_RATIO); }

// Damage that goes with `driven`, the driver over the strength: the stress (1 - damage) driven falls from 1 to 0 at `ratio`.
fn damage_at(m: MaterialParams, driven: f32, ratio: f32) -> f32 {
    if driven <= 1.0 { return 0.0; }
    if m.softening == SOFTENING_EXPONENTIAL {
        let damage = 1.0 - exp(-2.0 * (driven - 1.0) / (ratio - 1.0)) / driven;
        return select(damage, 1.0, damage > END_OF_TAIL);
    }
    if driven >= ratio { return 1.0; }
    return 1.0 - (ratio - driven) / (driven * (ratio - 1.0));
}

// Lambda that law and ghost pressure have together.
fn whole_lambda(m: MaterialParams) -> f32 { return m.elastic_lambda + m.ghost_modulus; }

fn sum_of(v: vec3f) -> f32 { return v.x + v.y + v.z; }

// Energy per volume at rest of law and ghost pressure, less what the ambient pressure gives.
fn whole_energy(m: MaterialParams, h: mat3x3f, q: f32) -> f32 {
    let grown = swelling_of(m, h, q);
    return elastic_energy(m.kind, h, elastic_part(m)) + ghost_energy(m, grown) + params.ambient_pressure * grown;
}

// What damage takes of a stress, along its principal axes: the positive values, or, where voids grow, all but pressure; and the elastic energy
// per volume at rest that it holds.
struct Tension { pull: vec3f, axes: mat3x3f, energy: f32, stress: vec3f }

// `tau`: of elastic_stress. The share of the energy is that of small strains: where all axes pull, tension holds all, however large they are.
fn tension_of(m: MaterialParams, h: mat3x3f, q: f32, tau: mat3x3f) -> Tension {
    let volume = 1.0 + swelling_of(m, h, q);
    let eigen = symmetric_eigen(tau - volume * (q - params.ambient_pressure) * IDENTITY);
    let sum = sum_of(eigen.values);
    let lambda = whole_lambda(m);
    let strain = (eigen.values - vec3f(lambda * sum / (3.0 * lambda + 2.0 * m.mu))) / (2.0 * m.mu);
    let pull = select(max(eigen.values, vec3f(0.0)), eigen.values - vec3f(min(sum / 3.0, 0.0)), breaks_by_voids(m));
    let share = dot(pull, strain) / max(dot(eigen.values, strain), 1e-30);
    return Tension(pull, eigen.vectors, share * whole_energy(m, h, q), eigen.values);
}

// What damage leaves of the stress.
fn damaged_stress(tau: mat3x3f, t: Tension, damage: f32) -> mat3x3f {
    if damage == 0.0 { return tau; }
    return tau - damage * (t.axes * diagonal(t.pull) * transpose(t.axes));
}

// Principal strains that leave no tension, by a law that is linear in them: as many axes give way, the most stretched first, as it takes.
fn strains_without_tension(m: MaterialParams, strain: vec3f) -> vec3f {
    let lambda = whole_lambda(m);
    var kept = strain;
    var loose = vec3<bool>(false);
    for (var turn = 0u; turn < 3u; turn++) {
        let stress = select(vec3f(lambda * sum_of(kept)) + 2.0 * m.mu * kept, vec3f(-3e38), loose);
        let largest = max(stress.x, max(stress.y, stress.z));
        if largest <= 0.0 { return kept; }
        loose = loose | (stress == vec3f(largest));
        let count = sum_of(select(vec3f(0.0), vec3f(1.0), loose));
        let given = -lambda * sum_of(select(strain, vec3f(0.0), loose)) / (count * lambda + 2.0 * m.mu);
        kept = select(strain, vec3f(given), loose);
    }
    return kept;
}

// Deformation of a broken particle, what it has opened by (logarithm of a volume), and its ghost pressure.
struct Opened { deformation: mat3x3f, open: f32, ghost: f32 }

fn without_tension(m: MaterialParams, h: mat3x3f, open: f32, q: f32) -> Opened {
    // an inverted F has no logarithmic strain; the caller reports it
    if swelling(h) <= -1.0 { return Opened(h, open, q); }
    let l = logarithmic_strain(h);
    let least = min(l.strain.x, min(l.strain.y, l.strain.z));
    // What has opened closes before it bears pressure.
    let closing = clamp(-least, 0.0, open);
    let strain = select(l.strain, vec3f(least + closing), (l.strain == vec3f(least)) & vec3<bool>(closing > 0.0));
    let change = strains_without_tension(m, strain) - l.strain;
    if all(change == vec3f(0.0)) { return Opened(h, open, q); }
    let moved = stretched(h, l, change);
    let opened = max(open - sum_of(change), 0.0);
    if !keeps_volume(m.kind) { return Opened(moved, opened, max(q, params.ambient_pressure)); }
    // The ghost pressure of the volume that is taken out goes with it.
    let gone = ghost_pressure_of(m, swelling_of(m, moved, q)) - ghost_pressure_of(m, swelling_of(m, h, q));
    return Opened(moved, opened, q + gone);
}

// What has crumbled bears shear by friction alone: plastic flow on a cone without cohesion. [Drucker & Prager 1952]
fn slid(m: MaterialParams, h: mat3x3f) -> PlasticReturn {
    var cone = m;
    cone.lambda = whole_lambda(m);
    cone.yield_stress = 0.0;
    cone.hardening = 0.0;
    cone.friction = m.rubble;
    cone.flow = vec4f(0.0);
    return plastic_flow(h, 0.0, cone);
}
