//! `bench`: how long the stages of a step take, how many bytes they move, and how fast that is beside a kernel that only copies.

mod table;

use std::path::Path;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::args::{BenchOptions, Cli};
use super::{interrupt, open_device, scenes};
use crate::diagnostics::StepRecord;
use crate::expect::{Budget, Summary};
use crate::gpu::{Detail, Gpu, Times, add_time};
use crate::numerics::{Rounds, copy_bandwidth};
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::stage::traffic::{self, Load};
use crate::state::MemoryPlan;
use crate::state::memory::finest_resolution;
use crate::{Error, Result, input};

/// Time to run towards: far behind the end of any measurement \[s\].
const NEVER: f64 = 1e30;

/// Gas that a measured run may lose or gain, relative to all gas.
const MASS_DRIFT: f64 = 1e-5;

/// Energy of gas and bodies that a measured run may lose or gain, relative to all: violent loads on soft bodies lose some percent.
const ENERGY_DRIFT: f64 = 0.1;

/// One line of the table.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct StageRow {
    stage: String,
    /// Per step.
    milliseconds: f64,
    /// Of the time of all stages.
    share: f64,
    /// Per step, by count.
    bytes: f64,
    /// Bytes over time \[GB/s\].
    gigabytes_per_second: f64,
    /// The same over what a kernel that only copies reaches.
    share_of_copy: f64,
}

/// Result of a measurement.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Measurement {
    version: String,
    scene: String,
    device: String,
    software: bool,
    cells: u64,
    particles: u64,
    steps: u64,
    seconds: f64,
    milliseconds_per_step: f64,
    cells_per_second: f64,
    particles_per_second: f64,
    /// Moves of a particle by an elastic sub-step: what explicit particle codes call particle-steps.
    particle_substeps_per_second: f64,
    pcg_iterations_per_step: f64,
    substeps_per_step: f64,
    bytes_allocated: u64,
    bytes_per_cell_planned: f64,
    bytes_per_particle_planned: f64,
    /// Bytes read and written by a kernel that only copies \[GB/s\].
    copy_gigabytes_per_second: f64,
    /// Gas lost or gained over all gas, with what crossed the sides.
    mass_drift: f64,
    /// Energy of gas and bodies lost or gained over all of it, with what crossed the sides.
    energy_drift: f64,
    stages: Vec<StageRow>,
}

/// Measures a scene, at one size or at several, and prints tables or JSON.
///
/// # Errors
/// Those of a run; a result that is not finite or lost mass; a file to compare with that is none.
pub(super) fn bench(options: &BenchOptions, cli: &Cli) -> Result<()> {
    interrupt::listen();
    let before = options.compare.as_deref().map(earlier).transpose()?;
    let gpu = open_device(cli)?;
    let copy = copy_bandwidth(&gpu, Rounds::MANY)?;
    if options.sweep.is_empty() {
        let measured = measure(&load(options)?, &gpu, copy, options)?;
        return show(cli, &measured, |m| table::print(m, before.as_ref()));
    }
    let mut sizes = Vec::new();
    for cells in &options.sweep {
        let scene = scenes::load(&options.scene, &[])?.with_resolution(*cells)?;
        match measure(&scene, &gpu, copy, options) {
            Ok(measured) => sizes.push(measured),
            Err(error) => {
                show(cli, &sizes, |sizes| table::print_sizes(sizes))?;
                return Err(error);
            }
        }
    }
    show(cli, &sizes, |sizes| table::print_sizes(sizes))
}

/// JSON for programs, text for people.
fn show<T: Serialize>(cli: &Cli, result: &T, print: impl Fn(&T)) -> Result<()> {
    if cli.json {
        say!("{}", serde_json::to_string(result).unwrap_or_default());
    } else {
        print(result);
    }
    Ok(())
}

/// What `--json` printed at an earlier time.
fn earlier(path: &Path) -> Result<Measurement> {
    let text = input::text(path, input::MOST_REPORT).map_err(|error| Error::io(path, error))?;
    serde_json::from_str(&text).map_err(|error| {
        let name = path.display();
        Error::Usage(format!("{name} is no measurement of `brisance bench SCENE --json`: {error}"))
    })
}

