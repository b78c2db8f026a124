//! report.json: what was run, where, how long it took and what it conserved.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use serde::Serialize;

use crate::expect::{Check, Gauge, Warning};
use crate::export::atomic;
use crate::scene::{self, Warned};
use crate::{Error, Result};

/// Name of the file.
pub const REPORT: &str = "report.json";
/// Version of its form: that of the scene in it. A report that names none has the first one.
pub const FORM: u32 = scene::FORM;

/// The device a run used.
#[derive(Debug, Clone, Serialize)]
pub struct DeviceReport {
    /// Name of the adapter.
    pub name: String,
    /// Graphics interface, such as `vulkan`.
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether it is a processor playing a graphics card.
    pub software: bool,
}

impl DeviceReport {
    /// As one line.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{} ({}, {})", self.name, self.backend, self.driver)
    }
}

/// How far a run came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It goes on, or its process was killed; the other entries are those of the last frame.
    Running,
    /// It came to its end, whatever its expectations say.
    Finished,
    /// Somebody stopped it.
    Stopped,
    /// Something went wrong; `outcome` says what went wrong first.
    Failed,
}

/// A quantity over time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Span {
    /// Its first value.
    pub first: f64,
    /// Its last value.
    pub last: f64,
    /// Its least value.
    pub least: f64,
    /// Its largest value.
    pub largest: f64,
    /// When that was \[s\].
    pub largest_time: f64,
}

/// Contents of report.json. `S` is the scene with its defaults filled in.
#[derive(Debug, Clone, Serialize)]
pub struct Report<S> {
    /// [`FORM`].
    pub form: u32,
    /// Version of Brisance.
    pub version: &'static str,
    /// How far it came.
    pub status: Status,
    /// `running`, `finished`, or the error message.
    pub outcome: String,
    /// Simulated time reached \[s\].
    pub time: f64,
    /// Steps done.
    pub steps: u64,
    /// Frames written.
    pub frames: u32,
    /// Wall clock time of the run \[s\].
    pub wall_seconds: f64,
    /// The device.
    pub device: DeviceReport,
    /// Particles at the start.
    pub particles: u64,
    /// Bytes of device memory by use.
    pub memory: BTreeMap<String, u64>,
    /// Seconds by activity or stage.
    pub timings: BTreeMap<String, f64>,
    /// Totals at the end: masses, momenta, energies, solver iterations.
    pub totals: BTreeMap<String, f64>,
    /// Relative change of each conserved total since the start, after what crossed the boundaries.
    pub drift: BTreeMap<String, f64>,
    /// The scene's expectations against what was measured; empty if they were not asked for.
    pub expect: Vec<Check>,
    /// All numbers that the program watches, see `docs/inside/warnings.md`.
    pub watched: BTreeMap<Warned, f64>,
    /// What the program warns of at the end, see `docs/inside/warnings.md`.
    pub warnings: Vec<Warning>,
    /// Warnings that the scene expects and that did not come.
    pub absent_warnings: Vec<Warned>,
    /// What each gauge has measured; empty while the run goes on.
    pub gauges: BTreeMap<String, Gauge>,
    /// Quantities of each body over the frames, by the columns of `bodies.csv`; empty while the run goes on.
    pub bodies: BTreeMap<String, BTreeMap<String, Span>>,
    /// Extremes over the steps, by the columns of `diagnostics.csv`; empty while the run goes on.
    pub extremes: BTreeMap<String, Span>,
    /// What the command line changed about the scene.
    pub changes: Vec<String>,
    /// [`crate::scene::Scene::hash`] of the scene: what pictures and states say about where they come from.
    pub scene_hash: String,
    /// File or name of the scene; paths in it start there.
    pub scene_file: String,
    /// The scene as it was run.
    pub scene: S,
}

/// Writes any report as indented JSON. On a full disk it takes the place of the earlier one, in one line, which is shorter.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn write(path: &Path, report: &impl Serialize) -> Result<()> {
    let mut text = serde_json::to_vec_pretty(report).map_err(|error| Error::io(path, error.into()))?;
    text.push(b'\n');
    atomic::write(path, |out| out.write_all(&text)).or_else(|error| {
        let line = serde_json::to_vec(report).unwrap_or_default();
        in_place(path, &line).map_err(|_| error)
    })
}

/// Writes over a file that is at least as long: no room is asked for.
fn in_place(path: &Path, text: &[u8]) -> std::io::Result<()> {
    let mut file = std::fs::OpenOptions::new().write(true).open(path)?;
    if file.metadata()?.len() < text.len() as u64 {
        return Err(std::io::ErrorKind::StorageFull.into());
    }
    file.write_all(text)?;
    file.set_len(text.len() as u64)
}
