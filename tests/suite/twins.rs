//! A simulation on the device and its CPU twin: same start, same steps, compared field by field.

use brisance::gpu::{Buffer, Detail, Gpu, readback};
use brisance::scene::{
    Boundary, Coupling, Elasticity, GasState, Ghost, Integrator, InterfacePressure, Pair, Scene, SolidUpdate,
};
use brisance::simulation::Simulation;
use glam::{DMat3, DVec3};

/// Numbers of a particle that are compared.
type Components = fn(&Particle) -> Vec<f64>;

use crate::common::{Borrowed, Random};
use reference::grid::Grid;
use reference::solid::material::Material;
use reference::step::time_step::time_step;
use reference::step::{Report, Trace, traced_step};
use reference::{self as twin, GAS, Particle, Problem, SOLID, Shared, Side, State};

/// The fixed parts of a scene for the twin.
pub(crate) fn problem_of(scene: &Scene) -> Problem {
    let axes = scene.domain.axes();
    let cells: Vec<i32> = scene.domain.cells[..axes].iter().map(|n| *n as i32).collect();
    let grid = Grid::new(&cells, scene.domain.origin, scene.domain.spacing());
    let sides = scene.boundary.sides().map(|side| match side {
        Boundary::Wall => Side::Wall,
        Boundary::Inlet(state) => {
            Side::Inlet { density: state.density, velocity: state.velocity, pressure: state.pressure }
        }
        Boundary::Periodic => Side::Periodic,
        Boundary::SubsonicInlet(flow) => Side::Subsonic { density: flow.density, velocity: flow.velocity },
        Boundary::TotalInlet(total) => Side::Total { density: total.density, pressure: total.pressure },
        Boundary::PressureOutlet(outlet) => Side::Pressure { pressure: outlet.pressure, relaxation: outlet.relaxation },
        Boundary::AttenuatedOutlet(far) => Side::Attenuated {
            density: far.density,
            velocity: far.velocity,
            pressure: far.pressure,
            attenuation: far.attenuation,
        },
        Boundary::FarField(far) => far_side(far),
        Boundary::Outlet => far_side(&scene.gas.ambient), // see `remember`
        Boundary::TimedInlet(_) | Boundary::Patched(_) => panic!("the twin has no tables and no patches"),
    });
    let mut problem = Problem::new(grid, sides);
    remember(&mut problem, scene);
    for (c, wall) in problem.grid.interior().into_iter().zip(scene.obstacle_cells()) {
        let slot = problem.grid.slot(c);
        problem.obstacles[slot] = wall;
    }
    problem.gamma = scene.gas.gamma;
    problem.gravity = scene.gravity;
    problem.ambient = (scene.gas.ambient.density, scene.gas.ambient.pressure);
    problem.materials = scene.materials.values().map(|material| material_of(scene, material)).collect();
    problem.numerics.pair = match scene.numerics.pair {
        Pair::B2b1 => twin::Pair::B2b1,
        Pair::B1b0 => twin::Pair::B1b0,
    };
    problem.numerics.shared = match scene.interface_pressure() {
        InterfacePressure::Resolved | InterfacePressure::Auto => Shared::Resolved,
        InterfacePressure::H => Shared::H,
        InterfacePressure::Single => Shared::Single,
    };
    problem.numerics.tolerance = 1e-9;
    problem.numerics.late_flux = scene.late_flux();
    problem.numerics.gradients = scene.numerics.paper.solid_update == SolidUpdate::Gradients;
    problem.numerics.coupling_last = scene.numerics.paper.coupling == Coupling::Last;
    problem.numerics.shared_volume = scene.numerics.paper.ghost == Ghost::SharedVolume;
    problem.numerics.implicit = scene.numerics.elasticity == Elasticity::Implicit;
    problem.numerics.max_substeps = scene.max_substeps() as usize;
    problem.numerics.predictor = scene.integrator() != Integrator::Paper;
    problem.numerics.consistent = scene.consistent();
    problem.numerics.two_solves = scene.solves() == 2;
    problem.numerics.fourth = scene.sound_of_fourth_order();
    problem
}

