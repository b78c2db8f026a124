//! What the budgets say was given to bodies, against mechanics.

use brisance::diagnostics::StepRecord;
use brisance::gpu::Gpu;
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// Next to no gas, and gravity.
const HEAD: &str = "title = \"budgets\"\ngravity = [0.0, -1.0]\n[gas]\nambient = { density = 1e-3, pressure = 1e-3 }\n\
    [materials.rigid]\nneo_hookean = { young_modulus = 200.0, poisson_ratio = 0.3, ghost_modulus = 0.1 }\n";

/// The end, and the record of the last step.
fn run(gpu: &Gpu, rest: &str, until: f64) -> (Simulation, StepRecord) {
    let text = format!("{HEAD}{rest}[time]\nuntil = {until}\nmax_courant = 0.3\n");
    let scene = Scene::parse(&text, "budgets.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
    let records = simulation.advance_to(until).unwrap_or_else(|error| panic!("{error}"));
    let last = records.last().expect("steps").clone();
    (simulation, last)
}

/// A block falls, and lands: gravity and floor have given it all the momentum and energy that it has.
#[test]
fn what_gravity_and_floor_give_is_what_the_body_has() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = "[domain]\ndimension = 2\ncells = [16, 24]\nsize = [0.8, 1.2]\n\
        [[bodies]]\nname = \"block\"\nmaterial = \"rigid\"\ndensity = 2.0\nshape = { box = { center = [0.4, 0.6], size = [0.3, 0.3] } }\n";
    let mass = 2.0 * 0.09;
    let (falling, _) = run(&gpu, scene, 0.5);
    let given = falling.given();
    eprintln!("falling: {given:?}");
    assert!((given[1] / (-0.5 * mass) - 1.0).abs() < 0.01 && given[0].abs() < 1e-4 * mass, "momentum {given:?}");
    assert!((given[3] / (0.125 * mass) - 1.0).abs() < 0.02, "energy {given:?}");
    // It reaches the floor at t = 0.95.
    let (landed, last) = run(&gpu, scene, 1.15);
    let momentum = f64::from(last.solid.momentum[1]);
    eprintln!("landed: {:?}, momentum {momentum}", landed.given());
    assert!(momentum > -0.4 * mass, "the floor has stopped it: {momentum}");
    assert!((landed.given()[1] - momentum).abs() < 0.01 * mass, "{:?} and {momentum}", landed.given());
}

/// A block of metal that a driven wall presses flat. Where it flows the stress does work on the plastic strain, which the budgets call heat:
/// sqrt(3/2) (Y a + H a^2 / 2) per volume at the equivalent plastic strain a, as the deviator has norm Y + H a. And the ghost pressure of the
/// wall, which does not give way, stays bounded where the block's nodes reach into it (it grew threefold in each step).
#[test]
fn a_pressed_block_heats_as_it_flows() {
    let Some(gpu) = gpu_or_skip() else { return };
    let (strength, hardening) = (1.0, 5.0);
    let scene = format!(
        "[materials.metal]\nvon_mises = {{ young_modulus = 200.0, poisson_ratio = 0.3, yield_stress = {strength}, hardening = {hardening}, \
         ghost_modulus = 0.1 }}\n[domain]\ndimension = 2\ncells = [32, 20]\nsize = [1.6, 1.0]\n\
         [[bodies]]\nname = \"block\"\nmaterial = \"metal\"\ndensity = 1.0\nshape = {{ box = {{ center = [0.5, 0.25], size = [1.0, 0.5] }} }}\n\
         [[bodies]]\nname = \"press\"\nmaterial = \"rigid\"\ndensity = 1.0\nshape = {{ box = {{ center = [1.1, 0.4], size = [0.2, 0.8] }} }}\n\
         motion = {{ velocity = [-0.2, 0.0] }}\n"
    );
    let (pressed, last) = run(&gpu, &scene, 0.5);
    let snapshot = pressed.snapshot().expect("a device");
    let work = |strain: f64| 1.5_f64.sqrt() * (strength + 0.5 * hardening * strain) * strain;
    let expected =
        snapshot.particles.iter().map(|p| f64::from(p.volume0) * work(f64::from(p.plastic_strain))).sum::<f64>();
    let (heat, ghost) = (last.plastic_heat, last.ghost_energy);
    eprintln!("heat {heat} expected {expected}, ghost {ghost}");
    assert!(expected > 0.05, "it flows: {expected}");
    assert!((f64::from(heat) / expected - 1.0).abs() < 0.03, "{heat} and {expected}");
    assert!(ghost < 0.1 * heat, "{ghost}");
}

/// A soft bar under the pressure of the gas, set going along itself between a held end and a chamber of gas. Its ghost pressure begins at that
/// of the gas, where its own volume is J^g = 1 - p / lambda of the body's: energies of the ghost pressure that leave that out are short by a
/// share p / lambda, here a fifth, of the work that the gas does.
#[test]
fn the_energy_of_the_ghost_pressure_is_the_work_done_on_it() {
    let Some(gpu) = gpu_or_skip() else { return };
    let all = ["time.until=1.6".to_owned(), "domain.cells=[110]".to_owned()];
    let scene = Scene::shipped("validation/sprung_piston.toml", &all).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
    let records = simulation.advance_to(scene.time.until).unwrap_or_else(|error| panic!("{error}"));
    let sum = |record: &StepRecord| {
        let gas = f64::from(record.gas.energy) + f64::from(record.owed.energy);
        gas + f64::from(record.solid.energy) + f64::from(record.elastic_energy) + f64::from(record.ghost_energy)
    };
    let (first, last) = (&records[0], records.last().expect("steps"));
    let work = f64::from(first.gas.energy + first.owed.energy - last.gas.energy - last.owed.energy);
    let missing = sum(last) - sum(first);
    eprintln!("work of the gas {work:e}, missing {missing:e}");
    assert!(work > 8e-3, "{work}");
    assert!(missing.abs() < 0.02 * work, "{missing:e} of {work:e}");
}

/// A region of dense gas ends in the middle of a wall, whose outer cells are filled to less than a half: they start with the gas outside.
#[test]
fn gas_of_the_start_lies_outside_of_bodies() {
    let keys = ["domain.cells=[32, 32]", "bodies[0].shape.shell.thickness=0.046875"].map(str::to_owned);
    let scene = Scene::shipped("validation/loaded_ring.toml", &keys).unwrap_or_else(|error| panic!("{error}"));
    let ring = &scene.bodies[0].shape;
    let gas = scene.initial_gas();
    let mut beside = 0;
    for (index, state) in gas.iter().enumerate() {
        let center = scene.domain.cell_center([index as u32 % 32, index as u32 / 32, 0]);
        let outside = (center[0] - 0.5).hypot(center[1] - 0.5) > 0.28;
        if outside && ring.distance(center) > -0.3 / 32.0 {
            assert_eq!(state[0], 1.0, "cell {index}");
            beside += u32::from(ring.distance(center) < 0.3 / 32.0);
        }
    }
    assert!(beside > 10, "{beside} cells beside the ring");
}
