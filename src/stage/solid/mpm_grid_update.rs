//! `mpm_grid_update`: how do the nodes move? Elastic force of one sub-step, walls. [Cao et al. 2022, step 6]

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct MpmGridUpdate {
    update: Bound,
}

impl MpmGridUpdate {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        Ok(Self { update: state.bind("solid/mpm_grid_update.wgsl", "mpm_grid_update", &[], &[])? })
    }

    /// One sub-step of the nodes.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::MpmGridUpdate.name());
        pass.dispatch(&self.update, &state.extent(Phase::Substep, Over::Reduce));
    }
}
