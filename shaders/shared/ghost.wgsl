// The law of the ghost pressure q of a body. [eqs. 17 to 20]
#include "shared/index.wgsl"
#include "shared/material.wgsl"

// Growth of the ghost pressure's stiffness with its pressure. [Murnaghan 1944]
const GHOST_STIFFENING = 7.0;

// Stiffness K against small changes of the volume at the ghost pressure q, dq = -K dJ / J. Bodies start with the ambient pressure. [eq. 17]
fn ghost_stiffness(m: MaterialParams, q: f32) -> f32 {
    return m.ghost_modulus + GHOST_STIFFENING * max(q - params.ambient_pressure, 0.0);
}

// Energy of the ghost pressure per volume at rest: the integral of q dq / K.
fn ghost_energy(m: MaterialParams, q: f32) -> f32 {
    let modulus = m.ghost_modulus;
    let start = params.ambient_pressure;
    let over = q - start;
    if over <= 0.0 { return 0.5 * q * q / modulus; }
    let growth = GHOST_STIFFENING * over / modulus;
    let first = 0.5 * start * start / modulus;
    // The first terms of the series where the logarithm would lose its digits.
    if growth < 0.03 { return first + over / modulus * (0.5 * over * (1.0 - growth * (2.0 / 3.0)) + start * (1.0 - 0.5 * growth)); }
    return first + over / GHOST_STIFFENING + (start - modulus / GHOST_STIFFENING) / GHOST_STIFFENING * log(1.0 + growth);
}