fn far_side(state: &GasState) -> Side {
    Side::far((state.density, state.velocity, state.pressure))
}

/// What outlets remember, face by face; beyond the edges of the domain what lies across the first axis.
fn remember(problem: &mut Problem, scene: &Scene) {
    let grid = problem.grid.clone();
    for c in grid.all() {
        let inside: [u32; 3] = std::array::from_fn(|d| c[d].clamp(0, grid.cells[d] - 1) as u32);
        let Some(axis) = (0..grid.dimension).find(|&d| c[d] != inside[d] as i32) else { continue };
        let side = 2 * axis + usize::from(c[axis] >= 0);
        if *scene.boundary.sides()[side] == Boundary::Outlet {
            problem.beyond.insert(grid.slot(c), far_side(&scene.gas_beyond(side, inside)));
        }
    }
}

/// Floor of entropy under random gas, over that of the scene.
const LOW_FLOOR: f32 = 0.1;

fn material_of(scene: &Scene, material: &brisance::scene::Material) -> Material {
    let params = material.params(scene.volume_share());
    Material {
        mu: material.mu(),
        lambda: material.lambda(),
        ghost: params.ghost_modulus.into(),
        elastic_lambda: params.elastic_lambda.into(),
        start: scene.gas.ambient.pressure,
        yield_stress: material.yield_stress(),
    }
}

/// A simulation and its twin.
pub(crate) struct Twins {
    simulation: Simulation,
    problem: Problem,
    state: State,
    /// Recordings that the last step took.
    pub(crate) recordings: usize,
    /// What differs more than rounding explains.
    failures: Vec<String>,
    gpu: Borrowed, // outlives the simulation
}

fn fetch<T: bytemuck::Pod>(gpu: &Gpu, buffer: &Buffer<T>) -> Vec<T> {
    readback::read(gpu, buffer).unwrap()
}

impl Twins {
    /// Both in the same state: the scene's, with random gas and velocity gradients of a relative size, in numbers that f32 holds.
    pub(crate) fn new(gpu: Borrowed, text: &str, overrides: &[&str], noise: f32) -> Twins {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        let scene = Scene::parse(text, "kernels.toml", &overrides).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        simulation.set_target(1e3).unwrap();
        let mut problem = problem_of(&scene);
        // random gas jumps from cell to cell: the floor lies far below, else it would act everywhere, to the last bit or not
        simulation.state.params.least_entropy *= LOW_FLOOR;
        let params = simulation.state.params;
        simulation.state.params_buffer.write(&gpu, 0, &[params]);
        problem.least_entropy = params.least_entropy.into();
        let mut flow = fetch(&gpu, &simulation.state.gas.conserved);
        let mut energy = fetch(&gpu, &simulation.state.gas.energy);
        let cells = fetch(&gpu, &simulation.state.interface.cells);
        let mut random = Random(11);
        for c in problem.grid.interior() {
            let slot = problem.grid.slot(c);
            if cells[slot] & 3 == GAS {
                let mut next = |low: f32, high: f32| random.between(low, high) * noise;
                let density = flow[slot][0] * (1.0 + next(-0.5, 0.5));
                let pressure = 0.4 * energy[slot] * (1.0 + next(-0.5, 0.5));
                let mut velocity = [0.0; 3];
                velocity[..problem.grid.dimension].iter_mut().for_each(|v| *v = next(-0.4, 0.4));
                let kinetic = 0.5 * density * velocity.iter().map(|v| v * v).sum::<f32>();
                flow[slot] = [density, density * velocity[0], density * velocity[1], density * velocity[2]];
                energy[slot] = pressure / 0.4 + kinetic;
            }
        }
        simulation.state.gas.conserved.write(&gpu, 0, &flow);
        simulation.state.gas.energy.write(&gpu, 0, &energy);
        let mut affine = fetch(&gpu, &simulation.state.particles.affine);
        for column in affine.chunks_exact_mut(3).flat_map(|columns| &mut columns[..problem.grid.dimension]) {
            column[..problem.grid.dimension].iter_mut().for_each(|rate| *rate = noise * random.between(-6.0, 6.0));
        }
        simulation.state.particles.affine.write(&gpu, 0, &affine);
        let particles = particles(&gpu, &simulation);
        let mut state = State::new(&problem, |_| (1.0, [0.0; 3], 1.0), particles);
        for c in problem.grid.interior() {
            let slot = problem.grid.slot(c);
            assert_eq!(cells[slot] & 3, state.cells[slot], "kind of {c:?} at the start");
            if state.cells[slot] == GAS {
                state.gas.set(slot, conserved(&flow, &energy, slot));
            }
        }
        twin::gas::gas_advection::fill_ghosts(&problem, &state.cells.clone(), &mut state.gas);
        Twins { gpu, simulation, problem, state, recordings: 0, failures: Vec::new() }
    }

