//! Checkpoints of a run at work: when they are due, what they say, and who goes on from them.

use std::str::FromStr;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::super::args::RunOptions;
use super::super::tables::Marks;
use super::super::writer::Message;
use super::{Run, interrupt};
use crate::expect::{Budget, Summary};
use crate::simulation::{BATCH, Host, Saved};
use crate::{Error, Result};

/// Without a wish, a crash costs ten minutes at most.
const DEFAULT: Every = Every::Wall(600.0);
/// Checkpoints that stay.
const KEPT: usize = 2;

/// How often a run leaves a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Every {
    /// So many steps.
    Steps(u64),
    /// So much simulated time \[s\].
    Time(f64),
    /// So much time on the clock \[s\].
    Wall(f64),
    /// Never.
    Off,
}

impl FromStr for Every {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let number = |part: &str| part.trim().parse().ok().filter(|value: &f64| *value > 0.0 && value.is_finite());
        let wall = [("min", 60.0), ("h", 3600.0), ("s", 1.0)];
        if text == "off" {
            return Ok(Every::Off);
        }
        if let Some(time) = text.strip_prefix("t=").and_then(number) {
            return Ok(Every::Time(time));
        }
        let steps = text.strip_suffix("steps").or_else(|| text.strip_suffix("step"));
        if let Some(steps) = steps.and_then(|part| part.trim().parse().ok()).filter(|steps| *steps > 0) {
            return Ok(Every::Steps(steps));
        }
        let found = wall.iter().find_map(|(unit, seconds)| Some(seconds * number(text.strip_suffix(unit)?)?));
        found.map(Every::Wall).ok_or_else(|| {
            "write a number of steps, as in 500steps; time on the clock, as in 90s, 10min, 2h; simulated seconds, as in t=0.01; or off"
                .to_owned()
        })
    }
}

/// What a checkpoint says of the run beside the state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct About {
    /// Last frame that was drawn.
    pub(super) frame: u32,
    /// Whether the device is on its way to the next one.
    pub(super) under_way: bool,
    /// Time on the clock so far \[s\].
    pub(super) wall_seconds: f64,
    /// What was changed by hand, also in the run that a branch comes from.
    #[serde(default)]
    pub(super) by_hand: Option<String>,
    /// [`Saved::host`].
    pub(super) host: Host,
    /// How far the tables had come.
    #[serde(default)]
    pub(super) tables: Marks,
    /// The command line.
    pub(super) options: RunOptions,
    /// The start of the run.
    pub(super) start_budget: Budget,
    /// Its steps so far.
    pub(super) summary: Summary,
}

/// A checkpoint on its way to the disk.
#[derive(Debug)]
pub(in crate::cli) struct Checkpoint {
    /// The state.
    pub(in crate::cli) saved: Saved,
    about: About,
    /// Checkpoints that stay, with this one.
    pub(in crate::cli) keep: usize,
}

impl Checkpoint {
    /// What it says of the run, whose tables have come so far.
    pub(in crate::cli) fn about(&mut self, tables: Marks) -> String {
        self.about.tables = tables;
        toml::to_string(&self.about).unwrap_or_default()
    }
}

/// When the next checkpoint is due.
#[derive(Debug)]
pub(super) struct Schedule {
    every: Every,
    /// Whether somebody asked for checkpoints: then the end leaves one, too.
    asked: bool,
    keep: usize,
    /// The latest one: on the clock, in simulated time, in steps.
    clock: Instant,
    time: f64,
    step: u64,
}

impl Schedule {
    /// Of a run that begins at a time \[s\] after so many steps.
    pub(super) fn new(options: &RunOptions, time: f64, step: u64) -> Self {
        let every = options.checkpoint.unwrap_or(DEFAULT);
        let keep = options.keep.unwrap_or(KEPT);
        Self { every, asked: options.checkpoint.is_some(), keep, clock: Instant::now(), time, step }
    }

