// The law of the ghost pressure q of a body. [eqs. 17 to 20]
// A body starts with the ambient pressure, and has the q of its volume, q(J), as long as the solve alone moves it. Where gas and body share
// one pressure unknown q follows the gas instead: the elastic force gives the difference, so the whole stress is that of the deformation.
#include "shared/index.wgsl"
#include "shared/material.wgsl"
#include "materials/neo_hookean.wgsl"

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
