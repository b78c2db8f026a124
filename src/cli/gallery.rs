//! `gallery`: scenes one after another or a few at a time, and one page that shows them all.

mod page;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use serde_json::{Value, json};

use super::args::{Cli, GalleryOptions, RunOptions, Scale, SceneOptions};
use super::interrupt;
use super::progress::clock;
use super::{open_device, run};
use crate::export::atomic;
use crate::scene::{self, GALLERY, SMALL, Scene, is_size};
use crate::{Error, Result, input};

/// Folders of the scenes that are shown when nobody asks for others.
const SHOWN: [&str; 2] = ["paper", "demos"];

/// Scenes that run at a time on a software device, at most.
const AT_A_TIME: usize = 4;

/// A scene in one of its variants.
#[derive(Clone, Debug)]
struct Entry {
    /// Scene as `run` takes it.
    scene: String,
    /// Variants, the scale first.
    variants: Vec<String>,
    /// Name of its folder, and on the page.
    id: String,
}

/// What became of an entry.
struct Shown {
    entry: Entry,
    /// The error, if there was one.
    error: Option<String>,
    /// Wall time \[s\].
    seconds: f64,
    /// `report.json` of the run; null if it did not get so far.
    report: Value,
}

/// Runs the scenes and writes the page, whatever becomes of them.
///
/// # Errors
/// [`Error::Expectation`] if a scene failed, after all have run; [`Error::Usage`] for unknown names; [`Error::Interrupted`].
pub(super) fn gallery(options: &GalleryOptions, cli: &Cli) -> Result<()> {
    let entries = entries(options)?;
    interrupt::listen();
    let start = Instant::now();
    let jobs = jobs(options, cli, entries.len())?;
    let shown = perform(&entries, options, cli, (jobs, start))?;
    let seconds = start.elapsed();
    let object = json!({ "scale": options.scale.name(), "seconds": seconds.as_secs_f64(),
                         "scenes": shown.iter().map(Shown::json).collect::<Vec<_>>() });
    if cli.json {
        say!("{object}");
    } else {
        say!("{} scenes in {}: {}", shown.len(), clock(seconds), options.out.join("gallery.html").display());
    }
    if interrupt::wish() { Err(Error::Interrupted) } else { verdict(&shown, &options.out) }
}

/// How many scenes run at a time.
fn jobs(options: &GalleryOptions, cli: &Cli, count: usize) -> Result<usize> {
    let jobs = match options.jobs {
        Some(jobs) => jobs.into(),
        // one small scene leaves cores idle: its kernels are short
        None if open_device(cli)?.is_software() => {
            std::thread::available_parallelism().map_or(1, usize::from).min(AT_A_TIME)
        }
        None => 1,
    };
    Ok(jobs.min(count))
}

