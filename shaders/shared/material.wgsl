// What every material law takes and gives. Mirror of MaterialParams: src/material/mod.rs.

struct MaterialParams {
    mu: f32,            // shear modulus [Pa]
    lambda: f32,        // first Lame constant of the body [Pa]
    yield_stress: f32,  // [Pa]; the largest f32 for laws that do not yield
    kind: u32,          // position in the registry
    ghost_modulus: f32, // of the ghost pressure, at the pressure that bodies start with [Pa]
    hardening: f32,     // growth of the yield stress per equivalent plastic strain [Pa]
    friction: f32,      // growth of the yield stress over minus the trace of the Kirchhoff stress [1]
    elastic_lambda: f32, // what the ghost pressure leaves of lambda to the elastic stress [Pa]
}

// What the ghost pressure leaves of a law.
fn elastic_part(m: MaterialParams) -> MaterialParams {
    var part = m;
    part.lambda = m.elastic_lambda;
    return part;
}

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

// What plastic flow leaves of a deformation gradient.
struct PlasticReturn {
    deformation: mat3x3f,  // the elastic part
    plastic_strain: f32,   // equivalent plastic strain that the flow added
}
