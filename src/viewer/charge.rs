//! A blast that grows while the button is held.

use std::time::{Duration, Instant};

/// Held no longer than this, a blast is that of the panel.
const WAITS: Duration = Duration::from_millis(300);
/// Then it doubles in this time \[s\].
const DOUBLES: f64 = 0.5;
/// As often at most.
const MOST_DOUBLES: f64 = 6.0;

/// How many times what stands in the panel goes off after the button was held so long.
pub fn growth(held: Duration) -> f64 {
    (held.saturating_sub(WAITS).as_secs_f64() / DOUBLES).min(MOST_DOUBLES).exp2()
}

/// A button that is held.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Charge(Option<Instant>);

impl Charge {
    /// The button goes down.
    pub(super) fn begin(&mut self) {
        self.0 = Some(Instant::now());
    }

    /// Growth so far, of a button that is held.
    pub(super) fn now(self) -> Option<f64> {
        self.0.map(|since| growth(since.elapsed()))
    }

    /// The button goes up; growth of what goes off, if it was held.
    pub(super) fn end(&mut self) -> Option<f64> {
        let grown = self.now();
        self.0 = None;
        grown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blast_that_is_held_doubles_and_stops_growing() {
        let after = |seconds: f64| growth(Duration::from_secs_f64(seconds));
        assert_eq!((after(0.0), after(0.3)), (1.0, 1.0), "a click is what stands in the panel");
        assert!((after(0.8) - 2.0).abs() < 1e-9 && (after(1.3) - 4.0).abs() < 1e-9);
        assert_eq!(after(60.0), 64.0);
    }
}
