//! One open scene: simulation and renderer on one device. No thread and no window: tests drive it as the worker does.

mod hand;
mod joins;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::model::Look;
use super::past::{self, Found, Kept, Past, Recorded};
use crate::diagnostics::StepRecord;
use crate::expect::{self, Budget, Ending, Summary, Warning};
use crate::export::states;
use crate::gpu::{Detail, Gpu};
use crate::render::{Picture, Renderer, SceneBuffers, Stored};
use crate::scene::{Camera, Changes, Field, RenderSettings, Scene};
use crate::simulation::{Saved, Simulation};
use crate::state::MemoryPlan;
use crate::{Error, Result};
use hand::Held;
use joins::Joins;

/// Time to run towards when the end of the scene's run has been passed \[s\].
const NEVER: f64 = 1e30;

/// A scene at work.
#[derive(Debug)]
pub struct Session {
    scene: Arc<Scene>,
    simulation: Simulation,
    renderer: Renderer,
    particles: u64,
    finished: bool,
    /// Length of the last step \[s\].
    dt: f64,
    /// Before the first step, and what the steps amount to.
    start: Budget,
    summary: Summary,
    warnings: Vec<Warning>,
    past: Past,
    /// Time \[s\] and step of a state that is shown and cannot go on.
    light: Option<(f64, u64)>,
    /// Whether there is more of it on the disk.
    of_a_run: bool,
    /// Whether a blast or a push has changed the state since the last step.
    touched: bool,
    /// The body that the mouse holds.
    held: Option<Held>,
    /// Bodies that pictures leave out.
    hidden: Vec<usize>,
    /// Bodies that have joined the scene.
    joins: Joins,
}

/// A state that was read: what the steps up to it amount to, where it lay, how many bodies had joined.
struct Read {
    state: Found,
    summary: Summary,
    path: Option<PathBuf>,
    joined: usize,
}

impl Session {
    /// Opens a scene.
    ///
    /// # Errors
    /// If it does not fit, or a shader or the driver fails.
    pub fn open(gpu: &Gpu, scene: Scene) -> Result<Self> {
        let mut session = Self::new(gpu, scene, None, Vec::new())?;
        session.keep()?;
        Ok(session)
    }

    /// Opens a run on the disk at its last state, to go on with changes.
    ///
    /// # Errors
    /// [`Error::Usage`] if it has none, or cannot go on with them; [`Error::Io`]; those of [`Session::open`].
    pub fn open_run(gpu: &Gpu, run: &Path, changes: &Changes) -> Result<Self> {
        let Recorded { was, scene, kept, start, goes_on } = past::of_run(run, changes)?;
        let begins = goes_on && kept.first().is_some_and(|first| first.time == 0.0);
        let mut session = Self { of_a_run: true, ..Self::new(gpu, scene, Some(&was), kept)? };
        match start {
            Some(start) => session.start = start,
            // a branch of another run begins later, from a state that is not here
            None if begins => {
                let saved = session.simulation.save()?;
                session.past.keep(Kept::of(saved, Summary::default(), 0));
            }
            None => {}
        }
        session.rewind(f64::INFINITY)?;
        Ok(session)
    }

    /// A scene at its start, which takes over states of the scene `was`.
    fn new(gpu: &Gpu, scene: Scene, was: Option<&Scene>, kept: Vec<Kept>) -> Result<Self> {
        let plan = MemoryPlan::fitting(&scene, gpu)?;
        let built = was.map_or_else(|| Ok(scene.clone()), |was| scene.taking_over(was))?;
        let mut simulation = Simulation::new(gpu, &built)?;
        simulation.change(&built, &scene, &mut Vec::new())?;
        let renderer = Renderer::of(&simulation, &scene)?;
        simulation.set_target(scene.time.until)?;
        let particles = plan.particles;
        let (start, summary, warnings) = (Budget::read(&simulation, &scene, 0.0)?, Summary::default(), Vec::new());
        let past = Past::new(scene.time.until, simulation.saved_bytes(), kept);
        let scene = Arc::new(scene);
        let (finished, dt, light, of_a_run, touched, held, hidden) = (false, 0.0, None, false, false, None, Vec::new());
        Ok(Self {
            scene,
            simulation,
            renderer,
            particles,
            finished,
            dt,
            start,
            summary,
            warnings,
            past,
            light,
            of_a_run,
            touched,
            held,
            hidden,
            joins: Joins::default(),
        })
    }

    /// The scene as it is now.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Number of particles at the start.
    pub fn particles(&self) -> u64 {
        self.particles
    }

