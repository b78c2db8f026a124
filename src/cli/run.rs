//! `run`: a scene to pictures, tables and a report.

mod beginning;
mod checkpoint;
mod formats;

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::args::{Cli, RunOptions};
use super::check::overlap_text;
use super::folder::Folder;
use super::init::not_an_input;
use super::interrupt;
use super::outcome::{Verdict, changed_by_hand, device, last_words, status, totals, verdict};
use super::progress::{Progress, clock};
use super::writer::{Files, FrameToWrite, Message, Writer, Written};
use super::{film, open_device};
use crate::diagnostics::StepRecord;
use crate::expect::{Budget, Check, Ending, Summary};
use crate::export::Needs;
use crate::export::report::{self, Report, Status};
use crate::gpu::Gpu;
use crate::math::plain;
use crate::render::{Renderer, SceneBuffers, Stored};
use crate::scene::Scene;
use crate::simulation::{BATCH, Simulation};
use crate::snapshot::Snapshot;
use crate::state::MemoryPlan;
use crate::{Error, Result};
use beginning::Beginning;
use checkpoint::Schedule;
pub(super) use checkpoint::{Checkpoint, Every};
use formats::formats;
pub(super) use formats::{PICTURES, without_coarse};

/// Runs a scene.
///
/// # Errors
/// Everything that can go wrong; what was computed before is on the disk, and the report says what happened.
pub(super) fn run(options: &RunOptions, cli: &Cli) -> Result<()> {
    interrupt::listen();
    perform(options, cli, cli.json)
}

/// The same, with or without the report on standard output.
pub(super) fn perform(options: &RunOptions, cli: &Cli, json: bool) -> Result<()> {
    let start = Instant::now();
    let beginning = Beginning::of(options)?;
    begun(&beginning, &open_device(cli)?, (start, json))
}

/// The same on a device that is open; its kernels are there for the next run.
pub(super) fn perform_on(gpu: &Gpu, options: &RunOptions) -> Result<()> {
    let start = Instant::now();
    begun(&Beginning::of(options)?, gpu, (start, false))
}

fn begun(beginning: &Beginning, gpu: &Gpu, told: (Instant, bool)) -> Result<()> {
    let plan = MemoryPlan::fitting(&beginning.scene, gpu)?;
    let folder = beginning.folder()?;
    let path = folder.path.clone();
    interrupt::last_words(&path, Some(Box::new(last_words(&folder))));
    let outcome = owning(beginning, (gpu, &plan), folder, told);
    interrupt::last_words(&path, None);
    outcome
}

/// The same in a folder of our own.
fn owning(
    beginning: &Beginning,
    (gpu, plan): (&Gpu, &MemoryPlan),
    folder: Folder,
    (start, json): (Instant, bool),
) -> Result<()> {
    let mut run = Run::prepare(beginning, gpu, plan, folder, start)?;
    interrupt::listen_between_steps();
    let outcome = run.frames();
    run.finish(outcome, json)
}

/// Tells what is about to run.
fn announce(scene: &Scene, plan: &MemoryPlan, gpu: &Gpu) {
    let cells = scene.domain.cells.map(|n| n.to_string())[..scene.domain.axes()].join(" x ");
    for overlap in scene.overlaps() {
        tell!("warning: {}", overlap_text(&overlap));
    }
    tell!("{}: {cells} cells, {} particles, on {}", scene.title, plan.particles, gpu.info.name);
}

/// Options that are keys of the scene.
fn overrides(options: &RunOptions) -> Vec<String> {
    let until = options.until.map(|until| format!("time.until={until:?}"));
    until.into_iter().chain(options.frames.map(|frames| format!("time.frames={frames}"))).collect()
}

/// A submission takes about as long, or one step: then it is seen whether somebody wants to stop.
const BATCH_TIME: Duration = Duration::from_secs(1);

/// Time spent on the main thread, by activity.
#[derive(Clone, Copy, Debug, Default)]
struct Clocks {
    setup: Duration,
    steps: Duration,
    pictures: Duration,
    waiting: Duration,
}

/// A run at work.
struct Run<'a> {
    options: &'a RunOptions,
    scene: Scene,
    folder: Folder,
    gpu: Gpu,
    plan: &'a MemoryPlan,
    simulation: Simulation,
    renderer: Option<Renderer>,
    writer: Option<Writer>,
    needs: Needs,
    progress: Progress,
    pending: Vec<StepRecord>,
    summary: Summary,
    start_budget: Budget,
    /// Steps of the next submission: so many as take about [`BATCH_TIME`].
    batch: u32,
    clocks: Clocks,
    start: Instant,
    /// Seconds that the run took before it goes on.
    before: f64,
    /// File or name of the scene.
    place: String,
    /// Last frame drawn, and whether the device is on its way to the next.
    frame: Option<u32>,
    under_way: bool,
    schedule: Schedule,
}

