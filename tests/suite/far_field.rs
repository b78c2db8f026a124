//! What a far field lets in.

use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// A tube between two far fields: velocity 0.3 and pressure 1 on the left; on the right 0.1 and what the left one becomes when a wave
/// slows it so far, p = (1 + 0.2 * 0.2 / c)^7 by the Riemann invariant, c = sqrt(1.4).
fn slowed(face_velocity: &str) -> Scene {
    let state = "density = 1.18069, velocity = [0.1], pressure = 1.26178";
    let text = format!(
        "title = \"far field\"\n[domain]\ndimension = 1\ncells = [40]\nsize = [1.0]\n[gas]\nambient = {{ {state} }}\n[boundary]\n\
         x_min = {{ far_field = {{ density = 1.0, velocity = [0.3], pressure = 1.0 }} }}\nx_max = {{ far_field = {{ {state} }} }}\n\
         [time]\nuntil = 6.0\n[numerics]\nface_velocity = \"{face_velocity}\"\n"
    );
    Scene::parse(&text, "far_field.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_far_field_lets_in_what_the_pressure_system_moves() {
    let Some(gpu) = gpu_or_skip() else { return };
    for face_velocity in ["consistent", "cell"] {
        let scene = slowed(face_velocity);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        simulation.advance_to(scene.time.until).unwrap_or_else(|error| panic!("{error}"));
        let after = simulation.snapshot().unwrap();
        let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
        let velocity: Vec<f32> = after.velocity.iter().map(|v| v[0]).collect();
        let (density, velocity, pressure) = (mean(&after.density), mean(&velocity), mean(&after.pressure));
        eprintln!("{face_velocity}: density {density}, velocity {velocity}, pressure {pressure}");
        // Faces of impedance Z = 1.444 meet at u = 0.2 - 0.13089 / Z and p = 1.1309 + 0.1 Z; the gas keeps the entropy it came with.
        assert!((velocity - 0.1094).abs() < 0.003, "{face_velocity}: velocity {velocity}");
        assert!((pressure - 1.2753).abs() < 0.005, "{face_velocity}: pressure {pressure}");
        assert!((density - 1.1897).abs() < 0.005, "{face_velocity}: density {density}");
    }
}
