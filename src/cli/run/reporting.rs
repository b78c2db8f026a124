//! report.json of a run: from the moment that the folder is its own to the end, whatever the end is.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use super::super::outcome::{Verdict, changes, device};
use super::super::writer::Written;
use super::{Beginning, Run};
use crate::Result;
use crate::export::report::{self, REPORT, Report, Status};
use crate::gpu::Gpu;
use crate::state::MemoryPlan;

/// A process that is killed leaves a report that is no older.
const OLDEST: Duration = Duration::from_secs(10);
/// Frames that follow each other faster share a report.
const OFTEN: Duration = Duration::from_millis(500);

/// A run before its first step: scene, device and memory are known, kernels are not compiled yet.
pub(super) struct Setup<'a> {
    pub(super) beginning: &'a Beginning,
    pub(super) gpu: &'a Gpu,
    pub(super) plan: &'a MemoryPlan,
    pub(super) start: Instant,
}

impl Setup<'_> {
    /// Writes what there is to say; a run that goes on has come as far as its checkpoint.
    pub(super) fn write_report(&self, folder: &Path, (status, outcome): (Status, &str)) -> Result<()> {
        let Self { beginning, gpu, plan, start } = self;
        let (time, steps, frames) = beginning.come_to();
        let report = Report {
            form: report::FORM,
            version: env!("CARGO_PKG_VERSION"),
            status,
            outcome: outcome.to_owned(),
            time,
            steps,
            frames,
            wall_seconds: start.elapsed().as_secs_f64(),
            device: device(gpu),
            particles: plan.particles,
            memory: plan.groups().into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect(),
            timings: BTreeMap::new(),
            totals: BTreeMap::new(),
            drift: BTreeMap::new(),
            expect: Vec::new(),
            watched: BTreeMap::new(),
            warnings: Vec::new(),
            absent_warnings: Vec::new(),
            scene_hash: beginning.scene.hash(),
            gauges: BTreeMap::new(),
            bodies: BTreeMap::new(),
            extremes: BTreeMap::new(),
            changes: changes(&beginning.options),
            scene_file: beginning.place.clone(),
            scene: &beginning.scene,
        };
        report::write(&folder.join(REPORT), &report)
    }
}

impl Run<'_> {
    /// How far the run is, for whoever looks, and for whoever finds what a killed process left.
    pub(super) fn report_so_far(&mut self) -> Result<()> {
        if self.reported.elapsed() < OLDEST { Ok(()) } else { self.report_now() }
    }

    /// The same behind a frame: of the first two, and of those that are not too close.
    pub(super) fn report_frame(&mut self, index: u32) -> Result<()> {
        if index > 1 && self.reported.elapsed() < OFTEN { Ok(()) } else { self.report_now() }
    }

    fn report_now(&mut self) -> Result<()> {
        self.reported = Instant::now();
        let written = Written { frames: self.frame.map_or(0, |last| last + 1), ..Written::default() };
        self.write_report((Status::Running, "running"), written, Verdict::default()).map(|_| ())
    }
}
