//! `elastic_first`: the elastic step before the pressure solve, an ablation: `numerics.coupling = "last"`.
//! [Cao et al. 2022, section 2.8 and fig. 14]

use super::Parts;
use super::time_step::slots;
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::scene::{Coupling, Scene};
use crate::state::State;
use crate::state::stages::Stage;

/// Kernels of the stage.
#[derive(Debug)]
pub struct ElasticFirst {
    start: Bound,
    before: Bound,
    walls: Bound,
}

impl ElasticFirst {
    /// Binds, if the scene wants it.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, scene: &Scene) -> Result<Option<Self>> {
        let Parts { gpu, state } = parts;
        if !state.has_solids() || scene.numerics.coupling != Coupling::Last {
            return Ok(None);
        }
        let bind = |entry: &str| state.bind(gpu, "elastic_first.wgsl", entry, &[], &[]);
        Ok(Some(Self { start: bind("elastic_start")?, before: bind("elastic_before")?, walls: bind("elastic_walls")? }))
    }

    /// Keeps the elastic force that `p2g` has left.
    pub fn record_start(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.start, &slots(state, "BEGIN"));
    }

    /// Gives it to the velocities that enter the solve, in a phase.
    pub fn record_before(&self, pass: &mut Pass, state: &State, phase: &str) {
        pass.stage(Stage::SolidPredictor.name());
        pass.dispatch(&self.before, &slots(state, phase));
    }

    /// The only sub-step, instead of `mpm_grid_update`.
    pub fn record_substep(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::MpmGridUpdate.name());
        pass.dispatch(&self.walls, &slots(state, "SUBSTEP"));
    }
}
