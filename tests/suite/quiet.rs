//! Quiet stays quiet: noise on gas at rest in a closed box.

use brisance::gpu::{Gpu, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::{Random, gpu_or_skip};
use crate::reference_exact::radial_density;

/// A scene whose gas has another density, velocity and pressure in every cell.
pub(crate) fn disturbed(gpu: &Gpu, text: &str, state: fn(&mut Random, usize) -> (f32, [f32; 3], f32)) -> Simulation {
    let scene = Scene::parse(text, "noise.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let simulation = Simulation::new(gpu, &scene).unwrap();
    let mut flow = readback::read(gpu, &simulation.state.gas.conserved).unwrap();
    let mut energy = readback::read(gpu, &simulation.state.gas.energy).unwrap();
    let mut random = Random(7);
    for (u, e) in flow.iter_mut().zip(&mut energy).filter(|(u, _)| u[0] > 0.0) {
        let (density, v, pressure) = state(&mut random, scene.domain.axes());
        *u = [density, density * v[0], density * v[1], density * v[2]];
        *e = pressure / 0.4 + 0.5 * density * v.iter().map(|v| v * v).sum::<f32>();
    }
    simulation.state.gas.conserved.write(gpu, 0, &flow);
    simulation.state.gas.energy.write(gpu, 0, &energy);
    simulation
}

/// A scene of gas at rest with rho = p = 1, and noise of 1e-3 on density, pressure and, over c, every velocity component.
pub(crate) fn noisy(gpu: &Gpu, text: &str) -> Simulation {
    disturbed(gpu, text, |random, axes| {
        let mut next = || random.between(-1e-3, 1e-3);
        let (density, pressure) = (1.0 + next(), 1.0 + next());
        let mut v = [0.0; 3];
        v[..axes].iter_mut().for_each(|v| *v = next() * 1.4_f32.sqrt());
        (density, v, pressure)
    })
}

/// Largest |dp|/p and |u|/c after steps of s dx/c, from noise of 1e-3 on density, pressure and every velocity component;
/// and the mean number of iterations.
pub(crate) fn noise(gpu: &Gpu, dimension: usize, cells: u32, s: f64, steps: u32, numerics: &str) -> [f64; 3] {
    let list = |value: String| vec![value; dimension].join(", ");
    let sound = 1.4_f64.sqrt();
    let step = s / f64::from(cells) / sound;
    let text = format!(
        "title = \"noise\"\n[domain]\ndimension = {dimension}\ncells = [{}]\nsize = [{}]\n\
         [gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n[time]\nuntil = 1e3\nfixed_step = {step:e}\n[numerics]\n{numerics}",
        list(cells.to_string()),
        list("1.0".to_owned()),
    );
    let mut simulation = noisy(gpu, &text);
    let records = simulation.advance_to(step * f64::from(steps)).unwrap_or_else(|error| panic!("s = {s}: {error}"));
    let last = records.last().unwrap();
    let pressure = f64::from((last.pressure[1] - 1.0).max(1.0 - last.pressure[0]));
    let iterations = records.iter().map(|r| f64::from(r.iterations)).sum::<f64>() / records.len() as f64;
    [pressure, f64::from(last.gas_speed) / sound, iterations]
}

/// Even gas at rest, with a density and pressure of no round number, keeps every bit: no sum of the scheme leaves its rounding behind.
#[test]
fn even_gas_at_rest_keeps_its_bits() {
    let Some(gpu) = gpu_or_skip() else { return };
    let cases = [
        ("dimension = 1\ncells = [70]\nsize = [0.7]\n", ""),
        ("dimension = 2\ncells = [37, 21]\nsize = [0.37, 0.21]\n", ""),
        ("dimension = 2\ncells = [37, 21]\nsize = [0.37, 0.21]\n", "[numerics]\nintegrator = \"ars222\"\n"),
        ("dimension = 2\ncells = [37, 21]\nsize = [0.37, 0.21]\n", "[numerics]\npair = \"b2b1\"\n"),
        ("dimension = 3\ncells = [13, 11, 14]\nsize = [0.13, 0.11, 0.14]\n", ""),
        ("dimension = 3\ncells = [13, 11, 14]\nsize = [0.13, 0.11, 0.14]\n", "[numerics]\npair = \"b2b1\"\n"),
        (
            "dimension = 3\ncells = [13, 11, 14]\nsize = [0.13, 0.11, 0.14]\n",
            "[boundary]\nx_min = \"periodic\"\nx_max = \"periodic\"\n",
        ),
    ];
    for (domain, rest) in cases {
        let text = format!(
            "title = \"even\"\n[domain]\n{domain}[gas]\nambient = {{ density = 1.2345, pressure = 0.7654321 }}\n{rest}\
             [time]\nuntil = 1.0\nfixed_step = 0.02\n"
        );
        let scene = Scene::parse(&text, "even.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let before = simulation.snapshot().unwrap();
        let records = simulation.advance_to(0.2).unwrap_or_else(|error| panic!("{domain}{rest}: {error}"));
        let after = simulation.snapshot().unwrap();
        let fastest = records.iter().fold(0.0_f32, |most, record| most.max(record.gas_speed));
        eprintln!("{fastest:.1e}: {}", domain.lines().next().unwrap());
        assert!(fastest == 0.0, "{domain}{rest}: {fastest:e}");
        assert_eq!((before.density, before.energy), (after.density, after.energy), "{domain}{rest}");
    }
}

fn print(title: &str, s: f64, [pressure, speed, iterations]: [f64; 3]) {
    eprintln!("{title:28} s {s:4}: |dp|/p {pressure:.1e}, |u|/c {speed:.1e}, {iterations:.1} iterations");
}

#[test]
fn rest_noise_does_not_grow_by_default() {
    let Some(gpu) = gpu_or_skip() else { return };
    let two = "integrator = \"ars222\"\n";
    let wide = "pair = \"b2b1\"\n";
    for (dimension, cells, s, steps, numerics) in [
        (2, 32, 0.5, 150, ""),
        (2, 32, 5.0, 100, ""),
        (3, 12, 2.0, 60, ""),
        (2, 32, 20.0, 100, ""),
        (3, 12, 20.0, 60, ""),
        (3, 12, 20.0, 60, two),
        (1, 128, 20.0, 100, two),
        (2, 32, 5.0, 100, two),
        (3, 12, 5.0, 60, two),
        (1, 128, 5.0, 100, wide),
        (2, 32, 5.0, 100, wide),
        (3, 12, 5.0, 60, wide),
        (2, 32, 20.0, 100, wide),
    ] {
        let found = noise(&gpu, dimension, cells, s, steps, numerics);
        print(&format!("{dimension}D {cells} {}", numerics.trim()), s, found);
        let most = if dimension == 3 && numerics == wide { 4e-3 } else { 2e-3 };
        assert!(found[0] < most, "{dimension}D, {numerics} s = {s}: {found:?}");
    }
    let [with, without] = ["", "filter = 0.0\n"].map(|filter| noise(&gpu, 3, 12, 20.0, 60, filter));
    print("without the filter, 3D 12", 20.0, without);
    assert!(with[0] < 0.7 * without[0], "long steps do not need the filter: {with:?} {without:?}");
    let short = ["", "filter = 0.0\n"].map(|filter| noise(&gpu, 2, 16, 5.0, 10, filter));
    assert_eq!(short[0], short[1], "shorter steps are filtered");
    for pair in ["", wide] {
        let cell = noise(&gpu, 2, 32, 5.0, 100, &format!("{pair}paper.face_velocity = \"cell\"\n"));
        print(&format!("cell, 2D 32 {}", pair.trim()), 5.0, cell);
        assert!(cell[0] > 1e-2, "the velocity of the cells is quiet too, then the carrier is not needed: {cell:?}");
    }
}

/// Gas at rest whose density and pressure alternate from cell to cell, without sides: amplitude of the mode and relative change of mass
/// and energy after steps of a given length.
fn alternating(gpu: &Gpu, [step, count]: [f64; 2], numerics: &str) -> [f64; 3] {
    let text = format!(
        "title = \"mode\"\n[domain]\ndimension = 2\ncells = [16, 16]\nsize = [1.0, 1.0]\n\
         [gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n\
         [boundary]\nx_min = \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"\n\
         [time]\nuntil = 100.0\nfixed_step = {step:e}\n[numerics]\n{numerics}"
    );
    let scene = Scene::parse(&text, "mode.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    let grid = simulation.state.grid;
    let sign = |x: i32, y: i32| if (x + y) % 2 == 0 { 1.0 } else { -1.0 };
    let mut flow = readback::read(gpu, &simulation.state.gas.conserved).unwrap();
    let mut energy = readback::read(gpu, &simulation.state.gas.energy).unwrap();
    for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
        let factor = 1.0 + 0.1 * sign(x, y) as f32;
        flow[grid.slot([x, y, 0])][0] *= factor;
        energy[grid.slot([x, y, 0])] *= factor;
    }
    simulation.state.gas.conserved.write(gpu, 0, &flow);
    simulation.state.gas.energy.write(gpu, 0, &energy);
    let sums = |simulation: &Simulation| {
        let snapshot = simulation.snapshot().unwrap();
        let sum = |values: &[f32]| values.iter().map(|v| f64::from(*v)).sum::<f64>();
        let cells = (0..16).flat_map(|y| (0..16).map(move |x| (x, y)));
        let mode: f64 = cells.map(|(x, y)| sign(x, y) * f64::from(snapshot.pressure[(x + 16 * y) as usize])).sum();
        [mode, sum(&snapshot.density), sum(&snapshot.energy)]
    };
    let before = sums(&simulation);
    simulation.advance_to(count * step).unwrap();
    let after = sums(&simulation);
    [after[0] / before[0], (after[1] / before[1] - 1.0).abs(), (after[2] / before[2] - 1.0).abs()]
}

/// The solve does not see the mode, and nothing carries it away: without the filter it stays for ever, at any step.
#[test]
fn only_the_filter_removes_the_alternating_mode_and_it_conserves() {
    let Some(gpu) = gpu_or_skip() else { return };
    // sound crosses 7e-5 cells in a step, or one
    for (share, steps) in [(0.0, [4e-6, 4.0]), (0.3, [4e-6, 4.0]), (0.0, [0.05, 200.0]), (0.1, [0.05, 200.0])] {
        let [left, mass, energy] = alternating(&gpu, steps, &format!("filter = {share}\n"));
        eprintln!("filter {share}, {steps:?}: {left:.1e} of the mode left, mass {mass:.1e}, energy {energy:.1e}");
        assert!((left - (1.0_f64 - share).powf(steps[1])).abs() < 2e-3, "filter {share}: {left}");
        assert!(mass < 3e-8 && energy < 1e-7, "{mass:e}, {energy:e}");
    }
}

/// One full cell in gas a thousand times thinner: the mean of the cells around a vertex alternates there by more than the thin ones have.
#[test]
fn the_filter_empties_no_cell() {
    let text = "title = \"spot\"\n[domain]\ndimension = 2\ncells = [9, 9]\nsize = [9.0, 9.0]\n\
                [gas]\nambient = { density = 1e-3, pressure = 1e-3 }\n[[gas.regions]]\ndensity = 1.0\npressure = 1.0\n\
                shape = { box = { center = [4.5, 4.5], size = [1.0, 1.0] } }\n[time]\nuntil = 1.0\nfixed_step = 1e-4\n[numerics]\nfilter = 1.0\n";
    let Some(gpu) = gpu_or_skip() else { return };
    let mut simulation = Simulation::new(&gpu, &Scene::parse(text, "spot.toml", &[]).unwrap()).unwrap();
    simulation.advance_to(2e-4).unwrap();
    assert!(simulation.snapshot().unwrap().pressure.iter().all(|p| *p > 5e-4));
}

/// Two cold streams that collide: the limiter keeps the pressure positive.
#[test]
fn cold_colliding_streams_stay_positive() {
    let Some(gpu) = gpu_or_skip() else { return };
    for face in ["cell", "consistent"] {
        let text = format!(
            "title = \"streams\"\n[domain]\ndimension = 1\ncells = [200]\nsize = [1.0]\n\
             [gas]\ngamma = 1.6666666666666667\nambient = {{ density = 1.0, velocity = [-1.0], pressure = 1e-6 }}\n\
             [[gas.regions]]\nshape = {{ half_space = {{ point = [0.5], normal = [1.0] }} }}\n\
             density = 1.0\nvelocity = [1.0]\npressure = 1e-6\n\
             [boundary]\nx_min = \"outlet\"\nx_max = \"outlet\"\n[time]\nuntil = 0.6\n[numerics]\npaper.face_velocity = \"{face}\"\n"
        );
        let scene = Scene::parse(&text, "streams.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let records =
            Simulation::new(&gpu, &scene).unwrap().advance_to(0.6).unwrap_or_else(|error| panic!("{face}: {error}"));
        let limited: u32 = records.iter().map(|r| r.limited).sum();
        let floored: u32 = records.iter().map(|r| r.floored).sum();
        let lowest = records.iter().map(|r| r.pressure[0]).fold(f32::INFINITY, f32::min);
        eprintln!("{face}: {} steps, {limited} limited, {floored} floored, lowest pressure {lowest:e}", records.len());
        assert!(limited > 0 && lowest > 0.0, "{limited} limited, {lowest:e}");
    }
}

/// Cold gas runs into a wall: limited faces beside unlimited ones.
#[test]
fn cold_gas_at_a_wall_stays_positive_with_both_pairs() {
    let Some(gpu) = gpu_or_skip() else { return };
    for pair in ["b1b0", "b2b1"] {
        let text = format!(
            "title = \"wall\"\n[domain]\ndimension = 1\ncells = [400]\nsize = [1.0]\n\
             [gas]\nambient = {{ density = 1.0, velocity = [-1.0], pressure = 1e-6 }}\n\
             [boundary]\nx_max = \"outlet\"\n[time]\nuntil = 0.06\n[numerics]\npair = \"{pair}\"\n"
        );
        let scene = Scene::parse(&text, "wall.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let records = Simulation::new(&gpu, &scene).unwrap().advance_to(0.06);
        let records = records.unwrap_or_else(|error| panic!("{pair}: {error}"));
        let limited: u32 = records.iter().map(|record| record.limited).sum();
        eprintln!("{pair}: {} steps, {limited} limited", records.len());
        assert!(limited > 0, "{pair}: the limiter has nothing to do");
    }
}

/// Cold gas with a random velocity in every cell.
#[test]
fn cold_random_flow_stays_positive_in_every_dimension() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (dimension, cells, numerics) in
        [(1, 256, ""), (1, 256, "pair = \"b2b1\""), (2, 24, ""), (2, 24, "pair = \"b2b1\""), (3, 10, "")]
    {
        let list = |value: String| vec![value; dimension].join(", ");
        let text = format!(
            "title = \"cold\"\n[domain]\ndimension = {dimension}\ncells = [{}]\nsize = [{}]\n\
             [gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n[time]\nuntil = 1.0\n[numerics]\n{numerics}\n",
            list(cells.to_string()),
            list("1.0".to_owned()),
        );
        let mut simulation = disturbed(&gpu, &text, |random, axes| {
            let density = random.between(0.1, 1.0);
            let mut velocity = [0.0; 3];
            velocity[..axes].iter_mut().for_each(|v| *v = random.between(-1.0, 1.0));
            (density, velocity, 1e-3 * density)
        });
        let mut records = Vec::new();
        let until = 2.0 / f64::from(cells);
        simulation.set_target(until).unwrap();
        while !simulation.advance_batch(&mut records).unwrap_or_else(|error| panic!("{dimension}D {numerics}: {error}"))
        {
        }
        let limited: u32 = records.iter().map(|record| record.limited).sum();
        eprintln!("{dimension}D {numerics}: {} steps, {limited} limited", records.len());
        assert!(limited > 0, "{dimension}D: the limiter has nothing to do");
        let masses = [records[0].gas.mass, records[records.len() - 1].gas.mass].map(f64::from);
        assert!(
            (masses[1] / masses[0] - 1.0).abs() < 1e-6,
            "{dimension}D {numerics}: limited fluxes lose mass: {masses:?}"
        );
    }
}

/// Asks for times that are alternately near and far: steps of 1 and 19 dx/c in turn would blow up.
#[test]
fn short_and_long_steps_in_turn_stay_quiet() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"turns\"\n[domain]\ndimension = 2\ncells = [24, 24]\nsize = [24.0, 24.0]\n\
        [gas]\nambient = { density = 1.0, pressure = 1.0 }\n[time]\nuntil = 1e3\nmax_courant = 20.0\n";
    let mut simulation = noisy(&gpu, text);
    let (mut time, mut worst) = (0.0, 0.0_f32);
    for turn in 0..24 {
        time += if turn % 2 == 0 { 1.0 } else { 19.0 } / 1.4_f64.sqrt();
        for record in simulation.advance_to(time).unwrap_or_else(|error| panic!("turn {turn}: {error}")) {
            worst = worst.max(record.pressure[1] - 1.0).max(1.0 - record.pressure[0]);
        }
    }
    eprintln!("{} steps, |dp|/p {worst:.1e}", simulation.step_count());
    assert!(worst < 1e-2, "{worst:e}");
}

#[test]
#[ignore = "minutes: the table of docs/notes/noise_at_rest.md"]
fn rest_noise_table() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (dimension, cells) in [(1, 128), (2, 32), (3, 16)] {
        for s in [0.5, 2.0, 5.0, 20.0] {
            for numerics in ["", "integrator = \"ars222\"\n", "pair = \"b2b1\"\n", "paper.face_velocity = \"cell\"\n"] {
                let found = noise(&gpu, dimension, cells, s, 300, numerics);
                print(&format!("{dimension}D {cells} {}", numerics.trim()), s, found);
                let most = if dimension == 3 && numerics.contains("b2b1") { 4e-3 } else { 2e-3 };
                assert!(numerics.contains("cell") || found[0] < most, "{dimension}D, {numerics} s = {s}: {found:?}");
            }
        }
    }
}

/// L1 error of the density of a round explosion against the radial solution.
fn round_error(gpu: &Gpu, dimension: usize, cells: u32, numerics: &str) -> f64 {
    let list = |value: &str| vec![value; dimension].join(", ");
    let text = format!(
        "title = \"round\"\n[domain]\ndimension = {dimension}\ncells = [{}]\nsize = [{}]\n\
         [gas]\nambient = {{ density = 0.125, pressure = 0.1 }}\n\
         [[gas.regions]]\nshape = {{ sphere = {{ center = [{}], radius = 0.4 }} }}\ndensity = 1.0\npressure = 1.0\n\
         [time]\nuntil = 0.25\n[numerics]\n{numerics}",
        list(&cells.to_string()),
        list("1.0"),
        list("0.0"),
    );
    let scene = Scene::parse(&text, "round.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    simulation.advance_to(0.25).unwrap();
    let density = simulation.snapshot().unwrap().density;
    let reference = radial_density(2000, 1.8, dimension as i32 - 1, 0.25);
    let side = cells as usize;
    let difference = |(i, found): (usize, &f32)| {
        let at = [i % side, i / side % side, i / (side * side)];
        let square: f64 = at[..dimension].iter().map(|k| ((*k as f64 + 0.5) / side as f64).powi(2)).sum();
        let place = square.sqrt() / 1.8 * 2000.0 - 0.5;
        let low = place.floor().max(0.0) as usize;
        let exact = reference[low] + (place - low as f64) * (reference[low + 1] - reference[low]);
        (f64::from(*found) - exact).abs()
    };
    density.iter().enumerate().map(difference).sum::<f64>() / density.len() as f64
}

#[test]
#[ignore = "a minute: the table of docs/notes/face_velocity.md"]
fn round_explosions() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (dimension, cells) in [(2, 32), (2, 64), (2, 128), (3, 32), (3, 48)] {
        let error = |face: &str| round_error(&gpu, dimension, cells, &format!("paper.face_velocity = \"{face}\"\n"));
        let [cell, consistent] = [error("cell"), error("consistent")];
        eprintln!("{dimension}D {cells} cells per unit: L1 {cell:.5} cell, {consistent:.5} consistent");
        assert!(consistent < cell, "{consistent} {cell}");
    }
}

/// Gas colder than any that was there is warmed to a tenth of the least entropy, and the cells are counted.
#[test]
fn no_gas_is_colder_than_any_that_was_there() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"cold\"\n[domain]\ndimension = 1\ncells = [40]\nsize = [1.0]\n[gas]\nambient = { density = 1.0, pressure = 1.0 }\n\
                [time]\nuntil = 1.0\nfixed_step = 1e-7\n";
    let mut simulation = disturbed(&gpu, text, |random, _| (random.between(0.1, 1.0), [0.0; 3], 1e-6));
    let records = simulation.advance_to(1e-7).unwrap_or_else(|error| panic!("{error}"));
    let found = simulation.snapshot().unwrap();
    let entropies = found.pressure.iter().zip(&found.density).map(|(p, density)| p / density.powf(1.4));
    assert!(entropies.map(|s| (s / 0.1 - 1.0).abs()).fold(0.0, f32::max) < 1e-3);
    let last = records.last().unwrap();
    assert_eq!(last.floored, 40);
    // and the heat is in the budgets
    let [gas, owed] = [last.gas.energy, last.owed.energy].map(f64::from);
    eprintln!("{gas:e} J of gas, {owed:e} J owed");
    assert!(owed < -0.1 * gas && (gas + owed - 1e-6 / 0.4).abs() < 1e-6 * gas, "{gas:e} and {owed:e}");
}

/// A cell that a step leaves less than a tenth of its internal energy, and nothing colder: `fluid_energy` has to call for the floor
/// by that alone.
#[test]
fn a_tenth_of_the_internal_energy_is_left() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"torn\"\n[domain]\ndimension = 1\ncells = [40]\nsize = [1.0]\n[gas]\nambient = { density = 1.0, pressure = 1e-9 }\n\
                [time]\nuntil = 1.0\nfixed_step = 3.8e-3\n";
    let mut simulation = disturbed(&gpu, text, |random, _| (1.0, [random.between(-3.0, 3.0), 0.0, 0.0], 0.1));
    let records = simulation.advance_to(3.8e-3).unwrap_or_else(|error| panic!("{error}"));
    let (floored, lowest) = (records[0].floored, records[0].pressure[0]);
    eprintln!("{floored} floored, lowest pressure {lowest:e}");
    assert!(floored > 0 && lowest > 5e-3, "{floored} floored, {lowest:e}");
}

/// Behind a strong shock the second of two solves may start from gas without internal energy. Its pressure is raised, and such cells are counted.
#[test]
fn pressures_raised_before_a_solve_are_counted() {
    let Some(gpu) = gpu_or_skip() else { return };
    let raised = |path: &str, integrator: &str| {
        let scene = Scene::shipped(path, &[format!("numerics.integrator={integrator}")]).unwrap();
        let records = Simulation::new(&gpu, &scene).unwrap().advance_to(scene.time.until).unwrap();
        records.iter().map(|record| record.raised).sum::<u32>()
    };
    let found = [
        raised("gas/high_mach.toml", "ars222"),
        raised("gas/sod.toml", "ars222"),
        raised("gas/high_mach.toml", "predictor"),
    ];
    eprintln!("raised, high Mach and Sod with two solves, high Mach with one: {found:?}");
    assert!(found[0] > 0 && found[1..] == [0, 0], "{found:?}");
}
