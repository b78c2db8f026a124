//! Who gets how much time: steps per submission, pictures per second, pixels of a picture while the user drags.
//!
//! Pure arithmetic; times are seconds on any clock.

use crate::simulation::BATCH;

/// A submission should last no longer than this \[s\]: commands are heard in between.
const SUBMISSION: f64 = 0.033;
/// Pictures follow each other no faster than this \[s\].
const PICTURE_PERIOD: f64 = 1.0 / 30.0;
/// Share of the time that pictures may take while the scene runs.
const PICTURE_SHARE: f64 = 0.08;
/// The same while the user turns the camera or changes the look.
const ATTENTIVE_SHARE: f64 = 0.6;
/// Pictures of a running scene follow each other at least this often, if steps allow it \[s\].
const LONGEST_PAUSE: f64 = 5.0;
/// A picture of a moving camera should last no longer than this \[s\].
const MOVING_PICTURE: f64 = 0.08;
/// A picture of a running scene should last no longer than this \[s\].
const RUNNING_PICTURE: f64 = 0.15;
/// Coarsest share of the pixels along an axis while the scene runs.
const COARSEST_RUNNING: f64 = 0.5;
/// The same while the camera moves.
const COARSEST_MOVING: f64 = 0.25;
/// Shares of the pixels along an axis are multiples of one over this.
const SHARES: f64 = 8.0;
/// Time that the rate of steps is averaged over \[s\].
const RATE_PERIOD: f64 = 1.0;
/// Weight of the newest measurement.
const NEWEST: f64 = 0.3;

/// Why a picture may have fewer pixels than asked for where a whole one takes long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Haste {
    /// Nothing moves: it may not.
    None,
    /// The scene runs.
    Running,
    /// The user turns the camera.
    Moving,
}

/// Measured costs, and what follows from them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Budget {
    step: Option<f64>,
    pixel: Option<f64>,
    picture: f64,
    picture_end: Option<f64>,
}

fn blend(old: Option<f64>, new: f64) -> Option<f64> {
    Some(old.map_or(new, |old| old + NEWEST * (new - old)))
}

impl Budget {
    /// Takes note of a submission of `steps` steps.
    pub fn stepped(&mut self, steps: usize, seconds: f64) {
        if steps > 0 {
            self.step = blend(self.step, seconds / steps as f64);
        }
    }

    /// Takes note of a picture of so many pixels that was done at `now`. The first one tells nothing: it compiles kernels on some drivers.
    pub fn drew(&mut self, pixels: u64, seconds: f64, now: f64) {
        if self.picture_end.is_some() {
            self.pixel = blend(self.pixel, seconds / pixels.max(1) as f64);
            self.picture = seconds;
        }
        self.picture_end = Some(now);
    }

    /// Time of one step, lately \[s\].
    pub fn step_seconds(&self) -> f64 {
        self.step.unwrap_or(0.0)
    }

    /// Time of the last picture \[s\].
    pub fn picture_seconds(&self) -> f64 {
        self.picture
    }

    /// Steps of the next submission. The first one is alone: it compiles kernels on some drivers.
    pub fn steps(&self) -> u32 {
        self.step.map_or(1, |step| ((SUBMISSION / step) as u32).clamp(1, BATCH))
    }

    /// When the next picture of a running scene is due; `attentive` if the user waits for it.
    pub fn picture_due(&self, attentive: bool) -> f64 {
        let share = if attentive { ATTENTIVE_SHARE } else { PICTURE_SHARE };
        let pause = (self.picture * (1.0 / share - 1.0)).clamp(PICTURE_PERIOD - self.picture, LONGEST_PAUSE);
        self.picture_end.map_or(f64::NEG_INFINITY, |end| end + pause)
    }

    /// Share of the pixels of a picture along each axis: all of them, or fewer in haste if a whole picture would take too long.
    pub fn share(&self, pixels: f64, haste: Haste) -> f64 {
        let expected = self.pixel.unwrap_or(0.0) * pixels;
        let (longest, coarsest) = match haste {
            Haste::None => return 1.0,
            Haste::Running => (RUNNING_PICTURE, COARSEST_RUNNING),
            Haste::Moving => (MOVING_PICTURE, COARSEST_MOVING),
        };
        if expected <= longest {
            return 1.0;
        }
        // In a few steps: what has the size of the picture is made anew for each.
        ((SHARES * (longest / expected).sqrt()).floor() / SHARES).max(coarsest)
    }
}

