// What every material law takes and gives. Mirror of MaterialParams: src/material/mod.rs.

struct MaterialParams {
    mu: f32,            // shear modulus [Pa]
    lambda: f32,        // first Lame constant [Pa]
    yield_stress: f32,  // [Pa]; the largest f32 for laws that do not yield
    kind: u32,          // position in the registry
    ghost_modulus: f32, // of the ghost pressure, q = -ghost_modulus (J - 1) [Pa]
    hardening: f32,     // growth of the yield stress per equivalent plastic strain [Pa]
    @size(8) friction: f32, // growth of the yield stress over minus the trace of the Kirchhoff stress [1]
}

// A law, or what is left of it where the ghost pressure has its volumetric part.
fn elastic_part(m: MaterialParams, without_volume: bool) -> MaterialParams {
    var part = m;
    if without_volume { part.lambda = 0.0; }
    return part;
}

// Ghost volume J^g = 1 - q / lambda is kept above this.
const SMALLEST_GHOST_VOLUME = 0.05;

// Stiffness lambda J^g against small changes of the volume at the ghost pressure q. [eq. 17]
fn ghost_stiffness(m: MaterialParams, q: f32) -> f32 {
    return m.ghost_modulus * max(1.0 - q / m.ghost_modulus, SMALLEST_GHOST_VOLUME);
}

// What plastic flow leaves of a deformation gradient.
struct PlasticReturn {
    deformation: mat3x3f,  // the elastic part
    plastic_strain: f32,   // equivalent plastic strain that the flow added
}
