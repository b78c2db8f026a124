//! The preconditioner with two spaces: its twin in double precision, the device's against the twin, and what a step costs with it.

use brisance::gpu::{Gpu, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::state::MemoryPlan;

use crate::common::gpu_or_skip;
use crate::reference_solids::lattice;
use crate::reference_tables::Noise;
use crate::twins::problem_of;
use reference::gas::gas_advection;
use reference::gas::intermediate_pressure;
use reference::grid::Grid;
use reference::interface;
use reference::interface::Interface;
use reference::solid::material::Material;
use reference::solid::p2g;
use reference::solid::particle_sort;
use reference::solve::coupled_solve::{Inputs, Q, System, assemble};
use reference::step::two_spaces::{Diagonals, TwoSpaces, iterations};
use reference::{GAS, Pair, Problem, Side, State};

/// The pressure system of a step of `dt` whose advection leaves the state as it is.
fn assembled(problem: Problem, mut state: State, dt: f64) -> (Problem, Interface, System) {
    gas_advection::fill_ghosts(&problem, &state.cells, &mut state.gas);
    let (bins, nodes) = (particle_sort::bin(&problem, &state.particles), p2g::p2g(&problem, &state.particles));
    let faces = interface::interface(&problem, state.cells.clone(), &bins, &nodes);
    let gas = (&state.gas, &state.gas);
    let intermediate = &intermediate_pressure::intermediate(&problem, &faces, gas, None, &state.open, dt);
    let system =
        assemble(&Inputs { problem: &problem, interface: &faces, bins: &bins, intermediate, nodes: &nodes, dt });
    (problem, faces, system)
}

/// A pulse and noise in a box at a Courant number, with what `configure` adds, and a stiff block if asked for.
fn system(
    cells: &[i32],
    sides: [Side; 6],
    courant: f64,
    block: bool,
    configure: impl Fn(&mut Problem),
) -> (Problem, Interface, System) {
    let mut problem = Problem::new(Grid::new(cells, [0.0; 3], 1.0 / f64::from(cells[0])), sides);
    problem.materials = vec![Material::new(1e4, 0.3, f64::INFINITY)];
    configure(&mut problem);
    let axes = cells.len();
    let inside = |x: [f64; 3]| block && x[..axes].iter().all(|x| (x - 0.5).abs() < 0.15);
    let particles = lattice(&problem, 2, 10.0, inside);
    let square = |x: [f64; 3]| -> f64 { x.iter().zip([0.3, 0.6, 0.5]).take(axes).map(|(x, c)| (x - c).powi(2)).sum() };
    let pressure = |x: [f64; 3]| if square(x) < 0.15 * 0.15 { 2.0 } else { 1.0 };
    let mut state = State::new(&problem, |x| (1.0, [0.0; 3], pressure(x)), particles);
    let mut noise = Noise(3);
    for c in problem.grid.interior() {
        let slot = problem.grid.slot(c);
        let mut u = state.gas.get(slot);
        (1..=axes).for_each(|k| u[k] += 0.005 * u[0] * noise.next());
        state.gas.set(slot, u);
    }
    let dt = courant * problem.grid.spacing / problem.gamma.sqrt();
    assembled(problem, state, dt)
}

/// Iterations with the diagonal, with both spaces and the cheap diagonals, with those of Galerkin, with the plain space alone.
fn counts(name: &str, (problem, faces, system): &(Problem, Interface, System)) -> [usize; 4] {
    let b = system.right_hand_side();
    let of = |diagonals, spaces| {
        let two = TwoSpaces::new(problem, faces, system, diagonals);
        iterations(system, &b, 1e-6, |r| two.apply(r, spaces)).0
    };
    let counts = [of(Diagonals::Sums, 0), of(Diagonals::Sums, 4), of(Diagonals::Exact, 4), of(Diagonals::Sums, 1)];
    println!(
        "{name}: diagonal {}, all spaces {}, exact diagonals {}, one space {}",
        counts[0], counts[1], counts[2], counts[3]
    );
    counts
}

/// Twice the iterations at ten times the Courant number, where the diagonal takes ten times as many; walls, odd numbers of cells,
/// obstacles, open sides and a stiff block included. Without the signed space it takes four times as many.
#[test]
fn two_spaces_do_not_mind_the_courant_number() {
    let walls = [Side::Wall; 6];
    let none = |_: &mut Problem| ();
    let obstacle = |problem: &mut Problem| {
        for c in problem.grid.interior() {
            let x = problem.grid.centre(c);
            let slot = problem.grid.slot(c);
            problem.obstacles[slot] = (x[0] - 0.7).hypot(x[1] - 0.3) < 0.12;
        }
    };
    let still = Side::far((1.0, [0.0; 3], 1.0));
    let open = [Side::Wall, still, Side::Wall, still, Side::Wall, Side::Wall];
    let round = [Side::Periodic, Side::Periodic, Side::Wall, Side::Wall, Side::Wall, Side::Wall];
    for (name, case, most) in [
        ("walls, C = 3", system(&[64, 64], walls, 3.0, false, none), 15),
        ("walls, C = 10", system(&[64, 64], walls, 10.0, false, none), 19),
        ("walls, C = 30", system(&[64, 64], walls, 30.0, false, none), 23),
        ("odd", system(&[63, 45], walls, 10.0, false, none), 21),
        ("obstacle", system(&[64, 64], walls, 10.0, false, obstacle), 22),
        ("open", system(&[64, 64], open, 10.0, false, none), 20),
        ("periodic", system(&[64, 64], round, 10.0, false, none), 18),
        ("block", system(&[64, 64], walls, 10.0, true, none), 38),
    ] {
        let [diagonal, two, exact, one] = counts(name, &case);
        assert!(two <= most && exact <= most && diagonal >= 3 * two, "{name}: {diagonal}, {two}, {exact}");
        assert!(3 * one >= 5 * two, "{name}: one space {one}, two {two}");
    }
    let quadratic = |problem: &mut Problem| problem.numerics.pair = Pair::B2b1;
    let [diagonal, two, ..] = counts("b2b1", &system(&[64, 64], walls, 10.0, false, quadratic));
    assert!(two <= 27 && diagonal >= 60, "b2b1: {diagonal}, {two}");
}

/// The same in space, where whole lines of modes are nearly invisible to the operator: a third of the iterations at C = 10, a fifth at 30.
/// Hat functions alone do nothing.
#[test]
fn spaces_in_3d_do_not_mind_the_courant_number() {
    let walls = [Side::Wall; 6];
    let round = [Side::Periodic, Side::Periodic, Side::Wall, Side::Wall, Side::Periodic, Side::Periodic];
    let none = |_: &mut Problem| ();
    for (name, case, most, gain) in [
        ("walls, C = 10", system(&[16, 16, 16], walls, 10.0, false, none), 26, 3.0),
        ("walls, C = 30", system(&[16, 16, 16], walls, 30.0, false, none), 32, 3.5),
        ("odd", system(&[15, 19, 13], walls, 10.0, false, none), 28, 2.5),
        ("periodic", system(&[16, 12, 16], round, 10.0, false, none), 25, 2.5),
        ("block", system(&[16, 16, 16], walls, 10.0, true, none), 45, 1.6),
    ] {
        let [diagonal, all, exact, one] = counts(name, &case);
        assert!(all <= most && exact <= most + 2, "{name}: {all}, {exact}");
        assert!(diagonal as f64 >= gain * all as f64 && 2 * one >= 3 * all, "{name}: {diagonal}, {one}, {all}");
    }
}

const BOX: &str = r#"
title = "Pulse in a closed box"
domain = { dimension = 2, cells = [128, 128], size = [1.0, 1.0] }
time = { until = 1.0, fixed_step = 0.066 }
[gas]
ambient = { density = 1.0, pressure = 1.0 }
regions = [{ shape = { sphere = { center = [0.3, 0.6], radius = 0.15 } }, density = 1.0, pressure = 1.01 }]
"#;

const BLOCK: [&str; 3] = [
    "numerics.elasticity=implicit",
    "materials.steel={ neo_hookean = { young_modulus = 1e4, poisson_ratio = 0.3 } }",
    "bodies=[{ name = \"block\", shape = { box = { center = [0.5, 0.5], size = [0.3, 0.3] } }, material = \"steel\", density = 10.0 }]",
];

/// The same in space.
const SPACE: [&str; 2] = [
    "domain={ dimension = 3, cells = [16, 16, 16], size = [1.0, 1.0, 1.0] }",
    "gas.regions=[{ shape = { sphere = { center = [0.3, 0.6, 0.5], radius = 0.15 } }, density = 1.0, pressure = 1.01 }]",
];

const BLOCK_IN_SPACE: [&str; 3] = [
    BLOCK[0],
    BLOCK[1],
    "bodies=[{ name = \"block\", shape = { box = { center = [0.5, 0.5, 0.5], size = [0.3, 0.3, 0.3] } }, material = \"steel\", density = 10.0 }]",
];

/// Iterations of some steps and the words of gas and pressure after them.
fn run(gpu: &Gpu, overrides: &[&str]) -> (Vec<u32>, Vec<f32>, Vec<f32>) {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let scene = Scene::parse(BOX, "box.toml", &overrides).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    let dt = scene.time.fixed_step.unwrap();
    let records = simulation.advance_to(2.0 * dt).unwrap();
    let gas = readback::read(gpu, &simulation.state.gas.conserved).unwrap();
    let pressure = readback::read(gpu, &simulation.state.pressure).unwrap();
    let iterations = records.iter().map(|record| record.iterations).collect();
    eprintln!("{overrides:?}: {iterations:?}");
    (iterations, pressure, gas.concat())
}

/// Largest difference as a share of how far the values lie apart.
fn difference(a: &[f32], b: &[f32]) -> f32 {
    let (low, high) = a.iter().fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / (high - low)
}

/// Ten cells of sound in a step: the same pressures in a tenth of the iterations, and equal bits on two runs.
#[test]
fn large_steps_cost_few_iterations() {
    let Some(gpu) = gpu_or_skip() else { return };
    let tolerance = "numerics.tolerance=1e-6";
    let (slow_block, fast_block) = ([&["numerics.expert.preconditioner=jacobi"], &BLOCK[..]].concat(), &BLOCK);
    let (slow_block, expected_block, _) = run(&gpu, &slow_block);
    let (fast_block, found_block, _) = run(&gpu, fast_block);
    let worst_block = difference(&expected_block, &found_block);
    eprintln!("with a stiff block pressures differ by {worst_block:.1e} of their range");
    assert!(slow_block.iter().zip(&fast_block).all(|(slow, fast)| *slow >= 3 * fast), "{slow_block:?} {fast_block:?}");
    assert!(worst_block < 2e-3, "{worst_block}");
    let (slow, expected, _) = run(&gpu, &["numerics.expert.preconditioner=jacobi", tolerance]);
    let (fast, found, gas) = run(&gpu, &[tolerance]);
    let (_, again, gas_again) = run(&gpu, &[tolerance]);
    let worst = difference(&expected, &found);
    eprintln!("pressures differ by {worst:.1e} of their range");
    assert!(slow.iter().all(|count| *count > 60) && fast.iter().all(|count| *count <= 15), "{slow:?} {fast:?}");
    assert!(worst < 2e-3, "{worst}");
    assert!(found.iter().zip(&again).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert!(gas.iter().zip(&gas_again).all(|(a, b)| a.to_bits() == b.to_bits()));
}

/// The same in space at C = 10 and 30, in gas and around a stiff block.
#[test]
fn large_steps_in_space_cost_few_iterations() {
    let Some(gpu) = gpu_or_skip() else { return };
    let common = [&["time.until=9.0", "numerics.tolerance=1e-6"], &SPACE[..]].concat();
    for (step, block, most, gain) in [
        ("time.fixed_step=0.528", false, 13, 3.0),
        ("time.fixed_step=1.58", false, 30, 3.0),
        ("time.fixed_step=0.528", true, 40, 1.3),
        ("time.fixed_step=1.58", true, 40, 1.3),
    ] {
        let case = [&common[..], &[step], if block { &BLOCK_IN_SPACE[..] } else { &[] }].concat();
        let of = |preconditioner: &str| run(&gpu, &[&case[..], &[preconditioner]].concat());
        let (slow, expected, _) = of("numerics.expert.preconditioner=jacobi");
        let (fast, found, _) = of("numerics.expert.preconditioner=multigrid");
        let worst = difference(&expected, &found);
        eprintln!("{step}, block {block}: pressures differ by {worst:.1e} of their range");
        let gains = slow.iter().zip(&fast).all(|(slow, fast)| f64::from(*slow) >= gain * f64::from(*fast));
        assert!(gains && fast.iter().all(|count| *count <= most), "{slow:?} {fast:?}");
        assert!(worst < 2e-3, "{worst}");
    }
}

/// Where sound crosses one cell in a step the levels are there and do nothing.
#[test]
fn small_steps_keep_their_bits() {
    let Some(gpu) = gpu_or_skip() else { return };
    for case in [&["time.fixed_step=0.0066"][..], &["time.fixed_step=0.0528", SPACE[0], SPACE[1]]] {
        let (iterations, expected, expected_gas) =
            run(&gpu, &[case, &["numerics.expert.preconditioner=jacobi"]].concat());
        let (same, found, gas) = run(&gpu, case);
        assert_eq!(iterations, same);
        assert!(expected.iter().zip(&found).all(|(a, b)| a.to_bits() == b.to_bits()));
        assert!(expected_gas.iter().zip(&gas).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}

/// The system of a scene at rest, which advection leaves as it is, from the gas that the device starts with.
fn system_at_rest(gpu: &Gpu, scene: &Scene, simulation: &Simulation) -> (Problem, Interface, System) {
    let problem = problem_of(scene);
    let inside =
        |x: [f64; 3]| !scene.bodies.is_empty() && x[..scene.domain.axes()].iter().all(|x| (x - 0.5).abs() < 0.15);
    let mut state = State::new(&problem, |_| (1.0, [0.0; 3], 1.0), lattice(&problem, 2, 10.0, inside));
    let density = readback::read(gpu, &simulation.state.gas.conserved).unwrap();
    let energy = readback::read(gpu, &simulation.state.gas.energy).unwrap();
    for slot in problem.grid.interior().into_iter().map(|c| problem.grid.slot(c)) {
        if state.cells[slot] == GAS {
            state.gas.set(slot, [f64::from(density[slot][0]), 0.0, 0.0, 0.0, f64::from(energy[slot])]);
        }
    }
    assembled(problem, state, scene.time.fixed_step.unwrap())
}

/// With a tolerance near 1 a solve ends before its first iteration and leaves the residual and what the preconditioner makes of it.
#[test]
fn the_device_applies_what_the_twin_does() {
    let Some(gpu) = gpu_or_skip() else { return };
    let dense =
        "gas.regions=[{ shape = { sphere = { center = [0.3, 0.6], radius = 0.15 } }, density = 4.0, pressure = 1.5 }]";
    let ends = ["boundary.x_min=periodic", "boundary.x_max=periodic"];
    let odd_ends = [ends[0], ends[1], "domain.cells=[47,47]"];
    let plane: [&[&str]; 6] = [
        &[],
        &["domain.cells=[47,33]", "domain.size=[1.0,0.7021276595744681]"],
        &ends,
        &odd_ends,
        &["numerics.pair=b2b1"],
        &BLOCK,
    ];
    let space: [&[&str]; 5] = [
        &[],
        &["domain.cells=[19,13,15]", "domain.size=[0.95,0.65,0.75]", ends[0], ends[1]],
        &["boundary.z_min=periodic", "boundary.z_max=periodic"],
        &["numerics.pair=b2b1"],
        &BLOCK_IN_SPACE,
    ];
    let always = "numerics.expert.preconditioner=multigrid";
    let common = ["time.fixed_step=0.17", "numerics.tolerance=0.999", always];
    let in_plane = [&common[..], &["domain.cells=[48,48]", dense]].concat();
    let (cells, dense) =
        (SPACE[0].replace("16", "20"), SPACE[1].replace("1.01", "1.5").replace("density = 1.0", "density = 4.0"));
    let in_space = [&common[..], &[&cells, &dense]].concat();
    let cases = plane.iter().map(|case| (&in_plane, *case)).chain(space.iter().map(|case| (&in_space, *case)));
    for (common, case) in cases {
        let overrides: Vec<String> = common.iter().chain(case).map(|&text| text.to_owned()).collect();
        let scene = Scene::parse(BOX, "box.toml", &overrides).unwrap_or_else(|error| panic!("{error}"));
        let plan = MemoryPlan::new(&scene, scene.seed_particles().len());
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        assert_eq!(plan.bytes(None), gpu.allocated_bytes(), "{case:?}");
        let (problem, faces, system) = system_at_rest(&gpu, &scene, &simulation);
        simulation.set_target(0.17).unwrap();
        simulation.advance_batch_of(&mut Vec::new(), 1).unwrap();
        let state = &simulation.state;
        let found = readback::read(&gpu, &state.pcg.direction).unwrap();
        let residual = readback::read(&gpu, &state.pcg.residual).unwrap();
        let slots = problem.grid.slots();
        let used = |slot: &usize| [*slot, Q * slots + *slot].into_iter().find(|at| system.diagonal[*at] > 0.0);
        let places: Vec<(usize, usize)> = (0..slots).filter_map(|slot| used(&slot).map(|at| (slot, at))).collect();
        let mut r = vec![0.0; system.diagonal.len()];
        places.iter().for_each(|(slot, at)| r[*at] = f64::from(residual[*slot]));
        let two = TwoSpaces::new(&problem, &faces, &system, Diagonals::Sums);
        let z = two.apply(&r, 4);
        let largest = places.iter().map(|(_, at)| z[*at].abs()).fold(0.0, f64::max);
        let differs = |(slot, at): &(usize, usize)| (f64::from(found[*slot]) - z[*at]).abs() / largest;
        let worst = places.iter().map(differs).fold(0.0, f64::max);
        let diagonal = two.apply(&r, 0);
        let alone = places.iter().map(|(_, at)| (z[*at] - diagonal[*at]).abs() / largest).fold(0.0, f64::max);
        let plain = places
            .iter()
            .map(|(slot, at)| (f64::from(found[*slot]) - diagonal[*at]).abs() / largest)
            .fold(0.0, f64::max);
        eprintln!("{case:?}: {} levels, worst {worst:.1e}, levels give {alone:.2} (device {plain:.2})", two.levels);
        assert!(two.levels >= 3 && worst < 3e-4 && alone > 0.1, "{case:?}: {worst}, {alone}");
    }
}