    /// One step of both; the twin takes the device's dt, which must follow the twin's rule unless the scene fixes it.
    pub(crate) fn step(&mut self) -> (Report, Trace) {
        let mut records = Vec::new();
        self.recordings = 0;
        while records.is_empty() {
            self.recordings += 1;
            self.simulation.advance_timed(&mut records, Detail::Stages).unwrap_or_else(|error| panic!("{error}"));
        }
        let dt = f64::from(records[0].dt);
        if self.simulation.state.params.fixed_step == 0.0 {
            let rule = time_step(&self.problem, &self.state);
            self.check("dt", 2e-5, &[dt], &[rule]);
            self.state.previous_dt = dt;
        }
        let (report, trace) = traced_step(&self.problem, &mut self.state, dt);
        assert!(report.converged);
        assert_eq!(report.substeps, (records[0].substeps as usize).max(1), "elastic sub-steps");
        eprintln!(
            "step {}: dt {dt:.3e}, iterations {} (twin {}), limited {} ({}), floored {} ({}), extra {}",
            records[0].step,
            records[0].iterations,
            report.iterations,
            records[0].limited,
            report.limited,
            records[0].floored,
            report.floored,
            records[0].extra,
        );
        (report, trace)
    }

    /// Notes the largest difference relative to the largest value.
    fn check(&mut self, name: &str, tolerance: f64, found: &[f64], expected: &[f64]) {
        self.check_scaled(name, tolerance, 0.0, found, expected);
    }

    /// The same with a least scale, for fields that may vanish.
    fn check_scaled(&mut self, name: &str, tolerance: f64, least: f64, found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{name}");
        let scale = expected.iter().map(|value| value.abs()).fold(least, f64::max);
        let (mut worst, mut at) = (0.0, 0);
        for (index, (a, b)) in found.iter().zip(expected).enumerate() {
            let difference = if (a - b).is_nan() { f64::INFINITY } else { (a - b).abs() };
            if difference > worst {
                (worst, at) = (difference, index);
            }
        }
        if worst > 0.0 {
            eprintln!("  {name:16} {:.1e} of {scale:.2e} ({} values)", worst / scale, found.len());
        }
        if worst > tolerance * scale {
            let step = self.simulation.step_count();
            let (a, b) = (found[at], expected[at]);
            self.failures.push(format!("step {step}, {name}[{at}]: device {a}, twin {b}, scale {scale:.3e}"));
        }
    }

    /// Interior slots of a kind, and a check that both agree on the kinds.
    fn slots(&mut self, kind: u32) -> Vec<usize> {
        let cells = fetch(&self.gpu, &self.simulation.state.interface.cells);
        let interior = self.problem.grid.interior();
        let slots: Vec<usize> = interior.into_iter().map(|c| self.problem.grid.slot(c)).collect();
        let differ = slots.iter().filter(|slot| cells[**slot] & 3 != self.state.cells[**slot]).count();
        if differ > 0 {
            self.failures.push(format!("kinds of {differ} cells"));
        }
        slots.into_iter().filter(|slot| self.state.cells[*slot] == kind).collect()
    }

