//! A case at work: it runs scenes through its session and leaves rows and plots.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use super::row::{Limit, Row, Solver};
use super::{Case, iteration_bound};
use crate::Result;
use crate::diagnostics::StepRecord;
use crate::expect::{Budget, Summary};
use crate::gpu::Gpu;
use crate::render::{Plot, Style};
use crate::scene::{self, Changes, Pair, Scene};
use crate::simulation::Simulation;
use crate::snapshot::Snapshot;
use crate::verify::exact::muscl;
use crate::verify::exact::profile::Profile;

/// Squared deviations below this are rounding, not error.
const ROUNDING: f64 = 1e-12;

/// How much to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suite {
    /// Minutes on two processor cores.
    Quick,
    /// Everything.
    Full,
}

/// Time integration of the gas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Integrator {
    /// That of the paper.
    Paper,
    /// Advection feels the pressure of the step before.
    Predictor,
    /// Two solves per step.
    Ars222,
    /// Two solves where the scene's steps allow them, else one.
    Auto,
}

impl Integrator {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::Paper => "paper",
            Integrator::Predictor => "predictor",
            Integrator::Ars222 => "ars222",
            Integrator::Auto => "auto",
        }
    }

    /// That of a scene, which has made its choice.
    fn of(scene: &Scene) -> Self {
        match scene.integrator() {
            scene::Integrator::Paper => Integrator::Paper,
            scene::Integrator::Predictor => Integrator::Predictor,
            scene::Integrator::Ars222 => Integrator::Ars222,
            scene::Integrator::Auto => Integrator::Auto,
        }
    }
}

/// Name of an element pair in tables and scene files.
pub fn pair_name(pair: Pair) -> &'static str {
    match pair {
        Pair::B1b0 => "b1b0",
        Pair::B2b1 => "b2b1",
    }
}

/// How to run a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Element pair.
    pub pair: Pair,
    /// Time integration.
    pub integrator: Integrator,
    /// Cells along the longest axis; those of the scene if 0.
    pub cells: u32,
}

impl Setting {
    /// The defaults of the method at a resolution.
    pub fn standard(cells: u32) -> Self {
        Setting { pair: Pair::default(), integrator: Integrator::Predictor, cells }
    }
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// The scene as it was run.
    pub scene: Scene,
    /// The end.
    pub snapshot: Snapshot,
    /// The steps.
    pub records: Vec<StepRecord>,
    /// What the steps amount to.
    pub summary: Summary,
    /// Pair, integrator and cells, for tables.
    pub label: String,
    /// What the solver took.
    pub solver: Solver,
    /// Most iterations of a step as a share of its bound; 0 with bodies, whose systems the bound is not for.
    pub solver_load: f64,
}

/// A run that was stopped to look at, and its budgets.
#[derive(Clone, Debug)]
pub struct Journey {
    /// The run.
    pub run: Run,
    /// Mass, momentum and energy before the first step and after the last.
    pub budgets: [Budget; 2],
    /// The start and each stop; the last is the end.
    pub stops: Vec<Snapshot>,
}

/// What the cases of one verification share.
pub struct Common<'a> {
    /// How much to run.
    pub suite: Suite,
    /// Called before each run with its name.
    pub notify: &'a (dyn Fn(&str) + Sync),
    /// Solutions of [`muscl`], by scene and cells.
    references: Mutex<BTreeMap<String, Arc<Profile>>>,
}

impl<'a> Common<'a> {
    /// Nothing computed yet.
    pub fn new(suite: Suite, notify: &'a (dyn Fn(&str) + Sync)) -> Self {
        Common { suite, notify, references: Mutex::default() }
    }
}

/// What cases found.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// All lines.
    pub rows: Vec<Row>,
    /// All plots, with the case they belong to; an empty one stands for the whole.
    pub plots: Vec<(&'static str, Plot)>,
    /// Wall-clock time of each case \[s\].
    pub seconds: Vec<(&'static str, f64)>,
    /// Deviations of eq. (38) over the cells, by title.
    curves: Vec<(String, Vec<[f64; 2]>)>,
}

impl Findings {
    /// Puts those of the next case behind.
    pub fn add(&mut self, next: Findings) {
        self.rows.extend(next.rows);
        self.plots.extend(next.plots);
        self.seconds.extend(next.seconds);
        self.curves.extend(next.curves);
    }

    /// Adds the plot of all errors over cells, as [Cao et al. 2022, fig. 16 left].
    pub fn overview(&mut self) {
        let empty = Plot::new("Squared density deviation, eq. (38), of the default method", "cells", "deviation");
        let curves = std::mem::take(&mut self.curves).into_iter();
        let plot = curves.fold(empty.logarithmic(), |plot, (title, points)| plot.with(title, Style::Both, points));
        self.plots.insert(0, ("", plot));
    }
}

/// One case at work on one device.
pub struct Session<'a> {
    gpu: &'a Gpu,
    common: &'a Common<'a>,
    /// How much to run.
    pub suite: Suite,
    case: &'static str,
    /// Runs of the case: solver, lowest density, lowest pressure, share of the iteration bound, drift of the gas mass.
    health: Vec<(Solver, [f64; 4])>,
    findings: Findings,
}

