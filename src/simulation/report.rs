//! What a simulation tells about itself beside its records.

use super::Simulation;
use crate::diagnostics::StepRecord;
use crate::error::Result;
use crate::snapshot;

impl Simulation {
    /// Momentum and energy that the energy floor has taken from gas cells without a ledger entry, since the start
    /// \[kg m s^-1\], \[J\].
    ///
    /// # Errors
    /// Driver errors.
    pub fn borrowed(&self) -> Result<[f64; 4]> {
        let params = &self.state.params;
        let volume = f64::from(params.spacing).powi(self.state.grid.dimension as i32);
        let [density, pressure] = [params.ambient_density, params.ambient_pressure].map(f64::from);
        let [x, y, z, energy] = self.control()?.borrowed();
        let momentum = volume * (density * pressure).sqrt();
        Ok([momentum * x, momentum * y, momentum * z, volume * pressure * energy])
    }

    /// Adds what gravity gave to the gas in a step: its kernel works on the gas that the advection has left, whose momentum is that of the
    /// step before but for what crossed the sides.
    pub(super) fn pull(&mut self, record: &StepRecord) {
        let before = std::mem::replace(&mut self.gas_before, record.gas.momentum.map(f64::from));
        let (dt, mass) = (f64::from(record.dt), f64::from(record.gas.mass));
        for (axis, g) in self.state.params.gravity.map(f64::from).into_iter().enumerate() {
            self.pulled[axis] += dt * mass * g;
            self.pulled[3] += dt * g * (before[axis] + 0.5 * dt * mass * g);
        }
    }

    /// Adds what the gas gave to bodies and obstacles in a step.
    pub(super) fn bear(&mut self, record: &StepRecord) {
        let dt = f64::from(record.dt);
        for (sum, load) in self.borne.iter_mut().zip(&record.loads) {
            let [x, y, z] = load.force;
            for (sum, rate) in sum.iter_mut().zip([x, y, z, load.power]) {
                *sum += dt * f64::from(rate);
            }
        }
    }

    /// Impulse \[kg m s^-1\] and work \[J\] of the gas since the start: on each body, if one of them is held or
    /// driven or has a gauge, and on each obstacle.
    #[must_use]
    pub fn borne(&self) -> (&[[f64; 4]], &[[f64; 4]]) {
        let [bodies, obstacles, _] = self.state.load_count;
        (&self.borne[..bodies], &self.borne[bodies..bodies + obstacles])
    }

    /// Energy of all blasts so far \[J\].
    #[must_use]
    pub fn blasts(&self) -> f64 {
        self.blasts
    }

    /// Momentum \[kg m s^-1\] and energy \[J\] that gravity has given to the gas since the start.
    #[must_use]
    pub fn pulled(&self) -> [f64; 4] {
        self.pulled
    }

    /// Momentum \[kg m s^-1\] and kinetic energy \[J\] that particles had when they left the domain, from their masses at the start \[kg\].
    ///
    /// # Errors
    /// Driver errors.
    pub fn gone(&self, mass: impl Fn(usize) -> f64) -> Result<[f64; 4]> {
        if self.control()?.escaped == 0 {
            return Ok([0.0; 4]);
        }
        let mut sum = [0.0; 4];
        for (index, [x, y, z, square]) in snapshot::gone(&self.gpu, &self.state)? {
            let mass = mass(index);
            for (total, part) in sum.iter_mut().zip([x, y, z, 0.5 * square]) {
                *total += mass * part;
            }
        }
        Ok(sum)
    }
}
