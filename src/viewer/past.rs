//! States of a scene at work that it can go back to: in memory, thinned out as the run gets longer, or the checkpoints of a run; and those
//! of its frames, which can only be looked at.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::expect::{Budget, Summary};
use crate::export::{self, checkpoint, container, forms, states};
use crate::render::Stored;
use crate::scene::{Changes, Scene};
use crate::simulation::{Host, Saved};
use crate::{Error, Result};

/// States that are kept in memory at most.
const MOST: u64 = 64;
/// Their bytes.
const MOST_BYTES: u64 = 1 << 30;
/// A time counts as reached up to this part of it.
const ROUNDING: f64 = 1e-9;

/// Where a state is.
#[derive(Debug)]
enum Place {
    Memory(Box<Saved>),
    File(PathBuf, Box<Host>),
    /// What pictures are drawn from.
    Light(PathBuf),
}

/// A state that was read.
#[derive(Debug)]
pub(super) enum Found {
    /// One to go on from.
    Whole(Box<Saved>),
    /// One to look at.
    Light(Box<Stored>),
}

/// A state to go back to.
#[derive(Debug)]
pub(super) struct Kept {
    /// Simulated time \[s\].
    pub(super) time: f64,
    /// Steps done.
    pub(super) step: u64,
    /// What the steps up to it amount to.
    pub(super) summary: Summary,
    /// Bodies that had joined the scene.
    pub(super) joined: usize,
    place: Place,
}

impl Kept {
    /// A state in memory.
    pub(super) fn of(saved: Saved, summary: Summary, joined: usize) -> Self {
        Self { time: saved.time, step: saved.step, summary, joined, place: Place::Memory(Box::new(saved)) }
    }

    /// The state, of at most so many bytes.
    ///
    /// # Errors
    /// [`Error::Io`] if its file cannot be read.
    pub(super) fn state(&self, most: u64) -> Result<Found> {
        Ok(match &self.place {
            Place::Memory(saved) => Found::Whole(saved.clone()),
            Place::File(path, host) => {
                Found::Whole(Box::new(Saved { host: (**host).clone(), ..checkpoint::read(path, most)? }))
            }
            Place::Light(path) => {
                let state = states::read(path, most, true)?.1;
                if let Some(name) = state.not_finite() {
                    return Err(Error::spoilt(path, format_args!("array `{name}` holds numbers that are not finite")));
                }
                Found::Light(Box::new(state))
            }
        })
    }

    /// Where it lies, if on the disk.
    pub(super) fn path(&self) -> Option<PathBuf> {
        match &self.place {
            Place::Memory(_) => None,
            Place::File(path, _) | Place::Light(path) => Some(path.clone()),
        }
    }

    fn is_whole(&self) -> bool {
        !matches!(self.place, Place::Light(_))
    }
}

/// The states of a scene, in order of time.
#[derive(Debug)]
pub(super) struct Past {
    kept: Vec<Kept>,
    /// Simulated time between two states \[s\].
    interval: f64,
    /// States that there is room for.
    room: usize,
}

impl Past {
    /// Of a scene that runs so long \[s\] and whose states have so many bytes; what is left of an earlier run comes first.
    pub(super) fn new(until: f64, bytes: u64, kept: Vec<Kept>) -> Self {
        let room = (MOST_BYTES / bytes.max(1)).clamp(2, MOST) as usize;
        Self { kept, interval: 2.0 * until / room as f64, room }
    }

    /// Whether a state at this time \[s\] is to be kept.
    pub(super) fn is_due(&self, time: f64) -> bool {
        self.kept.last().is_none_or(|last| time >= last.time + self.interval * (1.0 - ROUNDING))
    }

    /// Keeps a state. Where there is no room, every second one in memory goes.
    pub(super) fn keep(&mut self, state: Kept) {
        let place = self.kept.partition_point(|one| (one.time, one.step) <= (state.time, state.step));
        self.kept.insert(place, state);
        let in_memory = |one: &Kept| matches!(one.place, Place::Memory(_));
        if self.kept.iter().filter(|one| in_memory(one)).count() > self.room {
            let mut index = 0;
            self.kept.retain(|one| {
                index += usize::from(in_memory(one));
                !in_memory(one) || index % 2 == 1
            });
            self.interval *= 2.0;
        }
    }

    /// Whether the state at a time \[s\] and step is kept.
    pub(super) fn has(&self, time: f64, step: u64) -> bool {
        self.kept.iter().any(|one| one.time == time && one.step == step)
    }

    /// The last state up to a time \[s\]; the first one where there is none.
    pub(super) fn latest(&self, time: f64) -> Option<&Kept> {
        let reached = |one: &&Kept| one.time <= time * (1.0 + ROUNDING);
        self.kept.iter().rev().find(reached).or(self.kept.first())
    }

    /// The first state behind a time \[s\].
    pub(super) fn after(&self, time: f64) -> Option<&Kept> {
        self.kept.iter().find(|one| one.time > time * (1.0 + ROUNDING))
    }

