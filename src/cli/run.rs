//! `run`: a scene to pictures, tables and a report.

mod beginning;
mod checkpoint;
mod ending;
mod formats;
mod reporting;

use std::time::{Duration, Instant};

use super::args::{Cli, RunOptions};
use super::check::{lost_text, overlap_text, size, stale_texts};
use super::folder::Folder;
use super::init::not_an_input;
use super::interrupt;
use super::outcome::{Verdict, changed_by_hand, device, ended, last_words};
use super::progress::{self, Progress};
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
use reporting::Setup;

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
    if options.quiet || json {
        progress::hush();
    }
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
    asked_for(beginning)?;
    let folder = beginning.folder()?;
    // a state that is refused leaves what was there, and nothing else
    let taken = beginning.taken(gpu, &plan, &folder)?;
    beginning.clear(&folder)?;
    let path = folder.path.clone();
    Setup { beginning, gpu, plan: &plan, start: told.0 }.write_report(&path, (Status::Running, "running"))?;
    interrupt::last_words(&path, Some(Box::new(last_words(&folder))));
    let outcome = owning(beginning, (gpu, &plan), (folder, taken), told);
    interrupt::last_words(&path, None);
    outcome
}

/// The same in a folder of our own.
fn owning(
    beginning: &Beginning,
    (gpu, plan): (&Gpu, &MemoryPlan),
    owned: (Folder, Option<Simulation>),
    (start, json): (Instant, bool),
) -> Result<()> {
    let path = owned.0.path.clone();
    match Run::prepare(beginning, gpu, plan, owned, start) {
        Ok(mut run) => {
            let outcome = run.frames();
            run.finish(outcome, json)
        }
        Err(error) => {
            let (setup, status) = (Setup { beginning, gpu, plan, start }, ended(&error));
            // what failed first is told, not that the report could not be written either
            let _ = setup.write_report(&path, (status, &error.to_string()));
            Err(error)
        }
    }
}

/// What a run is asked to write: formats that exist, a film that is no input.
fn asked_for(beginning: &Beginning) -> Result<()> {
    let options = &beginning.options;
    Files { formats: formats(options, &beginning.scene), ..Files::default() }.needs()?;
    options.film.video.as_ref().map_or(Ok(()), |film| not_an_input(film, &options.scene.scene))
}

/// What the run will write.
fn files(beginning: &Beginning, gpu: &Gpu, folder: &Folder) -> Files {
    let film::Asked { film, lost } = film::asked(&beginning.options.film, &folder.path.join("frames"));
    Files {
        folder: folder.path.clone(),
        formats: formats(&beginning.options, &beginning.scene),
        video: film,
        lost_film: lost,
        tables: true,
        listed: true,
        before: beginning.tables(),
        source: [beginning.place.clone(), device(gpu).text()],
    }
}

/// Tells what is about to run.
fn announce(scene: &Scene, plan: &MemoryPlan, gpu: &Gpu, formats: &[String]) {
    let cells = scene.domain.cells.map(|n| n.to_string())[..scene.domain.axes()].join(" x ");
    for overlap in scene.overlaps() {
        tell!("warning: {}", overlap_text(&overlap));
    }
    for lost in scene.thin_obstacles() {
        tell!("warning: {}", lost_text(&lost));
    }
    for stale in stale_texts(scene) {
        tell!("warning: {stale}");
    }
    tell!("{}: {cells} cells, {} particles, on {}", scene.title, plan.particles, gpu.info.name);
    let formats: Vec<&str> = formats.iter().map(String::as_str).collect();
    let particles = plan.particles as usize;
    let disk = scene.disk_bytes((particles, scene.estimate(particles).steps), &formats);
    let checkpoint = size(plan.bytes(None));
    tell!("writes about {}; a checkpoint has at most {checkpoint} before compression", size(disk as u64));
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
    /// What was changed by hand: another experiment than that of the scene.
    by_hand: Option<String>,
    /// File or name of the scene.
    place: String,
    /// Last frame drawn, and whether the device is on its way to the next.
    frame: Option<u32>,
    under_way: bool,
    schedule: Schedule,
    /// When the report was written.
    reported: Instant,
    /// What the writer has done, once it has ended.
    written: Written,
    /// Whether somebody asks for wishes to stop.
    heard: Option<interrupt::Heard>,
}

impl<'a> Run<'a> {
    fn prepare(
        beginning: &'a Beginning,
        gpu: &Gpu,
        plan: &'a MemoryPlan,
        (folder, taken): (Folder, Option<Simulation>),
        start: Instant,
    ) -> Result<Self> {
        let (options, scene) = (&beginning.options, beginning.scene.clone());
        let files = files(beginning, gpu, &folder);
        let (place, pictures) = (beginning.place.clone(), !options.no_frames || files.video.is_some());
        let mut needs = files.needs()?;
        needs.snapshot |= !scene.bodies.is_empty();
        let formats = files.formats.clone();
        let writer = Writer::start(files, &scene);
        if !options.quiet {
            announce(&scene, plan, gpu, &formats);
        }
        let simulation = taken.map_or_else(|| Simulation::new(gpu, &scene), Ok)?;
        let about = beginning.from.as_ref().map(|from| &from.about);
        let start_budget =
            about.map_or_else(|| Budget::read(&simulation, &scene, 0.0), |about| Ok(about.start_budget))?;
        let (frame, under_way) =
            beginning.reached().map_or((None, false), |(frame, under_way)| (Some(frame), under_way));
        let buffers = SceneBuffers::of(&simulation.state);
        let renderer = pictures.then(|| Renderer::new(gpu, &scene, &buffers)).transpose()?;
        let schedule = Schedule::new(options, simulation.time(), simulation.step_count());
        let renderer = renderer.map(|renderer| renderer.with_depth(needs.depth).with_stop(interrupt::wish));
        let progress = Progress::new(scene.time.until, options.quiet);
        let clocks = Clocks { setup: start.elapsed(), ..Clocks::default() };
        let run = Self {
            schedule,
            before: about.map_or(0.0, |about| about.wall_seconds),
            summary: about.map(|about| about.summary.clone()).unwrap_or_default(),
            by_hand: changed_by_hand(options).or_else(|| about.and_then(|about| about.by_hand.clone())),
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
            reported: Instant::now(),
            written: Written::default(),
            heard: None,
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
            self.heard.get_or_insert_with(interrupt::listen_between_steps);
            if outcome? {
                return Ok(());
            }
            self.report_so_far()?;
            self.stop_if_asked()?;
        }
    }

    /// Draws a frame and hands it to the writer with the steps that led to it.
    fn frame(&mut self, index: u32, time: f64) -> Result<()> {
        self.stop_if_asked()?;
        let start = Instant::now();
        let pictures = match self.renderer.as_mut().map(|renderer| renderer.render(time)).transpose() {
            // a frame that is given up is drawn by whoever goes on from here
            Err(Error::Interrupted) => return self.stop_if_asked(),
            pictures => pictures?.unwrap_or_default(),
        };
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
            return self.close_writer();
        }
        self.heard.get_or_insert_with(interrupt::listen_between_steps);
        self.report_frame(index)
    }

    /// Waits for the writer.
    fn close_writer(&mut self) -> Result<()> {
        let Some(writer) = self.writer.take() else { return Ok(()) };
        let (written, outcome) = writer.finish();
        self.written = written;
        outcome
    }
}
