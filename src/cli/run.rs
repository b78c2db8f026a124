//! `run`: a scene to pictures, tables and a report.

mod beginning;
mod checkpoint;
mod ending;
mod formats;

use std::time::{Duration, Instant};

use super::args::{Cli, RunOptions};
use super::check::overlap_text;
use super::folder::Folder;
use super::init::not_an_input;
use super::interrupt;
use super::outcome::{Verdict, device, last_words};
use super::progress::Progress;
use super::writer::{Files, FrameToWrite, Message, Writer, Written};
use super::{film, open_device};
use crate::diagnostics::StepRecord;
use crate::expect::{Budget, Summary};
use crate::export::Needs;
use crate::export::report::Status;
use crate::gpu::Gpu;
use crate::render::{Renderer, SceneBuffers, Stored};
use crate::scene::Scene;
use crate::simulation::{BATCH, Simulation};
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
}