impl<'a> Session<'a> {
    /// Runs a case to its end. A run that diverges is a failed row, not the end of the verification. What was found before an error
    /// stays.
    pub fn perform(gpu: &'a Gpu, common: &'a Common<'a>, case: &'static Case) -> (Findings, Result<()>) {
        let (suite, health, findings, start) = (common.suite, Vec::new(), Findings::default(), Instant::now());
        let mut session = Session { gpu, common, suite, case: case.id, health, findings };
        let outcome = match (case.run)(&mut session) {
            Err(error @ crate::Error::Diverged { .. }) => {
                session.push(&format!("runs to the end: {error}"), 0.0).source("method").pass(Limit::AtLeast(1.0));
                Ok(())
            }
            other => other,
        };
        if outcome.is_ok() {
            session.report_health();
        }
        session.findings.seconds.push((case.id, start.elapsed().as_secs_f64()));
        (session.findings, outcome)
    }

    /// Runs a shipped scene (path below `scenes/`) with changes as [`Scene::load`] takes them.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`]; a wrong change.
    pub fn run(&mut self, path: &str, setting: Setting, changes: impl Into<Changes>) -> Result<Run> {
        let (scene, label) = self.prepare(path, setting, changes.into())?;
        let mut simulation = Simulation::new(self.gpu, &scene)?;
        let records = simulation.advance_to(scene.time.until)?;
        let snapshot = simulation.snapshot()?;
        Ok(self.finish(Run::new(scene, snapshot, records, label)))
    }

    /// As [`Session::run`], with stops at rising times \[s\]; the last is the end of the run.
    ///
    /// # Errors
    /// As [`Session::run`].
    pub fn follow(
        &mut self,
        path: &str,
        setting: Setting,
        changes: impl Into<Changes>,
        times: impl IntoIterator<Item = f64>,
    ) -> Result<Journey> {
        let (scene, label) = self.prepare(path, setting, changes.into())?;
        let mut simulation = Simulation::new(self.gpu, &scene)?;
        let start = Budget::read(&simulation, &scene, 0.0)?;
        let (mut records, mut stops) = (Vec::new(), vec![simulation.snapshot()?]);
        for time in times {
            records.extend(simulation.advance_to(time)?);
            stops.push(simulation.snapshot()?);
        }
        let run = Run::new(scene, simulation.snapshot()?, records, label);
        let end = Budget::read(&simulation, &run.scene, run.summary.stored_energy())?;
        Ok(Journey { run: self.finish(run), budgets: [start, end], stops })
    }

    /// The scene with its changes, and the name of the run.
    fn prepare(&self, path: &str, setting: Setting, mut changes: Changes) -> Result<(Scene, String)> {
        let Setting { pair, integrator, cells } = setting;
        let method = [("pair", pair_name(pair)), ("integrator", integrator.name())];
        changes.set.splice(0..0, method.map(|(key, value)| format!("numerics.{key}={value}")));
        let mut scene = Scene::shipped(path, changes)?;
        if cells > 0 {
            scene = scene.with_resolution(cells)?;
        }
        let size = scene.domain.cells.map(|n| n.to_string())[..scene.domain.axes()].join("x");
        let label = format!("{} {} {size}", pair_name(pair), Integrator::of(&scene).name());
        (self.common.notify)(&format!("{}: {label}", self.case));
        Ok((scene, label))
    }

    /// Keeps what [`Session::report_health`] wants to know. The bound on the iterations is that of a gas without bodies.
    fn finish(&mut self, run: Run) -> Run {
        let load = if run.scene.bodies.is_empty() { run.solver_load } else { 0.0 };
        self.health.push((run.solver, [run.summary.min_density, run.summary.min_pressure, load, run.mass_drift()]));
        run
    }

    /// Adds a row about a run.
    pub fn check(&mut self, run: &Run, quantity: &str, ours: f64) -> &mut Row {
        let (setting, solver) = (run.label.clone(), run.solver);
        let row = self.push(quantity, ours);
        row.setting = setting;
        row.solver = Some(solver);
        row
    }

    /// Adds a row about several runs.
    pub fn push(&mut self, quantity: &str, ours: f64) -> &mut Row {
        let (setting, source) = (String::new(), String::new());
        let row = Row {
            case: self.case,
            setting,
            quantity: quantity.to_owned(),
            reference: None,
            source,
            ours,
            pass: None,
            good: None,
            known: None,
            solver: None,
        };
        let rows = &mut self.findings.rows;
        rows.push(row);
        let last = rows.len() - 1;
        &mut rows[last]
    }