    /// The last state up to a time \[s\] that the scene can go on from.
    pub(super) fn latest_whole(&self, time: f64) -> Option<&Kept> {
        let reached = |one: &&Kept| one.is_whole() && one.time <= time * (1.0 + ROUNDING);
        self.kept.iter().rev().find(reached)
    }

    /// Forgets what came later: from here the scene goes another way.
    pub(super) fn forget_after(&mut self, time: f64) {
        self.kept.retain(|one| one.time <= time * (1.0 + ROUNDING));
    }

    /// Times of all states \[s\].
    pub(super) fn times(&self) -> Vec<f64> {
        self.kept.iter().map(|one| one.time).collect()
    }
}

/// What a checkpoint says of its run.
#[derive(Deserialize)]
struct About {
    host: Host,
    summary: Summary,
    start_budget: Budget,
}

/// A run on the disk.
#[derive(Debug)]
pub(super) struct Recorded {
    /// Its scene.
    pub(super) was: Scene,
    /// The same with what is to change.
    pub(super) scene: Scene,
    /// Its checkpoints, and the states of its frames between them.
    pub(super) kept: Vec<Kept>,
    /// Its budgets before the first step; none where it left no checkpoint to go on from.
    pub(super) start: Option<Budget>,
    /// Whether its form is that of this program: else its states are looked at alone.
    pub(super) goes_on: bool,
}

/// Reads what a run left, to go on with changes.
///
/// # Errors
/// [`Error::Usage`] if the folder has neither checkpoints nor states, or some of another scene; [`Error::Io`]; [`Error::Scene`].
pub(super) fn of_run(run: &Path, changes: &Changes) -> Result<Recorded> {
    let outside = changes.outside;
    forms::known(run, outside)?;
    let (whole, light) = (checkpoint::list(run)?, states::list(run)?);
    let all = || whole.iter().map(|(_, path)| path).chain(light.iter().map(|(_, path)| path));
    let Some(last) = whole.last().map(|(_, path)| path).or(light.last().map(|(_, path)| path)) else {
        let hint = "`brisance run SCENE --export fields`, or `--checkpoint 10min --keep 20`, leaves some";
        return Err(Error::Usage(format!("{} is a folder without states to look at; {hint}", run.display())));
    };
    if !outside {
        all().try_for_each(|path| export::stays_inside(run, path))?;
    }
    let (head, texts) = container::read_texts(last)?;
    let text = texts.get(container::SCENE).map_or("", String::as_str);
    let text = Scene::text_of_form(head.version, text)
        .map_err(|error| Error::Scene(format!("{}: {}: {error}", last.display(), container::SCENE)))?;
    let recorded = |set: &[String]| Scene::recorded(&text, (run, &head.source.scene_file), set, outside);
    let (was, scene) = (recorded(&[])?, recorded(&changes.set)?);
    for path in all() {
        if container::read_texts(path)?.0.source.scene_hash != head.source.scene_hash {
            return Err(Error::spoilt(path, "a state of another scene than the last one"));
        }
    }
    let goes_on = head.version == container::VERSION;
    let (mut kept, mut start) = (Vec::new(), None);
    let (whole, earlier) = if goes_on { (whole, Vec::new()) } else { (Vec::new(), whole) };
    for (step, path) in whole {
        let (own, _, about) = checkpoint::read_texts(&path)?;
        let About { host, summary, start_budget } =
            toml::from_str(&about).map_err(|error| Error::spoilt(&path, error))?;
        start = Some(start_budget);
        let place = Place::File(path, Box::new(host));
        kept.push(Kept { time: own.time, step, summary, joined: 0, place });
    }
    let earlier = earlier.into_iter().map(|(_, path)| path);
    for path in light.into_iter().map(|(_, path)| path).chain(earlier) {
        let (own, _) = container::read_texts(&path)?;
        if kept.iter().all(|other: &Kept| other.step != own.step) {
            let (summary, place) = (Summary::default(), Place::Light(path));
            kept.push(Kept { time: own.time, step: own.step, summary, joined: 0, place });
        }
    }
    kept.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(Recorded { was, scene, kept, start, goes_on })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time: f64) -> Kept {
        Kept::of(Saved { time, step: time as u64, host: Host::default(), arrays: Vec::new() }, Summary::default(), 0)
    }

    #[test]
    fn long_runs_keep_their_start_and_few_states() {
        let mut past = Past::new(32.0, MOST_BYTES / 8, Vec::new());
        for time in 0..1000 {
            if past.is_due(f64::from(time)) {
                past.keep(at(f64::from(time)));
            }
        }
        let times = past.times();
        assert!(times.len() <= 8 && times.len() >= 4 && times[0] == 0.0, "{times:?}");
        assert!(times.windows(3).all(|three| three[2] - three[1] == three[1] - three[0]), "{times:?}");
        let second = times[1];
        assert_eq!(past.latest(second + 1.0).map(|one| one.time), Some(second));
        assert_eq!(past.latest(-1.0).map(|one| one.time), Some(0.0));
        past.forget_after(second);
        assert_eq!(past.times(), [0.0, second]);
    }
}
