//! A run whose steps have become so short that it does not end: when that is so, which cell asked for it, and why.

use super::Simulation;
use crate::diagnostics::StepRecord;
use crate::error::{Error, Result};
use crate::math::plain;
use crate::snapshot::{Snapshot, kind};

/// Least part of the run that a step advances.
const LEAST_SHARE: f64 = 1e-9;
/// Shorter steps in a row that end the run.
const MOST_SHORT: u32 = 100;
/// Steps between two frames.
const MOST_STEPS: u64 = 1_000_000;

/// How long the steps were.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeastStep {
    /// End of the run \[s\].
    until: f64,
    short: u32,
    taken: u64,
}

/// A run that does not end: what tells it, and the step \[s\].
pub(super) struct Endless(String, f64);

/// What a bound allows, where it is the least, and what it comes from.
struct Bound {
    step: f64,
    place: String,
    cause: String,
}

impl LeastStep {
    pub(super) fn new(until: f64) -> Self {
        Self { until, short: 0, taken: 0 }
    }

    /// A new frame begins.
    pub(super) fn start_frame(&mut self) {
        self.taken = 0;
    }

    /// Takes a step from a time; tells what is wrong if the run will not end.
    pub(super) fn take(&mut self, time: f64, step: f64) -> Option<String> {
        self.taken += 1;
        let short = step < LEAST_SHARE * self.until;
        self.short = if short { self.short + 1 } else { 0 };
        let text = format!("a step of {} s", plain(step));
        if time + step <= time || !step.is_finite() {
            return Some(format!("{text} does not change the time of {} s", plain(time)));
        }
        if self.short >= MOST_SHORT {
            return Some(format!("{text}, as {MOST_SHORT} in a row, is below {LEAST_SHARE:e} of time.until"));
        }
        (self.taken > MOST_STEPS).then(|| format!("{text}, and more than {MOST_STEPS} up to the next frame"))
    }
}

impl Simulation {
    /// Adds up the steps of a submission.
    pub(super) fn pass_time(&mut self, newest: &[StepRecord]) -> Option<Endless> {
        let mut endless = None;
        for step in newest.iter().map(|record| f64::from(record.dt)) {
            let found = self.least_step.take(self.time, step).map(|what| Endless(what, step));
            endless = endless.or(found);
            self.time += step;
        }
        endless
    }

    /// The error of a run that does not end: the cell or particle that allows the shortest step, and why.
    pub(super) fn too_short(&self, Endless(what, step): &Endless) -> Result<Error> {
        let bounds = self.bounds(&self.snapshot()?);
        let least = bounds.into_iter().min_by(|a, b| a.step.total_cmp(&b.step));
        // what is known of the end of the step explains its length but for growth, bodies' waves and what enters at sides
        let (place, cause) = match least {
            _ if self.state.params.fixed_step > 0.0 => {
                ("all cells".to_owned(), "time.fixed_step asks for it".to_owned())
            }
            Some(bound) if bound.step <= 4.0 * *step || !self.state.has_solids() => (bound.place, bound.cause),
            _ => ("bodies".to_owned(), "their waves or strain rates ask for it".to_owned()),
        };
        let reason =
            format!("{what}; {cause}; look at the state there, or ask for a smaller time.until or more frames");
        Ok(Error::Diverged { step: self.step, stage: "time_step", place, reason })
    }

