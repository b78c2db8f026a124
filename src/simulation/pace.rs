//! How much work a submission gets: systems end one that runs for seconds (Windows after two), and the picture stutters long before.

/// Longest submission [ms], as far as a stage allows.
const LONGEST: f64 = 100.0;

/// What a step takes on the device.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    /// Milliseconds of a step, once one has been measured.
    step: Option<f64>,
    /// Steps of the last submission.
    last: u32,
}

impl Pace {
    /// Steps of the next submission, of those asked for.
    pub(super) fn steps(self, asked: u32) -> u32 {
        let most = self.step.map_or(1.0, |step| (LONGEST / step).min(f64::from(2 * self.last)));
        (most as u32).clamp(1, asked)
    }

    /// Whether a step has to be cut between its stages.
    pub(super) fn cut(self) -> bool {
        self.step.is_none_or(|step| step > LONGEST)
    }

    /// Takes the time `[ms]` of a submission that was to make `recorded` steps and has made `finished`.
    pub(super) fn note(&mut self, (recorded, finished): (u32, usize), time: f64) {
        self.last = recorded;
        self.step = Some(time / finished.clamp(1, recorded.max(1) as usize) as f64);
    }
}

#[cfg(test)]
mod tests {
    use super::Pace;

    #[test]
    fn a_submission_takes_a_tenth_of_a_second_at_most() {
        let mut pace = Pace::default();
        assert!(pace.cut() && pace.steps(16) == 1, "nothing is known before the first step");
        pace.note((1, 1), 4.0);
        assert!(!pace.cut());
        assert_eq!(pace.steps(16), 2, "it grows by two");
        pace.note((16, 16), 16.0 * 30.0);
        assert_eq!(pace.steps(16), 3);
        pace.note((3, 3), 3.0 * 250.0);
        assert!(pace.cut() && pace.steps(16) == 1, "a long step is cut");
        pace.note((1, 0), 80.0);
        assert_eq!(pace.steps(16), 1, "a step that goes on counts as one");
    }
}