    /// Density, momentum, energy of gas cells, and what cells owe.
    pub(crate) fn compare_gas(&mut self, tolerance: f64) {
        let flow = fetch(&self.gpu, &self.simulation.state.gas.conserved);
        let energy = fetch(&self.gpu, &self.simulation.state.gas.energy);
        let owed = fetch(&self.gpu, &self.simulation.state.gas.owed_flow);
        let owed_energy = fetch(&self.gpu, &self.simulation.state.gas.owed_energy);
        let slots = self.slots(GAS);
        let names = ["density", "momentum x", "momentum y", "momentum z", "energy"];
        for (k, name) in names.into_iter().enumerate() {
            let found: Vec<f64> = slots.iter().map(|slot| conserved(&flow, &energy, *slot)[k]).collect();
            let expected: Vec<f64> = slots.iter().map(|slot| self.state.gas.get(*slot)[k]).collect();
            self.check_scaled(name, tolerance, if (1..4).contains(&k) { 0.5 } else { 0.0 }, &found, &expected);
        }
        let volume = self.problem.grid.volume();
        let covered = self.slots(SOLID);
        let [x, y, z, heat] = self.simulation.borrowed().unwrap();
        let all = [0.0, x, y, z, heat];
        for (k, name) in names.into_iter().enumerate() {
            let held = |slot: &usize| conserved(&flow, &energy, *slot)[k];
            let owes = |slot: &usize| conserved(&owed, &owed_energy, *slot)[k] / volume;
            let twin = |slot: &usize| self.state.ledger[*slot][k] / volume;
            let (found, expected): (Vec<f64>, Vec<f64>) = if owed.len() < flow.len() {
                // gas cells have no budgets of their own: what floors took is one sum
                (vec![all[k] / volume], vec![slots.iter().map(twin).sum()])
            } else {
                // solid cells have two books, for the gas on either side
                let found = covered.iter().map(held).chain(covered.iter().chain(&slots).map(owes)).collect();
                let above = |slot: &usize| self.state.above[*slot][k] / volume;
                (
                    found,
                    covered.iter().map(twin).chain(covered.iter().map(above)).chain(slots.iter().map(twin)).collect(),
                )
            };
            self.check_scaled(&format!("owed {name}"), tolerance, 1.0, &found, &expected);
        }
    }

    /// Every pressure unknown that is in use.
    pub(crate) fn compare_pressure(&mut self, trace: &Trace, tolerance: f64) {
        let solved = fetch(&self.gpu, &self.simulation.state.pressure);
        let extra = fetch(&self.gpu, &self.simulation.state.interface.extra);
        let solids = self.simulation.state.has_solids();
        let grid = self.problem.grid.clone();
        let capacity = self.simulation.state.params.extra_capacity as usize;
        let mut pairs: [Vec<(f64, f64)>; 3] = Default::default();
        for vertex in grid.vertices() {
            let slot = grid.slot(vertex);
            let touches = |kind| twin::interface::touches(&self.problem, &self.state.cells, vertex, kind);
            let (gas, solid) = (touches(GAS), touches(SOLID));
            let place = if solids && extra[slot] != u32::MAX { Some(extra[slot] as usize) } else { None };
            assert_eq!(place.is_some(), gas && solid && !trace.shared[slot], "separate pressures at {vertex:?}");
            let at = [
                gas.then_some(slot),
                place.map(|k| grid.slots() + k),
                solid.then_some(place.map_or(slot, |k| grid.slots() + capacity + k)),
            ];
            for (field, at) in at.into_iter().enumerate() {
                pairs[field].extend(at.map(|at| (f64::from(solved[at]), trace.solution.pressure[field][slot])));
            }
        }
        for (name, pairs) in ["P", "h", "Q"].into_iter().zip(pairs) {
            let (found, expected): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
            self.check(name, tolerance, &found, &expected);
        }
    }

