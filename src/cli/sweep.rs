//! `sweep`: one scene many times over ranges of its keys, in one process that compiles its kernels once.

mod points;
mod table;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::json;

use super::args::{Cli, RunOptions, SceneOptions, SweepOptions};
use super::folder::Folder;
use super::run::Every;
use super::{interrupt, open_device, page, run, scenes};
use crate::export::atomic;
use crate::gpu::Gpu;
use crate::math::plain;
use crate::scene::{Changes, Scene};
use crate::simulation::Simulation;
use crate::{Error, Result, input};
use points::{Axis, axis, points, shard};
use table::{Rows, report};

/// Folder of the common start of `--branch-at`.
const START: &str = "start";

/// How long a part waits before it looks for the start again.
const WAIT: Duration = Duration::from_millis(100);

/// A sweep.
struct Sweep<'a> {
    options: &'a SweepOptions,
    scene: Scene,
    axes: Vec<Axis>,
    points: Vec<Vec<String>>,
    /// Points of this process.
    own: Vec<usize>,
}

/// Runs a sweep.
///
/// # Errors
/// [`Error::Usage`] if a range makes no sense; [`Error::Io`]; [`Error::Expectation`] if runs failed.
pub(super) fn sweep(options: &SweepOptions, cli: &Cli) -> Result<()> {
    let start = Instant::now();
    let sweep = Sweep::of(options)?;
    sweep.own.iter().try_for_each(|number| sweep.can_run(*number))?;
    interrupt::listen();
    let gpu = open_device(cli)?;
    let mut rows = Rows::new(sweep.keys(), sweep.points.len());
    let outcome = sweep.perform(&gpu, &mut rows);
    sweep.save(&mut rows)?;
    let failed = page::sweep::write(&options.out, &sweep.scene.title, &sweep.keys()).and(outcome)?;
    let (runs, seconds) = (sweep.own.len(), start.elapsed().as_secs_f64());
    if cli.json {
        say!("{}", json!({ "runs": runs, "failed": failed, "seconds": seconds }));
    } else if !options.quiet {
        say!("{runs} runs in {seconds:.1} s; sweep.csv and sweep.html in {}", options.out.display());
    }
    if failed.is_empty() { Ok(()) } else { Err(Error::Expectation(format!("runs failed: {}", failed.join(", ")))) }
}

/// An error in the scene of a run with the option that its changes were written in: those of `--set` are read before.
fn of_over(error: Error) -> Error {
    match error {
        Error::Scene(text) => Error::Scene(text.replace("--> --set:", "--> --over:")),
        other => other,
    }
}

impl<'a> Sweep<'a> {
    fn of(options: &'a SweepOptions) -> Result<Self> {
        let axes: Vec<Axis> = options.over.iter().map(|text| axis(text)).collect::<Result<_>>()?;
        let points = points(&axes, options.sample.as_deref(), options.seed)?;
        let (shard, shards) = shard(options.shard.as_deref())?;
        let own = (0..points.len()).filter(|number| number % shards == shard).collect();
        let until = options.until.map(|until| format!("time.until={until:?}"));
        let changes: Vec<String> =
            until.into_iter().chain(options.frames.map(|frames| format!("time.frames={frames}"))).collect();
        let scene = scenes::load(&options.scene, &changes)?;
        if let Some(time) = options.branch_at.filter(|time| !(*time > 0.0 && *time < scene.time.until)) {
            let until = plain(scene.time.until);
            return Err(Error::Usage(format!("--branch-at {time}: a time between 0 and the end, {until} s")));
        }
        Ok(Self { options, scene, axes, points, own })
    }

    /// Reads the scene of a run, before any run begins.
    ///
    /// # Errors
    /// [`Error::Scene`] if its values are wrong; [`Error::Usage`] if the common start cannot go on with them.
    fn can_run(&self, number: usize) -> Result<()> {
        let SweepOptions { scene: base, until, frames, branch_at, .. } = self.options;
        let sets = self.sets(number);
        let until = until.map(|until| format!("time.until={until:?}"));
        let frames = frames.map(|frames| format!("time.frames={frames}"));
        let all: Vec<String> = until.into_iter().chain(frames).chain(sets.iter().cloned()).collect();
        let scene = scenes::load(base, &all).map_err(of_over)?;
        if branch_at.is_none() {
            return Ok(());
        }
        Changes { set: sets, ..Changes::default() }.of_a_state(None, "--branch-at", "--over")?;
        Simulation::can_change(&scene.taking_over(&self.scene)?, &scene)
    }

    fn keys(&self) -> Vec<String> {
        self.axes.iter().map(|axis| axis.key.clone()).collect()
    }

