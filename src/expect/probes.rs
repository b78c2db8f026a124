//! What probes have seen: the largest pressure, when a front and when a body came by.

use serde::{Deserialize, Serialize};

use super::Checks;
use crate::diagnostics::{ProbeRecord, StepRecord};
use crate::scene::{Expect, Probe};
use crate::snapshot::kind;

/// Relative change of the pressure that counts as the arrival of a front: above the noise of gas at rest, below the weakest of the
/// shocks that scenes wait for.
pub(super) const FRONT: f64 = 0.05;

/// What one probe has seen in gas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// Pressure after the first step \[Pa\].
    pub first: f64,
    /// Largest pressure \[Pa\].
    pub peak: f64,
    /// Pressure after the last step \[Pa\].
    pub last: f64,
    /// When the pressure first differed from `first` by more than a twentieth \[s\].
    pub arrival: Option<f64>,
    /// When a body first covered it \[s\].
    pub covered: Option<f64>,
}

impl Seen {
    /// Adds what a step has left at the probe.
    fn add(&mut self, time: f64, probe: &ProbeRecord) {
        if probe.kind == kind::SOLID {
            self.covered.get_or_insert(time);
        }
        if probe.kind != kind::GAS {
            return;
        }
        let pressure = f64::from(probe.pressure);
        if self.peak == 0.0 {
            self.first = pressure;
        }
        self.peak = self.peak.max(pressure);
        self.last = pressure;
        if (pressure - self.first).abs() > FRONT * self.first {
            self.arrival.get_or_insert(time);
        }
    }
}

/// Adds a step to what every probe has seen.
pub(super) fn add(all: &mut Vec<Seen>, record: &StepRecord) {
    all.resize(record.probes.len(), Seen::default());
    for (seen, probe) in all.iter_mut().zip(&record.probes) {
        seen.add(record.time, probe);
    }
}

impl Checks {
    /// Every expectation about probes. What has not come by passes nothing.
    pub(super) fn probes(&mut self, expect: &Expect, probes: &[Probe], all: &[Seen]) {
        for expected in &expect.probes {
            let index = probes.iter().position(|probe| probe.name == expected.probe);
            let seen = index.and_then(|index| all.get(index).copied()).unwrap_or_default();
            let lead = seen.covered.zip(seen.arrival).map(|(covered, arrival)| covered - arrival);
            let values = [Some(seen.peak), Some(seen.last), seen.arrival, lead];
            for ((name, range), value) in expected.ranges().into_iter().zip(values) {
                if let Some(range) = range {
                    self.within(&format!("probes.{}.{name}", expected.probe), value.unwrap_or(f64::NAN), range);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ExpectedProbe;

    fn record(time: f64, pressure: f32, kind: u8) -> StepRecord {
        let probe = ProbeRecord { density: 1.0, velocity: [0.0; 3], pressure, kind };
        StepRecord { time, probes: vec![probe], ..StepRecord::default() }
    }

    /// A front at 0.3 s, a peak of 4, a body from 0.5 s on, gas of 2 after it.
    fn seen() -> Vec<Seen> {
        let mut all = Vec::new();
        let steps = [
            record(0.1, 1.0, kind::GAS),
            record(0.2, 1.04, kind::GAS),
            record(0.3, 3.0, kind::GAS),
            record(0.4, 4.0, kind::GAS),
            record(0.5, 9.0, kind::SOLID),
            record(0.6, 9.0, kind::SOLID),
            record(0.7, 2.0, kind::GAS),
        ];
        for step in &steps {
            add(&mut all, step);
        }
        all
    }

    fn judged(all: &[Seen], arrival: [f64; 2]) -> Vec<(f64, bool)> {
        let probe = Probe { name: "p".to_owned(), position: [0.0; 3] };
        let expected = ExpectedProbe {
            probe: "p".to_owned(),
            pressure: Some([3.9, 4.1]),
            pressure_at_end: Some([1.9, 2.1]),
            arrival: Some(arrival),
            lead: Some([0.19, 0.21]),
        };
        let expect = Expect { probes: vec![expected], ..Expect::default() };
        let mut checks = Checks(Vec::new());
        checks.probes(&expect, &[probe], all);
        checks.0.iter().map(|check| (check.measured, check.passed)).collect()
    }

    #[test]
    fn probes_are_judged_by_what_came_by() {
        let checks = judged(&seen(), [0.29, 0.31]);
        assert!(checks.len() == 4 && checks.iter().all(|(_, passed)| *passed), "{checks:?}");
        assert!(!judged(&seen(), [0.31, 0.5])[2].1);
        // nothing came by: only the pressures are numbers
        let mut still = Vec::new();
        add(&mut still, &record(0.1, 4.0, kind::GAS));
        let checks = judged(&still, [0.0, 1.0]);
        assert!(checks[0].1 && checks[2].0.is_nan() && !checks[2].1 && !checks[3].1, "{checks:?}");
    }
}
