//! What window and worker tell each other: commands one way, what came of them the other way.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::adding::{Added, Addition, MeshFile};
use super::past;
use crate::Result;
use crate::diagnostics::StepRecord;
use crate::render::Picture;
use crate::scene::{Camera, Changes, Field, RenderSettings, SMALL, Scene};

/// A scene to open: file or name of a shipped one, and what to change about it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    /// Path of a scene file, name of a shipped scene, or folder of a run.
    pub name: String,
    /// What to change about it.
    pub changes: Changes,
    /// Cells along the longest axis, if not the scene's own.
    pub resolution: Option<u32>,
    /// Bodies that were added in the window.
    pub added: Added,
}

impl Request {
    /// A scene as it is.
    pub fn of(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    /// Reads the scene.
    ///
    /// # Errors
    /// Those of [`Scene::find`]; [`Error::Usage`] where a run cannot go on with what is to change.
    pub fn load(&self) -> Result<Scene> {
        if let Some(run) = self.run() {
            self.changes.of_a_state(self.resolution, "a run in the window", "--set")?;
            return past::of_run(run, &self.changes).map(|recorded| recorded.scene);
        }
        let scene = Scene::find(&self.name, &self.changes)?;
        let scene = match self.resolution {
            Some(cells) => scene.with_resolution(cells)?,
            None => scene,
        };
        self.added.to(scene)
    }

    /// The same at its small size, if it has one and is not that.
    pub fn small(&self) -> Option<Self> {
        let own = &self.changes.variants;
        if own.iter().any(|name| name == SMALL) {
            return None;
        }
        let variants = std::iter::once(SMALL.to_owned()).chain(own.iter().cloned()).collect();
        let small = Self { changes: Changes { variants, ..self.changes.clone() }, ..self.clone() };
        small.load().is_ok().then_some(small)
    }

    /// The folder of a run, if it is one.
    pub fn run(&self) -> Option<&Path> {
        Some(Path::new(&self.name)).filter(|path| path.is_dir())
    }

    /// The file behind the request; none for a scene that the program carries.
    pub fn file(&self) -> Option<PathBuf> {
        let below = Path::new("scenes").join(&self.name);
        [PathBuf::from(&self.name), below].into_iter().find(|path| path.is_file())
    }
}

/// What a picture shows and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Quantity of the gas.
    pub field: Field,
    /// Everything else.
    pub settings: RenderSettings,
}

/// How fast simulated time may pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// As fast as the device can.
    Fastest,
    /// So that the scene's whole run takes at least so many seconds.
    Lasting(f64),
}

/// A click that sets energy free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strike {
    /// Where on the picture, as shares of its width and height from the top left corner.
    pub at: [f64; 2],
    /// What goes off there.
    pub source: Source,
}

/// What a click sets off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// Energy \[J\], per metre of depth in 2D, in the gas of a ball of a radius \[m\].
    Energy(f64, f64),
    /// A mass of TNT \[kg\], per metre of depth in 2D.
    Tnt(f64),
}

impl Source {
    /// So many times as much energy.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        match self {
            Source::Energy(energy, radius) => Source::Energy(factor * energy, radius),
            Source::Tnt(mass) => Source::Tnt(factor * mass),
        }
    }
}

/// What the window asks for.
#[derive(Debug)]
pub enum Command {
    /// Open a scene, also the same one again from its start. `Look` keeps what is set in the window.
    Open(Request, Option<Box<Look>>),
    /// Let go of the scene.
    Close,
    /// Run or pause; what a run has left is shown again.
    Play(bool),
    /// Simulate from the state that is shown.
    GoOn,
    /// So many steps, then pause.
    Steps(u32),
    /// How fast simulated time may pass.
    Pace(Pace),
    /// What pictures show; `moving` while the user drags: speed before resolution.
    Look {
        /// The look.
        look: Box<Look>,
        /// Whether it is about to change again.
        moving: bool,
    },
    /// Go on with other parameters.
    Change(Box<Scene>),
    /// Go to the last state that is kept up to a time \[s\].
    Rewind(f64),
    /// Set energy free at a point of the picture.
    Detonate(Strike),
    /// Add a body where a place of the picture is, in shares of its width and height from the top left corner.
    Add([f64; 2], Box<Addition>),
    /// Read a mesh file for a body to add; whether also one that is open or crosses itself.
    ReadMesh(PathBuf, bool),
    /// Hold the body at a place of the picture, in shares of its width and height from the top left corner.
    Hold([f64; 2]),
    /// Lead the body that is held to a place of the picture.
    Lead([f64; 2]),
    /// Let go of it.
    LetGo,
    /// What lies at a place of the picture, in shares of its width and height from the top left corner.
    Ask([f64; 2]),
    /// What lies where a click was, to pick it.
    Pick([f64; 2]),
    /// Leave these bodies out of pictures.
    Hide(Vec<usize>),
    /// Save the scene as it is now, with what pictures show.
    SaveScene,
    /// Save the picture.
    Screenshot,
    /// Start or stop saving every picture.
    Record(bool),
    /// Measure the stages of a step now and then.
    Measure(bool),
}