impl<'a> Run<'a> {
    fn prepare(
        beginning: &'a Beginning,
        gpu: &Gpu,
        plan: &'a MemoryPlan,
        folder: Folder,
        start: Instant,
    ) -> Result<Self> {
        let (options, scene) = (&beginning.options, beginning.scene.clone());
        let (formats, video) = (formats(options, &scene), film::asked(&options.film, &folder.path.join("frames")));
        if let Some((film, _)) = &video {
            not_an_input(film, &options.scene.scene)?;
        }
        let pictures = !options.no_frames || video.is_some();
        let (place, source) = (beginning.place.clone(), [beginning.place.clone(), device(gpu).text()]);
        let before = beginning.tables();
        let files = Files { folder: folder.path.clone(), formats, video, tables: true, listed: true, before, source };
        let mut needs = files.needs()?;
        needs.snapshot |= !scene.bodies.is_empty();
        let writer = Writer::start(files, &scene);
        if !options.quiet {
            announce(&scene, plan, gpu);
        }
        let simulation = beginning.simulation(gpu, plan)?;
        let about = beginning.from.as_ref().map(|from| &from.about);
        let start_budget =
            about.map_or_else(|| Budget::read(&simulation, &scene, 0.0), |about| Ok(about.start_budget))?;
        let (frame, under_way) =
            beginning.reached().map_or((None, false), |(frame, under_way)| (Some(frame), under_way));
        let buffers = SceneBuffers::of(&simulation.state);
        let renderer = pictures.then(|| Renderer::new(gpu, &scene, &buffers)).transpose()?;
        let renderer = renderer.map(|renderer| renderer.with_depth(needs.depth));
        let progress = Progress::new(scene.time.until, options.quiet);
        let clocks = Clocks { setup: start.elapsed(), ..Clocks::default() };
        let run = Self {
            schedule: Schedule::new(options, simulation.time(), simulation.step_count()),
            before: about.map_or(0.0, |about| about.wall_seconds),
            summary: about.map(|about| about.summary.clone()).unwrap_or_default(),
            place,
            frame,
            under_way,
            options,
            scene,
            folder,
            gpu: gpu.clone(),
            plan,
            simulation,
            renderer,
            writer: Some(writer),
            needs,
            progress,
            pending: Vec::new(),
            start_budget,
            batch: 1,
            clocks,
            start,
        };
        run.write_report((Status::Running, "running"), Written::default(), Verdict::default())?;
        Ok(run)
    }

    /// Frame 0 is the start; frame k follows at k / frames of the time.
    fn frames(&mut self) -> Result<()> {
        let frames = self.scene.time.frames.max(1);
        if self.frame.is_none() {
            self.frame(0, 0.0)?;
        }
        for index in self.frame.map_or(1, |last| last + 1)..=frames {
            self.stop_if_asked()?;
            let time = self.scene.frame_time(index);
            self.advance(time)?;
            self.frame(index, time)?;
        }
        self.checkpoint_at_end()
    }

    fn advance(&mut self, time: f64) -> Result<()> {
        let start = Instant::now();
        let outcome = self.advance_steps(time);
        self.clocks.steps += start.elapsed();
        outcome
    }

    fn advance_steps(&mut self, time: f64) -> Result<()> {
        if !std::mem::replace(&mut self.under_way, true) {
            self.simulation.set_target(time)?;
        }
        loop {
            self.checkpoint_if_due()?;
            let first = self.pending.len();
            let begun = Instant::now();
            let latest = self.summary.last.as_ref().map_or(0.0, |last| last.dt.into());
            let now = (self.simulation.time(), self.simulation.step_count());
            let batch = self.schedule.batch(self.batch, now, latest);
            let outcome = self.simulation.advance_batch_of(&mut self.pending, batch);
            let steps = (self.pending.len() - first).max(1) as u32;
            self.batch = (BATCH_TIME.as_secs_f64() / (begun.elapsed() / steps).as_secs_f64().max(1e-9)) as u32;
            self.batch = self.batch.clamp(1, BATCH);
            self.summary.add(&self.pending[first..]);
            self.progress.show(self.simulation.time(), self.summary.last.as_ref());
            if outcome? {
                return Ok(());
            }
            self.stop_if_asked()?;
        }
    }

    /// Draws a frame and hands it to the writer with the steps that led to it.
    fn frame(&mut self, index: u32, time: f64) -> Result<()> {
        if interrupt::urgent() {
            return Err(Error::Interrupted);
        }
        let start = Instant::now();
        let pictures = self.renderer.as_mut().map(|renderer| renderer.render(time)).transpose()?.unwrap_or_default();
        let snapshot = self.needs.snapshot.then(|| self.simulation.snapshot()).transpose()?;
        let buffers = SceneBuffers::of(&self.simulation.state);
        let at = (time, self.simulation.step_count());
        let stored = self.needs.stored.then(|| Stored::read(&self.gpu, &buffers, at)).transpose()?;
        self.clocks.pictures += start.elapsed();
        let start = Instant::now();
        let frame = Some(FrameToWrite { index, time, step: at.1, pictures, snapshot, stored });
        (self.frame, self.under_way) = (Some(index), false);
        let message = Message { records: std::mem::take(&mut self.pending), frame, checkpoint: None };
        let accepted = self.writer.as_ref().is_some_and(|writer| writer.send(message));
        self.clocks.waiting += start.elapsed();
        if !accepted {
            return self.close_writer().map(|_| ());
        }
        let written = Written { frames: index + 1, ..Written::default() };
        self.write_report((Status::Running, "running"), written, Verdict::default()).map(|_| ())
    }

