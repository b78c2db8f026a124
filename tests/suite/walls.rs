//! Sides that are walls: planes of symmetry of the pressure system.

use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// Gas at rest under gravity in a box stays at rest, whatever its walls and however the steps change.
#[test]
fn gas_under_gravity_rests_on_its_floor_at_every_step() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"column\"\ngravity = [0.0, -0.01]\n[domain]\ndimension = 2\ncells = [6, 16]\nsize = [0.375, 1.0]\n\
                [gas]\nambient = { density = 1.4, pressure = 1.0 }\n\
                waves = [{ vector = [0.0, 0.02], phase = 1.570796327, pressure = 0.7 }]\n\
                [time]\nuntil = 30.0\nmax_courant = 5.0\n";
    let scene = Scene::parse(text, "column.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let mut fastest = 0.0_f32;
    for time in [3.0, 7.1, 7.2, 15.0, 15.01, 30.0] {
        let records = simulation.advance_to(time).unwrap();
        fastest = records.iter().fold(fastest, |most, record| most.max(record.gas_speed));
    }
    eprintln!("largest speed {:.1e} of sqrt(g H)", fastest / 0.1);
    assert!(fastest < 5e-5, "{fastest:e}");
}
