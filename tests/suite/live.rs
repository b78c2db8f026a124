//! What may change while a simulation runs: blasts, and the parameters of a step.

use brisance::Error;
use brisance::diagnostics::StepRecord;
use brisance::expect::Budget;
use brisance::gpu::{Gpu, GpuOptions};
use brisance::render::{Renderer, SceneBuffers};
use brisance::scene::Scene;
use brisance::simulation::{Blast, Simulation};

use crate::common::gpu_or_skip;

fn scene(dimension: u32, more: &str) -> Scene {
    let (cells, edges) = (vec![16; dimension as usize], vec![1.0; dimension as usize]);
    let text = format!(
        "title = \"Still air\"\n\
         domain = {{ dimension = {dimension}, cells = {cells:?}, size = {edges:?} }}\n\
         gas.ambient = {{ density = 1.2, pressure = 1.0e5 }}\n\
         time = {{ until = 0.1, frames = 1, fixed_step = 2.0e-5 }}\n{more}"
    );
    Scene::parse(&text, "still.toml", &[]).expect("the scene of the test is valid")
}

const OBSTACLE: &str = "[[obstacles]]\nname = \"rock\"\nshape.sphere = { center = [0.7, 0.5, 0.5], radius = 0.13 }";
const BODY: &str = "[[bodies]]\nname = \"lump\"\nshape.sphere = { center = [0.3, 0.5, 0.5], radius = 0.12 }\n\
                    material = \"rubber\"\ndensity = 1000.0\nvelocity = [0.0, 0.0, 0.0]\n\
                    [materials.rubber]\nneo_hookean = { young_modulus = 1.0e7, poisson_ratio = 0.3 }";

/// The same thing in the plane.
fn flat(text: &str) -> String {
    text.replace(", 0.5, 0.5]", ", 0.5]").replace("[0.0, 0.0, 0.0]", "[0.0, 0.0]")
}

/// So many steps, in as many submissions as the device needs.
fn advance(simulation: &mut Simulation, records: &mut Vec<StepRecord>, steps: usize) {
    let end = records.len() + steps;
    while records.len() < end {
        simulation.advance_batch_of(records, (end - records.len()) as u32).unwrap();
    }
}

/// Energy of the gas \[J\].
fn energy(simulation: &Simulation, scene: &Scene) -> f64 {
    Budget::read(simulation, scene, 0.0).unwrap().energy + simulation.given()[3]
}

#[test]
fn a_blast_gives_what_was_asked_for_and_the_budgets_close() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in 1..=3 {
        // the budget knows whole cells only
        let stairs = format!("{OBSTACLE}\n[numerics]\npaper.obstacles = \"cells\"");
        for more in ["", &stairs, BODY] {
            if dimension == 1 && !more.is_empty() {
                continue;
            }
            let scene = scene(dimension, &if dimension == 3 { more.to_owned() } else { flat(more) });
            let mut simulation = Simulation::new(&gpu, &scene).unwrap();
            let mut records = Vec::new();
            simulation.set_target(scene.time.until).unwrap();
            advance(&mut simulation, &mut records, 3);
            let (asked, before) = (3.0e4, energy(&simulation, &scene));
            let budgets = Budget::read(&simulation, &scene, 0.0).unwrap().energy;
            let blast = Blast { center: [0.5; 3], radius: 0.3, energy: asked };
            let given = simulation.detonate(&blast, &mut records).unwrap();
            let added = energy(&simulation, &scene) - before;
            assert!((added - asked).abs() < 1e-5 * asked, "{dimension}D {more}: {added} J instead of {asked}");
            assert!((given - asked).abs() < 1e-6 * asked, "{given}");
            let drift = Budget::read(&simulation, &scene, 0.0).unwrap().energy - budgets;
            assert!(drift.abs() < 1e-5 * asked, "{dimension}D {more}: the budgets lose {drift} J at once");
            advance(&mut simulation, &mut records, 12);
            let last = records.last().unwrap();
            let stored = f64::from(last.elastic_energy) + f64::from(last.plastic_heat);
            let drift = Budget::read(&simulation, &scene, stored).unwrap().energy - budgets;
            // bodies that strain leave the error of explicit elastic steps
            let allowed = if scene.bodies.is_empty() { 1e-4 } else { 2e-3 };
            assert!(drift.abs() < allowed * asked, "{dimension}D {more}: {drift} J are missing later");
            assert!(last.given.energy > 0.99 * asked as f32 && last.gas_speed > 10.0, "{last:?}");
        }
    }
}

#[test]
fn a_blast_is_a_pressure_rise_and_symmetric() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in [2_usize, 3] {
        let scene = scene(dimension as u32, "");
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let mut records = Vec::new();
        let blast = Blast { center: [0.5; 3], radius: 0.26, energy: 5.0e4 };
        simulation.detonate(&blast, &mut records).unwrap();
        let state = simulation.snapshot().unwrap();
        assert!(
            state.density.iter().all(|&density| density == 1.2) && state.velocity.iter().flatten().all(|&v| v == 0.0)
        );
        let raised: Vec<f32> = state.pressure.iter().copied().filter(|&p| p > 1.001e5).collect();
        assert!(raised.len() > 10 && raised.iter().all(|&p| (p - raised[0]).abs() < 1e-4 * p), "{raised:?}");
        simulation.set_target(scene.time.until).unwrap();
        advance(&mut simulation, &mut records, 12);
        let state = simulation.snapshot().unwrap();
        let at = |x: usize, y: usize, z: usize| state.pressure[x + 16 * (y + 16 * z)];
        let largest = state.pressure.iter().fold(0.0_f32, |a, &b| a.max(b));
        let depth = if dimension == 3 { 16 } else { 1 };
        let cells = (0..16 * 16 * depth).map(|k| (k % 16, k / 16 % 16, k / 256));
        let off = cells.map(|(x, y, z)| (at(x, y, z) - at(15 - x, y, z)).abs().max((at(x, y, z) - at(y, x, z)).abs()));
        let off = off.fold(0.0_f32, f32::max);
        assert!(off < 1e-3 * largest, "{dimension}D: {off} of {largest}");
    }
}

