//! `supports`: what is held? Clamped and driven parts of bodies, friction at walls and obstacles.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage; scenes without clamped, driven or rubbing bodies have none.
#[derive(Debug)]
pub struct Supports {
    now: Bound,
    particles: Bound,
    nodes: Bound,
}

impl Supports {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let now = state.bind("solid/motions.wgsl", "motions_now", &[], &[])?;
        let bind = |entry: &str| state.bind("solid/supports.wgsl", entry, &[], &[]);
        Ok(Self { now, particles: bind("supports_particles")?, nodes: bind("supports_nodes")? })
    }

    /// Velocities of driven parts in the step that has just been chosen.
    pub fn record_motions(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Supports.name());
        pass.dispatch(&self.now, &state.extent(Phase::Begin, Over::Single));
        pass.dispatch(&self.particles, &state.extent(Phase::Begin, Over::Particles));
    }

    /// Nodes of driven parts, and the friction of nodes at walls, after particles have reached the grid in a phase.
    pub fn record_nodes(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.stage(Stage::Supports.name());
        pass.dispatch(&self.nodes, &state.extent(phase, Over::Slots));
    }
}
