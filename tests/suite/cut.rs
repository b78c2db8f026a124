//! Cut cells: obstacles by their true surface.

use brisance::diagnostics::StepRecord;
use brisance::expect::Budget;
use brisance::gpu::{Gpu, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::snapshot::Snapshot;

use crate::common::gpu_or_skip;
use crate::quiet::noisy;

fn parse(text: &str) -> Scene {
    Scene::parse(text, "cut.toml", &[]).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn run(gpu: &Gpu, text: &str) -> (Snapshot, Vec<StepRecord>) {
    let scene = parse(text);
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    let records = simulation.advance_to(scene.time.until).unwrap_or_else(|error| panic!("{error}"));
    (simulation.snapshot().unwrap(), records)
}

/// A polygon turned by an angle about its middle, as a shape.
fn turned_square(center: [f64; 2], half: f64, degrees: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let place = |[x, y]: [f64; 2]| [center[0] + cos * x - sin * y, center[1] + sin * x + cos * y];
    format!("{{ polygon = {{ points = {:?} }} }}", corners.map(place))
}

/// A closed box with an obstacle, and more lines.
fn closed_box(cells: u32, shape: &str, until: f64, more: &str) -> String {
    format!(
        "title = \"box\"\n[domain]\ndimension = 2\ncells = [{cells}, {cells}]\nsize = [1.0, 1.0]\n\
         [[obstacles]]\nname = \"o\"\nshape = {shape}\n[time]\nuntil = {until:?}\n{more}\n[gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n"
    )
}

#[test]
fn shares_apertures_and_clusters_fill_the_box() {
    let text = closed_box(24, "{ sphere = { center = [0.48, 0.51], radius = 0.27 } }", 1.0, "");
    let geometry = parse(&text).cut_geometry();
    let walls = geometry.walls.iter().filter(|wall| **wall).count() as f64;
    let lost: f64 = geometry.cells.iter().map(|cut| 1.0 - cut.part.volume).sum();
    let area = (walls + lost) / (24.0 * 24.0);
    let exact = std::f64::consts::PI * 0.27 * 0.27;
    assert!((area / exact - 1.0).abs() < 5e-3, "{area} {exact}");
    for cluster in &geometry.clusters {
        let together: f64 = cluster.iter().map(|&place| geometry.cells[place].part.volume).sum();
        assert!(together >= 0.5 && cluster.len() <= 4, "{cluster:?} {together}");
    }
    for cut in &geometry.cells {
        let twin = |offset: [i32; 2]| {
            let at = [cut.cell[0] as i32 + offset[0], cut.cell[1] as i32 + offset[1], 0].map(|n| n as u32);
            geometry.cells.iter().find(|other| other.cell == at)
        };
        let (right, above) = (twin([1, 0]), twin([0, 1]));
        let pairs = [(right, 1, 0), (above, 3, 2)];
        for (other, own, its) in pairs {
            let Some(other) = other else { continue };
            assert!((cut.part.apertures[own] - other.part.apertures[its]).abs() < 1e-12, "{cut:?} {other:?}");
        }
    }
    let aligned = closed_box(20, "{ box = { center = [0.5, 0.5], size = [0.4, 0.2] } }", 1.0, "");
    let aligned = parse(&aligned).cut_geometry();
    assert!(aligned.cells.is_empty(), "nothing is cut along the grid");
    assert_eq!(aligned.walls.iter().filter(|wall| **wall).count(), 8 * 4);
}

#[test]
fn a_stream_along_a_slanted_wall_is_left_alone() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (speed, degrees) in [(3.0_f64, 15.0_f64), (2.5, 35.0), (2.5, 50.0), (0.4, 15.0)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let state = format!("density = 1.0, velocity = [{:?}, {:?}], pressure = 1.0", speed * cos, speed * sin);
        let inlet = format!("{{ inlet = {{ {state} }} }}");
        let text = format!(
            "title = \"slope\"\n[domain]\ndimension = 2\ncells = [24, 24]\nsize = [1.0, 1.0]\n[gas]\nambient = {{ {state} }}\n\
             [boundary]\nx_min = {inlet}\nx_max = \"outlet\"\ny_max = \"outlet\"\n\
             [[obstacles]]\nname = \"o\"\nshape = {{ half_space = {{ point = [0.0, 0.107], normal = [{:?}, {:?}] }} }}\n\
             [time]\nuntil = 0.3\n[numerics]\ntolerance = 1e-7\n",
            -sin, cos
        );
        let (after, records) = run(&gpu, &text);
        let gas: Vec<usize> = (0..24 * 24).filter(|i| after.kind[*i] == 0).collect();
        let (u, v) = ((speed * cos) as f32, (speed * sin) as f32);
        let change = |i: usize| {
            let velocity = (after.velocity[i][0] - u).abs().max((after.velocity[i][1] - v).abs());
            velocity.max((after.pressure[i] - 1.0).abs()).max((after.density[i] - 1.0).abs())
        };
        let worst = gas.iter().map(|&i| change(i)).fold(0.0, f32::max);
        eprintln!("{speed} {degrees}: {worst:.1e} after {} steps", records.len());
        assert!(worst < 3e-5, "{speed} {degrees}: {worst:.1e}");
    }
}

/// The same in 3D: the wall leans along both axes beside the stream, and all its cells are cut differently.
#[test]
fn a_stream_along_a_slanted_wall_is_left_alone_in_3d() {
    let Some(gpu) = gpu_or_skip() else { return };
    let state = "density = 1.0, velocity = [3.0, 0.0, 0.9], pressure = 1.0";
    let text = format!(
        "title = \"slope\"\n[domain]\ndimension = 3\ncells = [8, 8, 8]\nsize = [1.0, 1.0, 1.0]\n[gas]\nambient = {{ {state} }}\n\
         [boundary]\nx_min = {{ inlet = {{ {state} }} }}\nx_max = \"outlet\"\nz_max = \"outlet\"\n\
         [[obstacles]]\nname = \"o\"\nshape = {{ half_space = {{ point = [0.0, 0.0, 0.107], normal = [-0.3, -0.2, 1.0] }} }}\n\
         [time]\nuntil = 0.2\n[numerics]\ntolerance = 1e-7\n"
    );
    let (after, _) = run(&gpu, &text);
    let gas = (0..512).filter(|i| after.kind[*i] == 0);
    let worst = gas.fold(0.0_f32, |most, i| most.max((after.pressure[i] - 1.0).abs()).max(after.velocity[i][1].abs()));
    assert!(worst < 1e-5, "{worst:.1e}");
}

#[test]
fn rest_beside_a_turned_square_stays_rest() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = closed_box(16, &turned_square([0.47, 0.52], 0.2, 27.0), 10.0, "fixed_step = 0.01");
    let (after, records) = run(&gpu, &text);
    assert_eq!(records.len(), 1000);
    let fastest = after.velocity.iter().flatten().filter(|u| u.is_finite()).fold(0.0_f32, |most, u| most.max(u.abs()));
    assert!(fastest < 1e-6, "{fastest:.1e}");
    let drift = records[999].gas.mass / records[0].gas.mass - 1.0;
    assert!(drift.abs() < 1e-6, "{drift:.1e}");
}

