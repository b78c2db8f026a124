//! Cut cells in scenes with bodies: obstacles act by their true surface, but where a body is near.

use brisance::expect::Budget;
use brisance::gpu::{Buffer, Extent, Gpu, Pass, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::state::{Over, State};

use crate::common::{Random, gpu_or_skip};

const RUBBER: &str = "[materials.rubber]\nneo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }\n";

fn parse(text: &str) -> Scene {
    Scene::parse(text, "cut_bodies.toml", &[]).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A closed box with an obstacle, of which no side lies along the grid, and a ball.
fn room(dimension: usize, cells: u32, ball: [f64; 3], velocity: [f64; 3], more: &str) -> String {
    let list = |values: &[f64]| format!("{:?}", &values[..dimension]);
    let obstacle = match dimension {
        2 => "polygon = { points = [[0.35, 0.29], [0.71, 0.43], [0.6, 0.72], [0.27, 0.6]] }",
        _ => "sphere = { center = [0.5, 0.53, 0.49], radius = 0.2 }",
    };
    format!(
        "title = \"room\"\n[domain]\ndimension = {dimension}\ncells = {:?}\nsize = {}\n[gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n\
         [[obstacles]]\nname = \"stone\"\nshape = {{ {obstacle} }}\n{RUBBER}[[bodies]]\nname = \"ball\"\nmaterial = \"rubber\"\n\
         density = 5.0\nvelocity = {}\nshape = {{ sphere = {{ center = {}, radius = 0.1 }} }}\n[time]\nuntil = 1.0\n{more}\n",
        vec![cells; dimension],
        list(&[1.0; 3]),
        list(&velocity),
        list(&ball),
    )
}

/// Cells that are cut still, and those that were at the start.
fn cut_cells(gpu: &Gpu, simulation: &Simulation, scene: &Scene) -> [usize; 2] {
    let words = readback::read(gpu, &simulation.state.interface.cells).unwrap();
    let marked = words.iter().filter(|word| **word >> 16 == 0xffff && **word & 3 == 0).count();
    [marked, scene.cut_geometry().cells.len()]
}

#[test]
fn rest_stays_rest_between_cut_and_whole_cells() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (dimension, cells, ball) in [(2, 24, [0.2, 0.24, 0.0]), (3, 14, [0.2, 0.3, 0.5])] {
        let scene = parse(&room(dimension, cells, ball, [0.0; 3], "fixed_step = 0.01"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let records = simulation.advance_to(1.0).unwrap_or_else(|error| panic!("{error}"));
        let [left, all] = cut_cells(&gpu, &simulation, &scene);
        assert!(0 < left && left < all, "{left} of {all} are cut");
        let fastest = records.iter().map(|record| record.gas_speed).fold(0.0, f32::max);
        assert!(fastest < 2e-6, "{dimension}D: {fastest:.1e}");
    }
}

#[test]
fn a_ball_that_hits_a_cut_obstacle_keeps_mass_momentum_and_energy() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (dimension, cells, until) in [(2, 32, 0.5), (3, 14, 0.3)] {
        let blast = "[[gas.regions]]\nshape = { half_space = { point = [0.15, 0.0], normal = [1.0, 0.0] } }\n\
            density = 2.0\npressure = 3.0\n";
        let blast = if dimension == 3 { blast.replace(", 0.0]", ", 0.0, 0.0]") } else { blast.to_owned() };
        let text = room(dimension, cells, [0.85, 0.8, 0.5], [-1.5, -0.9, 0.0], "") + &blast;
        let scene = parse(&text);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let start = Budget::read(&simulation, &scene, 0.0).unwrap();
        let [first, all] = cut_cells(&gpu, &simulation, &scene);
        let records = simulation.advance_to(until).unwrap_or_else(|error| panic!("{error}"));
        let [left, _] = cut_cells(&gpu, &simulation, &scene);
        assert!(left < first && first <= all && left > 0, "{left} of {first} of {all} are cut");
        let mut summary = brisance::expect::Summary::default();
        summary.add(&records);
        let end = Budget::read(&simulation, &scene, summary.stored_energy()).unwrap();
        let missing = end.over(&start).momentum.iter().map(|part| part.abs()).fold(0.0, f64::max);
        let drift = end.drift_since(&start);
        eprintln!("{dimension}D: {left} of {first} of {all} cut, momentum {missing:.1e} missing, {drift:?}");
        assert!(missing < 1e-6, "{missing:.1e}");
        assert!(drift["gas_mass"].abs() < 1e-6, "{drift:?}");
        assert!(drift["energy"].abs() < 2e-2, "{drift:?}");
        let gas = simulation.snapshot().unwrap();
        let least =
            gas.kind.iter().zip(&gas.pressure).filter(|(kind, _)| **kind == 0).map(|(_, p)| *p).fold(9.0, f32::min);
        assert!(least > 0.1, "{least}");
    }
}

/// Angle, pressure and density ratio of the shock of a stream at Mach 3 that a ramp turns by 15 degrees (NACA report 1135, 1953).
const EXACT: [f64; 3] = [32.240, 2.8216, 2.0324];

/// A ramp behind an oblique shock, and a disc that stands in the stream behind all of it: as in gas alone.
#[test]
fn a_ramp_is_as_in_gas_alone_with_a_body_elsewhere() {
    let Some(gpu) = gpu_or_skip() else { return };
    let state = "{ density = 1.4, velocity = [3.0, 0.0], pressure = 1.0 }";
    let scene = parse(&format!(
        "title = \"ramp\"\n[domain]\ndimension = 2\ncells = [80, 48]\nsize = [1.0, 0.6]\n[gas]\nambient = {state}\n\
             [boundary]\nx_min = {{ inlet = {state} }}\nx_max = \"outlet\"\ny_max = {{ inlet = {state} }}\n[[obstacles]]\nname = \"ramp\"\n\
             shape = {{ polygon = {{ points = [[0.1, 0.0], [0.1, -0.1], [1.1, -0.1], [1.1, 0.267949]] }} }}\n{RUBBER}[[bodies]]\n\
             name = \"disc\"\nshape = {{ sphere = {{ center = [0.94, 0.55], radius = 0.03 }} }}\nmaterial = \"rubber\"\ndensity = 50.0\n\
             motion = {{ velocity = [0.0, 0.0] }}\n[time]\nuntil = 0.6\n"
    ));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    simulation.advance_to(0.6).unwrap_or_else(|error| panic!("{error}"));
    let gas = simulation.snapshot().unwrap();
    let column = |x: usize| (0..48).map(move |y| x + 80 * y);
    let half = 0.5 * (1.0 + EXACT[1]) as f32;
    let mut points = Vec::new();
    let (mut density, mut pressure) = (Vec::new(), Vec::new());
    for x in 28..64 {
        let crossing =
            column(x).zip(column(x).skip(1)).find(|(a, b)| gas.pressure[*a] > half && gas.pressure[*b] <= half);
        let (a, b) = crossing.unwrap();
        let share = (gas.pressure[a] - half) / (gas.pressure[a] - gas.pressure[b]);
        points.push([x as f64, (a / 80) as f64 + f64::from(share)]);
        let wall = column(x).find(|cell| gas.pressure[*cell].is_finite() && gas.density[*cell] > 0.0).unwrap();
        density.push(f64::from(gas.density[wall]) / 1.4 / EXACT[2] - 1.0);
        pressure.push(f64::from(gas.pressure[wall]) / EXACT[1] - 1.0);
    }
    let mean = |k: usize| points.iter().map(|point| point[k]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let slope = points.iter().map(|[a, b]| (a - x) * (b - y)).sum::<f64>()
        / points.iter().map(|[a, _]| (a - x) * (a - x)).sum::<f64>();
    let off = slope.atan().to_degrees() - EXACT[0];
    let worst = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let (density, pressure) = (worst(&density), worst(&pressure));
    eprintln!("angle off {off:.3} degrees, density {density:.4}, pressure {pressure:.4}");
    assert!(off.abs() < 0.5 && density < 0.03 && pressure < 0.01, "{off} {density} {pressure}");
}

fn run(gpu: &Gpu, state: &State, over: Over, [shader, entry]: [&str; 2], renamed: &[(&str, &wgpu::Buffer)]) {
    let bound = state.bind(shader, entry, renamed, &[("SWEEP", f64::from(over as u32))]).unwrap();
    let mut pass = Pass::new(gpu, entry);
    pass.dispatch(&bound, &Extent::Threads(u64::from(state.params.slots)));
    pass.submit().unwrap();
}

/// Forces of pressures on nodes of mass 1, as rows of three, and rows of velocities at the unknowns, with dt = 1.
fn halves(gpu: &Gpu, state: &State, x: &[f32], velocity: &[[f32; 4]]) -> [Vec<f32>; 2] {
    let mut control = readback::read(gpu, &state.control).unwrap();
    control[0].dt = 1.0;
    state.control.write(gpu, 0, &control);
    let buffer = |name: &str, values: &[f32]| Buffer::from_slice(gpu, name, values).unwrap();
    let none = vec![0.0; x.len()];
    let (pressure, zero, y) = (buffer("x", x), buffer("stiffness", &none), buffer("y", &none));
    let work = Buffer::from_slice(gpu, "work", &vec![[0.0_f32, 0.0, 0.0, 1.0]; velocity.len()]).unwrap();
    let inertia = buffer("inertia", &vec![1.0; velocity.len() / 2]);
    let masses = buffer("energy", &vec![1.0; state.gas.energy.len()]);
    let named = [("x", pressure.raw()), ("work", work.raw()), ("inertia", inertia.raw()), ("energy", masses.raw())];
    for over in [Over::Interior, Over::Listed] {
        run(gpu, state, over, ["solve/solve_forces.wgsl", "solve_forces"], &named);
    }
    let forces = readback::read(gpu, &work).unwrap();
    work.write(gpu, 0, velocity);
    let named = [("x", zero.raw()), ("y", y.raw()), ("work", work.raw()), ("stiffness", zero.raw())];
    run(gpu, state, Over::Listed, ["solve/solve_operator.wgsl", "solve_operator"], &named);
    [forces.iter().flat_map(|force| force[..3].to_vec()).collect(), readback::read(gpu, &y).unwrap()]
}

/// Forces of random pressures on nodes and rows of random velocities: what one gives the other takes, cut and whole cells, gas and body.
#[test]
fn forces_and_rows_are_transposed() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (dimension, cells, ball) in [(2, 10, [0.12, 0.15, 0.0]), (3, 9, [0.12, 0.12, 0.12])] {
        let far = room(dimension, cells, ball, [0.0; 3], "fixed_step = 0.001")
            .replace("[0.5, 0.53, 0.49]", "[0.72, 0.75, 0.7]");
        let scene = parse(&far);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        simulation.set_target(1.0).unwrap();
        simulation.advance_batch_of(&mut Vec::new(), 1).unwrap();
        let state = &simulation.state;
        let words = readback::read(&gpu, &state.interface.cells).unwrap();
        let extra = readback::read(&gpu, &state.interface.extra).unwrap();
        let slots = words.len();
        let length = slots + 2 * state.params.extra_capacity as usize;
        let mut random = Random(7);
        // unknowns of listed vertices
        let mut used = vec![false; length];
        for &slot in &extra[slots..slots + extra[2 * slots] as usize] {
            used[slot as usize] = true;
            let place = extra[slot as usize];
            if place == u32::MAX {
                continue;
            }
            used[slots + place as usize] = true;
            used[slots + (length - slots) / 2 + place as usize] = true;
        }
        let x: Vec<f32> = used.iter().map(|used| if *used { random.between(-1.0, 1.0) } else { 0.0 }).collect();
        let mut velocity: Vec<[f32; 4]> = (0..2 * slots)
            .map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0), 1.0])
            .collect();
        // cells that share one state have one velocity, and count once
        let mut once = vec![true; 2 * slots];
        let geometry = scene.cut_geometry();
        let slot_of = |place: usize| state.grid.slot(geometry.cells[place].cell.map(|c| c as i32));
        let cut = |place: usize| words[slot_of(place)] >> 16 == 0xffff && words[slot_of(place)] & 3 == 0;
        let mut joined = 0;
        for cluster in geometry.clusters.iter().filter(|cluster| cut(cluster[0])) {
            for &member in &cluster[1..] {
                velocity[slot_of(member)] = velocity[slot_of(cluster[0])];
                once[slot_of(member)] = false;
                joined += 1;
            }
        }
        let [forces, rows] = halves(&gpu, state, &x, &velocity);
        let nodes = (0..2 * slots).filter(|node| once[*node]);
        let dot =
            |node: usize| (0..3).map(|d| f64::from(forces[3 * node + d]) * f64::from(velocity[node][d])).sum::<f64>();
        let [by_nodes, size] = nodes.fold([0.0, 0.0], |[sum, size], node| [sum + dot(node), size + dot(node).abs()]);
        let by_rows: f64 = (0..length).filter(|at| used[*at]).map(|at| f64::from(x[at]) * f64::from(rows[at])).sum();
        let whole = geometry.cells.len() - (0..geometry.cells.len()).filter(|place| cut(*place)).count();
        eprintln!("{dimension}D: {joined} joined, {whole} whole: {by_nodes} {by_rows}");
        assert!(joined > 0 && whole > 0, "{joined} joined, {whole} whole");
        assert!((by_nodes - by_rows).abs() < 1e-6 * size, "{dimension}D: {by_nodes} {by_rows} of {size}");
    }
}