/// Warm-up, then steps as `run` makes them for the totals, then as many with a stopwatch for the table.
fn measure(scene: &Scene, gpu: &Gpu, copy: f64, options: &BenchOptions) -> Result<Measurement> {
    let plan = MemoryPlan::fitting(scene, gpu)?;
    let mut simulation = Simulation::new(gpu, scene)?;
    let _heard = interrupt::listen_between_steps();
    simulation.set_target(NEVER)?;
    let warm = summary(&run_steps(&mut simulation, options.warmup)?);
    gpu.wait(None)?;
    let budgets = Budget::read(&simulation, scene, warm.stored_energy())?;
    let start = Instant::now();
    let whole = summary(&run_steps(&mut simulation, options.steps)?);
    let seconds = start.elapsed().as_secs_f64();
    let (records, times) = timed_steps(&mut simulation, options.steps, options.detail())?;
    let timed = summary(&records);
    let drift = Budget::read(&simulation, scene, timed.stored_energy())?.drift_since(&budgets);
    let [mass_drift, energy_drift] = ["gas_mass", "energy"].map(|name| drift[name].abs());
    sound(mass_drift, energy_drift)?;
    let load = Load {
        slots: simulation.state.grid.slots() as u64,
        particles: plan.particles,
        steps: timed.steps,
        iterations: timed.iterations,
        substeps: timed.substeps,
        carrier: scene.consistent(),
        quadratic: simulation.state.quadratic,
    };
    let per_second = |count: u64| count as f64 * whole.steps as f64 / seconds;
    Ok(Measurement {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: options.scene.scene.clone(),
        device: gpu.info.name.clone(),
        software: gpu.is_software(),
        cells: plan.cells,
        particles: plan.particles,
        steps: whole.steps,
        seconds,
        milliseconds_per_step: 1e3 * seconds / whole.steps as f64,
        cells_per_second: per_second(plan.cells),
        particles_per_second: per_second(plan.particles),
        particle_substeps_per_second: plan.particles as f64 * whole.substeps as f64 / seconds,
        pcg_iterations_per_step: whole.iterations as f64 / whole.steps as f64,
        substeps_per_step: whole.substeps as f64 / whole.steps as f64,
        bytes_allocated: gpu.allocated_bytes(),
        bytes_per_cell_planned: plan.per_cell(),
        bytes_per_particle_planned: plan.per_particle(),
        copy_gigabytes_per_second: copy,
        mass_drift,
        energy_drift,
        stages: rows(&times, &load, copy),
    })
}

/// Fast and wrong is no result. What is not finite has stopped the run before.
fn sound(mass_drift: f64, energy_drift: f64) -> Result<()> {
    for (name, drift, most) in [("gas", mass_drift, MASS_DRIFT), ("energy", energy_drift, ENERGY_DRIFT)] {
        if drift.is_nan() || drift > most {
            return Err(Error::Expectation(format!(
                "no score: the measured steps lost or gained {drift:.1e} of the {name}, allowed are {most:.0e}; `brisance run` of the scene has \
                 the budgets in diagnostics.csv"
            )));
        }
    }
    Ok(())
}

/// The scene at the size asked for.
fn load(options: &BenchOptions) -> Result<Scene> {
    let scene = scenes::load(&options.scene, &[])?;
    let Some(most) = options.cells else { return Ok(scene) };
    // Larger scenes of the same shape are found by refining first.
    let longest = scene.domain.cells.iter().copied().max().unwrap_or(1);
    let count = scene.domain.cell_count() as f64;
    let factor = (most as f64 / count).powf(1.0 / f64::from(scene.domain.dimension)).ceil().max(1.0) as u32;
    let large = scene.with_resolution(longest.saturating_mul(factor.saturating_add(1)))?;
    let largest = large.domain.cells.iter().copied().max().unwrap_or(1);
    let cells_at = |cells: u32| {
        let ratio = f64::from(cells) / f64::from(largest);
        large.domain.cell_count() as f64 * ratio.powi(large.domain.dimension as i32)
    };
    let fitting = finest_resolution(&large, |cells| cells_at(cells) <= most as f64 * (1.0 + 1e-9));
    let cells =
        fitting.ok_or_else(|| Error::Usage(format!("--cells {most} is too few for {}", options.scene.scene)))?;
    scene.with_resolution(cells)
}

fn summary(records: &[StepRecord]) -> Summary {
    let mut summary = Summary::default();
    summary.add(records);
    summary
}

/// Runs at least `steps` steps in whole submissions.
fn run_steps(simulation: &mut Simulation, steps: u32) -> Result<Vec<StepRecord>> {
    let mut records = Vec::new();
    while records.len() < steps as usize {
        stop_if_asked()?;
        simulation.advance_batch(&mut records)?;
    }
    Ok(records)
}

/// Runs at least `steps` steps one by one and adds up the milliseconds of each stage or kernel.
fn timed_steps(simulation: &mut Simulation, steps: u32, detail: Detail) -> Result<(Vec<StepRecord>, Times)> {
    let mut records = Vec::new();
    let mut sums = Times::new();
    while records.len() < steps as usize {
        stop_if_asked()?;
        let (_, times) = simulation.advance_timed(&mut records, detail)?;
        times.iter().for_each(|(stage, time)| add_time(&mut sums, stage, *time));
    }
    Ok((records, sums))
}

fn stop_if_asked() -> Result<()> {
    if interrupt::wish() { Err(Error::Interrupted) } else { Ok(()) }
}

/// Times and bytes per step of each stage.
fn rows(times: &[(String, f64)], load: &Load, copy: f64) -> Vec<StageRow> {
    let total: f64 = times.iter().map(|(_, time)| time).sum();
    let steps = load.steps as f64;
    let row = |(stage, time): &(String, f64)| {
        let bytes = traffic::bytes(stage, load) as f64;
        StageRow {
            stage: stage.clone(),
            milliseconds: time / steps,
            share: time / total,
            bytes: bytes / steps,
            gigabytes_per_second: bytes / (1e6 * time),
            share_of_copy: bytes / (1e6 * time * copy),
        }
    };
    times.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_loses_gas_has_no_score() {
        assert!(sound(0.5 * MASS_DRIFT, 0.5 * ENERGY_DRIFT).is_ok());
        assert!(sound(0.0, 2.0 * ENERGY_DRIFT).unwrap_err().to_string().contains("energy"));
        for drift in [2.0 * MASS_DRIFT, f64::INFINITY, f64::NAN] {
            assert!(sound(drift, 0.0).unwrap_err().to_string().contains("no score"), "{drift}");
        }
    }
}
