//! What a run conserved, and whether it did what its scene expects: the `[expect]` table against measured values.

mod bodies;
mod gauges;
mod probes;
mod warnings;

pub use gauges::{Gauge, Recording};
pub use probes::Seen;
pub use warnings::{RULES, Rule, Warning, Watched, absent, marks, table, warnings, watched};

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::gpu::{Gpu, readback};
use crate::math::plain;
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::snapshot::{Snapshot, kind};
use crate::state::Grid;
use crate::state::cut;

/// What must stay constant without driven parts: everything inside plus what has crossed the boundary.
/// Summed on the CPU in double precision, so that the sum itself loses nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Gas in gas cells and owed gas \[kg\].
    pub gas_mass: f64,
    /// The same with what has crossed the boundary \[kg\].
    pub gas_mass_with_crossed: f64,
    /// Solids \[kg\].
    pub solid_mass: f64,
    /// Energy of gas and solids, the heat of plastic flow, and what has crossed the boundary, without what walls, films and gravity
    /// have given \[J\].
    pub energy: f64,
    /// Momentum of gas and solids, and what has crossed the boundary, without what walls, films and gravity have given \[kg m s^-1\].
    pub momentum: [f64; 3],
    /// Momentum and energy of the gas alone, with what crossed and what it gave to bodies and obstacles, without what gravity and blasts
    /// gave to it. Only scenes with bodies that are held or driven know what the gas gave to bodies \[kg m s^-1\], \[J\].
    pub gas_budget: [f64; 4],
    /// Momentum below which a gap is rounding: a thousandth of that of all gas at the speed of sound \[kg m s^-1\].
    pub noise_momentum: f64,
    /// Cell that owes most, or has most too much.
    pub most_owed: [i32; 3],
    /// Particles at the start.
    pub particles: u64,
    /// Least p / rho^gamma of the start and of what may flow in \[Pa (m^3/kg)^gamma\].
    pub start_entropy: f64,
}

/// Whether a slot is of an obstacle, inside the domain.
fn ledger_of_obstacle(word: u32, grid: &Grid, slot: usize) -> bool {
    let inside = grid.cell(slot as u32).iter().zip(grid.cells).all(|(&at, count)| (0..count as i32).contains(&at));
    inside && word & u32::from(kind::MASK) == u32::from(kind::WALL)
}

/// Share of the speed of sound that gas at rest may seem to move with.
const NOISE_SPEED: f64 = 1e-3;

impl Budget {
    /// Reads the state. `stored` is the elastic energy of the solids and the heat of plastic flow, 0 at the start \[J\].
    ///
    /// # Errors
    /// Driver errors.
    pub fn read(simulation: &Simulation, scene: &Scene, stored: f64) -> Result<Self> {
        let (gpu, state) = (simulation.gpu(), &simulation.state);
        let volume = scene.domain.cell_volume();
        let flow = readback::read(gpu, &state.gas.conserved)?;
        let energy = readback::read_range(gpu, &state.gas.energy, 0, state.grid.slots())?;
        let cells = readback::read(gpu, &state.interface.cells)?;
        let owed = readback::read(gpu, &state.gas.owed_flow)?;
        let owed_energy = readback::read(gpu, &state.gas.owed_energy)?;
        let geometry = cut::left(&state.grid, scene.cut_geometry(), &cells, state.has_solids());
        let shares = cut::gas_shares(&state.grid, &geometry);
        let mut budgets = owed.iter().zip(&owed_energy);
        let mut budget = Self {
            energy: stored,
            particles: state.params.particles.into(),
            start_entropy: state.start_entropy[0],
            ..Self::default()
        };
        let mut most = 0.0;
        for (slot, &word) in cells.iter().enumerate() {
            let inside = matches!((word & u32::from(kind::MASK)) as u8, kind::GAS | kind::SOLID);
            // What has crossed the boundary is kept per volume, like the gas; what is owed is not.
            let share = if inside { 1.0 } else { volume };
            let entry = if owed.len() == cells.len() || !inside { budgets.next() } else { None };
            let (owed, owed_energy) = entry.map_or(([0.0; 4], 0.0), |(flow, energy)| (*flow, *energy));
            let room = volume * shares[slot];
            let covered = if word & u32::from(kind::MASK) == u32::from(kind::SOLID) {
                room * f64::from(flow[slot][0])
            } else {
                0.0
            };
            if inside && (f64::from(owed[0]) + covered).abs() > most {
                most = (f64::from(owed[0]) + covered).abs();
                budget.most_owed = state.grid.cell(slot as u32);
            }
            let mass = share * f64::from(owed[0]) + room * f64::from(flow[slot][0]);
            budget.gas_mass += if inside { mass } else { 0.0 };
            budget.gas_mass_with_crossed += mass;
            budget.energy += share * f64::from(owed_energy) + room * f64::from(energy[slot]);
            // what obstacles have collected is a part of their loads
            if ledger_of_obstacle(word, &state.grid, slot) {
                continue;
            }
            for (axis, sum) in budget.momentum.iter_mut().enumerate() {
                *sum += share * f64::from(owed[axis + 1]) + room * f64::from(flow[slot][axis + 1]);
            }
        }
        let borrowed = simulation.borrowed()?;
        budget.energy += borrowed[3];
        for (sum, borrowed) in budget.momentum.iter_mut().zip(borrowed) {
            *sum += borrowed;
        }
        budget.gas_mass_with_crossed -= simulation.released().mass;
        budget.close_gas(simulation, stored);
        budget.noise_momentum = NOISE_SPEED * scene.gas.ambient.sound_speed(scene.gas.gamma) * budget.gas_mass.abs();
        budget.add_solids(&simulation.snapshot()?, scene);
        budget.add_outside(simulation, scene)?;
        Ok(budget)
    }