/// Steps per second, lately.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rate {
    since: f64,
    steps: u64,
    value: f64,
}

impl Rate {
    /// Starts to count.
    pub fn since(now: f64) -> Self {
        Self { since: now, ..Self::default() }
    }

    /// Takes note of steps.
    pub fn add(&mut self, steps: usize, now: f64) {
        self.steps += steps as u64;
        if now - self.since >= RATE_PERIOD {
            self.value = self.steps as f64 / (now - self.since);
            (self.since, self.steps) = (now, 0);
        }
    }

    /// Steps per second; 0 until there is something to tell.
    pub fn value(&self) -> f64 {
        self.value
    }
}

/// Steps that bring simulated time to where the pace allows it by now, at most `most`; 0 if it is ahead.
pub fn paced_steps(ahead: f64, dt: f64, most: u32) -> u32 {
    if ahead >= 0.0 {
        return 0;
    }
    if dt <= 0.0 {
        return 1;
    }
    ((-ahead / dt).ceil()).clamp(1.0, f64::from(most)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn submissions_fit_the_budget_and_a_long_step_is_alone() {
        let mut budget = Budget::default();
        assert_eq!(budget.steps(), 1);
        budget.stepped(4, 0.04);
        assert_eq!(budget.steps(), 3);
        let mut slow = Budget::default();
        slow.stepped(1, 2.0);
        assert_eq!(slow.steps(), 1);
        let mut quick = Budget::default();
        quick.stepped(16, 0.001);
        assert_eq!(quick.steps(), BATCH);
    }

    #[test]
    fn pictures_take_their_share_of_the_time_and_no_more() {
        for cost in [0.001, 0.02, 0.5, 2.0] {
            let mut budget = Budget::default();
            assert!(budget.picture_due(false) < 0.0, "the first picture is due at once");
            budget.drew(1000, 60.0, 0.0);
            let (mut now, mut drawing, mut waiting) = (0.0, 0.0, 0.0);
            for _ in 0..50 {
                now += cost;
                drawing += cost;
                budget.drew(1000, cost, now);
                let due = budget.picture_due(false);
                waiting += due - now;
                now = due;
            }
            let share = drawing / (drawing + waiting);
            assert!(share <= PICTURE_SHARE + 1e-9 || cost > 0.4, "{cost}: {share}");
            assert!(waiting <= 50.0 * LONGEST_PAUSE + 1e-9);
            assert!(50.0 / now <= 30.0 + 1e-6, "{cost}: {} pictures per second", 50.0 / now);
            assert!(budget.picture_due(true) <= budget.picture_due(false));
        }
    }

    #[test]
    fn haste_takes_pixels_only_where_pictures_are_slow() {
        let whole = 1200.0 * 800.0;
        let mut budget = Budget::default();
        budget.drew(960_000, 9.0, 0.0);
        budget.drew(960_000, 0.02, 0.0);
        assert_eq!(budget.share(whole, Haste::Moving), 1.0);
        let mut slow = Budget::default();
        slow.drew(960_000, 9.0, 0.0);
        slow.drew(960_000, 0.32, 0.0);
        assert_eq!(slow.share(whole, Haste::None), 1.0);
        assert_eq!(slow.share(whole, Haste::Moving), 0.5);
        assert_eq!(slow.share(whole, Haste::Running), 0.625);
        slow.drew(960_000, 1e3, 1.0);
        assert_eq!([slow.share(whole, Haste::Running), slow.share(whole, Haste::Moving)], [0.5, 0.25]);
    }

    #[test]
    fn the_pace_holds_steps_back() {
        assert_eq!(paced_steps(0.1, 0.01, 16), 0);
        assert_eq!(paced_steps(-0.025, 0.01, 16), 3);
        assert_eq!(paced_steps(-10.0, 0.01, 16), 16);
        assert_eq!(paced_steps(-1.0, 0.0, 16), 1);
    }
}
