// Metals break by voids that grow with plastic flow: omega, the sum of plastic strains over those at which voids would join, is their driver.
// It goes to the nodes times the yield stress of a rod, and comes back as a mean, as the driver of what is brittle does. [Johnson & Cook 1985]
#include "materials/law.wgsl"

// Plastic strain that voids take at least, whatever the tension.
const LEAST_STRAIN = 0.01;

fn breaks_by_voids(m: MaterialParams) -> bool { return FRACTURE && m.void_softening > 0.0; }

// Plastic strain at which voids join, under principal stresses, at a strain rate and `heated` of the way to melting; what is pressed by more than a rod has none.
fn strain_of_voids(m: MaterialParams, stress: vec3f, rate: f32, heated: f32) -> f32 {
    let mean = (stress.x + stress.y + stress.z) / 3.0;
    let von_mises = sqrt(1.5) * length(stress - vec3f(mean));
    let tension = clamp(mean / max(von_mises, 1e-30), -10.0, 10.0);
    if tension < -1.0 / 3.0 { return 1e30; }
    let fast = 1.0 + m.voids.w * log(max(rate / m.void_rate, 1.0));
    let hot = 1.0 + m.void_heat * heated;
    return max((m.voids.x + m.voids.y * exp(m.voids.z * tension)) * fast * hot, LEAST_STRAIN);
}

// Damage that goes with the mean of omega.
fn damage_of_voids(m: MaterialParams, omega: f32) -> f32 { return clamp((omega - 1.0) * m.void_softening, 0.0, 1.0); }

// The most of omega: of what is broken, so that what is beside it breaks as well. MOST_DRIVE: materials/stress.wgsl.
fn most_voids(m: MaterialParams) -> f32 { return 1.0 + MOST_DRIVE / m.void_softening; }
