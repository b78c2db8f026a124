//! How a run ended: its status, its verdict, and what is left to do when there is no time.

use std::collections::BTreeMap;

use super::args::RunOptions;
use super::folder::Folder;
use crate::expect::{self, Budget, Check, Ending, Summary, Warning};
use crate::export::report::{self, DeviceReport, Status};
use crate::gpu::Gpu;
use crate::scene::{Scene, Warned};
use crate::{Error, Result, input};

/// What is left to do when the process ends at once: the report says so, and the folder is free.
pub(super) fn last_words(folder: &Folder) -> impl FnMut() + Send + use<> {
    let (report, lock) = (folder.path.join("report.json"), folder.lock().to_owned());
    move || {
        let text = input::text(&report, input::MOST_REPORT).ok();
        let read = text.and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok());
        if let Some(mut read) = read.filter(|read| read["status"] == "running") {
            read["status"] = "stopped".into();
            read["outcome"] = Error::Interrupted.to_string().into();
            let _ = report::write(&report, &read);
        }
        let _ = std::fs::remove_file(&lock);
    }
}

/// The device as reports name it.
pub(super) fn device(gpu: &Gpu) -> DeviceReport {
    let info = &gpu.info;
    DeviceReport {
        name: info.name.clone(),
        backend: info.backend.to_string(),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        software: gpu.is_software(),
    }
}

/// Totals at the end, by name.
pub(super) fn totals(summary: &Summary, end: &Budget) -> BTreeMap<String, f64> {
    let values = [
        ("gas_mass", end.gas_mass),
        ("solid_mass", end.solid_mass),
        ("energy_with_crossed", end.energy),
        ("momentum_x_with_crossed", end.momentum[0]),
        ("momentum_y_with_crossed", end.momentum[1]),
        ("momentum_z_with_crossed", end.momentum[2]),
        ("pcg_iterations", summary.iterations as f64),
        ("pcg_iterations_max", summary.max_iterations.into()),
        ("pcg_residual_max", summary.max_residual),
        ("substeps", summary.substeps as f64),
        ("min_density", summary.min_density),
        ("min_pressure", summary.min_pressure),
        ("max_speed", summary.max_speed),
        ("floored_cells", summary.floored as f64),
    ];
    values.map(|(name, value)| (name.to_owned(), value)).into()
}

/// How far a run came.
pub(super) fn status(outcome: &Result<()>) -> Status {
    outcome.as_ref().err().map_or(Status::Finished, ended)
}

/// What has become of a run that did not come to its end.
pub(super) fn ended(error: &Error) -> Status {
    match error {
        Error::Interrupted => Status::Stopped,
        _ => Status::Failed,
    }
}

/// Sections whose keys change no number of the result.
const LOOKS: [&str; 6] = ["render.", "output.", "expect.", "title", "description", "time.frames"];

/// What the command line changed about the experiment.
pub(super) fn changed_by_hand(options: &RunOptions) -> Option<String> {
    if options.scene.resolution.is_some() {
        return Some("the resolution".to_owned());
    }
    if options.until.is_some() {
        return Some("the end".to_owned());
    }
    let key = |set: &String| set.split('=').next().unwrap_or_default().trim().to_owned();
    options.scene.set.iter().map(key).find(|key| !LOOKS.iter().any(|look| key.starts_with(look)))
}

/// What the command line changed about the scene, as it was given.
pub(super) fn changes(options: &RunOptions) -> Vec<String> {
    let scene = &options.scene;
    let branch = options.branch.then(|| format!("--branch {}", scene.scene));
    let variants = scene.variant.iter().map(|variant| format!("--variant {variant}"));
    let resolution = scene.resolution.map(|cells| format!("--resolution {cells}"));
    let sets = scene.set.iter().map(|set| format!("--set {set}"));
    let until = options.until.map(|until| format!("--until {until}"));
    let frames = options.frames.map(|frames| format!("--frames {frames}"));
    branch.into_iter().chain(variants).chain(resolution).chain(sets).chain(until).chain(frames).collect()
}

/// The error of a run whose checks failed.
pub(super) fn verdict(checks: &[Check]) -> Result<()> {
    let failed: Vec<String> = checks.iter().filter(|check| !check.passed).map(|check| check.name.clone()).collect();
    if failed.is_empty() {
        return Ok(());
    }
    Err(Error::Expectation(format!(
        "the run does not meet the scene's [expect]: {}; report.json has the values, --no-expect skips the check",
        failed.join(", ")
    )))
}

/// What is said of a run at its end.
#[derive(Debug, Default)]
pub(super) struct Verdict {
    /// Against `[expect]`, if that was asked for.
    pub(super) checks: Vec<Check>,
    /// All watched numbers, and those over their limits.
    pub(super) watched: BTreeMap<Warned, f64>,
    pub(super) warnings: Vec<Warning>,
    /// Expected warnings that did not come.
    pub(super) absent: Vec<Warned>,
}

impl Verdict {
    /// That of the state as it is now.
    pub(super) fn of(scene: &Scene, ending: &Ending<'_>, expects: bool) -> Self {
        let warnings = expect::warnings(scene, ending);
        let absent = expect::absent(scene, &warnings);
        Self {
            checks: if expects { expect::evaluate(scene, ending) } else { Vec::new() },
            watched: expect::watched(scene, ending),
            warnings,
            absent,
        }
    }

    /// Tells the warnings.
    pub(super) fn tell(&self) {
        for warning in &self.warnings {
            match warning.expected {
                None => tell!("warning: {warning}"),
                Some(_) => tell!("note: {warning}"),
            }
        }
        for name in &self.absent {
            tell!("note: the scene expects a warning of {}, which did not come; see [expect] warnings", name.name());
        }
    }

    /// The error of a run that bears no warning but those that are expected.
    pub(super) fn strict(&self) -> Result<()> {
        let names =
            self.warnings.iter().filter(|warning| warning.expected.is_none()).map(|warning| warning.name.name());
        match names.collect::<Vec<_>>().join(", ") {
            names if names.is_empty() => Ok(()),
            names => Err(Error::Expectation(format!(
                "--strict: the run is warned of {names}; report.json has the values, [expect] warnings bears those that are right"
            ))),
        }
    }
}