#[test]
fn a_blast_beside_a_turned_square_conserves_mass_and_energy() {
    let Some(gpu) = gpu_or_skip() else { return };
    let region = "[[gas.regions]]\nshape = { sphere = { center = [0.15, 0.2], radius = 0.12 } }\ndensity = 4.0\npressure = 8.0\n";
    let text = closed_box(24, &turned_square([0.47, 0.52], 0.2, 27.0), 0.5, "") + region;
    let (after, records) = run(&gpu, &text);
    let (first, last) = (&records[0], &records[records.len() - 1]);
    let drift = |a: f32, b: f32| (f64::from(b) / f64::from(a) - 1.0).abs();
    let (mass, energy) = (drift(first.gas.mass, last.gas.mass), drift(first.gas.energy, last.gas.energy));
    eprintln!("mass {mass:.1e}, energy {energy:.1e} after {} steps", records.len());
    assert!(mass < 1e-6 && energy < 2e-6, "{mass:.1e} {energy:.1e}");
    let share = parse(&text).cut_geometry();
    let volume: f64 = share.walls.iter().map(|wall| f64::from(u8::from(!wall))).sum::<f64>()
        - share.cells.iter().map(|cut| 1.0 - cut.part.volume).sum::<f64>();
    let initial = f64::from(first.gas.mass);
    let exact = volume / 576.0 + 3.0 * std::f64::consts::PI * 0.12 * 0.12;
    assert!((initial / exact - 1.0).abs() < 0.01, "{initial} {exact}");
    assert!(after.pressure.iter().all(|p| p.is_nan() || *p > 0.0));
}