    /// Waits for the writer and returns what it wrote.
    fn close_writer(&mut self) -> Result<Written> {
        self.writer.take().map_or_else(|| Ok(Written::default()), Writer::finish)
    }

    /// Writes the rest, judges, reports.
    fn finish(mut self, outcome: Result<()>, json: bool) -> Result<()> {
        self.progress.finish();
        if let Some(writer) = &self.writer {
            writer.send(Message { records: std::mem::take(&mut self.pending), ..Message::default() });
        }
        // The first error is the one to tell about.
        let (mut outcome, written) = match (outcome, self.close_writer()) {
            (Ok(()), Err(error)) => (Err(error), Written::default()),
            (outcome, written) => (outcome, written.unwrap_or_default()),
        };
        let filmed = film::tell(&written.films, self.options.quiet || json);
        let status = status(&outcome);
        let judged = if status == Status::Failed { Verdict::default() } else { self.judge(status)? };
        judged.tell();
        if outcome.is_ok() {
            outcome = self.verdict(&judged.checks);
            if self.options.strict {
                outcome = outcome.and(judged.strict());
            }
        }
        outcome = outcome.and(filmed);
        let text = outcome.as_ref().map_or_else(ToString::to_string, |()| "finished".to_owned());
        let reported = self.write_report((status, &text), written, judged);
        // what failed first is told, not that the report could not be written either
        let report = match (outcome, reported) {
            (Err(error), Err(_)) => return Err(error),
            (Ok(()), Err(error)) => return Err(error),
            (told, Ok(report)) => {
                outcome = told;
                report
            }
        };
        if json && outcome.is_ok() {
            say!("{}", serde_json::to_string(&report).unwrap_or_default());
        } else if !json && !self.options.quiet {
            self.print(&report);
        }
        outcome
    }

    fn judge(&self, status: Status) -> Result<Verdict> {
        let snapshot: Snapshot = self.simulation.snapshot()?;
        let end = self.end_budget()?;
        let ending = Ending { start: &self.start_budget, end: &end, summary: &self.summary, snapshot: &snapshot };
        Ok(Verdict::of(&self.scene, &ending, status == Status::Finished && !self.options.no_expect))
    }

    /// The error of a run whose checks failed. What was changed by hand is another experiment, whose checks are told only.
    fn verdict(&self, checks: &[Check]) -> Result<()> {
        match (verdict(checks), changed_by_hand(self.options)) {
            (Err(error), Some(change)) if !self.options.expect => {
                tell!("note: not enforced, since {change} was changed by hand (--expect enforces it): {error}");
                Ok(())
            }
            (verdict, _) => verdict,
        }
    }

    fn end_budget(&self) -> Result<Budget> {
        Budget::read(&self.simulation, &self.scene, self.summary.stored_energy())
    }

    fn write_report(
        &self,
        (status, outcome): (Status, &str),
        written: Written,
        judged: Verdict,
    ) -> Result<Report<&Scene>> {
        // A device that is lost cannot be asked any more; the report must come all the same.
        let running = status == Status::Running;
        let end = if running { Budget::default() } else { self.end_budget().unwrap_or_default() };
        let seconds = |(name, time): (&str, Duration)| (name.to_owned(), time.as_secs_f64());
        let clocks = &self.clocks;
        let timings = [
            ("setup", clocks.setup),
            ("steps", clocks.steps),
            ("pictures", clocks.pictures),
            ("waiting_for_writer", clocks.waiting),
            ("writer", written.busy),
        ];
        let report = Report {
            version: env!("CARGO_PKG_VERSION"),
            status,
            outcome: outcome.to_owned(),
            time: self.simulation.time(),
            steps: self.simulation.step_count(),
            frames: written.frames,
            wall_seconds: self.wall_seconds(),
            device: device(&self.gpu),
            particles: self.plan.particles,
            memory: self.plan.groups().into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect(),
            timings: timings.map(seconds).into(),
            totals: totals(&self.summary, &end),
            drift: if running { BTreeMap::new() } else { end.drift_since(&self.start_budget) },
            expect: judged.checks,
            watched: judged.watched,
            warnings: judged.warnings,
            absent_warnings: judged.absent,
            scene_hash: self.scene.hash(),
            scene_file: self.place.clone(),
            scene: &self.scene,
        };
        report::write(&self.folder.path.join("report.json"), &report)?;
        Ok(report)
    }

    /// Time on the clock, with that before the run went on \[s\].
    fn wall_seconds(&self) -> f64 {
        self.before + self.start.elapsed().as_secs_f64()
    }

    fn print(&self, report: &Report<&Scene>) {
        let wall = clock(self.start.elapsed());
        let (time, steps) = (report.time, report.steps);
        let time = plain(time);
        say!("t = {time} s after {steps} steps in {wall}; {} frames in {}", report.frames, self.folder.path.display());
        for check in &report.expect {
            say!("  {check}");
        }
    }
}
