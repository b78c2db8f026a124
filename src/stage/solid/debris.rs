//! `debris`: which debris is dropped?

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::scene::Scene;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// The kernel of the stage.
#[derive(Debug)]
pub struct Debris {
    drop: Bound,
}

impl Debris {
    /// Binds, if a material of the scene drops its debris.
    pub fn new(state: &State, scene: &Scene) -> Result<Option<Self>> {
        let dropped = state.has_solids() && scene.drops_debris();
        let bind = || state.bind("solid/debris.wgsl", "debris_drop", &[], &[]);
        dropped.then(|| Ok(Self { drop: bind()? })).transpose()
    }

    /// Takes debris out, if a step has just ended.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Debris.name());
        pass.dispatch(&self.drop, &state.extent(Phase::End, Over::Particles));
    }
}
