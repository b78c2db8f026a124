//! `fluid_update`: what does the solved pressure do to the gas? Local gradients, flux form. [Kwatra et al. 2009; eqs. 3, 14]

use super::{Carried, CarrierVelocity, Parts, TimeStep, extent, record_both, record_busy};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;

/// Kernels of the stage.
#[derive(Debug)]
pub struct FluidUpdate {
    momentum: [Bound; 2],
    parting: [Bound; 2],
    energy: [Bound; 2],
    floor: [Bound; 2],
}

impl FluidUpdate {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        Ok(Self {
            momentum: parts.both("fluid_update.wgsl", "fluid_momentum", &[], &[])?,
            parting: parts.both("parting.wgsl", "parting_surplus", &[], &[])?,
            energy: parts.both("fluid_update.wgsl", "fluid_energy", &[], &[])?,
            floor: parts.both("fluid_floor.wgsl", "fluid_floor", &[], &[])?,
        })
    }

    /// Momentum; who pays where velocities part; energy; floor.
    pub fn record(&self, pass: &mut Pass, state: &State, carrier: &CarrierVelocity, control: &TimeStep) {
        pass.stage("fluid_update");
        record_busy(pass, state, "UPDATE", &self.momentum);
        carrier.record(pass, state, Carried::Solved, "UPDATE");
        record_both(pass, state, "UPDATE", &self.parting);
        record_both(pass, state, "UPDATE", &self.energy);
        control.record_cold(pass);
        let [plain, listed] = &self.floor;
        pass.dispatch(plain, &extent(state, "FLOOR", Entry::Awake));
        pass.dispatch(listed, &extent(state, "UPDATE", Entry::Listed));
    }
}