/// Where the worker stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Phase {
    /// No scene.
    #[default]
    Empty,
    /// A scene is open.
    Ready,
    /// The scene cannot go on; the last picture stays.
    Failed,
}

/// What is true of the open scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// Where the worker stands.
    pub phase: Phase,
    /// Whether the scene runs.
    pub playing: bool,
    /// Whether to play is to show the states of a run.
    pub replay: bool,
    /// Whether the end of the scene's run is reached.
    pub finished: bool,
    /// Number of particles at the start, with those of bodies that were added.
    pub particles: u64,
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// Steps per second, lately; 0 while paused.
    pub steps_per_second: f64,
    /// Steps that ran, and the seconds that they took with pictures and everything else.
    pub ran: (u64, f64),
    /// Time of one step, lately \[s\].
    pub step_seconds: f64,
    /// Time of one picture, lately \[s\].
    pub picture_seconds: f64,
    /// Pictures of the recording under way.
    pub recorded: Option<u32>,
    /// Times of the states to go back to \[s\].
    pub kept: Vec<f64>,
    /// Whether the state was changed by hand since the last step.
    pub touched: bool,
    /// Where the body that is held is held, in shares of the picture's width and height.
    pub held: Option<[f64; 2]>,
    /// Where the probes are, in such shares.
    pub probes: Vec<Option<[f64; 2]>>,
    /// What the run is warned of so far; expected warnings are left out.
    pub warnings: Vec<String>,
}

/// A scene that has just been opened.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What was asked for.
    pub request: Request,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Number of particles.
    pub particles: u64,
    /// The look to begin with.
    pub look: Look,
    /// The camera that shows all of a 3D scene.
    pub fitted: Option<Camera>,
    /// Name of the device.
    pub device: String,
    /// Whether it is a processor in the role of a GPU.
    pub software: bool,
}

/// A picture to show.
#[derive(Clone, Debug)]
pub struct Shown {
    /// The picture.
    pub picture: Arc<Picture>,
    /// What it shows.
    pub look: Look,
    /// When \[s\].
    pub time: f64,
    /// After how many steps.
    pub step: u64,
}

/// How serious a note is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// Something went as asked.
    Fine,
    /// Something did not.
    Wrong,
}

/// A line for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// How serious it is.
    pub weight: Weight,
    /// The text; findings in scene files have several lines.
    pub text: String,
}

/// What lies at a place of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// The place that was asked for.
    pub at: [f64; 2],
    /// The point there \[m\]; empty beside the domain.
    pub point: Vec<f64>,
    /// The value that a picture of a plane shows of the gas.
    pub value: Option<f64>,
    /// Name of the body.
    pub body: Option<String>,
}

/// What came of a scene that was to be opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It is open.
    Opened,
    /// It is not, and the scene before goes on.
    Refused,
    /// It is not, and no other one is.
    Failed,
}

/// What the worker has for the window since the window last looked.
#[derive(Debug, Default)]
pub struct Outbox {
    /// What is true now.
    pub status: Status,
    /// What came of scenes that were to be opened, one for each, in their order.
    pub answers: Vec<Answer>,
    /// The scene that was opened last.
    pub opened: Option<Opened>,
    /// The newest picture.
    pub shown: Option<Shown>,
    /// The scene went to another time \[s\]: what is known of later ones is gone, but for `records`.
    pub rewound: Option<f64>,
    /// Steps done.
    pub records: Vec<StepRecord>,
    /// Milliseconds of each stage of a step.
    pub stages: Option<Vec<(String, f64)>>,
    /// Parameters were changed: the scene as it is now.
    pub changed: Option<Arc<Scene>>,
    /// What lies where the window asked.
    pub spot: Option<Spot>,
    /// What was picked.
    pub picked: Option<Spot>,
    /// A mesh was read.
    pub mesh: Option<MeshFile>,
    /// Whether there was a body where one was to be held.
    pub holds: Option<bool>,
    /// Lines for the user.
    pub notes: Vec<Note>,
}