#[test]
fn a_mirrored_obstacle_gives_a_mirrored_flow() {
    let Some(gpu) = gpu_or_skip() else { return };
    let cells = 24;
    let flow = |sign: f64| {
        let place = |x: f64| 0.5 + sign * (x - 0.5);
        let region = format!(
            "[[gas.regions]]\nshape = {{ sphere = {{ center = [{:?}, 0.2], radius = 0.12 }} }}\ndensity = 4.0\npressure = 8.0\n",
            place(0.15)
        );
        let obstacle = turned_square([place(0.47), 0.52], 0.2, 27.0 * sign);
        run(&gpu, &(closed_box(cells, &obstacle, 0.25, "") + &region)).0
    };
    let (left, right) = (flow(1.0), flow(-1.0));
    let mut worst = 0.0_f32;
    for y in 0..cells as usize {
        for x in 0..cells as usize {
            let (i, j) = (x + cells as usize * y, cells as usize - 1 - x + cells as usize * y);
            assert_eq!(left.kind[i], right.kind[j], "{x} {y}");
            if left.kind[i] == 0 {
                worst = worst.max((left.pressure[i] - right.pressure[j]).abs());
                worst = worst.max((left.velocity[i][0] + right.velocity[j][0]).abs());
            }
        }
    }
    eprintln!("mirror: {worst:.1e}");
    assert!(worst < 1e-5, "{worst:.1e}");
}

/// Gives every cluster the state of its first cell.
fn join_clusters(gpu: &Gpu, text: &str, simulation: &Simulation) {
    let geometry = parse(text).cut_geometry();
    let slot = |place: usize| simulation.state.grid.slot(geometry.cells[place].cell.map(|c| c as i32));
    let gas = &simulation.state.gas;
    let flow = readback::read(gpu, &gas.conserved).unwrap();
    let energy = readback::read(gpu, &gas.energy).unwrap();
    for cluster in &geometry.clusters {
        for &member in cluster {
            gas.conserved.write(gpu, slot(member), &[flow[slot(cluster[0])]]);
            gas.energy.write(gpu, slot(member), &[energy[slot(cluster[0])]]);
        }
    }
}

#[test]
fn noise_beside_a_turned_square_does_not_grow() {
    let Some(gpu) = gpu_or_skip() else { return };
    for courant in [0.5, 2.0] {
        let step = courant / 24.0 / 1.4_f64.sqrt();
        let text = closed_box(24, &turned_square([0.47, 0.52], 0.2, 27.0), 1e3, &format!("fixed_step = {step:e}"));
        let mut simulation = noisy(&gpu, &text);
        join_clusters(&gpu, &text, &simulation);
        let records = simulation.advance_to(step * 150.0).unwrap_or_else(|error| panic!("{error}"));
        let last = records.last().unwrap();
        let found = (last.pressure[1] - 1.0).max(1.0 - last.pressure[0]);
        eprintln!("s = {courant}: |dp|/p {found:.1e}, |u| {:.1e}", last.gas_speed);
        assert!(found < 2e-3, "{found:.1e}");
    }
}

