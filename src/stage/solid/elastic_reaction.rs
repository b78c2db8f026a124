//! `elastic_reaction`: which part of the elastic force bears the load of a node? The pressure solve starts from the velocity that this
//! reaction gives, so a body under load rests in it; what else the solve gives is spread over the elastic sub-steps.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::scene::{Coupling, Ghost, Scene};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct ElasticReaction {
    start: Bound,
    fill: Bound,
    before: Bound,
    /// The power of the pressures goes without the reaction; not with a shared volume.
    aside: Option<Bound>,
    after: Bound,
    left: Bound,
}

impl ElasticReaction {
    /// Binds, if the scene has bodies and the solve comes first.
    pub fn new(state: &State, scene: &Scene) -> Result<Option<Self>> {
        if !state.has_solids() || scene.numerics.paper.coupling == Coupling::Last {
            return Ok(None);
        }
        let bind = |entry: &str| state.bind("solid/elastic_reaction.wgsl", entry, &[], &[]);
        let aside = (scene.numerics.paper.ghost == Ghost::Absorbs).then(|| bind("reaction_aside"));
        Ok(Some(Self {
            start: bind("reaction_start")?,
            fill: bind("reaction_fill")?,
            before: bind("reaction_before")?,
            aside: aside.transpose()?,
            after: bind("reaction_after")?,
            left: bind("reaction_left")?,
        }))
    }

    /// Keeps the velocity of the nodes and the elastic force that `p2g` has left; nodes with next to no mass move with those around them.
    pub fn record_start(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.start, &state.extent(Phase::Begin, Over::Slots));
        pass.dispatch(&self.fill, &state.extent(Phase::Begin, Over::Slots));
    }

    /// The velocities that enter the solve, from its load without them, in a phase.
    pub fn record_before(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.stage(Stage::ElasticReaction.name());
        pass.dispatch(&self.before, &state.extent(phase, Over::Slots));
    }

    /// Sets the reaction aside for the power of the solved pressures.
    pub fn record_aside(&self, pass: &mut Pass, state: &State) {
        if let Some(aside) = &self.aside {
            pass.dispatch(aside, &state.extent(Phase::Update, Over::Slots));
        }
    }

    /// The acceleration to spread, and the velocity of the particles again.
    pub fn record_after(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.after, &state.extent(Phase::Update, Over::Slots));
    }

    /// What nodes that have grown lighter pass on in a sub-step, before `mpm_grid_update`.
    pub fn record_substep(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::MpmGridUpdate.name());
        pass.dispatch(&self.left, &state.extent(Phase::Again, Over::Slots));
    }
}
