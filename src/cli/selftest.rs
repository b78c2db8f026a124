//! `selftest`: whether a device computes what it should. Small cases against values from the host in double precision, exact solutions,
//! conservation and each other; then a short bench. A stranger attaches its file to an issue.

mod cases;
mod host;
mod picture;

use std::time::Instant;

use serde::Serialize;
use serde_json::json;

use super::args::{Cli, SelftestOptions};
use super::init::not_an_input;
use super::list::settings;
use super::open_device;
use crate::diagnostics::StepRecord;
use crate::export::atomic;
use crate::gpu::Gpu;
use crate::math::plain;
use crate::numerics::{Rounds, copy_bandwidth};
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::{Error, Result};

/// What a case found: the largest difference from what should be, and where.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// Largest difference, relative unless the case says otherwise.
    difference: f64,
    /// What it may be.
    limit: f64,
    /// Cell or element of the largest difference.
    place: String,
}

impl Found {
    /// Of two arrays: the largest difference over the largest value of `should`, with its index.
    fn between(is: &[f64], should: &[f64], limit: f64, name: impl Fn(usize) -> String) -> Self {
        let scale = should.iter().fold(0.0, |most: f64, value| most.max(value.abs())).max(f64::MIN_POSITIVE);
        let mut found = Self { difference: 0.0, limit, place: String::new() };
        for (index, (is, should)) in is.iter().zip(should).enumerate() {
            let apart = (is - should).abs() / scale;
            // A value that is no number is the worst.
            let difference = if apart.is_nan() { f64::INFINITY } else { apart };
            if difference > found.difference {
                found.difference = difference;
                found.place = format!("{}: {} instead of {}", name(index), plain(*is), plain(*should));
            }
        }
        if is.len() != should.len() {
            found.difference = f64::INFINITY;
            found.place = format!("{} values instead of {}", is.len(), should.len());
        }
        found
    }

    fn passed(&self) -> bool {
        self.difference <= self.limit
    }
}

/// A case: its name, the stage that is to blame, the work.
pub(super) struct Case {
    name: &'static str,
    stage: &'static str,
    run: fn(&Gpu, bool) -> Result<Found>,
}

/// One line of the table.
#[derive(Debug, Serialize)]
struct Line {
    case: &'static str,
    stage: &'static str,
    passed: bool,
    difference: Option<f64>,
    limit: Option<f64>,
    place: String,
    seconds: f64,
}

/// Runs the cases, prints a table, writes the file.
///
/// # Errors
/// [`Error::Expectation`] with the first stage that is wrong; [`Error::NoAdapter`], [`Error::Gpu`], [`Error::Io`].
pub(super) fn selftest(options: &SelftestOptions, cli: &Cli) -> Result<()> {
    options.out.as_ref().map_or(Ok(()), |path| not_an_input(path, ""))?;
    let gpu = open_device(cli)?;
    let name = &gpu.info.name;
    if !cli.json {
        say!("{}\nsettings of {}\n", gpu.summary(), settings(&gpu));
    }
    let wanted = |case: &&Case| options.filter.as_ref().is_none_or(|part| case.name.contains(part.as_str()));
    let mut lines = Vec::new();
    for case in cases::CASES.iter().filter(wanted) {
        let line = perform(case, &gpu, options.full)?;
        if !cli.json {
            say!("{}", row(&line));
        }
        lines.push(line);
    }
    if lines.is_empty() {
        let names: Vec<_> = cases::CASES.iter().map(|case| case.name).collect();
        return Err(Error::Usage(format!("no case matches; there are: {}", names.join(", "))));
    }
    let bench = if options.filter.is_some() { Vec::new() } else { bench(&gpu, cli, options.full)? };
    let passed = lines.iter().filter(|line| line.passed).count();
    let path = options.out.clone().unwrap_or_else(|| format!("selftest-{}.json", file_name(name)).into());
    let adapter = gpu.summary();
    let limits: serde_json::Map<_, _> =
        adapter.limits.iter().map(|(name, value)| ((*name).to_owned(), json!(value))).collect();
    let report = json!({ "version": env!("CARGO_PKG_VERSION"), "full": options.full, "system": std::env::consts::OS,
        "device": { "name": adapter.name, "kind": adapter.kind, "backend": adapter.backend, "driver": adapter.driver,
            "max_binding": adapter.max_binding, "max_buffer": adapter.max_buffer, "limits": limits,
            "timestamps": gpu.timestamps, "settings": settings(&gpu) },
        "passed": passed, "cases": lines, "bench": bench });
    atomic::write(&path, |file| writeln!(file, "{report:#}"))?;
    if cli.json {
        say!("{report}");
    } else {
        say!("\n{passed} of {} cases passed; {}", lines.len(), path.display());
    }
    match lines.iter().find(|line| !line.passed) {
        None => Ok(()),
        Some(line) => Err(Error::Expectation(format!(
            "{name}: `{}` is the first case that is wrong, stage {}: {}; please attach {} to an issue",
            line.case,
            line.stage,
            line.place,
            path.display()
        ))),
    }
}

