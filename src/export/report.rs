//! report.json: what was run, where, how long it took and what it conserved.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::Result;
use crate::expect::Check;
use crate::export::atomic;

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

/// Contents of report.json. `S` is the scene with its defaults filled in.
#[derive(Debug, Clone, Serialize)]
pub struct Report<S> {
    /// Version of Brisance.
    pub version: &'static str,
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
    /// [`crate::scene::Scene::hash`] of the scene: what pictures and states say about where they come from.
    pub scene_hash: String,
    /// File or name of the scene; paths in it start there.
    pub scene_file: String,
    /// The scene as it was run.
    pub scene: S,
}

/// Writes any report as indented JSON.
pub fn write(path: &Path, report: &impl Serialize) -> Result<()> {
    atomic::write(path, |out| {
        serde_json::to_writer_pretty(&mut *out, report)?;
        out.write_all(b"\n")
    })
}