    /// Simulated time \[s\].
    pub fn time(&self) -> f64 {
        self.light.map_or(self.simulation.time(), |(time, _)| time)
    }

    /// Steps done.
    pub fn step_count(&self) -> u64 {
        self.light.map_or(self.simulation.step_count(), |(_, step)| step)
    }

    /// Length of the last step \[s\]; 0 before the first.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Whether the end of the scene's run is reached.
    pub fn finished(&self) -> bool {
        self.finished
    }

    /// The look that the scene file asks for.
    pub fn look(&self) -> Look {
        let field = self.scene.output.fields.first().copied().unwrap_or(Field::Density);
        Look { field, settings: self.scene.own_look() }
    }

    /// The camera that shows all of a 3D scene in a picture of some size.
    pub fn fitted_camera(&self, look: &Look) -> Option<Camera> {
        let settings = RenderSettings { camera: None, path: None, ..look.settings.clone() };
        (self.scene.domain.dimension == 3).then(|| self.renderer.camera(&settings, 0.0))
    }

    /// Lets the scene run past the end of its run.
    ///
    /// # Errors
    /// Driver errors.
    pub fn go_on(&mut self) -> Result<()> {
        self.whole()?;
        self.finished = false;
        self.simulation.set_target(NEVER)
    }

    /// Runs one submission of at most `steps` steps.
    ///
    /// # Errors
    /// [`Error::Diverged`]; driver errors.
    pub fn advance(&mut self, steps: u32, records: &mut Vec<StepRecord>) -> Result<()> {
        self.whole()?;
        self.forget_later();
        let before = records.len();
        self.pull(records)?;
        let outcome = self.simulation.advance_batch_of(records, steps);
        self.touched = false;
        self.note(&records[before..]);
        self.finished = outcome?;
        self.keep()?;
        self.judge()
    }

    /// Keeps the state where one is due, unless a step is under way.
    fn keep(&mut self) -> Result<()> {
        if self.past.is_due(self.time()) && self.simulation.is_settled()? {
            self.keep_this()?;
        }
        Ok(())
    }

    fn keep_this(&mut self) -> Result<()> {
        let saved = self.simulation.save()?;
        self.past.keep(Kept::of(saved, self.summary.clone(), self.joins.now()));
        Ok(())
    }

    /// Goes to the last state that is kept up to a time \[s\], with the parameters of now; its time \[s\].
    ///
    /// # Errors
    /// [`Error::Io`] if a checkpoint cannot be read; [`Error::Usage`] if it is none of this scene; driver errors.
    pub fn rewind(&mut self, time: f64) -> Result<f64> {
        let Some(kept) = self.past.latest(time) else { return Ok(self.time()) };
        if self.touched || kept.step != self.step_count() || kept.time != self.time() {
            let read = self.read(kept)?;
            self.take(read)?;
        }
        Ok(self.time())
    }

    /// Shows the state that is kept behind this one; whether there is one.
    ///
    /// # Errors
    /// As [`Session::rewind`].
    pub fn show_next(&mut self) -> Result<bool> {
        let Some(kept) = self.past.after(self.time()) else { return Ok(false) };
        let read = self.read(kept)?;
        self.take(read).map(|()| true)
    }

    /// Time of the state that is kept behind this one \[s\].
    pub fn next(&self) -> Option<f64> {
        self.past.after(self.time()).map(|kept| kept.time)
    }

    /// Whether it was opened by [`Session::open_run`].
    pub fn is_of_a_run(&self) -> bool {
        self.of_a_run
    }

    /// A state that is kept; one of an earlier program may have more arrays than this one asks for.
    fn read(&self, kept: &Kept) -> Result<Read> {
        let most = 2 * self.simulation.saved_bytes().max(self.most_light());
        let (state, summary, path) = (kept.state(most)?, kept.summary.clone(), kept.path());
        Ok(Read { state, summary, path, joined: kept.joined })
    }

    /// Takes a state from where it lay.
    fn take(&mut self, Read { state, summary, path, joined }: Read) -> Result<()> {
        (self.touched, self.held) = (false, None);
        self.be_joined_by(joined)?;
        let taken = match state {
            Found::Whole(saved) => self.set(&saved, summary),
            Found::Light(stored) => self.show(&stored),
        };
        taken.map_err(|error| match (path, error) {
            (Some(path), Error::Spoilt(text)) => Error::spoilt(&path, text),
            (_, error) => error,
        })
    }

    /// Bytes that a state to look at has at most.
    fn most_light(&self) -> u64 {
        states::most_bytes(self.simulation.state.grid.slots() as u64, self.particles)
    }