    /// Runs of a case at two resolutions: the second in the full suite only.
    ///
    /// # Errors
    /// As [`Session::run`].
    pub fn runs(&mut self, path: &str, cells: [u32; 2]) -> Result<Vec<Run>> {
        let count = if self.suite == Suite::Quick { 1 } else { 2 };
        cells.iter().take(count).map(|cells| self.run(path, Setting::standard(*cells), &[])).collect()
    }

    /// Adds a plot to the case.
    pub fn plot(&mut self, plot: Plot) {
        self.findings.plots.push((self.case, plot));
    }

    /// Keeps errors over cells for [`Findings::overview`]; those of mere rounding are left out.
    pub(in crate::verify) fn curve(&mut self, title: &str, points: Vec<[f64; 2]>) {
        if points.iter().all(|point| point[1] > ROUNDING) {
            self.findings.curves.push((title.to_owned(), points));
        }
    }

    /// End of a 1D scene by the independent solver of [`muscl`]; computed once per session.
    ///
    /// # Errors
    /// A scene that cannot have so many cells.
    pub fn fine_reference(&mut self, scene: &Scene, cells: u32) -> Result<Arc<Profile>> {
        let key = format!("{} {cells} {}", scene.title, scene.time.until);
        // held while it is computed: whoever else wants it waits for it
        let mut references = self.common.references.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = references.get(&key) {
            return Ok(Arc::clone(found));
        }
        (self.common.notify)(&format!("{}: MUSCL-HLLC reference {cells}", self.case));
        let profile = Arc::new(muscl::solve(&scene.with_resolution(cells)?));
        references.insert(key, Arc::clone(&profile));
        Ok(profile)
    }

    /// Rows that every case gets: nothing negative anywhere, no gas lost, and a solver that takes no longer than it must.
    fn report_health(&mut self) {
        if self.health.is_empty() {
            return;
        }
        let least = |k: usize| self.health.iter().map(|(_, own)| own[k]).fold(f64::INFINITY, f64::min);
        let (density, pressure) = (least(0), least(1));
        let bounded = self.health.iter().filter(|(_, own)| own[2] > 0.0);
        let hardest = bounded.max_by(|a, b| a.1[2].total_cmp(&b.1[2])).copied();
        self.push("lowest density of all runs", density).source("physics").pass(Limit::Above(0.0));
        self.push("lowest pressure of all runs", pressure).source("physics").pass(Limit::Above(0.0));
        let drift = self.health.iter().map(|(_, own)| own[3]).fold(0.0, f64::max);
        let row = self.push("gas mass, largest drift of all runs", drift).source("conservation law");
        row.pass(Limit::AtMost(1e-6)).known(Limit::AtMost(2e-6), "sums of single precision over thousands of steps");
        if let Some((solver, [_, _, load, _])) = hardest.filter(|(_, own)| own[2] > 0.0) {
            let row = self.push("PCG iterations over bound, worst step", load);
            row.source("conjugate gradients, 1 + 4 d C^2").pass(Limit::AtMost(1.0)).solver = Some(solver);
        }
    }
}

impl Run {
    fn new(scene: Scene, snapshot: Snapshot, records: Vec<StepRecord>, label: String) -> Self {
        let mut summary = Summary::default();
        summary.add(&records);
        let bound = |courant: f64| iteration_bound(scene.domain.dimension, courant, scene.numerics.tolerance);
        let courant = records.iter().map(|record| f64::from(record.courant)).fold(0.0, f64::max);
        let load = records.iter().map(|record| f64::from(record.iterations) / bound(record.courant.into()));
        // the bound is that of a uniform gas: bodies and light nodes around fragments have conditions of their own
        let solver_load = if scene.bodies.is_empty() { load.fold(0.0, f64::max) } else { 0.0 };
        let solver = Solver {
            steps: summary.steps,
            mean_iterations: summary.iterations as f64 / summary.steps.max(1) as f64,
            max_iterations: summary.max_iterations,
            courant,
            bound: bound(courant),
        };
        Run { scene, snapshot, records, summary, label, solver, solver_load }
    }

    /// Largest change of the mass of the gas since the first step, owed gas, what has left and what charges gave included, over the mass or over what
    /// has left, whichever is more.
    fn mass_drift(&self) -> f64 {
        let parts = |record: &StepRecord| {
            [record.gas.mass, record.owed.mass, record.crossed.mass, -record.given.mass].map(f64::from)
        };
        let Some(first) = self.records.first().map(parts) else { return 0.0 };
        let drifts = self.records.iter().map(parts).map(|now| {
            let change: f64 = now.iter().sum::<f64>() - first.iter().sum::<f64>();
            change.abs() / first[0].max(now[2].abs())
        });
        drifts.fold(0.0, f64::max)
    }
}
