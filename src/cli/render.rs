//! `render`: the frames of a run again, with another camera or look, from its stored states.

use std::path::{Path, PathBuf};
use std::sync::mpsc::sync_channel;
use std::time::Instant;

use serde::Deserialize;
use serde_json::{Value, json};

use super::args::{Cli, ConvertOptions, RenderOptions};
use super::interrupt;
use super::progress::clock;
use super::run::{PICTURES, without_coarse};
use super::writer::{Files, FrameToWrite, Message, Writer, Written};
use super::{film, open_device};
use crate::export::{self, forms, report, states};
use crate::gpu::Gpu;
use crate::render::{Loaded, Renderer, Stored};
use crate::scene::{Field, MOST_PARTICLES, Overlays, Scene, Shot};
use crate::spelling::did_you_mean;
use crate::state::Grid;
use crate::{Error, Result, input};

/// Name of the scene's own look among the views.
const MAIN: &str = "main";

/// What is needed of a run's report.
#[derive(Deserialize)]
pub(super) struct Recorded {
    #[serde(default = "first_form")]
    form: u32,
    pub(super) scene_hash: String,
    pub(super) scene_file: String,
    pub(super) particles: u64,
    pub(super) scene: Scene,
}

/// Of a report that names none.
fn first_form() -> u32 {
    1
}

/// Draws the frames of a run again.
///
/// # Errors
/// [`Error::Usage`] if the run has no states or an option makes no sense; [`Error::Scene`] if the look is wrong.
pub(super) fn render(options: &RenderOptions, cli: &Cli) -> Result<()> {
    let folder = options.out.clone().unwrap_or_else(|| options.run.join("again"));
    perform(options, (files(options, folder)?, true), cli)
}

/// Draws the frames of a run for compositors: layers without letters, and without the edges of the domain.
///
/// # Errors
/// As [`render`].
pub(super) fn layers(options: &ConvertOptions, cli: &Cli) -> Result<()> {
    let folder = options.out.clone().unwrap_or_else(|| options.run.clone());
    let ConvertOptions { run, allow_outside, frame, quiet, .. } = options.clone();
    let options = RenderOptions { run, allow_outside, frame, quiet, ..RenderOptions::default() };
    let files = Files { folder, formats: vec!["exr".to_owned()], ..Files::default() };
    perform(&options, (files, false), cli)
}

/// The same into files, with what is written over pictures or without it.
fn perform(options: &RenderOptions, (files, labelled): (Files, bool), cli: &Cli) -> Result<()> {
    interrupt::listen();
    let start = Instant::now();
    let recorded = read_report(&options.run, options.allow_outside)?;
    let (hash, particles) = (recorded.scene_hash.clone(), recorded.particles.min(MOST_PARTICLES));
    let form = recorded.form;
    let scene = with_look(recorded, options)?;
    if form == report::FORM && scene.hash() != hash {
        let message = "the scene of the run is read differently by this program, or a mesh file of it has changed";
        return Err(Error::spoilt(&options.run, format_args!("{message}; run it again")));
    }
    let mut shots = chosen(&scene, options)?;
    if !labelled {
        shots.iter_mut().for_each(|shot| shot.settings.overlays = Overlays::NONE);
    }
    let frames = frames(options)?;
    let folder = files.folder.clone();
    let gpu = open_device(cli)?;
    let grid = Grid::of(&scene.domain);
    let owed = shots.iter().flat_map(|shot| &shot.fields).any(|field| *field == Field::Owed);
    let reading = Reading { hash, grid, most: states::most_bytes(grid.slots() as u64, particles), owed };
    let mut drawing = Drawing { gpu, scene, grid, shots, depth: files.needs()?.depth, at_work: None };
    let writer = Writer::start(files, &drawing.scene);
    let drawn = drawing.all(&reading, &frames, &writer);
    // What the writer has to say comes first: a disk that is full, for example.
    let (Written { frames, films, .. }, outcome) = writer.finish();
    outcome?;
    let filmed = film::tell(&films, options.quiet || cli.json);
    drawn.and(filmed)?;
    if cli.json {
        say!("{}", json!({ "frames": frames, "folder": folder, "seconds": start.elapsed().as_secs_f64() }));
    } else if !options.quiet {
        say!("{frames} frames in {} in {}", folder.display(), clock(start.elapsed()));
    }
    Ok(())
}