/// Runs the entries, and writes the page after each, so that a long gallery can be looked at while it grows.
fn perform(
    entries: &[Entry],
    options: &GalleryOptions,
    cli: &Cli,
    (jobs, start): (usize, Instant),
) -> Result<Vec<Shown>> {
    let count = entries.len();
    let next = AtomicUsize::new(0);
    let shown: Mutex<Vec<(usize, Shown)>> = Mutex::default();
    let quiet = cli.json || options.quiet || jobs > 1;
    let work = || {
        while !interrupt::wish() {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(entry) = entries.get(index) else { break };
            tell!("[{}/{count}] {}", index + 1, entry.id);
            let one = show(entry, &options.out, quiet, cli);
            tell!("[{}/{count}] {}: {}", index + 1, one.entry.id, one.error.as_deref().unwrap_or("done"));
            let mut shown = shown.lock().unwrap_or_else(PoisonError::into_inner);
            let place = shown.partition_point(|(other, _)| *other < index);
            shown.insert(place, (index, one));
            write(&options.out, &shown, start, cli)?;
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .try_for_each(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    Ok(shown.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter().map(|(_, one)| one).collect())
}

/// What to run, in the order of the names.
fn entries(options: &GalleryOptions) -> Result<Vec<Entry>> {
    let names: Vec<String> =
        if options.names.is_empty() { SHOWN.map(str::to_owned).into() } else { options.names.clone() };
    let mut found = Vec::new();
    for name in &names {
        let below = format!("{}/", name.trim_start_matches("scenes/").trim_end_matches('/'));
        let folder: Vec<_> = scene::shipped().into_iter().filter(|scene| scene.path.starts_with(&below)).collect();
        for scene in &folder {
            found.extend(variants_of(&scene.path, None, options.scale)?);
        }
        if folder.is_empty() {
            let (scene, variant) = name.rsplit_once(':').map_or((name.as_str(), None), |(a, b)| (a, Some(b)));
            found.extend(variants_of(scene, variant, options.scale)?);
        }
    }
    Ok(found)
}

/// One entry for each variant of a scene beside its sizes, or for the scene itself.
fn variants_of(scene: &str, wanted: Option<&str>, scale: Scale) -> Result<Vec<Entry>> {
    let read = Scene::find(scene, &[])?;
    let sizes: &[&str] = match scale {
        Scale::Small => &[SMALL],
        Scale::Gallery => &[GALLERY, SMALL],
        Scale::Full => &[],
    };
    let size = sizes.iter().find(|name| read.variants.contains_key(**name)).map(|&name| name.to_owned());
    let known: Vec<&str> = read.variants.keys().map(String::as_str).filter(|name| !is_size(name)).collect();
    let chosen: Vec<Option<&str>> = match wanted {
        Some(name) if known.contains(&name) => vec![Some(name)],
        Some(name) => {
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            return Err(Error::Usage(format!("no variant `{name}` of `{scene}`; there are: {known}")));
        }
        None if known.is_empty() => vec![None],
        None => known.into_iter().map(Some).collect(),
    };
    let stem = scene::stem(scene);
    let entry = |variant: Option<&str>| Entry {
        scene: scene.to_owned(),
        variants: size.clone().into_iter().chain(variant.map(str::to_owned)).collect(),
        id: variant.map_or_else(|| stem.clone(), |variant| format!("{stem}-{variant}")),
    };
    Ok(chosen.into_iter().map(entry).collect())
}

/// Runs one entry on a device of its own, so that a device that is lost takes no other scene with it.
fn show(entry: &Entry, out: &Path, quiet: bool, cli: &Cli) -> Shown {
    let start = Instant::now();
    let folder = out.join(&entry.id);
    let scene = SceneOptions {
        scene: entry.scene.clone(),
        variant: entry.variants.clone(),
        set: Vec::new(),
        allow_outside: false,
        resolution: None,
    };
    let run = RunOptions { scene, out: Some(folder.clone()), force: true, quiet, ..RunOptions::default() };
    // what an earlier gallery left must not stand for a run that does not get so far
    let _ = std::fs::remove_file(folder.join("report.json"));
    let outcome = catch_unwind(AssertUnwindSafe(|| run::perform(&run, cli, false)));
    let error = match outcome {
        Ok(Ok(())) => None,
        Ok(Err(error)) => Some(error.to_string()),
        Err(_) => Some("a bug of ours, said above".to_owned()),
    };
    let report = input::text(&folder.join("report.json"), input::MOST_REPORT).ok();
    let report = report.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
    Shown { entry: entry.clone(), error, seconds: start.elapsed().as_secs_f64(), report }
}

impl Shown {
    fn json(&self) -> Value {
        json!({ "id": self.entry.id, "scene": self.entry.scene, "variants": self.entry.variants,
                "passed": self.error.is_none(), "error": self.error, "seconds": self.seconds })
    }

    /// The command that does the same.
    fn command(&self) -> String {
        let name = self.entry.scene.trim_end_matches(".toml");
        let variants = self.entry.variants.iter().map(|variant| format!(" --variant {variant}"));
        format!("brisance run {name}{}", variants.collect::<String>())
    }
}

fn write(out: &Path, shown: &[(usize, Shown)], start: Instant, cli: &Cli) -> Result<()> {
    let shown: Vec<&Shown> = shown.iter().map(|(_, one)| one).collect();
    let page = page::html(out, &shown, start.elapsed(), cli);
    atomic::write(&out.join("gallery.html"), |file| file.write_all(page.as_bytes()))
}

/// The error of a gallery with scenes that failed.
fn verdict(shown: &[Shown], out: &Path) -> Result<()> {
    let failed: Vec<&str> = shown.iter().filter(|one| one.error.is_some()).map(|one| one.entry.id.as_str()).collect();
    if failed.is_empty() {
        return Ok(());
    }
    let page = out.join("gallery.html");
    Err(Error::Expectation(format!(
        "{} of {} scenes failed: {}; see {}",
        failed.len(),
        shown.len(),
        failed.join(", "),
        page.display()
    )))
}
