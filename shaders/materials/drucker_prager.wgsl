// Soil and sand: linear in the logarithmic strain, with a cone of yield. [Drucker & Prager 1952; Klar et al. 2016]
#include "materials/hencky.wgsl"

fn stress_drucker_prager(h: mat3x3f, m: MaterialParams) -> mat3x3f { return stress_hencky(h, m); }

fn return_drucker_prager(h: mat3x3f, hardened: f32, m: MaterialParams) -> PlasticReturn {
    return plastic_flow(h, hardened, m);
}

fn energy_drucker_prager(h: mat3x3f, m: MaterialParams) -> f32 { return energy_hencky(h, m); }

fn wave_speed_drucker_prager(h: mat3x3f, m: MaterialParams, density: f32) -> f32 {
    return wave_speed_hencky(h, m, density);
}
