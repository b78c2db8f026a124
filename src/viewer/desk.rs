//! What the worker does: obeys commands, steps the scene within its budget, draws, and leaves the outcome in the outbox.

mod ask;
mod files;
mod hand;
mod opening;
mod pace;
mod rewind;

use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::budget::{Budget, Haste, Rate};
use super::model::{Answer, Command, Look, Note, Outbox, Pace, Phase, Shown, Status, Weight};
use super::record::Recording;
use super::session::Session;
use super::worker::lock;
use crate::diagnostics::StepRecord;
use crate::gpu::{Gpu, GpuOptions};
use crate::scene::Scene;
use crate::{Error, Result};
use pace::LONGEST_LAG;

/// Time between two measurements of the stages \[s\].
const MEASURE_PERIOD: f64 = 2.0;
/// Where shipped scenes are saved, below a folder per scene.
const OUT: &str = "out";

/// The worker's state.
pub(super) struct Desk {
    options: GpuOptions,
    outbox: Arc<Mutex<Outbox>>,
    gpu: Option<Gpu>,
    session: Option<Session>,
    /// Its scene as the window knows it.
    told: Option<Arc<Scene>>,
    /// Where screenshots and recordings of the scene go.
    folder: PathBuf,
    /// Where scenes are saved, and the beginning of their names.
    saved: (PathBuf, String),
    look: Option<Look>,
    moving: bool,
    /// The look has changed since the last picture; then also whether it was drawn with fewer pixels than asked for.
    stale: bool,
    coarse: bool,
    /// Steps since the last picture.
    news: bool,
    playing: bool,
    /// Whether to play is to show the states of a run, one after another.
    replay: bool,
    steps_left: u32,
    pace: Pace,
    /// Clock and simulated time when the scene began to run at its pace.
    paced_from: (f64, f64),
    budget: Budget,
    measuring: bool,
    measured: f64,
    rate: Rate,
    /// Steps after the first submission, and seconds that they took with everything beside them.
    ran: (u64, f64),
    /// End of the turn before.
    turned: f64,
    shown: Option<Shown>,
    recording: Option<Recording>,
    records: Vec<StepRecord>,
    phase: Phase,
    /// A scene is being opened, and the window has no answer yet.
    asked: bool,
    start: Instant,
}

