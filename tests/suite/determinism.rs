//! Equal runs give equal bits; the two forms of particle-to-grid transfer agree.

use brisance::gpu::{Gpu, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

const STEPS: u64 = 20;

/// All that the state holds after some steps of the shrunk shell, as words, by name.
fn run(gpu: &Gpu, transfer: &str) -> Vec<(&'static str, Vec<u32>)> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/paper/fig03_elastic_shell_2d.toml");
    let mut scene = Scene::load(path, &["variant=small".to_owned(), format!("numerics.transfer={transfer}")]).unwrap();
    scene = scene.with_resolution(48).unwrap();
    scene.time.fixed_step = Some(1e-3);
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    simulation.advance_to(STEPS as f64 * 1e-3).unwrap();
    assert!(simulation.step_count() >= STEPS);
    let state = &simulation.state;
    let flow = |buffer| bytemuck::cast_vec(readback::read(gpu, buffer).unwrap());
    vec![
        ("cells", readback::read(gpu, &state.interface.cells).unwrap()),
        ("conserved", flow(&state.gas.conserved)),
        ("owed flow", flow(&state.gas.owed_flow)),
        ("position", flow(&state.particles.position)),
        ("velocity", flow(&state.particles.velocity)),
        ("affine", flow(&state.particles.affine)),
        ("deformation", flow(&state.particles.deformation)),
        ("node", flow(&state.particles.node)),
        ("pressure", bytemuck::cast_vec(readback::read(gpu, &state.pressure).unwrap())),
        ("history", flow(&state.history)),
    ]
}

fn equal_bits(transfer: &str) {
    let Some(gpu) = gpu_or_skip() else { return };
    let (one, two) = (run(&gpu, transfer), run(&gpu, transfer));
    for ((name, a), (_, b)) in one.iter().zip(&two) {
        let first = a.iter().zip(b).position(|(a, b)| a != b);
        assert_eq!(first, None, "{transfer}: first word of `{name}` that differs");
    }
}

#[test]
fn gather_gives_equal_bits() {
    equal_bits("gather");
}

#[test]
fn scatter_gives_equal_bits() {
    equal_bits("scatter");
}

#[test]
fn gather_and_scatter_agree() {
    let Some(gpu) = gpu_or_skip() else { return };
    let (gather, scatter) = (run(&gpu, "gather"), run(&gpu, "scatter"));
    for (name, tolerance) in [("conserved", 2e-4), ("position", 1e-5), ("velocity", 2e-4)] {
        let values = |all: &[(&str, Vec<u32>)]| -> Vec<f32> {
            let (_, words) = all.iter().find(|(known, _)| *known == name).unwrap();
            words.iter().map(|word| f32::from_bits(*word)).collect()
        };
        let (a, b) = (values(&gather), values(&scatter));
        let scale = a.iter().fold(0.0, |most: f32, v| most.max(v.abs()));
        let worst = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / scale;
        eprintln!("{name}: {worst:.1e}");
        assert!(worst <= tolerance, "{name} differs by {worst:e} of {scale}");
    }
}
