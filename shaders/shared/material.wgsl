// What every material law takes and gives.

// Generated from src/material/mod.rs by scripts/generate.
struct MaterialParams {
    mu: f32,                    // Shear modulus [Pa]
    lambda: f32,                // First Lame constant of the body [Pa]
    yield_stress: f32,          // Yield stress [Pa]; f32::MAX for laws that do not yield
    kind: u32,                  // Position in KINDS
    ghost_modulus: f32,         // Modulus of the ghost pressure at the pressure that bodies start with [Pa]
    hardening: f32,             // Growth of the yield stress per equivalent plastic strain [Pa]
    friction: f32,              // Growth of the yield stress over minus the trace of the Kirchhoff stress [1]
    elastic_lambda: f32,        // What the ghost pressure leaves of lambda to the elastic stress [Pa]
    tensile_strength: f32,      // Tensile strength [Pa]; 0 for what does not break
    toughness: f32,             // Twice the fracture energy over the width of a band, times the modulus of pressure waves [Pa^2]
    softening: u32,             // Softening as a number
    crack_modulus: f32,         // Density times the square of the rate of damage at most: Rayleigh's waves over the width of a band [kg m^-3 s^-2]
}
// End of what is generated.

// The index of a material, the low half of a particle's word; the high half has what scatters its strength [shared/fracture.wgsl].
fn material_index(word: f32) -> u32 { return bitcast<u32>(word) & 0xffffu; }

// What the ghost pressure leaves of a law.
fn elastic_part(m: MaterialParams) -> MaterialParams {
    var part = m;
    part.lambda = m.elastic_lambda;
    return part;
}

// What plastic flow leaves of a deformation.
struct PlasticReturn {
    deformation: mat3x3f,   // of the elastic part, F - I
    plastic_strain: f32,    // equivalent plastic strain that the flow added
}
