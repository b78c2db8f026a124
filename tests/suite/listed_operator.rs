//! The listed form of the pressure operator, both halves by themselves, and its diagonal against the CPU twin's coefficients: random
//! pressures give forces on nodes, random velocities give rows at vertices.

use std::collections::BTreeMap;

use brisance::gpu::{Buffer, Extent, Gpu, Pass, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::state::{Over, State};

use crate::common::{Random, gpu_or_skip};
use crate::twins::problem_of;
use reference::grid::add;
use reference::solve::coupled_solve::block_with_images;
use reference::{GAS, Problem, SOLID, interface};

/// Bodies in gas, at a wall, at an open side and at a corner, with a gap of one cell between two of them; and an obstacle.
const SCENE: &str = r#"
title = "Bodies at everything"
[domain]
dimension = 3
cells = [14, 11, 9]
size = [1.4, 1.1, 0.9]
[gas]
ambient = { density = 1.0, pressure = 1.0 }
[boundary]
x_max = "outlet"
[[obstacles]]
name = "block"
shape = { box = { center = [1.0, 0.7, 0.5], size = [0.2, 0.2, 0.3] } }
[materials.rubber]
neo_hookean = { young_modulus = 100.0, poisson_ratio = 0.3 }
[[bodies]]
name = "ball"
shape = { sphere = { center = [0.47, 0.55, 0.45], radius = 0.23 } }
material = "rubber"
density = 10.0
[[bodies]]
name = "foot"
shape = { box = { center = [0.75, 0.1, 0.4], size = [0.4, 0.2, 0.2] } }
material = "rubber"
density = 10.0
[[bodies]]
name = "corner"
shape = { box = { center = [1.3, 1.0, 0.8], size = [0.2, 0.2, 0.2] } }
material = "rubber"
density = 10.0
[[bodies]]
name = "fragment"
shape = { box = { center = [0.85, 0.85, 0.45], size = [0.1, 0.1, 0.1] } }
material = "rubber"
density = 10.0
[time]
until = 1.0
fixed_step = 0.001
[numerics]
paper.obstacles = "cells"
"#;

/// Slots, flags and unknowns as the device has them after a step.
struct Marks {
    cells: Vec<u32>,
    kinds: Vec<u32>,
    extra: Vec<u32>,
    listed: Vec<usize>,
    capacity: usize,
}

impl Marks {
    fn of(gpu: &Gpu, state: &State) -> Marks {
        let cells = readback::read(gpu, &state.interface.cells).unwrap();
        let extra = readback::read(gpu, &state.interface.extra).unwrap();
        let slots = cells.len();
        let count = extra[2 * slots] as usize;
        let listed = extra[slots..slots + count].iter().map(|slot| *slot as usize).collect();
        let kinds = cells.iter().map(|word| word & 3).collect();
        Marks { cells, kinds, extra, listed, capacity: state.params.extra_capacity as usize }
    }

    fn apart(&self, vertex: usize) -> bool {
        self.capacity > 0 && self.extra[vertex] != u32::MAX
    }

    fn unknown_count(&self) -> usize {
        self.cells.len() + 2 * self.capacity
    }

    /// Unknowns that a vertex has for a kind of element: of the element itself, and of its faces to the other kind.
    fn unknowns(&self, vertex: usize, kind: u32) -> [usize; 2] {
        let slots = self.cells.len();
        let place = self.extra[vertex] as usize;
        match kind {
            _ if !self.apart(vertex) => [vertex, vertex],
            SOLID => [slots + self.capacity + place, slots + place],
            _ => [vertex, slots + place],
        }
    }
}

/// One coefficient: places in the node array and in the vector of unknowns.
struct Entry {
    node: usize,
    axis: usize,
    unknown: usize,
    value: f64,
}

/// C without a grid of its own: every coefficient of every node, bodies' nodes behind those of the gas. Those that
/// others stand for have none.
fn entries(problem: &Problem, marks: &Marks) -> Vec<Entry> {
    let grid = &problem.grid;
    let mut entries = Vec::new();
    for kind in [GAS, SOLID] {
        for node in grid.all() {
            let touched = |c: [i32; 3]| marks.kinds[grid.slot(c)] == kind;
            if kind == GAS && problem.node_of(node) != node {
                continue;
            }
            if !interface::elements_of(problem, node).any(|(c, _)| touched(c)) {
                continue;
            }
            for axis in 0..grid.dimension {
                let block = block_with_images(problem, &marks.kinds, node, axis, kind);
                for offset in grid.offsets(-1, 2) {
                    let at = (offset[0] + 1 + 4 * (offset[1] + 1) + 16 * (offset[2] + 1)) as usize;
                    for (own, part) in block.iter().enumerate().filter(|(_, part)| part[at] != 0.0) {
                        let vertex = grid.slot(add(node, offset));
                        let slot = grid.slot(node) + if kind == SOLID { marks.cells.len() } else { 0 };
                        let unknown = marks.unknowns(vertex, kind)[own];
                        entries.push(Entry { node: slot, axis, unknown, value: part[at] });
                    }
                }
            }
        }
    }
    entries
}

/// Slots of gas nodes that others stand for: without mass and velocity.
fn images(problem: &Problem) -> Vec<usize> {
    let all = problem.grid.all().into_iter();
    all.filter(|node| problem.node_of(*node) != *node).map(|node| problem.grid.slot(node)).collect()
}

fn worst(found: &[f64], expected: &[f64]) -> f64 {
    let scale = expected.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
    let worst = found.iter().zip(expected).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
    assert!(scale > 0.0 && found.len() == expected.len());
    worst / scale
}

fn run(gpu: &Gpu, state: &State, shader: &str, entry: &str, renamed: &[(&str, &wgpu::Buffer)]) {
    let bound = state.bind(shader, entry, renamed, &[("SWEEP", f64::from(Over::Listed as u32))]).unwrap();
    let mut pass = Pass::new(gpu, entry);
    pass.dispatch(&bound, &Extent::Threads(u64::from(state.params.slots)));
    pass.submit().unwrap();
}

fn noise(length: usize) -> Vec<f32> {
    let mut random = Random(5);
    (0..length).map(|_| random.between(-1.0, 1.0)).collect()
}

/// Error of the forces at listed nodes. What an unknown has no use for must not matter, so all are random.
fn error_of_forces(gpu: &Gpu, problem: &Problem, (state, marks): (&State, &Marks), entries: &[Entry]) -> f64 {
    let slots = marks.cells.len();
    let x = noise(marks.unknown_count());
    let x_buffer = Buffer::from_slice(gpu, "x", &x).unwrap();
    let mut work = vec![[0.0, 0.0, 0.0, 1.0_f32]; 2 * slots];
    for image in images(problem) {
        work[image] = [0.0; 4];
    }
    let work = Buffer::from_slice(gpu, "work", &work).unwrap();
    let inertia = Buffer::from_slice(gpu, "inertia", &vec![1.0_f32; slots]).unwrap();
    let named = [("x", x_buffer.raw()), ("work", work.raw()), ("inertia", inertia.raw())];
    run(gpu, state, "solve/solve_forces.wgsl", "solve_forces", &named);
    let found = readback::read(gpu, &work).unwrap();
    let mut expected = vec![[0.0; 3]; 2 * slots];
    for entry in entries {
        expected[entry.node][entry.axis] += entry.value * f64::from(x[entry.unknown]);
    }
    let nodes: Vec<usize> = marks.listed.iter().flat_map(|slot| [*slot, slots + slot]).collect();
    worst(
        &nodes.iter().flat_map(|node| [0, 1, 2].map(|d| f64::from(found[*node][d]))).collect::<Vec<_>>(),
        &nodes.iter().flat_map(|node| expected[*node]).collect::<Vec<_>>(),
    )
}

/// Error of the rows at listed vertices, without stiffness and with dt = 1.
fn error_of_rows(gpu: &Gpu, problem: &Problem, (state, marks): (&State, &Marks), entries: &[Entry]) -> f64 {
    let length = marks.unknown_count();
    let velocity = noise(8 * marks.cells.len());
    let mut velocity: Vec<[f32; 4]> = velocity.chunks_exact(4).map(|v| [v[0], v[1], v[2], 1.0]).collect();
    for image in images(problem) {
        velocity[image] = [0.0; 4];
    }
    let mut control = readback::read(gpu, &state.control).unwrap();
    control[0].dt = 1.0;
    state.control.write(gpu, 0, &control);
    let work = Buffer::from_slice(gpu, "work", &velocity).unwrap();
    let zero = Buffer::from_slice(gpu, "stiffness", &vec![0.0_f32; length]).unwrap();
    let y = Buffer::from_slice(gpu, "y", &vec![0.0_f32; length]).unwrap();
    let named = [("x", zero.raw()), ("y", y.raw()), ("work", work.raw()), ("stiffness", zero.raw())];
    run(gpu, state, "solve/solve_operator.wgsl", "solve_operator", &named);
    let found = readback::read(gpu, &y).unwrap();
    let mut expected = vec![0.0; length];
    for entry in entries {
        expected[entry.unknown] += entry.value * f64::from(velocity[entry.node][entry.axis]);
    }
    let places = |slot: &usize| {
        let [own, h] = marks.unknowns(*slot, SOLID);
        if own == *slot { vec![own] } else { vec![*slot, h, own] }
    };
    let unknowns: Vec<usize> = marks.listed.iter().flat_map(places).collect();
    worst(
        &unknowns.iter().map(|place| f64::from(found[*place])).collect::<Vec<_>>(),
        &unknowns.iter().map(|place| expected[*place]).collect::<Vec<_>>(),
    )
}

/// Largest relative error of the diagonal at listed vertices, without stiffness, with dt = 1 and random masses. Pressures between gas and
/// body that have a preconditioner of their own have no diagonal.
fn error_of_diagonal(gpu: &Gpu, problem: &Problem, (state, marks): (&State, &Marks), entries: &[Entry]) -> f64 {
    let length = marks.unknown_count();
    let masses = noise(2 * marks.cells.len());
    let mut work: Vec<[f32; 4]> = masses.iter().map(|mass| [0.0, 0.0, 0.0, 1.5 + mass]).collect();
    for image in images(problem) {
        work[image] = [0.0; 4];
    }
    let work_buffer = Buffer::from_slice(gpu, "work", &work).unwrap();
    let zero = Buffer::from_slice(gpu, "stiffness", &vec![0.0_f32; length]).unwrap();
    let inverse = Buffer::from_slice(gpu, "inverse_diagonal", &vec![0.0_f32; length]).unwrap();
    let named = [("work", work_buffer.raw()), ("stiffness", zero.raw()), ("inverse_diagonal", inverse.raw())];
    run(gpu, state, "solve/solve_diagonal.wgsl", "solve_diagonal", &named);
    let found = readback::read(gpu, &inverse).unwrap();
    let mut sums = BTreeMap::<_, f64>::new();
    for entry in entries {
        *sums.entry((entry.node, entry.axis, entry.unknown)).or_default() += entry.value;
    }
    let mut expected = vec![0.0; length];
    for ((node, _, unknown), sum) in sums {
        expected[unknown] += sum * sum * f64::from(work[node][3]);
    }
    let rows = state.params.surface_rows as usize;
    let used = marks.listed.iter().flat_map(|slot| {
        let [own, h] = marks.unknowns(*slot, SOLID);
        if own == *slot {
            vec![own]
        } else {
            [*slot, own].into_iter().chain((h - marks.cells.len() >= rows).then_some(h)).collect()
        }
    });
    used.map(
        |at| if expected[at] == 0.0 { f64::from(found[at]) } else { (f64::from(found[at]) * expected[at] - 1.0).abs() },
    )
    .fold(0.0, f64::max)
}

/// Returns how many vertices keep their pressures apart, none without a device.
fn compare(overrides: &[&str]) -> Option<usize> {
    let gpu = gpu_or_skip()?;
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let scene = Scene::parse(SCENE, "listed.toml", &overrides).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    simulation.set_target(1e3).unwrap();
    simulation.advance_batch_of(&mut Vec::new(), 1).unwrap();
    let state = &simulation.state;
    let marks = Marks::of(&gpu, state);
    let mut problem = problem_of(&scene);
    if scene.bodies.is_empty() {
        problem.materials.clear();
    }
    let entries = entries(&problem, &marks);
    let forces = error_of_forces(&gpu, &problem, (state, &marks), &entries);
    let rows = error_of_rows(&gpu, &problem, (state, &marks), &entries);
    let diagonal = error_of_diagonal(&gpu, &problem, (state, &marks), &entries);
    let mut sorted = marks.listed.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(sorted.len(), marks.listed.len(), "a slot stands twice in the list");
    let apart = marks.listed.iter().filter(|slot| marks.apart(**slot)).count();
    eprintln!(
        "{overrides:?}: {apart} of {} listed vertices apart, forces {forces:.1e}, rows {rows:.1e}, \
         diagonal {diagonal:.1e}",
        marks.listed.len()
    );
    assert!(forces < 1e-6 && rows < 1e-6, "{overrides:?}: forces {forces}, rows {rows}");
    assert!(diagonal < 2e-6, "{overrides:?}: diagonal {diagonal}");
    Some(apart)
}

/// Both pairs under every rule of what shares a pressure.
fn compare_all(overrides: &[&str]) {
    for pair in ["b1b0", "b2b1"] {
        let apart = ["single", "resolved", "h"].map(|rule| {
            let (pair, rule) = (format!("numerics.pair={pair}"), format!("numerics.paper.interface={rule}"));
            compare(&[overrides, &[&pair, &rule]].concat())
        });
        if let [Some(single), Some(resolved), Some(h)] = apart {
            assert!(single == 0 && 0 < resolved && resolved < h, "{apart:?}");
        }
    }
}

#[test]
fn listed_operator_3d() {
    compare_all(&[]);
}

/// Without bodies, which do not cross periodic sides.
#[test]
fn listed_operator_3d_periodic() {
    for pair in ["numerics.pair=b1b0", "numerics.pair=b2b1"] {
        let sides = ["x_min", "x_max", "z_min", "z_max"].map(|side| format!("boundary.{side}=periodic"));
        let sides: Vec<&str> = sides.iter().map(String::as_str).collect();
        compare(&[&sides[..], &["bodies=[]", pair]].concat());
    }
}

/// A slice through the same scene.
#[test]
fn listed_operator_2d() {
    compare_all(&[
        "domain.dimension=2",
        "domain.cells=[14,11]",
        "domain.size=[1.4,1.1]",
        "obstacles[0].shape={ box = { center = [1.0, 0.7], size = [0.2, 0.2] } }",
        "bodies[0].shape={ sphere = { center = [0.47, 0.55], radius = 0.23 } }",
        "bodies[1].shape={ box = { center = [0.75, 0.1], size = [0.4, 0.2] } }",
        "bodies[2].shape={ box = { center = [1.3, 1.0], size = [0.2, 0.2] } }",
        "bodies[3].shape={ box = { center = [0.85, 0.85], size = [0.1, 0.1] } }",
    ]);
}

/// Along a line every body is resolved.
#[test]
fn listed_operator_1d() {
    for (pair, rule) in [("b1b0", "h"), ("b2b1", "h"), ("b1b0", "resolved"), ("b2b1", "single")] {
        let (pair, rule) = (format!("numerics.pair={pair}"), format!("numerics.paper.interface={rule}"));
        compare(&[
            "domain.dimension=1",
            "domain.cells=[14]",
            "domain.size=[1.4]",
            "obstacles[0].shape={ box = { center = [1.0], size = [0.2] } }",
            "bodies[0].shape={ box = { center = [0.45], size = [0.3] } }",
            "bodies[1].shape={ box = { center = [0.05], size = [0.1] } }",
            "bodies[2].shape={ box = { center = [1.3], size = [0.2] } }",
            "bodies[3].shape={ box = { center = [0.75], size = [0.1] } }",
            &pair,
            &rule,
        ]);
    }
}