    /// Shows a state that the scene cannot go on from.
    fn show(&mut self, stored: &Stored) -> Result<()> {
        let buffers = SceneBuffers::of(&self.simulation.state);
        if !stored.write(self.simulation.gpu(), &buffers) {
            let wrong = stored.wrong_length(&buffers.grid).map(|name| format!("array `{name}` has a wrong length"));
            let text = wrong.unwrap_or_else(|| "its arrays are other ones than its scene asks for".to_owned());
            return Err(Error::Spoilt(text));
        }
        self.light = Some((stored.time, stored.step));
        Ok(())
    }

    /// Takes a state to go on from.
    fn set(&mut self, saved: &Saved, summary: Summary) -> Result<()> {
        self.simulation.restore(saved)?;
        (self.summary, self.light) = (summary, None);
        self.dt = self.summary.last.as_ref().map_or(0.0, |last| last.dt.into());
        let until = self.scene.time.until;
        self.finished = self.time() >= until * (1.0 - 1e-6);
        self.simulation.set_target(if self.finished { NEVER } else { until })?;
        self.warnings = expect::marks(&self.scene, &self.start, &self.summary);
        Ok(())
    }

    /// Where a state is shown that cannot go on, goes to the last one before it that can.
    fn whole(&mut self) -> Result<()> {
        let Some((time, _)) = self.light else { return Ok(()) };
        let kept = self.past.latest_whole(time).ok_or_else(|| {
            Error::Usage("this state can only be looked at: the run left no checkpoint up to it".to_owned())
        })?;
        let read = self.read(kept)?;
        self.take(read)
    }

    /// Times of the states to go back to \[s\].
    pub fn kept(&self) -> Vec<f64> {
        self.past.times()
    }

    /// Runs one step with a stopwatch; milliseconds of its stages, none without timestamps.
    ///
    /// # Errors
    /// As [`Session::advance`].
    pub fn measure(&mut self, records: &mut Vec<StepRecord>) -> Result<Vec<(String, f64)>> {
        self.whole()?;
        let before = records.len();
        let (finished, times) = self.simulation.advance_timed(records, Detail::Stages)?;
        self.note(&records[before..]);
        self.finished = finished;
        self.judge()?;
        Ok(times)
    }

    fn note(&mut self, records: &[StepRecord]) {
        self.dt = records.last().map_or(self.dt, |record| record.dt.into());
        self.summary.add(records);
    }

    /// What is to be warned of: the budgets are closed at the end of the run, the rest follows from every step.
    fn judge(&mut self) -> Result<()> {
        if !self.finished {
            self.warnings = expect::marks(&self.scene, &self.start, &self.summary);
            return Ok(());
        }
        let end = Budget::read(&self.simulation, &self.scene, self.summary.stored_energy())?;
        let snapshot = self.simulation.snapshot()?;
        let ending = Ending { start: &self.start, end: &end, summary: &self.summary, snapshot: &snapshot };
        self.warnings = expect::warnings(&self.scene, &ending);
        Ok(())
    }

    /// Texts of the warnings that the scene does not expect.
    pub fn unexpected(&self) -> Vec<String> {
        self.warnings.iter().filter(|warning| warning.expected.is_none()).map(ToString::to_string).collect()
    }

    /// What the run is warned of so far, see `docs/inside/warnings.md`.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Draws the state as it is now.
    ///
    /// # Errors
    /// Those of the renderer.
    pub fn draw(&mut self, look: &Look) -> Result<Picture> {
        self.draw_in_haste(look, 1.0)
    }

    /// The same with a share of the pixels of the plot along each axis.
    ///
    /// # Errors
    /// Those of the renderer.
    pub fn draw_in_haste(&mut self, look: &Look, share: f64) -> Result<Picture> {
        let time = self.time();
        self.renderer.draw_in_haste(&look.settings, look.field, time, share)
    }

    /// Goes on with other parameters, see [`Simulation::alter`].
    ///
    /// # Errors
    /// [`Error::Usage`] if something differs that cannot change.
    pub fn change(&mut self, to: Scene, records: &mut Vec<StepRecord>) -> Result<()> {
        self.whole()?;
        let before = records.len();
        self.start.solid_mass += self.simulation.alter(&self.scene, &to, records)?;
        self.summary.add(&records[before..]);
        self.start.start_entropy = self.simulation.state.start_entropy[0];
        self.renderer.repaint(&to, &self.hidden);
        self.scene = Arc::new(to);
        Ok(())
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }
}
