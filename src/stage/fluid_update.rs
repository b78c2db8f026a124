//! `fluid_update`: what does the solved pressure do to the gas? Local gradients, flux form. [Kwatra et al. 2009; eqs. 3, 14]

use super::Parts;
use super::time_step::slots;
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;

/// Kernels of the stage.
#[derive(Debug)]
pub struct FluidUpdate {
    kernels: [Bound; 3],
}

impl FluidUpdate {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let bind = |shader: &str, entry: &str| state.bind(gpu, shader, entry, &[], &[]);
        Ok(Self {
            kernels: [
                bind("fluid_update.wgsl", "fluid_momentum")?,
                bind("fluid_update.wgsl", "fluid_energy")?,
                bind("fluid_floor.wgsl", "fluid_floor")?,
            ],
        })
    }

    /// Momentum, energy, floor.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage("fluid_update");
        for kernel in &self.kernels {
            pass.dispatch(kernel, &slots(state, "UPDATE"));
        }
    }
}