/// Refuses a state that is none of the scene of a report, or is not whole.
///
/// # Errors
/// [`Error::Spoilt`] with the file, and the array that is wrong.
pub(super) fn belongs(path: &Path, (hash, scene): (&str, &str), stored: &Stored, grid: Option<&Grid>) -> Result<()> {
    let wrong = grid.map_or_else(|| stored.wrong_particles(), |grid| stored.wrong_length(grid));
    let why = match (wrong, hash == scene) {
        (_, false) => "it is a state of another scene than report.json".to_owned(),
        (Some(name), _) => {
            let slots = grid.map_or(String::new(), |grid| format!(": its scene has {} slots", grid.slots()));
            format!("array `{name}` has a wrong length{slots}")
        }
        (None, _) => match stored.not_finite() {
            Some(name) => format!("array `{name}` holds numbers that are not finite"),
            None => return Ok(()),
        },
    };
    Err(Error::spoilt(path, why))
}

/// Reads the report of a run.
///
/// # Errors
/// [`Error::Usage`] if the folder is none of a run or one of a later program, or the report lies elsewhere and `outside` does not allow
/// it.
pub(super) fn read_report(run: &Path, outside: bool) -> Result<Recorded> {
    let path = run.join("report.json");
    forms::known(run, outside)?;
    let text = input::text(&path, input::MOST_REPORT).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => {
            Error::Usage(format!("{} is no folder of a run: it has no report.json", run.display()))
        }
        _ => Error::io(&path, source),
    })?;
    recorded(&text)
        .map_err(|error| Error::spoilt(&path, format_args!("{error}; run the scene again with this program")))
}

/// What a report says, its scene in the words of this program.
fn recorded(text: &str) -> serde_json::Result<Recorded> {
    let mut report: Value = serde_json::from_str(text)?;
    let form = report["form"].as_u64().and_then(|form| u32::try_from(form).ok()).unwrap_or(1);
    report["scene"] = Scene::of_form(form, report["scene"].take());
    Recorded::deserialize(report)
}

/// The scene of the run with the look that the options ask for.
fn with_look(recorded: Recorded, options: &RenderOptions) -> Result<Scene> {
    let mut scene = recorded.scene;
    if let Some(name) = &options.scene {
        let other = Scene::find(name, &[])?;
        (scene.render, scene.output.fields) = (other.render, other.output.fields);
    }
    if let Some(key) =
        options.set.iter().find(|set| !["render.", "output.fields"].iter().any(|own| set.starts_with(own)))
    {
        let message =
            "only render.* and output.fields can change without simulating; use `brisance run` for other keys";
        return Err(Error::Usage(format!("--set {key}: {message}")));
    }
    let mut overrides = Vec::new();
    if let Some(camera) = &options.camera {
        scene.render.path = None;
        overrides.push(format!("render.camera={camera}"));
    }
    if let Some(size) = &options.size {
        let sides = size.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
        let Some([width, height]) = sides else {
            return Err(Error::Usage(format!("--size {size} is no size; write width x height, as in 3840x2160")));
        };
        let [width, height]: [u32; 2] = [width, height];
        overrides.push(format!("render.size=[{width}, {height}]"));
    }
    if !options.field.is_empty() {
        let names: Vec<String> = options.field.iter().map(|name| format!("{name:?}")).collect();
        overrides.push(format!("output.fields=[{}]", names.join(", ")));
    }
    overrides.extend(options.set.iter().cloned());
    let text = toml::to_string(&scene).map_err(|error| Error::Scene(format!("report.json: {error}")))?;
    Scene::recorded(&text, (&options.run, &recorded.scene_file), &overrides, options.allow_outside)
}

/// The views that are asked for; what the command line says holds for each of them.
fn chosen(scene: &Scene, options: &RenderOptions) -> Result<Vec<Shot>> {
    let mut shots = scene.shots()?;
    let name_of = |shot: &Shot| if shot.name.is_empty() { MAIN.to_owned() } else { shot.name.clone() };
    let names: Vec<String> = shots.iter().map(name_of).collect();
    if let Some(unknown) = options.view.iter().find(|name| !names.contains(name)) {
        return Err(Error::Usage(format!("no view `{unknown}`; there are: {}", names.join(", "))));
    }
    if !options.view.is_empty() {
        shots.retain(|shot| options.view.contains(&name_of(shot)));
    }
    for shot in &mut shots {
        if options.camera.is_some() {
            (shot.settings.camera, shot.settings.path) = (scene.render.camera, None);
        }
        if options.size.is_some() {
            shot.settings.size = scene.render.size;
        }
        if !options.field.is_empty() {
            shot.fields.clone_from(&scene.output.fields);
        }
    }
    Ok(shots)
}

