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
    tensile_strength: f32, // [Pa]; 0 for what does not break
    toughness: f32,     // twice the fracture energy over the width of a band, times the modulus of pressure waves [Pa^2]
    softening: u32,     // SOFTENING_LINEAR or SOFTENING_EXPONENTIAL
    crack_modulus: f32, // density times the square of the largest rate of damage [kg m^-3 s^-2]
}

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