    /// What gas and particles allow.
    fn bounds(&self, now: &Snapshot) -> Vec<Bound> {
        let params = &self.state.params;
        let edge = f64::from(params.spacing);
        let gas: Vec<usize> = (0..now.kind.len()).filter(|cell| now.kind[*cell] == kind::GAS).collect();
        let most = |value: &dyn Fn(usize) -> f64| {
            gas.iter().map(|cell| (value(*cell), *cell)).max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let place = |cell: usize| format!("cell {:?}", position(now, cell));
        let sound = |cell: usize| now.sound_speed_at(cell);
        let state = |cell: usize| {
            let [density, pressure] = [now.density[cell], now.pressure[cell]].map(|value| plain(f64::from(value)));
            let speed = now.velocity[cell].map(f64::from).iter().map(|v| v * v).sum::<f64>().sqrt();
            format!("density {density}, pressure {pressure}, speed {}", plain(speed))
        };
        let rate = |cell: usize| rate(now, edge, cell);
        let by_rate = most(&rate).map(|(rate, cell)| Bound {
            step: f64::from(params.cfl) / rate,
            place: place(cell),
            cause: format!("speed and pressure differences there ask for it (time.cfl): {}", state(cell)),
        });
        let by_sound = most(&sound).map(|(sound, cell)| Bound {
            step: f64::from(params.max_courant) * edge / sound,
            place: place(cell),
            cause: format!("sound there asks for it (time.max_courant): {}", state(cell)),
        });
        let speed = |v: [f32; 3]| v.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt();
        let fastest = now.particles.iter().max_by(|a, b| speed(a.velocity).total_cmp(&speed(b.velocity)));
        let by_particle = fastest.map(|particle| Bound {
            step: f64::from(params.cfl) * edge / speed(particle.velocity),
            place: format!("particle {}", particle.index),
            cause: format!("its speed {} asks for it (time.cfl)", plain(speed(particle.velocity))),
        });
        [by_rate, by_sound, by_particle].into_iter().flatten().collect()
    }
}

/// Cell per axis.
fn position(now: &Snapshot, cell: usize) -> [usize; 3] {
    let [nx, ny, _] = now.grid.cells.map(|n| n as usize);
    [cell % nx, cell / nx % ny, cell / (nx * ny)]
}

/// Rate of a gas cell, as `shaders/step/time_step.wgsl` has it away from sides.
fn rate(now: &Snapshot, edge: f64, cell: usize) -> f64 {
    let at = position(now, cell);
    let steps = [1, now.grid.cells[0] as usize, (now.grid.cells[0] * now.grid.cells[1]) as usize];
    let along = |axis: usize| {
        let below = (at[axis] > 0).then(|| cell - steps[axis]);
        let above = (at[axis] + 1 < now.grid.cells[axis] as usize).then(|| cell + steps[axis]);
        let push = |other: usize| {
            let difference = f64::from((now.pressure[other] - now.pressure[cell]).abs());
            difference / (edge * edge * f64::from(now.density[cell].min(now.density[other])))
        };
        let beside = [below, above].into_iter().flatten().filter(|other| now.kind[*other] == kind::GAS);
        let push = beside.map(push).fold(0.0, f64::max);
        let speed = f64::from(now.velocity[cell][axis].abs()) / edge;
        0.5 * (speed + (speed * speed + 4.0 * push).sqrt())
    };
    (0..now.grid.dimension as usize).map(along).sum()
}

#[cfg(test)]
mod tests {
    use super::LeastStep;

    #[test]
    fn a_step_that_does_not_change_the_time_ends_the_run() {
        let mut least = LeastStep::new(1.0);
        assert_eq!(least.take(0.0, 1e-12), None);
        assert!(least.take(0.5, 1e-18).is_some_and(|text| text.contains("does not change the time")));
        assert!(least.take(0.5, f64::NAN).is_some());
    }

    #[test]
    fn a_hundred_short_steps_in_a_row_end_the_run() {
        let mut least = LeastStep::new(2.0);
        for _ in 0..99 {
            assert_eq!(least.take(0.0, 1.9e-9), None);
        }
        assert_eq!(least.take(0.0, 2.1e-9), None, "one longer step begins anew");
        for _ in 0..99 {
            assert_eq!(least.take(0.0, 1.9e-9), None);
        }
        assert!(least.take(0.0, 1.9e-9).is_some_and(|text| text.contains("below 1e-9 of time.until")));
    }

    #[test]
    fn a_frame_takes_a_million_steps_at_most() {
        let mut least = LeastStep::new(1.0);
        for _ in 0..1_000_000 {
            assert_eq!(least.take(0.0, 1e-8), None);
        }
        least.start_frame();
        for _ in 0..1_000_000 {
            assert_eq!(least.take(0.0, 1e-8), None);
        }
        assert!(least.take(0.0, 1e-8).is_some_and(|text| text.contains("up to the next frame")));
    }
}