/// Runs a case. A case that ends with an error of the device's results is a failed one; a lost device ends the test.
fn perform(case: &Case, gpu: &Gpu, full: bool) -> Result<Line> {
    let start = Instant::now();
    let outcome = (case.run)(gpu, full);
    let seconds = start.elapsed().as_secs_f64();
    let line = |passed, difference: f64, limit: f64, place| Line {
        case: case.name,
        stage: case.stage,
        passed,
        difference: difference.is_finite().then_some(difference),
        limit: limit.is_finite().then_some(limit),
        place,
        seconds,
    };
    match outcome {
        Ok(found) => Ok(line(found.passed(), found.difference, found.limit, found.place)),
        Err(error @ (Error::Diverged { .. } | Error::Shader(_) | Error::Bug(_) | Error::DoesNotFit(_))) => {
            Ok(line(false, f64::INFINITY, f64::INFINITY, error.to_string()))
        }
        Err(error) => Err(error),
    }
}

/// A line for people.
fn row(line: &Line) -> String {
    let verdict = if line.passed { "ok  " } else { "FAIL" };
    let number = |value: Option<f64>| value.map_or("none".to_owned(), |value| format!("{value:.1e}"));
    let (difference, limit) = (number(line.difference), number(line.limit));
    let place = if line.passed { "" } else { &line.place };
    format!(
        "{verdict} {:34} {:22} {difference:>8} of {limit:>8} {:6.1} s  {place}",
        line.case, line.stage, line.seconds
    )
}

/// Recordings that may pass without the end of a step.
const PATIENCE: usize = 50;

/// Makes steps.
fn advance(simulation: &mut Simulation, steps: usize) -> Result<Vec<StepRecord>> {
    let (mut records, mut idle) = (Vec::new(), 0);
    while records.len() < steps {
        let before = records.len();
        simulation.advance_batch_of(&mut records, (steps - before) as u32)?;
        idle = if records.len() > before { 0 } else { idle + 1 };
        if idle > PATIENCE {
            let name = &simulation.gpu().info.name;
            return Err(Error::Gpu(format!("{name} does not finish a step: its control is stuck; try a newer driver")));
        }
    }
    Ok(records)
}

/// Letters, digits and hyphens of a device's name.
fn file_name(name: &str) -> String {
    let parts = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("-").to_lowercase()
}

/// Scenes of the short bench, with cells along the longest axis: short and full.
const BENCH: [(&str, [u32; 2]); 4] = [
    ("sod", [400, 1600]),
    ("fig16_convergence", [128, 1024]),
    ("bursting_shell_3d", [16, 64]),
    ("gelatine_3d", [16, 32]),
];
/// Steps before the clock runs, and while it does.
const STEPS: [usize; 2] = [2, 8];

/// Milliseconds per step of four scenes, and the bandwidth of a copy.
fn bench(gpu: &Gpu, cli: &Cli, full: bool) -> Result<Vec<serde_json::Value>> {
    let copy = copy_bandwidth(gpu, Rounds::MANY)?;
    if !cli.json {
        say!("\ncopy       {copy:.1} GB/s");
    }
    let mut rows = vec![json!({ "copy_gigabytes_per_second": copy })];
    for (name, cells) in BENCH {
        // A large scene on a processor would take minutes.
        let cells = cells[usize::from(full && !gpu.is_software())];
        let scene = Scene::find(name, &[])?.with_resolution(cells)?;
        let mut simulation = Simulation::new(gpu, &scene)?;
        simulation.set_target(1e30)?;
        let mut run = |steps: usize| -> Result<f64> {
            let start = Instant::now();
            let records = advance(&mut simulation, steps)?;
            Ok(1e3 * start.elapsed().as_secs_f64() / records.len() as f64)
        };
        let first = run(STEPS[0])?;
        let each = run(STEPS[1])?;
        if !cli.json {
            say!(
                "{name:20} {cells:5} cells along the longest axis {each:9.2} ms per step; the first ones {first:.0} ms"
            );
        }
        rows.push(json!({ "scene": name, "cells": cells, "ms_per_step": each, "first_ms_per_step": first }));
    }
    Ok(rows)
}