#[test]
fn the_budget_counts_the_gas_that_an_obstacle_leaves_in_a_cell() {
    let Some(gpu) = gpu_or_skip() else { return };
    let state = "density = 1.4, velocity = [2.0, 0.0], pressure = 1.0";
    let scene = parse(&format!(
        "title = \"disc\"\n[domain]\ndimension = 2\ncells = [24, 24]\nsize = [1.0, 1.0]\n[gas]\nambient = {{ {state} }}\n\
         [boundary]\nx_min = {{ inlet = {{ {state} }} }}\nx_max = \"outlet\"\n\
         [[obstacles]]\nname = \"o\"\nshape = {{ sphere = {{ center = [0.53, 0.47], radius = 0.2 }} }}\n\
         [time]\nuntil = 0.1\n"
    ));
    assert!(!scene.cut_geometry().cells.is_empty());
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let start = Budget::read(&simulation, &scene, 0.0).unwrap();
    simulation.advance_to(0.1).unwrap();
    let drift = Budget::read(&simulation, &scene, 0.0).unwrap().drift_since(&start);
    assert!(drift["gas_mass"].abs() < 1e-6 && drift["energy"].abs() < 1e-6, "{drift:?}");
}

/// A stream around an obstacle in periodic space, until t = 0.2: density and how much of the mass is missing.
fn periodic_stream(gpu: &Gpu, shape: &str) -> (Vec<f32>, f64) {
    let sides = "[boundary]\nx_min = \"periodic\"\nx_max = \"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"";
    let still = closed_box(24, shape, 0.2, sides);
    let scene = parse(&still.replace("density = 1.0,", "density = 1.0, velocity = [2.0, 1.0],"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    let start = Budget::read(&simulation, &scene, 0.0).unwrap();
    simulation.advance_to(scene.time.until).unwrap_or_else(|error| panic!("{error}"));
    let end = Budget::read(&simulation, &scene, 0.0).unwrap();
    (simulation.snapshot().unwrap().density, (end.gas_mass / start.gas_mass - 1.0).abs())
}

/// What reaches beyond a periodic side goes on at the other end: the same as half a domain away.
#[test]
fn an_obstacle_across_a_periodic_side_is_whole() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (at_the_corner, in_the_middle) in [
        ("{ sphere = { center = [0.0, 1.0], radius = 0.2 } }", "{ sphere = { center = [0.5, 0.5], radius = 0.2 } }"),
        (
            "{ box = { center = [1.0, 0.0], size = [0.37, 0.23] } }",
            "{ box = { center = [0.5, 0.5], size = [0.37, 0.23] } }",
        ),
    ] {
        let (corner, missing) = periodic_stream(&gpu, at_the_corner);
        let (middle, _) = periodic_stream(&gpu, in_the_middle);
        let moved = |k: usize| middle[(k % 24 + 12) % 24 + 24 * ((k / 24 + 12) % 24)];
        let apart = (0..24 * 24).map(|k| (corner[k] - moved(k)).abs()).fold(0.0, f32::max);
        eprintln!("{at_the_corner}: apart {apart:e}, missing {missing:e}");
        assert!(missing < 1e-6 && apart < 1e-3, "apart {apart:e}, missing {missing:e}");
    }
}

/// A slope without an end has another height at either end of the axis: the step between them is closed.
#[test]
fn a_slope_across_a_periodic_side_keeps_the_mass() {
    let Some(gpu) = gpu_or_skip() else { return };
    let (_, missing) = periodic_stream(&gpu, "{ half_space = { point = [0.5, 0.27], normal = [0.21, 1.0] } }");
    eprintln!("missing {missing:e}");
    assert!(missing < 1e-6, "{missing:e}");
}