#[test]
fn a_blast_without_gas_or_numbers_is_refused() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = scene(2, &flat(OBSTACLE));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let mut refused = |center, radius, energy| {
        simulation.detonate(&Blast { center, radius, energy }, &mut Vec::new()).unwrap_err().to_string()
    };
    assert!(refused([0.7, 0.5, 0.0], 0.05, 1.0).contains("no gas within"));
    assert!(refused([0.2, 0.5, 0.0], 0.05, -1.0).contains("must be positive"));
    assert!(refused([0.2, 0.5, 0.0], f64::NAN, 1.0).contains("must be positive"));
}

#[test]
fn parameters_change_between_steps_and_nothing_else_does() {
    let Some(gpu) = gpu_or_skip() else { return };
    let inlet =
        "[boundary]\nx_min.inlet = { density = 1.2, velocity = [50.0, 0.0], pressure = 1.0e5 }\nx_max = \"outlet\"";
    let scene = scene(2, inlet);
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let mut records = Vec::new();
    simulation.set_target(scene.time.until).unwrap();
    advance(&mut simulation, &mut records, 4);
    let mut faster = scene.clone();
    faster.gravity = [0.0, -1.0e4, 0.0];
    let brisance::scene::Boundary::Inlet(state) = &mut faster.boundary.x_min else { panic!("an inlet") };
    state.velocity[0] = 200.0;
    simulation.change(&scene, &faster, &mut records).unwrap();
    advance(&mut simulation, &mut records, 16);
    let state = simulation.snapshot().unwrap();
    let inflow = state.velocity[8 * 16][0];
    assert!(inflow > 120.0, "the gas behind the inlet has {inflow} m/s");
    let falls = state.velocity[8 * 16 + 15][1];
    assert!(falls < -1.0, "gravity acts: {falls} m/s");
    let mut other = faster.clone();
    other.domain.cells[0] = 32;
    assert!(simulation.change(&faster, &other, &mut records).unwrap_err().to_string().contains("only gravity"));
    let mut wall = faster.clone();
    wall.boundary.x_max = brisance::scene::Boundary::Wall;
    assert!(simulation.change(&faster, &wall, &mut records).unwrap_err().to_string().contains("its rule"));
}

#[test]
fn a_blast_beside_cut_cells_gives_each_its_share() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = scene(2, &flat(OBSTACLE));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let (mut records, asked) = (Vec::new(), 3.0e4);
    simulation.set_target(scene.time.until).unwrap();
    advance(&mut simulation, &mut records, 1);
    simulation.detonate(&Blast { center: [0.6, 0.5, 0.0], radius: 0.2, energy: asked }, &mut records).unwrap();
    advance(&mut simulation, &mut records, 4);
    // the totals of a step weigh cut cells by the gas that they hold; the domain is closed
    let added = f64::from(records.last().unwrap().gas.energy) - f64::from(records[0].gas.energy);
    assert!((added - asked).abs() < 1e-4 * asked, "{added} J instead of {asked}");
}

#[test]
fn a_tighter_tolerance_costs_iterations() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut scene = scene(2, &flat(BODY).replace("velocity = [0.0, 0.0]", "velocity = [20.0, 0.0]"));
    scene.time.fixed_step = None;
    let run = |tolerance: f64| {
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let mut records = Vec::new();
        simulation.set_target(1.0).unwrap();
        let blast = Blast { center: [0.6, 0.45, 0.0], radius: 0.2, energy: 3.0e5 };
        simulation.detonate(&blast, &mut records).unwrap();
        let mut to = scene.clone();
        to.numerics.tolerance = tolerance;
        simulation.change(&scene, &to, &mut records).unwrap();
        while records.len() < 6 {
            advance(&mut simulation, &mut records, 1);
        }
        records.iter().map(|record| record.iterations).sum::<u32>()
    };
    let [loose, tight] = [1e-2, 1e-6].map(run);
    assert!(tight > loose, "{loose} and {tight} iterations");
}

/// A device that goes away is an error that says so, and another one takes its place.
#[test]
fn a_lost_device_is_no_panic() {
    let Some(_) = gpu_or_skip() else { return };
    let scene = scene(3, BODY);
    let gpu = Gpu::new(&GpuOptions::default()).unwrap();
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    simulation.set_target(0.1).unwrap();
    let mut renderer = Renderer::new(&gpu, &scene, &SceneBuffers::of(&simulation.state)).unwrap();
    gpu.device.destroy();
    let stepped = simulation.advance_batch(&mut Vec::new()).map(|_| ()).unwrap_err();
    let drawn = renderer.render(0.0).map(|_| ()).unwrap_err();
    for error in [stepped, drawn] {
        assert!(matches!(error, Error::Gpu(_)) && error.exit_code() == 75, "{error}");
    }
    let mut again = Simulation::new(&Gpu::new(&GpuOptions::default()).unwrap(), &scene).unwrap();
    again.set_target(0.1).unwrap();
    again.advance_batch(&mut Vec::new()).unwrap();
}