    /// Nodes after the last sub-step, particles at the end.
    pub(crate) fn compare_solid(&mut self, trace: &Trace, tolerance: f64) {
        let node = fetch(&self.gpu, &self.simulation.state.particles.node);
        let full = trace.nodes.mass.iter().copied().fold(0.0, f64::max);
        let heavy: Vec<usize> = (0..node.len()).filter(|slot| trace.nodes.mass[*slot] > 1e-3 * full).collect();
        let mass = |slot: &usize| f64::from(node[*slot][3]);
        self.check(
            "node mass",
            tolerance,
            &heavy.iter().map(mass).collect::<Vec<_>>(),
            &heavy.iter().map(|slot| trace.nodes.mass[*slot]).collect::<Vec<_>>(),
        );
        let speed = |slot: &usize| [0, 1, 2].map(|d| f64::from(node[*slot][d]));
        self.check(
            "node velocity",
            10.0 * tolerance,
            &heavy.iter().flat_map(speed).collect::<Vec<_>>(),
            &heavy.iter().flat_map(|slot| trace.nodes.velocity[*slot]).collect::<Vec<_>>(),
        );
        let found = particles(&self.gpu, &self.simulation);
        let expected = self.state.particles.clone();
        let cell = self.problem.grid.spacing;
        let fields: [(&str, f64, Components); 6] = [
            ("position", cell, |p| p.position.to_array().to_vec()),
            ("velocity", 0.0, |p| p.velocity.to_array().to_vec()),
            ("affine", 1.0, |p| p.affine.to_cols_array().to_vec()),
            ("F - 1", 0.1, |p| (p.deformation - DMat3::IDENTITY).to_cols_array().to_vec()),
            ("ghost pressure", 0.0, |p| vec![p.ghost_pressure]),
            ("plastic strain", 1e-3, |p| vec![p.plastic_strain]),
        ];
        for (name, least, field) in fields {
            let values = |all: &[Particle]| all.iter().flat_map(field).collect::<Vec<f64>>();
            self.check_scaled(name, 10.0 * tolerance, least, &values(&found), &values(&expected));
        }
    }

    /// Fails the test if anything differed.
    pub(crate) fn finish(self) {
        assert!(self.failures.is_empty(), "{}", self.failures.join("\n"));
    }
}

fn conserved(flow: &[[f32; 4]], energy: &[f32], slot: usize) -> [f64; 5] {
    let u = flow[slot].map(f64::from);
    [u[0], u[1], u[2], u[3], f64::from(energy[slot])]
}

/// The device's particles for the twin.
fn particles(gpu: &Gpu, simulation: &Simulation) -> Vec<Particle> {
    let all = &simulation.state.particles;
    let (position, velocity) = (fetch(gpu, &all.position), fetch(gpu, &all.velocity));
    let (affine, deformation) = (fetch(gpu, &all.affine), fetch(gpu, &all.deformation));
    let xyz = |v: [f32; 4]| DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
    let matrix = |columns: &[[f32; 4]]| DMat3::from_cols(xyz(columns[0]), xyz(columns[1]), xyz(columns[2]));
    let particle = |p: usize| Particle {
        position: xyz(position[p]),
        velocity: xyz(velocity[p]),
        affine: matrix(&affine[3 * p..]),
        deformation: DMat3::IDENTITY + matrix(&deformation[3 * p..]),
        mass: f64::from(position[p][3]),
        volume0: f64::from(velocity[p][3]),
        ghost_pressure: f64::from(affine[3 * p][3]),
        plastic_strain: f64::from(affine[3 * p + 1][3]),
        material: affine[3 * p + 2][3].to_bits() as usize,
        active: deformation[3 * p + 1][3] > 0.0,
    };
    (0..all.count as usize).map(particle).collect()
}
