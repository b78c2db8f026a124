//! What a run begins from: a scene, or a checkpoint of another run or of itself.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::super::args::RunOptions;
use super::super::folder::Folder;
use super::super::outcome::device;
use super::super::tables::{Marks, Tables};
use super::super::{scenes, writer};
use super::checkpoint::About;
use super::overrides;
use crate::export::container::{Head, VERSION};
use crate::export::{checkpoint, forms};
use crate::gpu::Gpu;
use crate::math::plain;
use crate::scene::{self, Changes, Scene};
use crate::simulation::{Saved, Simulation};
use crate::state::MemoryPlan;
use crate::{Error, Result, input};

/// A frame counts as a multiple of the distance of frames up to this part of it.
const ROUNDING: f64 = 1e-6;

/// The start of a run.
#[derive(Debug)]
pub(super) struct Beginning {
    /// The command line; of a run that goes on, that of its start.
    pub(super) options: RunOptions,
    /// The scene.
    pub(super) scene: Scene,
    /// File or name of the scene; paths in it start there.
    pub(super) place: String,
    /// The checkpoint.
    pub(super) from: Option<From>,
}

/// A checkpoint to begin from.
#[derive(Debug)]
pub(super) struct From {
    /// Folder of the run that left it.
    run: PathBuf,
    path: PathBuf,
    head: Head,
    /// Its scene.
    scene: Scene,
    /// What it says of the run.
    pub(super) about: About,
    /// Whether it is a run of its own that begins here.
    branch: bool,
}

/// What is needed of a report.
#[derive(Deserialize)]
struct Recorded {
    scene_hash: String,
}

impl Beginning {
    /// What the command line asks for.
    ///
    /// # Errors
    /// [`Error::Scene`], [`Error::Usage`], [`Error::Io`].
    pub(super) fn of(options: &RunOptions) -> Result<Self> {
        if options.resume {
            return Self::resumed(options);
        }
        if options.branch {
            return Self::branched(options);
        }
        let scene = scenes::load(&options.scene, &overrides(options))?;
        let place = scenes::place(&options.scene.scene);
        Ok(Self { options: options.clone(), scene, place, from: None })
    }

    /// A run goes on as it began, from its latest checkpoint.
    fn resumed(given: &RunOptions) -> Result<Self> {
        let run = Path::new(&given.scene.scene);
        refuse_changes(given)?;
        forms::known(run, true)?;
        let all = listed(run)?;
        let path = all.last().map(|(_, path)| path.clone()).unwrap_or_default();
        let mut from = From::read(run, &path, &[]).map_err(|error| older(error, &all))?;
        let mut options = from.about.options.clone();
        (options.resume, options.quiet) = (true, given.quiet);
        options.checkpoint = given.checkpoint.or(options.checkpoint);
        options.keep = given.keep.or(options.keep);
        options.no_expect = (options.no_expect || given.no_expect) && !given.expect;
        options.expect |= given.expect;
        if let Some(until) = given.until {
            let frames = more_frames(&from, until)?;
            (from.scene.time.until, from.scene.time.frames, options.until) = (until, frames, Some(until));
        }
        let (scene, place) = (from.scene.clone(), from.head.source.scene_file.clone());
        Ok(Self { options, scene, place, from: Some(from) })
    }

    /// A new run from a state of another one.
    fn branched(given: &RunOptions) -> Result<Self> {
        let text = &given.scene.scene;
        let wrong = || Error::Usage(format!("--branch {text}: write DIR@TIME, as in out/sod@0.1"));
        let (run, time) = text.rsplit_once('@').ok_or_else(wrong)?;
        let time: f64 = time.parse().map_err(|_| wrong())?;
        let scene = &given.scene;
        scenes::changes(scene, &[]).of_a_state(scene.resolution, "--branch", "--set")?;
        forms::known(Path::new(run), true)?;
        let path = latest_before(Path::new(run), time)?;
        let mut from = From::read(Path::new(run), &path, &[])?;
        from.branch = true;
        let changes: Vec<String> = given.scene.set.iter().cloned().chain(overrides(given)).collect();
        let scene = From::read(Path::new(run), &path, &changes)?.scene;
        Ok(Self { options: given.clone(), scene, place: from.head.source.scene_file.clone(), from: Some(from) })
    }

