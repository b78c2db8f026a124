//! How a run ended: its status, its verdict, and what is left to do when there is no time.

use std::collections::BTreeMap;

use super::args::RunOptions;
use super::folder::Folder;
use crate::expect::{Budget, Check, Summary};
use crate::export::report::{self, DeviceReport, Status};
use crate::gpu::Gpu;
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
    match outcome {
        Ok(()) => Status::Finished,
        Err(Error::Interrupted) => Status::Stopped,
        Err(_) => Status::Failed,
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
