//! `convert`: a finished run for other programs, from its states, without simulating.

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::json;

use super::args::{Cli, ConvertOptions};
use super::interrupt;
use super::progress::clock;
use super::render::{Recorded, belongs, read_report};
use crate::export::{self, Moment, Needs, Origin, checkpoint, states};
use crate::scene::{Fire, MOST_PARTICLES, Scene};
use crate::spelling::did_you_mean;
use crate::state::{Grid, MemoryPlan};
use crate::{Error, Result};

/// Writes the states of a run in other formats.
///
/// # Errors
/// [`Error::Usage`] if the run has no states or a format needs a device; [`Error::Io`].
pub(super) fn convert(options: &ConvertOptions, cli: &Cli) -> Result<()> {
    interrupt::listen();
    let start = Instant::now();
    known(&options.to)?;
    let (drawn, to): (Vec<String>, Vec<String>) = options.to.iter().cloned().partition(|name| name == "exr");
    if !drawn.is_empty() {
        // what is wrong with the others is told before anything is drawn
        export::open(&to, &options.run)?;
        super::render::layers(options, cli)?;
        if to.is_empty() {
            return Ok(());
        }
    }
    let folder = options.out.clone().unwrap_or_else(|| options.run.clone());
    let mut exporters = export::open(&to, &folder)?;
    let needs = Needs::of(&exporters);
    if !needs.snapshot || needs.stored {
        let text = "png and fields are no formats to convert to; `brisance render DIR` draws png and png16";
        return Err(Error::Usage(format!("--to {}: {text}", options.to.join(","))));
    }
    let Recorded { scene_hash, scene_file, particles, mut scene, .. } =
        read_report(&options.run, options.allow_outside)?;
    if needs.obstacles && !scene.obstacles.is_empty() {
        let text = toml::to_string(&scene).map_err(|error| Error::Scene(format!("report.json: {error}")))?;
        scene = Scene::recorded(&text, (&options.run, &scene_file), &[], options.allow_outside)?;
    }
    scene.output.ambient_kelvin = options.kelvin.or(scene.output.ambient_kelvin);
    let origin = Origin::of(&scene).at(&scene_file, "");
    let frames = frames(options, &scene)?;
    let grid = Grid::of(&scene.domain);
    let light = states::most_bytes(grid.slots() as u64, particles.min(MOST_PARTICLES));
    let plan = MemoryPlan::new(&scene, particles.min(MOST_PARTICLES) as usize);
    let most = light.max(plan.bytes(None));
    let _heard = interrupt::listen_between_steps();
    for (index, path) in &frames {
        if interrupt::wish() {
            return Err(Error::Interrupted);
        }
        let (hash, stored) = states::read_of(path, most, needs.cells, Some(&plan))?;
        belongs(path, (&hash, &scene_hash), &stored, needs.cells.then_some(&grid))?;
        let mut snapshot = states::snapshot(stored, grid, scene.gas.equation_of_state());
        snapshot.fire = Fire::of(&scene);
        snapshot.laws = scene.laws();
        let (time, step) = (snapshot.time, snapshot.step);
        let snapshot = Some(&snapshot);
        let moment = Moment { index: *index, origin: &origin, time, step, pictures: &[], snapshot, stored: None };
        exporters.iter_mut().try_for_each(|exporter| exporter.write(&moment))?;
    }
    if cli.json {
        let seconds = start.elapsed().as_secs_f64();
        say!("{}", json!({ "frames": frames.len(), "folder": folder, "formats": options.to, "seconds": seconds }));
    } else if !options.quiet {
        say!("{} frames in {} in {}", frames.len(), folder.display(), clock(start.elapsed()));
    }
    Ok(())
}

/// Formats that a run is not converted to: pictures with letters, and the states themselves.
const OTHERS: [&str; 3] = ["png", "png16", "fields"];

/// Refuses names that no format has.
fn known(names: &[String]) -> Result<()> {
    let all = || export::FORMATS.iter().map(|format| format.name);
    let unknown = names.iter().find(|name| !all().any(|own| own == export::keyword(name)));
    unknown.map_or(Ok(()), |name| {
        let offered: Vec<&str> = all().filter(|own| !OTHERS.contains(own)).collect();
        let like = did_you_mean(name, offered.iter().copied());
        Err(Error::Usage(format!("no export format `{name}`; a run is converted to {}{like}", offered.join(", "))))
    })
}

/// The states to convert, with the numbers of their frames; where a run has none, its checkpoints.
fn frames(options: &ConvertOptions, scene: &Scene) -> Result<Vec<(u32, PathBuf)>> {
    let allowed = |path: &Path| if options.allow_outside { Ok(()) } else { export::stays_inside(&options.run, path) };
    let mut all = states::list(&options.run)?;
    all.iter().try_for_each(|(_, path)| allowed(path))?;
    if all.is_empty() {
        for (_, path) in checkpoint::list(&options.run)? {
            allowed(&path)?;
            let time = checkpoint::read_texts(&path)?.0.time;
            all.push(((time / scene.frame_interval()).round() as u32, path));
        }
    }
    if all.is_empty() {
        let run = options.run.display();
        return Err(Error::Usage(format!(
            "{run} has neither states nor checkpoints; run the scene with --export fields"
        )));
    }
    if let Some(missing) = options.frame.iter().find(|number| all.iter().all(|(index, _)| index != *number)) {
        let text = format!("{} has no state of frame {missing}; it has {} states", options.run.display(), all.len());
        return Err(Error::Usage(text));
    }
    all.retain(|(index, _)| options.frame.is_empty() || options.frame.contains(index));
    Ok(all)
}