    /// The folder of the run.
    ///
    /// # Errors
    /// As those of [`Folder`].
    pub(super) fn folder(&self) -> Result<Folder> {
        match (&self.from, &self.options.out) {
            (Some(from), _) if !from.branch => Folder::again(&from.run),
            (Some(from), Some(path)) if same_place(&from.run, path) => {
                let run = from.run.display();
                Err(Error::Usage(format!("--out {run} is the run that this one begins from; name another folder")))
            }
            (_, Some(path)) => Folder::take(path, self.options.force),
            (from, None) => {
                let name = if from.is_some() { "branch" } else { &scene::stem(&self.options.scene.scene) };
                Folder::next_free(&Path::new("out").join(name))
            }
        }
    }

    /// The tables that the run goes on with: where they lie, and how far they had come.
    pub(super) fn tables(&self) -> writer::Before {
        let marks = |from: &From| (from.run.clone(), from.about.tables.clone());
        let (folder, marks) = self.from.as_ref().map_or_else(|| (PathBuf::new(), Marks::default()), marks);
        let goes_on = self.from.as_ref().is_some_and(|from| !from.branch);
        let frames = self.from.as_ref().map_or(0, |from| from.about.frame + 1);
        writer::Before { folder, marks, frames: if goes_on { frames } else { 0 } }
    }

    /// Removes what another run left in the folder of this one; a run that goes on keeps it.
    ///
    /// # Errors
    /// As those of [`Folder::clear`].
    pub(super) fn clear(&self, folder: &Folder) -> Result<()> {
        if self.from.as_ref().is_some_and(|from| !from.branch) { Ok(()) } else { folder.clear() }
    }

    /// The simulation of a run that begins from a checkpoint.
    ///
    /// # Errors
    /// Those of [`Simulation::new`]; [`Error::Spoilt`] and [`Error::Usage`] if the checkpoint is not of this scene and program, or tables
    /// are not those that belong to it.
    pub(super) fn taken(&self, gpu: &Gpu, plan: &MemoryPlan, folder: &Folder) -> Result<Option<Simulation>> {
        let Some(from) = &self.from else { return Ok(None) };
        let tables = self.tables();
        Tables::continued(&folder.path, &self.scene, (&tables.folder, &tables.marks))?;
        let before = self.scene.taking_over(&from.scene)?;
        from.warn(gpu);
        let mut simulation = Simulation::new(gpu, &before)?;
        let read = checkpoint::read(&from.path, plan.bytes(None).max(simulation.saved_bytes()))?;
        let saved = Saved { host: from.about.host.clone(), ..read };
        let told = |error: Error| match error {
            Error::Usage(text) => Error::Usage(format!("{}: {text}", from.path.display())),
            Error::Spoilt(text) => Error::spoilt(&from.path, text),
            other => other,
        };
        simulation.restore(&saved).map_err(told)?;
        if from.branch {
            simulation.change(&before, &self.scene, &mut Vec::new())?;
        }
        Ok(Some(simulation))
    }

    /// Time \[s\], steps and frames of the run so far.
    pub(super) fn come_to(&self) -> (f64, u64, u32) {
        let frames = self.tables().frames;
        self.from.as_ref().map_or((0.0, 0, 0), |from| (from.head.time, from.head.step, frames))
    }

    /// The last frame that exists, and whether the device is on its way to the next.
    pub(super) fn reached(&self) -> Option<(u32, bool)> {
        let from = self.from.as_ref()?;
        let (new, old) = (self.scene.frame_interval(), from.scene.frame_interval());
        if (new - old).abs() <= ROUNDING * old {
            return Some((from.about.frame, from.about.under_way));
        }
        // a branch with other frames: those up to its time count as drawn
        Some(((from.head.time / new + ROUNDING).floor() as u32, false))
    }
}

/// Whether two paths name one folder that is there.
fn same_place(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}

/// A run that goes on does so as it began.
fn refuse_changes(given: &RunOptions) -> Result<()> {
    let RunOptions { scene, out, frames, export, film, no_frames, force, branch, .. } = given;
    let asked = [
        ("--branch", *branch),
        ("--set", !scene.set.is_empty()),
        ("--variant", !scene.variant.is_empty()),
        ("--resolution", scene.resolution.is_some()),
        ("--out", out.is_some()),
        ("--frames", frames.is_some()),
        ("--export", !export.is_empty()),
        ("--video", film.video.is_some()),
        ("--no-frames", *no_frames),
        ("--force", *force),
    ];
    match asked.iter().find(|(_, asked)| *asked) {
        None => Ok(()),
        Some((name, _)) => Err(Error::Usage(format!(
            "{name} with --resume: a run goes on as it began, up to a later --until; --branch DIR@TIME starts another one"
        ))),
    }
}