    /// Adds what has left, without what came from outside.
    fn add_outside(&mut self, simulation: &Simulation, scene: &Scene) -> Result<()> {
        let seeds = scene.seed_particles();
        let gone = simulation.gone(|index| seeds.get(index).map_or(0.0, |seed| seed.volume * seed.density))?;
        let from_outside = [simulation.given(), simulation.pulled()].map(|given| given.map(|part| -part));
        for [x, y, z, energy] in [gone].into_iter().chain(from_outside) {
            self.energy += energy;
            for (sum, part) in self.momentum.iter_mut().zip([x, y, z]) {
                *sum += part;
            }
        }
        Ok(())
    }

    /// Adds the impulse on obstacles, and closes the budgets of the gas.
    fn close_gas(&mut self, simulation: &Simulation, stored: f64) {
        let (bodies, obstacles) = simulation.borne();
        for (axis, sum) in self.momentum.iter_mut().enumerate() {
            *sum += obstacles.iter().map(|borne| borne[axis]).sum::<f64>();
        }
        let [x, y, z] = self.momentum;
        self.gas_budget = [x, y, z, self.energy - stored - simulation.blasts()];
        for (sum, released) in self.gas_budget.iter_mut().zip(simulation.released().momentum) {
            *sum -= released;
        }
        let pulled = simulation.pulled();
        for (k, sum) in self.gas_budget.iter_mut().enumerate() {
            *sum += bodies.iter().map(|borne| borne[k]).sum::<f64>() - pulled[k];
        }
    }

    fn add_solids(&mut self, snapshot: &Snapshot, scene: &Scene) {
        let materials = scene.material_parameters();
        for particle in &snapshot.particles {
            let mass = f64::from(particle.mass);
            let (volume, q) = (f64::from(particle.volume_ratio()), f64::from(particle.ghost_pressure));
            let material = materials.get(particle.material as usize);
            let energy = material.map_or(0.0, |material| material.ghost_energy(volume, q, scene.gas.ambient.pressure));
            self.solid_mass += mass;
            self.energy += f64::from(particle.kinetic_energy) + f64::from(particle.volume0) * energy;
            for (sum, v) in self.momentum.iter_mut().zip(particle.velocity) {
                *sum += mass * f64::from(v);
            }
        }
    }

    /// What differs from another one.
    #[must_use]
    pub fn over(&self, other: &Self) -> Self {
        self.plus(other, -1.0)
    }