/// The states to draw.
fn frames(options: &RenderOptions) -> Result<Vec<(u32, PathBuf)>> {
    let run = options.run.display();
    let all = if states::folder_of(&options.run).is_dir() { states::list(&options.run)? } else { Vec::new() };
    if all.is_empty() {
        return Err(Error::Usage(format!("{run} has no states; run the scene again with --export fields")));
    }
    let found = |number: &u32| all.iter().any(|(index, _)| index == number);
    if let Some(missing) = options.frame.iter().find(|number| !found(number)) {
        return Err(Error::Usage(format!("{run} has no state of frame {missing}; it has {} states", all.len())));
    }
    if !options.allow_outside {
        all.iter().try_for_each(|(_, path)| export::stays_inside(&options.run, path))?;
    }
    Ok(all.into_iter().filter(|(index, _)| options.frame.is_empty() || options.frame.contains(index)).collect())
}

fn files(options: &RenderOptions, folder: PathBuf) -> Result<Files> {
    let mut formats = vec!["png".to_owned()];
    for name in &options.export {
        if !PICTURES.contains(&name.as_str()) {
            let known = PICTURES.join(", ");
            let like = did_you_mean(name, PICTURES);
            return Err(Error::Usage(format!("--export {name}: pictures are drawn again as one of: {known}{like}")));
        }
        if !formats.contains(name) {
            formats.push(name.clone());
        }
    }
    without_coarse(&mut formats);
    let film::Asked { film, lost } = film::asked(&options.film, &folder.join("frames"));
    Ok(Files { folder, formats, video: film, lost_film: lost, ..Files::default() })
}

/// What belongs into the states of a run: hash of their scene, its grid, bytes at most.
struct Reading {
    hash: String,
    grid: Grid,
    most: u64,
    /// Whether a picture shows what gas is owed; if none does it is left out, for it takes as many bytes as the flow.
    owed: bool,
}

impl Reading {
    fn read(&self, path: &Path) -> Result<Stored> {
        let (hash, stored) = states::read(path, self.most, true)?;
        belongs(path, (&hash, &self.hash), &stored, Some(&self.grid))?;
        Ok(if self.owed { stored } else { Stored { owed: Vec::new(), ..stored } })
    }
}

/// Device, scene and look, and the buffers and kernels of the frames so far.
struct Drawing {
    gpu: Gpu,
    scene: Scene,
    grid: Grid,
    shots: Vec<Shot>,
    depth: crate::render::Depth,
    at_work: Option<(Loaded, Renderer)>,
}

impl Drawing {
    /// Draws all frames: a state is read while the one before is drawn and the picture before that is written. None is read further ahead.
    fn all(&mut self, reading: &Reading, frames: &[(u32, PathBuf)], writer: &Writer) -> Result<()> {
        std::thread::scope(|scope| {
            let (sender, states) = sync_channel(0);
            scope.spawn(move || frames.iter().all(|(_, path)| sender.send(reading.read(path)).is_ok()));
            let mut heard = None;
            for ((index, path), stored) in frames.iter().zip(states) {
                let frame = if interrupt::wish() { Err(Error::Interrupted) } else { stored };
                let frame = frame.and_then(|stored| self.draw(*index, path, &stored))?;
                if !writer.send(Message { frame: Some(frame), ..Message::default() }) {
                    break;
                }
                heard.get_or_insert_with(interrupt::listen_between_steps);
            }
            Ok(())
        })
    }

    fn draw(&mut self, index: u32, path: &Path, stored: &Stored) -> Result<FrameToWrite> {
        let map = self.shots.iter().flat_map(|shot| &shot.fields).find(|field| field.is_map());
        if let Some(map) = map.filter(|_| stored.maps.is_empty()) {
            let (path, name) = (path.display(), map.keyword());
            return Err(Error::Usage(format!(
                "{path} has no map of {name}; run the scene again with --set output.maps=true"
            )));
        }
        let renderer = self.renderer(stored)?;
        let pictures = renderer.render(stored.time)?;
        let (time, step) = (stored.time, stored.step);
        Ok(FrameToWrite { index, time, step, pictures, snapshot: None, stored: None })
    }

    /// The renderer with a state in its buffers.
    fn renderer(&mut self, stored: &Stored) -> Result<&mut Renderer> {
        let filled = self.at_work.as_ref().is_some_and(|(loaded, _)| loaded.fill(&self.gpu, stored));
        if !filled {
            self.at_work = None;
            let loaded = Loaded::new(&self.gpu, self.grid, stored)?;
            let renderer = Renderer::new(&self.gpu, &self.scene, &loaded.buffers())?;
            let renderer = renderer.with_depth(self.depth).with_shots(self.shots.clone()).with_stop(interrupt::wish);
            self.at_work = Some((loaded, renderer));
        }
        Ok(self.at_work.as_mut().map(|(_, renderer)| renderer).expect("made above"))
    }
}