    /// Runs what is not finished yet; returns the numbers of the runs that failed.
    fn perform(&self, gpu: &Gpu, rows: &mut Rows) -> Result<Vec<String>> {
        let mut failed = Vec::new();
        for (done, &number) in self.own.iter().enumerate() {
            let (folder, sets) = (self.folder(number), self.sets(number));
            if !self.finished(&folder, &sets)? {
                let begun = Instant::now();
                rows.forget(number);
                self.start(gpu)?;
                match run::perform_on(gpu, &self.one(&sets, &folder)) {
                    Err(
                        error @ (Error::Interrupted
                        | Error::Scene(_)
                        | Error::Usage(_)
                        | Error::Gpu(_)
                        | Error::Io { .. }
                        | Error::NoAdapter(_)),
                    ) => return Err(error),
                    Err(error) => {
                        tell!("warning: {number:04}: {error}");
                        failed.push(format!("{number:04}"));
                    }
                    Ok(()) => {}
                }
                self.note(&folder, &sets)?;
                if !self.options.quiet {
                    let (at, all, seconds) = (done + 1, self.own.len(), begun.elapsed().as_secs_f64());
                    tell!("{at} of {all}: {} in {seconds:.2} s", sets.join(" "));
                }
            }
            self.save(rows)?;
        }
        Ok(failed)
    }

    fn folder(&self, number: usize) -> PathBuf {
        self.options.out.join(format!("{number:04}"))
    }

    /// The values of a run as `--set` takes them.
    fn sets(&self, number: usize) -> Vec<String> {
        self.axes.iter().zip(&self.points[number]).map(|(axis, value)| format!("{}={value}", axis.key)).collect()
    }

    /// The options of one run.
    fn one(&self, sets: &[String], folder: &Path) -> RunOptions {
        let (base, time) = (&self.options.scene, self.options.branch_at);
        let scene = match time {
            // the state has the changes of the whole sweep
            Some(time) => SceneOptions {
                scene: format!("{}@{time:?}", self.options.out.join(START).display()),
                set: sets.to_vec(),
                ..SceneOptions::default()
            },
            None => SceneOptions { set: base.set.iter().chain(sets).cloned().collect(), ..base.clone() },
        };
        let whole = time.map(|_| (self.scene.time.until, self.scene.time.frames));
        RunOptions {
            scene,
            out: Some(folder.to_owned()),
            until: whole.map_or(self.options.until, |(until, _)| Some(until)),
            frames: whole.map_or(self.options.frames, |(_, frames)| Some(frames)),
            export: self.options.export.clone(),
            no_frames: self.options.no_frames,
            branch: time.is_some(),
            force: true,
            quiet: true,
            ..RunOptions::default()
        }
    }

    /// Runs up to where the runs part, unless that is there; of several parts one does so, and the others wait for it.
    fn start(&self, gpu: &Gpu) -> Result<()> {
        let Some(time) = self.options.branch_at else { return Ok(()) };
        let folder = self.options.out.join(START);
        let mut told = false;
        while !self.finished(&folder, &[])? {
            match Folder::locked(&self.options.out) {
                // who had the turn before may have come to the end
                Ok(_turn) if self.finished(&folder, &[])? => return Ok(()),
                Ok(_turn) => return self.run_start(gpu, time, &folder),
                Err(Error::Usage(who)) => {
                    if !std::mem::replace(&mut told, true) {
                        tell!("waiting for the start of the runs: {who}");
                    }
                    std::thread::sleep(WAIT);
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    fn run_start(&self, gpu: &Gpu, time: f64, folder: &Path) -> Result<()> {
        let options = RunOptions {
            scene: self.options.scene.clone(),
            out: Some(folder.to_owned()),
            until: Some(time),
            frames: Some(1),
            no_frames: true,
            checkpoint: Some(Every::Time(time)),
            keep: Some(1),
            force: true,
            no_expect: true,
            quiet: true,
            ..RunOptions::default()
        };
        run::perform_on(gpu, &options)?;
        self.note(folder, &[])
    }

    /// What a run of this sweep is a run of, one line each.
    fn mark(&self, sets: &[String]) -> String {
        let SweepOptions { scene, until, frames, export, no_frames, branch_at, .. } = self.options;
        let of = json!({ "scene": self.scene.hash(), "resolution": scene.resolution, "variants": scene.variant, "set": scene.set,
                         "until": until, "frames": frames, "export": export, "no_frames": no_frames, "branch_at": branch_at });
        [of.to_string()].into_iter().chain(sets.iter().cloned()).collect::<Vec<_>>().join("\n")
    }

    /// Marks a folder with its run.
    fn note(&self, folder: &Path, sets: &[String]) -> Result<()> {
        atomic::write(&folder.join("point.txt"), |out| out.write_all(self.mark(sets).as_bytes()))
    }

    /// Whether a folder holds the finished run of these values.
    fn finished(&self, folder: &Path, sets: &[String]) -> Result<bool> {
        Ok(self.is_own(folder, sets) && report(folder)?["status"] == "finished")
    }

    fn is_own(&self, folder: &Path, sets: &[String]) -> bool {
        input::text(&folder.join("point.txt"), input::MOST_SCENE).is_ok_and(|text| text == self.mark(sets))
    }

    fn save(&self, rows: &mut Rows) -> Result<()> {
        rows.save(&self.options.out, &self.points, |number, folder| self.is_own(folder, &self.sets(number)))
    }
}