    fn due(&self, time: f64, step: u64) -> bool {
        match self.every {
            Every::Steps(steps) => step / steps > self.step / steps,
            Every::Time(span) => (time / span).floor() > (self.time / span).floor(),
            Every::Wall(seconds) => self.clock.elapsed() >= Duration::from_secs_f64(seconds.min(1e9)),
            Every::Off => false,
        }
    }

    /// Steps of a submission that may have `batch`: none goes past a checkpoint, as far as the latest step \[s\] tells.
    pub(super) fn batch(&self, batch: u32, (time, step): (f64, u64), latest: f64) -> u32 {
        match self.every {
            Every::Time(span) if latest > 0.0 => {
                let left = ((time / span).floor() + 1.0) * span - time;
                (0.5 * left / latest).clamp(1.0, batch.into()) as u32 // steps may grow
            }
            Every::Steps(steps) => u64::from(batch).min(steps - step % steps).clamp(1, u64::from(BATCH)) as u32,
            _ => batch,
        }
    }
}

impl Run<'_> {
    /// Leaves a checkpoint where one is due.
    pub(super) fn checkpoint_if_due(&mut self) -> Result<()> {
        let due = self.schedule.due(self.simulation.time(), self.simulation.step_count());
        if due { self.checkpoint() } else { Ok(()) }
    }

    /// At the end: whoever asked for checkpoints may go on from there to a later end.
    pub(super) fn checkpoint_at_end(&mut self) -> Result<()> {
        let here = self.simulation.step_count() == self.schedule.step;
        if self.schedule.asked && self.schedule.every != Every::Off && !here { self.checkpoint() } else { Ok(()) }
    }

    /// Whether somebody wants the run to stop; then the last checkpoint is on its way.
    pub(super) fn stop_if_asked(&mut self) -> Result<()> {
        if !interrupt::wish() {
            return Ok(());
        }
        if self.schedule.every != Every::Off {
            self.checkpoint()?;
        }
        Err(Error::Interrupted)
    }

    /// Copies the state between two steps, and hands it to the writer with the steps that led to it.
    fn checkpoint(&mut self) -> Result<()> {
        let first = self.pending.len();
        let settled = self.simulation.settle(&mut self.pending);
        self.summary.add(&self.pending[first..]);
        settled?;
        let saved = self.simulation.save()?;
        let mut options = self.options.clone();
        options.scene.scene.clone_from(&self.place);
        (options.out, options.resume, options.branch) = (None, false, false);
        options.film.video = options.film.video.map(|film| std::path::absolute(&film).unwrap_or(film));
        let about = About {
            frame: self.frame.unwrap_or_default(),
            under_way: self.under_way,
            wall_seconds: self.wall_seconds(),
            by_hand: self.by_hand.clone(),
            host: saved.host.clone(),
            tables: Marks::default(),
            options,
            start_budget: self.start_budget,
            summary: self.summary.clone(),
        };
        (self.schedule.clock, self.schedule.time, self.schedule.step) = (Instant::now(), saved.time, saved.step);
        let checkpoint = Some(Box::new(Checkpoint { saved, about, keep: self.schedule.keep }));
        let message = Message { records: std::mem::take(&mut self.pending), frame: None, checkpoint };
        if self.writer.as_ref().is_some_and(|writer| writer.send(message)) {
            return Ok(());
        }
        self.close_writer().map(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_read() {
        let read = |text: &str| text.parse::<Every>();
        assert_eq!(read("500steps"), Ok(Every::Steps(500)));
        assert_eq!(read("10min"), Ok(Every::Wall(600.0)));
        assert_eq!(read("1.5h"), Ok(Every::Wall(5400.0)));
        assert_eq!(read("90s"), Ok(Every::Wall(90.0)));
        assert_eq!(read("t=1e-3"), Ok(Every::Time(1e-3)));
        assert_eq!(read("off"), Ok(Every::Off));
        for wrong in ["", "5", "0steps", "-1s", "nans", "t=0", "infs", "steps"] {
            assert!(read(wrong).unwrap_err().contains("500steps"), "{wrong}");
        }
    }
}