impl Desk {
    pub(super) fn new(options: GpuOptions, outbox: Arc<Mutex<Outbox>>) -> Self {
        Self {
            options,
            outbox,
            gpu: None,
            session: None,
            told: None,
            folder: PathBuf::from(OUT),
            saved: (PathBuf::from(OUT), String::new()),
            look: None,
            moving: false,
            stale: false,
            coarse: false,
            news: false,
            playing: false,
            replay: false,
            steps_left: 0,
            pace: Pace::Fastest,
            paced_from: (0.0, 0.0),
            budget: Budget::default(),
            measuring: false,
            measured: 0.0,
            rate: Rate::default(),
            ran: (0, 0.0),
            turned: 0.0,
            shown: None,
            recording: None,
            records: Vec::new(),
            phase: Phase::Empty,
            asked: false,
            start: Instant::now(),
        }
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    fn ready(&self) -> bool {
        self.session.is_some() && self.phase == Phase::Ready
    }

    /// How long the worker may wait for a command; for ever if there is nothing to do.
    pub(super) fn patience(&self) -> Option<Duration> {
        if !self.ready() {
            return None;
        }
        if self.steps_left > 0 || (self.playing && self.is_due()) {
            return Some(Duration::ZERO);
        }
        let wait = |until: f64| Some(Duration::from_secs_f64((until - self.now()).clamp(0.0, 1.0)));
        if self.wants_picture() {
            return wait(if self.playing { self.budget.picture_due(self.stale) } else { 0.0 });
        }
        // A paced scene waits for its next step.
        if self.playing { Some(Duration::from_millis(5)) } else { None }
    }

    /// Does what is asked for.
    pub(super) fn obey(&mut self, command: Command) {
        let outcome = match command {
            Command::Open(request, look) => {
                self.open(&request, look);
                Ok(())
            }
            Command::Close => {
                self.close();
                Ok(())
            }
            Command::Play(playing) => self.play(playing),
            Command::GoOn => {
                self.replay = false;
                self.play(true)
            }
            Command::Steps(steps) => {
                (self.playing, self.replay) = (false, false);
                self.steps_left = self.steps_left.saturating_add(steps);
                self.pass_the_end()
            }
            Command::Pace(pace) => {
                self.pace = pace;
                self.start_pace();
                Ok(())
            }
            Command::Look { look, moving } => {
                self.stale |= self.look.as_ref() != Some(&*look);
                (self.look, self.moving) = (Some(*look), moving);
                Ok(())
            }
            Command::Change(scene) => self.change(*scene),
            Command::Rewind(time) => self.rewind(time),
            Command::Detonate(strike) => self.strike(&strike),
            Command::Add(at, addition) => self.add(at, &addition),
            Command::ReadMesh(file, repair) => self.read_mesh(&file, repair),
            Command::Hold(at) => self.hold(at),
            Command::Lead(at) => {
                self.lead(at);
                Ok(())
            }
            Command::LetGo => self.let_go(),
            Command::Ask(at) => self.ask(at),
            Command::Pick(at) => self.pick(at),
            Command::Hide(hidden) => {
                self.hide(hidden);
                Ok(())
            }
            Command::SaveScene => self.save_scene(),
            Command::Screenshot => self.screenshot(),
            Command::Record(on) => self.record(on),
            Command::Measure(on) => {
                self.measuring = on;
                Ok(())
            }
        };
        outcome.unwrap_or_else(|error| self.report(error));
    }

    /// Steps and draws what is due.
    pub(super) fn work(&mut self) {
        if !self.ready() {
            return;
        }
        let (start, step) = (self.now(), self.session.as_ref().map_or(0, Session::step_count));
        // The start is shown before the first step, for which some drivers compile for long.
        let next = match self.shown {
            None => Ok(()),
            Some(_) if self.replay && self.playing => self.show_next(),
            Some(_) => self.advance(),
        };
        let outcome = next.and_then(|()| self.draw());
        if self.playing && !self.replay && step > 0 {
            // from a frame without a checkpoint the scene goes on before it
            let steps = self.session.as_ref().map_or(step, Session::step_count).saturating_sub(step);
            self.ran = (self.ran.0 + steps, self.ran.1 + (self.now() - self.turned.max(start - LONGEST_LAG)));
        }
        self.turned = self.now();
        outcome.unwrap_or_else(|error| self.report(error));
    }

    fn advance(&mut self) -> Result<()> {
        let single = self.steps_left > 0;
        let steps = if single { self.steps_left.min(self.budget.steps()) } else { self.due_steps() };
        if steps == 0 || !(single || self.playing) {
            return Ok(());
        }
        let (start, before) = (self.now(), self.records.len());
        let measure = self.measuring && start - self.measured > MEASURE_PERIOD;
        let Some(session) = &mut self.session else { return Ok(()) };
        if measure {
            let stages = session.measure(&mut self.records)?;
            self.measured = start;
            lock(&self.outbox).stages = Some(stages);
        } else {
            let outcome = session.advance(steps, &mut self.records);
            let done = self.records.len() - before;
            self.steps_left = self.steps_left.saturating_sub(done as u32);
            self.news = true;
            self.budget.stepped(done, self.start.elapsed().as_secs_f64() - start);
            self.rate.add(done, self.start.elapsed().as_secs_f64());
            outcome?;
        }
        let finished = self.session.as_ref().is_some_and(Session::finished);
        if finished {
            (self.playing, self.steps_left) = (false, 0);
        }
        self.forget_lag();
        Ok(())
    }

    /// Whether pictures must come quickly; recorded ones are whole.
    fn haste(&self) -> Haste {
        match (self.moving, self.playing && self.recording.is_none()) {
            (true, _) => Haste::Moving,
            (false, true) => Haste::Running,
            (false, false) => Haste::None,
        }
    }

    /// Whether something has changed since the last picture, or that one was made in haste.
    fn wants_picture(&self) -> bool {
        self.stale || self.news || (self.coarse && self.haste() == Haste::None)
    }

    fn draw(&mut self) -> Result<()> {
        let wanted = self.wants_picture();
        // each state of a run is seen
        let due = !self.playing
            || self.replay
            || self.now() >= self.budget.picture_due(self.stale || self.recording.is_some());
        let haste = self.haste();
        let (Some(session), Some(whole)) = (&mut self.session, &self.look) else { return Ok(()) };
        if !wanted || !due {
            return Ok(());
        }
        let start = self.start.elapsed().as_secs_f64();
        let look = whole.clone();
        let [width, height] = look.settings.size.map(f64::from);
        let share = self.budget.share(width * height, haste);
        let picture = Arc::new(session.draw_in_haste(&look, share)?);
        let now = self.start.elapsed().as_secs_f64();
        self.budget.drew((width * height * share * share) as u64, now - start, now);
        self.coarse = share < 1.0;
        let shown = Shown { picture, look, time: session.time(), step: session.step_count() };
        let recorded = match &mut self.recording {
            Some(recording) if self.news && !self.coarse => recording.add(&shown),
            _ => true,
        };
        (self.stale, self.news) = (false, false);
        lock(&self.outbox).shown = Some(shown.clone());
        self.shown = Some(shown);
        if !recorded {
            self.finish_recording();
        }
        Ok(())
    }

    fn change(&mut self, scene: Scene) -> Result<()> {
        let Some(session) = &mut self.session else { return Ok(()) };
        self.replay = false;
        session.change(scene, &mut self.records)?;
        self.stale = true;
        Ok(())
    }

    fn note(&self, weight: Weight, text: String) {
        lock(&self.outbox).notes.push(Note { weight, text });
    }

    /// Tells the user; what cannot go on stops.
    fn report(&mut self, error: Error) {
        match &error {
            Error::Usage(_) | Error::Io { .. } => {}
            Error::Gpu(_) => {
                // Everything on the device is lost with it; the next scene opens another one.
                self.gpu = None;
                self.give_up(&format!("{error}\nR starts the scene again."));
                return;
            }
            _ => (self.playing, self.phase) = (false, Phase::Failed),
        }
        if self.session.is_none() {
            self.phase = Phase::Failed;
        }
        self.note(Weight::Wrong, error.to_string());
    }

    /// Lets go of a scene that cannot go on.
    pub(super) fn give_up(&mut self, reason: &str) {
        self.close();
        self.phase = Phase::Failed;
        self.note(Weight::Wrong, reason.to_owned());
        if self.asked {
            self.answer(Answer::Failed);
        }
    }

    /// Leaves the state of things in the outbox.
    pub(super) fn publish(&mut self) {
        let session = self.session.as_ref();
        let status = Status {
            phase: self.phase.clone(),
            playing: self.playing,
            replay: self.replay,
            finished: session.is_some_and(Session::finished),
            particles: session.map_or(0, Session::particles),
            time: session.map_or(0.0, Session::time),
            step: session.map_or(0, Session::step_count),
            steps_per_second: if self.playing { self.rate.value() } else { 0.0 },
            ran: self.ran,
            step_seconds: self.budget.step_seconds(),
            picture_seconds: self.budget.picture_seconds(),
            recorded: self.recording.as_ref().map(Recording::count),
            kept: session.map_or_else(Vec::new, Session::kept),
            touched: session.is_some_and(Session::is_touched),
            probes: session.zip(self.look.as_ref()).map_or_else(Vec::new, |(session, look)| session.probes_at(look)),
            held: session.zip(self.look.as_ref()).and_then(|(session, look)| session.held_at(look)),
            warnings: session.map_or_else(Vec::new, Session::unexpected),
        };
        let mut outbox = lock(&self.outbox);
        outbox.status = status;
        let scene = session.map(Session::scene);
        if let Some(scene) = scene.filter(|scene| self.told.as_ref().is_some_and(|told| !Arc::ptr_eq(told, scene))) {
            outbox.changed = Some(Arc::clone(scene));
            self.told = outbox.changed.clone();
        }
        outbox.records.append(&mut self.records);
    }
}
