// Elastoplastic metal: neo-Hookean elasticity, plastic flow with linear hardening above a yield stress.
#include "materials/plastic_flow.wgsl"

fn stress_von_mises(h: mat3x3f, m: MaterialParams) -> mat3x3f { return stress_neo_hookean(h, m); }

fn return_von_mises(h: mat3x3f, hardened: f32, m: MaterialParams) -> PlasticReturn {
    return plastic_flow(h, hardened, m);
}

fn energy_von_mises(h: mat3x3f, m: MaterialParams) -> f32 { return energy_neo_hookean(h, m); }

fn wave_speed_von_mises(h: mat3x3f, m: MaterialParams, density: f32) -> f32 {
    return wave_speed_neo_hookean(h, m, density);
}
