//! `elastic_first`: the elastic step before the pressure solve, an ablation: `numerics.paper.coupling = "last"`.
//! [Cao et al. 2022, section 2.8 and fig. 14]

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::scene::{Coupling, Scene};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct ElasticFirst {
    start: Bound,
    before: Bound,
    walls: Bound,
}

impl ElasticFirst {
    /// Binds, if the scene wants it.
    pub fn new(state: &State, scene: &Scene) -> Result<Option<Self>> {
        if !state.has_solids() || scene.numerics.paper.coupling != Coupling::Last {
            return Ok(None);
        }
        let bind = |entry: &str| state.bind("solid/elastic_first.wgsl", entry, &[], &[]);
        Ok(Some(Self { start: bind("elastic_start")?, before: bind("elastic_before")?, walls: bind("elastic_walls")? }))
    }

    /// Keeps the elastic force that `p2g` has left.
    pub fn record_start(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.start, &state.extent(Phase::Begin, Over::Slots));
    }

    /// Gives it to the velocities that enter the solve, in a phase.
    pub fn record_before(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.stage(Stage::SolidPredictor.name());
        pass.dispatch(&self.before, &state.extent(phase, Over::Slots));
    }

    /// The only sub-step, instead of `mpm_grid_update`.
    pub fn record_substep(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::MpmGridUpdate.name());
        pass.dispatch(&self.walls, &state.extent(Phase::Substep, Over::Slots));
    }
}
