//! Equal runs give equal bits; the two forms of particle-to-grid transfer agree.

use brisance::gpu::{Gpu, readback};
use brisance::scene::{Changes, Scene};
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

const STEPS: u64 = 20;

/// All that the state holds after some steps of the shrunk shell, as words, by name.
fn run(gpu: &Gpu, transfer: &str) -> Vec<(&'static str, Vec<u32>)> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/paper/fig03_elastic_shell_2d.toml");
    let changes = Changes::variant("small").set(format!("numerics.expert.transfer={transfer}"));
    let mut scene = Scene::load(path, changes).unwrap();
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
fn columns_give_equal_bits() {
    equal_bits("columns");
}

#[test]
fn nodes_give_equal_bits() {
    equal_bits("nodes");
}

#[test]
fn columns_and_nodes_agree() {
    let Some(gpu) = gpu_or_skip() else { return };
    let (columns, nodes) = (run(&gpu, "columns"), run(&gpu, "nodes"));
    for (name, tolerance) in [("conserved", 2e-4), ("position", 1e-5), ("velocity", 2e-4)] {
        let values = |all: &[(&str, Vec<u32>)]| -> Vec<f32> {
            let (_, words) = all.iter().find(|(known, _)| *known == name).unwrap();
            words.iter().map(|word| f32::from_bits(*word)).collect()
        };
        let (a, b) = (values(&columns), values(&nodes));
        let scale = a.iter().fold(0.0, |most: f32, v| most.max(v.abs()));
        let worst = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / scale;
        eprintln!("{name}: {worst:.1e}");
        assert!(worst <= tolerance, "{name} differs by {worst:e} of {scale}");
    }
}

/// A square in the middle of a box, at rest or as fast as a fifth of the speed of sound.
fn square(gpu: &Gpu, speed: f64) -> Simulation {
    let text = format!(
        "title = \"square\"\ndomain = {{ dimension = 2, cells = [16, 16], size = [1.6, 1.6] }}\n\
         gas.ambient = {{ density = 1.0, pressure = 1.0 }}\ntime = {{ until = 1.0, fixed_step = 0.02 }}\n\
         materials.rubber.neo_hookean = {{ young_modulus = 1000.0, poisson_ratio = 0.3 }}\n\
         [[bodies]]\nname = \"square\"\nshape.box = {{ center = [0.8, 0.8], size = [0.4, 0.4] }}\nmaterial = \"rubber\"\ndensity = 10.0\n\
         velocity = [{speed:?}, 0.0]\n"
    );
    Simulation::new(gpu, &Scene::parse(&text, "square.toml", &[]).unwrap()).unwrap()
}

/// Swaps the first two particles of the order; whether a sort has put them back after some steps of many sub-steps.
fn sorts_again(gpu: &Gpu, speed: f64) -> bool {
    let mut simulation = square(gpu, speed);
    simulation.advance_to(0.02).unwrap();
    let order = |simulation: &Simulation| readback::read(gpu, &simulation.state.particles.order).unwrap();
    let sorted = order(&simulation);
    simulation.state.particles.order.write(gpu, 0, &[sorted[1], sorted[0]]);
    simulation.advance_to(0.2).unwrap();
    assert!(simulation.step_count() >= 10);
    order(&simulation) != [&[sorted[1], sorted[0]], &sorted[2..]].concat()
}

#[test]
fn particles_are_sorted_again_only_where_one_has_left_its_cell() {
    let Some(gpu) = gpu_or_skip() else { return };
    assert!(!sorts_again(&gpu, 0.0), "a body at rest was sorted again");
    assert!(sorts_again(&gpu, 0.24), "a body that moves was not sorted again");
}
