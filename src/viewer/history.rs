//! The steps so far as curves for plots, thinned out so that long runs stay cheap to draw.

use crate::diagnostics::StepRecord;

/// Points that are kept at most; then every second one goes.
const MOST: usize = 2048;

/// What is kept of a step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Point {
    /// Time at its end \[s\].
    pub(super) time: f64,
    /// Its length \[s\].
    pub(super) dt: f64,
    /// Iterations of its solves.
    pub(super) iterations: f64,
    /// Elastic sub-steps.
    pub(super) substeps: f64,
    /// Energy of gas, of moving solids, stored in solids \[J\].
    pub(super) energy: [f64; 3],
    /// Mass of the gas with what is owed \[kg\].
    pub(super) mass: f64,
    /// Largest pressure \[Pa\].
    pub(super) pressure: f64,
    /// Largest speed of gas and of solids \[m s^-1\].
    pub(super) speed: [f64; 2],
    /// Pressure at each probe \[Pa\].
    pub(super) probes: Vec<f64>,
}

impl Point {
    fn of(record: &StepRecord) -> Self {
        let stored = record.elastic_energy + record.ghost_energy + record.plastic_heat + record.fracture_energy;
        Self {
            time: record.time,
            dt: record.dt.into(),
            iterations: record.iterations.into(),
            substeps: record.substeps.into(),
            energy: [record.gas.energy + record.owed.energy, record.solid.energy, stored].map(f64::from),
            mass: f64::from(record.gas.mass) + f64::from(record.owed.mass),
            pressure: record.pressure[1].into(),
            speed: [record.gas_speed.into(), record.solid_speed.into()],
            probes: record.probes.iter().map(|probe| probe.pressure.into()).collect(),
        }
    }
}

/// The points so far.
#[derive(Clone, Debug)]
pub(super) struct History {
    points: Vec<Point>,
    stride: usize,
    count: usize,
}

impl Default for History {
    fn default() -> Self {
        Self { points: Vec::new(), stride: 1, count: 0 }
    }
}

impl History {
    /// Adds steps.
    pub(super) fn add(&mut self, records: &[StepRecord]) {
        for record in records {
            if self.count.is_multiple_of(self.stride) {
                self.points.push(Point::of(record));
            }
            self.count += 1;
            if self.points.len() >= MOST {
                let mut index = 0;
                self.points.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.stride *= 2;
            }
        }
    }

    /// Forgets what came after a time \[s\].
    pub(super) fn forget_after(&mut self, time: f64) {
        self.points.retain(|point| point.time <= time);
        self.count = self.points.len() * self.stride;
    }

    /// Forgets what a probe has seen.
    pub(super) fn forget_probe(&mut self, index: usize) {
        for point in self.points.iter_mut().filter(|point| index < point.probes.len()) {
            point.probes.remove(index);
        }
    }

    /// One curve over time.
    pub(super) fn curve(&self, value: impl Fn(&Point) -> f64) -> Vec<[f64; 2]> {
        self.points.iter().map(|point| [point.time, value(point)]).filter(|pair| pair[1].is_finite()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_runs_keep_their_ends_and_few_points() {
        let mut history = History::default();
        for step in 0..100_000_u32 {
            history.add(&[StepRecord { step, time: f64::from(step), dt: 1.0, ..StepRecord::default() }]);
        }
        let curve = history.curve(|point| point.dt);
        assert!(curve.len() < MOST && curve.len() > MOST / 4, "{}", curve.len());
        assert_eq!(curve[0][0], 0.0);
        let gaps: Vec<f64> = curve.windows(2).map(|pair| pair[1][0] - pair[0][0]).collect();
        assert!(gaps.iter().all(|gap| *gap == gaps[0]), "evenly spaced");
        assert!(curve.last().unwrap()[0] > 99_000.0);
        history.forget_after(50_000.0);
        assert!(history.curve(|point| point.dt).last().unwrap()[0] <= 50_000.0);
    }
}
