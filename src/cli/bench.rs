//! `bench`: how long the stages of a step take, and how many bytes they move.

use std::time::Instant;

use serde::Serialize;

use super::args::{BenchOptions, Cli};
use super::check::size;
use super::{interrupt, open_device, scenes};
use crate::diagnostics::StepRecord;
use crate::expect::Summary;
use crate::gpu::Detail;
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::stage::traffic::{self, Load};
use crate::state::MemoryPlan;
use crate::state::memory::resolutions;
use crate::{Error, Result};

/// Time to run towards: far behind the end of any measurement \[s\].
const NEVER: f64 = 1e30;

/// One line of the table.
#[derive(Clone, Debug, Serialize)]
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
}

/// Result of a measurement.
#[derive(Clone, Debug, Serialize)]
struct Measurement {
    version: &'static str,
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
    stages: Vec<StageRow>,
}

/// Measures a scene: warm-up, then steps as `run` makes them for the totals, then as many with a stopwatch for the table.
///
/// # Errors
/// Those of a run.
pub(super) fn bench(options: &BenchOptions, cli: &Cli) -> Result<()> {
    interrupt::listen();
    let scene = load(options)?;
    let gpu = open_device(cli)?;
    let plan = MemoryPlan::fitting(&scene, &gpu)?;
    let mut simulation = Simulation::new(&gpu, &scene)?;
    simulation.set_target(NEVER)?;
    run_steps(&mut simulation, options.warmup)?;
    gpu.wait(None)?;
    let start = Instant::now();
    let whole = summary(&run_steps(&mut simulation, options.steps)?);
    let seconds = start.elapsed().as_secs_f64();
    let (records, times) = timed_steps(&mut simulation, options.steps, options.detail())?;
    let timed = summary(&records);
    let load = Load {
        slots: simulation.state.grid.slots() as u64,
        particles: plan.particles,
        steps: timed.steps,
        iterations: timed.iterations,
        substeps: timed.substeps,
        carrier: scene.consistent(),
    };
    let per_second = |count: u64| count as f64 * whole.steps as f64 / seconds;
    let measurement = Measurement {
        version: env!("CARGO_PKG_VERSION"),
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
        stages: rows(&times, &load),
    };
    if cli.json {
        say!("{}", serde_json::to_string(&measurement).unwrap_or_default());
    } else {
        print(&measurement);
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
    let fitting = resolutions(&large).find(|&cells| cells_at(cells) <= most as f64 * (1.0 + 1e-9));
    let cells =
        fitting.ok_or_else(|| Error::Usage(format!("--cells {most} is too few for {}", options.scene.scene)))?;
    scene.with_resolution(cells)
}

/// Stages with their milliseconds.
type StageTimes = Vec<(String, f64)>;

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
fn timed_steps(simulation: &mut Simulation, steps: u32, detail: Detail) -> Result<(Vec<StepRecord>, StageTimes)> {
    let mut records = Vec::new();
    let mut sums = StageTimes::new();
    while records.len() < steps as usize {
        stop_if_asked()?;
        let (_, times) = simulation.advance_timed(&mut records, detail)?;
        for (stage, time) in times {
            match sums.iter_mut().find(|(known, _)| *known == stage) {
                Some((_, sum)) => *sum += time,
                None => sums.push((stage, time)),
            }
        }
    }
    Ok((records, sums))
}

fn stop_if_asked() -> Result<()> {
    if interrupt::wish() == interrupt::Wish::GoOn { Ok(()) } else { Err(Error::Interrupted) }
}

/// Times and bytes per step of each stage.
fn rows(times: &[(String, f64)], load: &Load) -> Vec<StageRow> {
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
        }
    };
    times.iter().map(row).collect()
}

fn print(m: &Measurement) {
    say!("{} on {}: {} cells, {} particles", m.scene, m.device, m.cells, m.particles);
    let width = m.stages.iter().map(|row| row.stage.len()).max().unwrap_or(0).max(24);
    if m.stages.is_empty() {
        say!("(this device has no timestamps: no table of stages)");
    } else {
        say!("\n{:width$} {:>10} {:>8} {:>12} {:>8}", "stage", "ms/step", "share", "MB/step", "GB/s");
    }
    for row in &m.stages {
        let (share, megabytes) = (100.0 * row.share, row.bytes / 1e6);
        let speed = row.gigabytes_per_second;
        // Bytes are counted per stage, not per kernel.
        let moved = if row.bytes > 0.0 { format!("{megabytes:12.3} {speed:8.2}") } else { String::new() };
        say!("{:width$} {:10.4} {share:6.1} % {moved}", row.stage, row.milliseconds);
    }
    say!("\n{:24} {:>14}", "steps", m.steps);
    say!("{:24} {:>14.4}", "milliseconds per step", m.milliseconds_per_step);
    say!("{:24} {:>14.4e}", "cells/s", m.cells_per_second);
    say!("{:24} {:>14.4e}", "particles/s", m.particles_per_second);
    say!("{:24} {:>14.4e}", "particle sub-steps/s", m.particle_substeps_per_second);
    say!("{:24} {:>14.2}", "PCG iterations per step", m.pcg_iterations_per_step);
    say!("{:24} {:>14.2}", "sub-steps per step", m.substeps_per_step);
    say!("{:24} {:>14}", "bytes allocated", size(m.bytes_allocated));
    say!("{:24} {:>14.1}", "planned bytes per cell", m.bytes_per_cell_planned);
    say!("{:24} {:>14.1}", "... per particle", m.bytes_per_particle_planned);
}
