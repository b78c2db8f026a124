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
         [time]\nuntil = 6.0\n[numerics]\npaper.face_velocity = \"{face_velocity}\"\n"
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
        // as on the right: the wave from there has changed the far gas of the left into it
        assert!((velocity - 0.1).abs() < 0.002, "{face_velocity}: velocity {velocity}");
        assert!((pressure - 1.26178).abs() < 0.002, "{face_velocity}: pressure {pressure}");
        assert!((density - 1.18069).abs() < 0.002, "{face_velocity}: density {density}");
    }
}

/// A shock meets a block in a closed channel and comes back to the far field on the left, which gas then enters and leaves.
fn thrown_back() -> Scene {
    let behind = "density = 1.63\nvelocity = [0.3461, 0.0]\npressure = 1.557";
    let text = format!(
        "title = \"far field\"\n[domain]\ndimension = 2\ncells = [40, 20]\nsize = [2.0, 1.0]\n\
         [gas]\nambient = {{ density = 1.2, pressure = 1.01 }}\n\
         [[gas.regions]]\nshape = {{ half_space = {{ point = [0.4, 0.0], normal = [1.0, 0.0] }} }}\n{behind}\n\
         [boundary]\nx_min = {{ far_field = {{ {} }} }}\n\
         [[obstacles]]\nname = \"block\"\nshape = {{ box = {{ center = [0.8, 0.0], size = [0.1, 1.5] }} }}\n\
         [time]\nuntil = 14.0\n[numerics]\npaper.face_velocity = \"cell\"\n",
        behind.replace('\n', ", ")
    );
    Scene::parse(&text, "far_field.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Cells along the side do not take turns in pressure: no vertex would see it, and nothing would stop it.
#[test]
fn pressures_along_a_far_field_are_even() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = thrown_back();
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    simulation.advance_to(scene.time.until).unwrap_or_else(|error| panic!("{error}"));
    let after = simulation.snapshot().unwrap();
    let column: Vec<f32> = (0..20).map(|row| after.pressure[row * 40]).collect();
    let turn = |three: &[f32]| (three[0] - 2.0 * three[1] + three[2]).abs() / three[1];
    let worst = column.windows(3).map(turn).fold(0.0, f32::max);
    eprintln!("{worst}");
    assert!(worst < 0.02, "{column:?}");
}