    /// With so many times another one; place and least entropy stay.
    #[must_use]
    pub fn plus(&self, other: &Self, times: f64) -> Self {
        let sum = |own: f64, other: f64| own + times * other;
        Self {
            gas_mass: sum(self.gas_mass, other.gas_mass),
            gas_mass_with_crossed: sum(self.gas_mass_with_crossed, other.gas_mass_with_crossed),
            solid_mass: sum(self.solid_mass, other.solid_mass),
            energy: sum(self.energy, other.energy),
            momentum: std::array::from_fn(|axis| sum(self.momentum[axis], other.momentum[axis])),
            gas_budget: std::array::from_fn(|part| sum(self.gas_budget[part], other.gas_budget[part])),
            particles: sum(self.particles as f64, other.particles as f64) as u64,
            ..*self
        }
    }

    /// Relative change since `start`.
    pub fn drift_since(&self, start: &Self) -> BTreeMap<String, f64> {
        let relative = |now: f64, then: f64| if then == 0.0 { 0.0 } else { (now - then) / then };
        BTreeMap::from([
            ("gas_mass".to_owned(), relative(self.gas_mass_with_crossed, start.gas_mass_with_crossed)),
            ("solid_mass".to_owned(), relative(self.solid_mass, start.solid_mass)),
            ("energy".to_owned(), relative(self.energy, start.energy)),
        ])
    }
}

/// What the steps of a run amount to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Steps.
    pub steps: u64,
    /// Conjugate gradient iterations of all steps.
    pub iterations: u64,
    /// Most iterations of one step.
    pub max_iterations: u32,
    /// Elastic sub-steps of all steps.
    pub substeps: u64,
    /// Largest residual that a solve ended with.
    pub max_residual: f64,
    /// Smallest gas density \[kg m^-3\].
    pub min_density: f64,
    /// Smallest gas pressure \[Pa\].
    pub min_pressure: f64,
    /// Largest speed of gas or particles \[m s^-1\].
    pub max_speed: f64,
    /// Cells where the energy floor acted, summed over steps.
    pub floored: u64,
    /// What the warnings want to know of the steps.
    pub watched: Watched,
    /// What each probe has seen.
    pub probes: Vec<Seen>,
    /// The last step.
    pub last: Option<StepRecord>,
}

impl Default for Summary {
    fn default() -> Self {
        Self {
            steps: 0,
            iterations: 0,
            max_iterations: 0,
            substeps: 0,
            max_residual: 0.0,
            min_density: f64::INFINITY,
            min_pressure: f64::INFINITY,
            max_speed: 0.0,
            floored: 0,
            watched: Watched::default(),
            probes: Vec::new(),
            last: None,
        }
    }
}

impl Summary {
    /// Adds steps.
    pub fn add(&mut self, records: &[StepRecord]) {
        for record in records {
            self.steps += 1;
            self.iterations += u64::from(record.iterations);
            self.max_iterations = self.max_iterations.max(record.iterations);
            self.substeps += u64::from(record.substeps);
            self.max_residual = self.max_residual.max(record.residual.into());
            self.min_density = self.min_density.min(record.density[0].into());
            self.min_pressure = self.min_pressure.min(record.pressure[0].into());
            self.max_speed = self.max_speed.max(record.gas_speed.max(record.solid_speed).into());
            self.floored += u64::from(record.floored);
            self.watched.add(record);
            probes::add(&mut self.probes, record);
        }
        if let Some(last) = records.last() {
            self.last = Some(last.clone());
        }
    }

    /// Elastic energy after the last step, without that of the ghost pressure, the heat of plastic flow, what cracks took, and what of these
    /// has left the domain \[J\].
    pub fn stored_energy(&self) -> f64 {
        let stored = |last: &StepRecord| {
            let all = [last.elastic_energy, last.plastic_heat, last.fracture_energy, last.gone_energy];
            all.map(f64::from).iter().sum()
        };
        self.last.as_ref().map_or(0.0, stored)
    }
}

/// One line of the verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Key in `[expect]`.
    pub name: String,
    /// What was measured.
    pub measured: f64,
    /// What is allowed, for people.
    pub allowed: String,
    /// Whether it holds.
    pub passed: bool,
}

impl std::fmt::Display for Check {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let verdict = if self.passed { "ok  " } else { "FAIL" };
        write!(f, "{verdict} {} = {}, expected {}", self.name, plain(self.measured), self.allowed)
    }
}

/// The end of a run, as expectations see it.
#[derive(Clone, Copy, Debug)]
pub struct Ending<'a> {
    /// Before the first step.
    pub start: &'a Budget,
    /// After the last step.
    pub end: &'a Budget,
    /// The steps.
    pub summary: &'a Summary,
    /// The state.
    pub snapshot: &'a Snapshot,
}

