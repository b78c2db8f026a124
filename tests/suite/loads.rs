//! Loads of the gas on what is held, driven or fixed: against pressure integrals, and budgets that close with them.

use brisance::diagnostics::StepRecord;
use brisance::expect::{Budget, Summary};
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

const HEAD: &str = "title = \"loads\"\n[materials.rigid]\nneo_hookean = { young_modulus = 200.0, poisson_ratio = 0.3 }\n\
    [gas]\nambient = { density = 1.0, pressure = 1.0 }\n";

/// A closed box with more pressure on the left.
const BOX: &str = "[domain]\ndimension = 2\ncells = [24, 12]\nsize = [2.4, 1.2]\norigin = [1.0, -0.6]\n\
    [[gas.regions]]\nshape = { half_space = { point = [JUMP, 0.0], normal = [1.0, 0.0] } }\ndensity = 2.0\npressure = 2.0\n";

/// A run, its budgets, and its steps.
fn run(text: &str, until: f64) -> Option<(Simulation, [Budget; 2], Vec<StepRecord>)> {
    let gpu = gpu_or_skip()?;
    let text = format!("{HEAD}{text}[time]\ncfl = 0.5\nuntil = {until}\n");
    let scene = Scene::parse(&text, "loads.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
    let start = Budget::read(&simulation, &scene, 0.0).unwrap();
    let records = simulation.advance_to(until).unwrap_or_else(|error| panic!("{error}"));
    let mut summary = Summary::default();
    summary.add(&records);
    let end = Budget::read(&simulation, &scene, summary.stored_energy()).unwrap();
    Some((simulation, [start, end], records))
}

fn near(what: &str, ours: f32, right: f32, most: f32) {
    assert!((ours - right).abs() <= most, "{what}: {ours}, not {right}");
}

/// A held plate between two gases at rest bears the difference of their pressures on its 1.2 m; both of its faces have 2.4 m.
#[test]
fn a_held_plate_bears_the_integral_of_the_pressure() {
    let plate = "[[bodies]]\nname = \"plate\"\nmaterial = \"rigid\"\ndensity = 5.0\nmotion = { velocity = [0.0, 0.0] }\n\
        shape = { box = { center = [2.2, 0.0], size = [0.4, 1.2] } }\n";
    let Some((simulation, _, records)) = run(&format!("{}{plate}", BOX.replace("JUMP", "2.2")), 0.5) else { return };
    assert!(!records.is_empty() && records.iter().all(|record| record.loads.len() == 1));
    for record in &records {
        let load = record.loads[0];
        near("force along x", load.force[0], 1.2, 0.02 * 1.2);
        near("force along y", load.force[1], 0.0, 1e-4);
        // about the origin of coordinates: the force acts at y = 0
        near("moment", load.moment[2], 0.0, 0.02 * 1.2);
        near("pressure", load.pressure, 1.5, 0.03);
        near("area", load.area, 2.4, 1e-5);
    }
    let impulse = simulation.borne().0[0];
    assert!((impulse[0] / 0.6 - 1.0).abs() < 0.02 && impulse[3].abs() < 1e-3, "{impulse:?}");
}

/// A shock meets a disc that stays where it is, as a body or as an obstacle, whole cells or cut ones, with one solve a step or two: what the
/// gas gave to it closes the book of momentum, and all of them bear about the same.
#[test]
fn the_momentum_of_the_gas_closes_with_what_it_gave() {
    let disc = "shape = { sphere = { center = [2.2, 0.1], radius = 0.25 } }\n";
    let body = format!(
        "[[bodies]]\nname = \"disc\"\nmaterial = \"rigid\"\ndensity = 5.0\nmotion = {{ velocity = [0.0, 0.0] }}\n{disc}"
    );
    let fixed = |numerics: &str| format!("[[obstacles]]\nname = \"disc\"\n{disc}[numerics]\n{numerics}\n");
    let kinds = [
        ("body", body),
        ("cells", fixed("paper.obstacles = \"cells\"")),
        ("cut", fixed("")),
        ("two solves", fixed("integrator = \"ars222\"\n")),
    ];
    for (name, kind) in kinds {
        let text = format!("{}{kind}", BOX.replace("JUMP", "1.6"));
        let Some((simulation, [start, end], records)) = run(&text, 0.6) else { return };
        let (bodies, obstacles) = simulation.borne();
        let borne = bodies.iter().chain(obstacles).next().unwrap();
        let gap = (0..2).map(|k| (end.gas_budget[k] - start.gas_budget[k]).abs()).fold(0.0, f64::max);
        eprintln!("{name}: borne {borne:?}, gap {gap:e}, {} steps", records.len());
        assert!(borne[0] > 0.02, "{name}: {borne:?}");
        assert!(gap < 1e-4 * borne[0], "{name}: {gap:e} of {}", borne[0]);
    }
}

/// A piston is driven into a tube: the work that the gas gets is what the piston's load says.
#[test]
fn the_energy_of_the_gas_closes_with_the_work_of_a_piston() {
    let tube = "[domain]\ndimension = 1\ncells = [60]\nsize = [1.2]\n[[bodies]]\nname = \"piston\"\nmaterial = \"rigid\"\n\
        density = 5.0\nmotion = { velocity = [0.4] }\nshape = { box = { center = [0.3], size = [0.2] } }\n";
    let Some((simulation, [start, end], _)) = run(tube, 0.5) else { return };
    let borne = simulation.borne().0[0];
    let change: Vec<f64> = (0..4).map(|k| end.gas_budget[k] - start.gas_budget[k]).collect();
    eprintln!("borne {borne:?}, change {change:?}");
    assert!(borne[3] < -0.05, "the piston loses: {borne:?}");
    assert!(change[3].abs() < 1e-3 * borne[3].abs(), "energy {change:?} of {borne:?}");
    assert!(change[0].abs() < 1e-4 * borne[0].abs(), "momentum {change:?} of {borne:?}");
}
