//! What a simulation tells about itself beside its records.

use super::Simulation;
use crate::error::Result;

impl Simulation {
    /// Momentum and energy that the energy floor has taken from gas cells without books of their own, since the start
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

    /// Share of the slots that the last step computed: the others slept.
    ///
    /// # Errors
    /// Driver errors.
    pub fn awake_share(&self) -> Result<f64> {
        let all = self.state.interface.runs;
        let runs = if self.state.sleeps() { self.control()?.runs as usize } else { all };
        Ok(runs as f64 / all as f64)
    }
}