/// Compares a run with the `[expect]` table of its scene; one line per key that is given.
pub fn evaluate(scene: &Scene, ending: &Ending<'_>) -> Vec<Check> {
    let (expect, summary) = (&scene.expect, ending.summary);
    let drift = ending.end.drift_since(ending.start);
    let sound = scene.gas.ambient.sound_speed(scene.gas.gamma);
    let mut checks = Checks(Vec::new());
    checks.at_most("gas_mass_drift", drift["gas_mass"].abs(), expect.gas_mass_drift);
    checks.at_most("energy_drift", drift["energy"].abs(), expect.energy_drift);
    if let Some(range) = expect.energy_change {
        checks.within("energy_change", drift["energy"], range);
    }
    checks.at_most("max_speed", summary.max_speed / sound, expect.max_speed);
    if let Some(range) = expect.peak_speed {
        checks.within("peak_speed", summary.max_speed / sound, range);
    }
    if let Some(limit) = expect.density_l1 {
        checks.at_most("density_l1", density_error(scene, ending.snapshot).unwrap_or(f64::NAN), Some(limit));
    }
    if let Some(range) = expect.peak_density {
        let peak = summary.last.as_ref().map_or(f64::NAN, |last| last.density[1].into());
        checks.within("peak_density", peak, range);
    }
    checks.above("min_density", summary.min_density, expect.min_density);
    checks.above("min_pressure", summary.min_pressure, expect.min_pressure);
    checks.at_most("max_iterations", summary.max_iterations.into(), expect.max_iterations.map(f64::from));
    checks.at_most("max_steps", summary.steps as f64, expect.max_steps.map(f64::from));
    checks.probes(expect, &scene.probes, &summary.probes);
    checks.bodies(scene, ending.snapshot);
    checks.0
}

/// Runs a scene to its end and judges it: by its expectations, and what it is warned of.
///
/// # Errors
/// Those of [`Simulation::new`] and [`Simulation::advance_to`].
pub fn run(gpu: &Gpu, scene: &Scene) -> Result<(Vec<Check>, Vec<Warning>)> {
    let mut simulation = Simulation::new(gpu, scene)?;
    let start = Budget::read(&simulation, scene, 0.0)?;
    let mut summary = Summary::default();
    summary.add(&simulation.advance_to(scene.time.until)?);
    let end = Budget::read(&simulation, scene, summary.stored_energy())?;
    let snapshot = simulation.snapshot()?;
    let ending = Ending { start: &start, end: &end, summary: &summary, snapshot: &snapshot };
    Ok((evaluate(scene, &ending), warnings(scene, &ending)))
}

/// The lines so far. A value that is no number passes nothing.
struct Checks(Vec<Check>);

impl Checks {
    fn add(&mut self, name: &str, measured: f64, allowed: String, passed: bool) {
        self.0.push(Check { name: name.to_owned(), measured, allowed, passed });
    }

    fn at_most(&mut self, name: &str, measured: f64, limit: Option<f64>) {
        if let Some(limit) = limit {
            self.add(name, measured, format!("at most {}", plain(limit)), measured <= limit);
        }
    }

    fn above(&mut self, name: &str, measured: f64, limit: Option<f64>) {
        if let Some(limit) = limit {
            self.add(name, measured, format!("above {}", plain(limit)), measured > limit);
        }
    }

    fn within(&mut self, name: &str, measured: f64, [low, high]: [f64; 2]) {
        self.add(name, measured, format!("{} to {}", plain(low), plain(high)), (low..=high).contains(&measured));
    }
}

/// L1 error of the density against the exact solution \[kg m^-2\], if the scene is a shock tube.
pub fn density_error(scene: &Scene, snapshot: &Snapshot) -> Option<f64> {
    let (exact, jump) = scene.riemann()?;
    let spacing = scene.domain.spacing();
    let error = |(cell, &density): (usize, &f32)| {
        let low = scene.domain.origin[0] + cell as f64 * spacing;
        let (expected, _, _) = exact.cell_average(low, low + spacing, jump, snapshot.time);
        (f64::from(density) - expected).abs() * spacing
    };
    Some(snapshot.density.iter().enumerate().map(error).sum())
}