/// Checkpoints of a run.
fn listed(run: &Path) -> Result<Vec<(u64, PathBuf)>> {
    let all = checkpoint::list(run)?;
    if all.is_empty() {
        let hint = "`brisance run SCENE --checkpoint 10min` leaves some";
        return Err(Error::Usage(format!("{} has no checkpoints to go on from; {hint}", run.display())));
    }
    Ok(all)
}

/// Says that an older checkpoint is there.
fn older(error: Error, all: &[(u64, PathBuf)]) -> Error {
    match (error, all) {
        (Error::Spoilt(text), [.., (_, older), _]) => {
            Error::Spoilt(format!("{text}; remove it to go on from {}", older.display()))
        }
        (error, _) => error,
    }
}

/// The latest checkpoint up to a time \[s\].
fn latest_before(run: &Path, time: f64) -> Result<PathBuf> {
    let mut times = Vec::new();
    for (_, path) in listed(run)? {
        times.push((checkpoint::read_texts(&path)?.0.time, path));
    }
    let found = times.iter().rev().find(|(own, _)| *own <= time * (1.0 + ROUNDING));
    found.map(|(_, path)| path.clone()).ok_or_else(|| {
        let all: Vec<String> = times.iter().map(|(own, _)| plain(*own)).collect();
        let text = format!("{} has no checkpoint up to {} s; it has: {} s", run.display(), plain(time), all.join(", "));
        Error::Usage(format!("{text}. `--checkpoint t={} --keep 1000` leaves more", plain(time)))
    })
}

/// Frames up to a later end: their distance stays.
fn more_frames(from: &From, until: f64) -> Result<u32> {
    let interval = from.scene.frame_interval();
    let frames = until / interval;
    let whole = frames.round();
    if (frames - whole).abs() > ROUNDING || until <= from.head.time || whole > f64::from(u32::MAX) {
        let next = ((from.head.time / interval + ROUNDING).floor() + 1.0) * interval;
        return Err(Error::Usage(format!(
            "--until {until}: the run has come to {} s and draws a frame every {} s; a later end is a multiple of it, from {} s on",
            plain(from.head.time),
            plain(interval),
            plain(next)
        )));
    }
    Ok(whole as u32)
}

impl From {
    /// Reads head and texts of a checkpoint of a run; `changes` apply to its scene.
    fn read(run: &Path, path: &Path, changes: &[String]) -> Result<Self> {
        let (head, text, about) = checkpoint::read_texts(path)?;
        if head.version != VERSION {
            let (program, form) = (&head.source.program, head.version);
            let text = format!(
                "brisance {program} wrote it in form {form}, and the steps of this program ask for form {VERSION}"
            );
            let hint = "`render`, `convert` and `view` read it; run the scene again to go on";
            return Err(Error::spoilt(path, format_args!("{text}: {hint}")));
        }
        let about: About = toml::from_str(&about)
            .map_err(|error| Error::spoilt(path, format_args!("{}: {error}", checkpoint::RUN)))?;
        let outside = about.options.scene.allow_outside;
        let parsed =
            |set: &[String]| Scene::parse(&text, &head.source.scene_file, Changes { outside, ..Changes::from(set) });
        let foreign = |reason: &str| Error::spoilt(path, reason);
        if parsed(&[])?.hash() != head.source.scene_hash {
            return Err(foreign(
                "its scene is read differently by this program, or a mesh file has changed; run it again",
            ));
        }
        let report = input::text(&run.join("report.json"), input::MOST_REPORT).ok();
        let report = report.and_then(|text| serde_json::from_str::<Recorded>(&text).ok());
        if report.is_some_and(|report| report.scene_hash != head.source.scene_hash) {
            return Err(foreign("it is a checkpoint of another scene than report.json"));
        }
        let scene = parsed(changes)?;
        Ok(Self { run: run.to_owned(), path: path.to_owned(), head, scene, about, branch: false })
    }

    /// Tells where bits may differ.
    fn warn(&self, gpu: &Gpu) {
        let (source, here) = (&self.head.source, device(gpu).text());
        if source.device != here {
            tell!(
                "warning: the checkpoint was made on {}; on {here} the run goes on, but not bit for bit",
                source.device
            );
        }
        if source.program != env!("CARGO_PKG_VERSION") {
            tell!(
                "warning: the checkpoint was made by brisance {}; this is {}",
                source.program,
                env!("CARGO_PKG_VERSION")
            );
        }
    }
}
