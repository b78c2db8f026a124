//! `supports`: what is held? Clamped and driven parts of bodies, friction at walls and obstacles.

use super::time_step::slots;
use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// Kernels of the stage; scenes without clamped, driven or rubbing bodies have none.
#[derive(Debug)]
pub struct Supports {
    now: Bound,
    particles: Bound,
    nodes: Bound,
}

impl Supports {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let now = state.bind(gpu, "motions.wgsl", "motions_now", &[], &[])?;
        let bind = |entry: &str| state.bind(gpu, "supports.wgsl", entry, &[], &[]);
        Ok(Self { now, particles: bind("supports_particles")?, nodes: bind("supports_nodes")? })
    }

    /// Velocities of driven parts in the step that has just been chosen.
    pub fn record_motions(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Supports.name());
        pass.dispatch(&self.now, &extent(state, "BEGIN", Entry::Single));
        pass.dispatch(&self.particles, &extent(state, "BEGIN", Entry::Particles));
    }

    /// Nodes of driven parts, and the friction of nodes at walls, after particles have reached the grid in a phase.
    pub fn record_nodes(&self, pass: &mut Pass, state: &State, phase: &str) {
        pass.stage(Stage::Supports.name());
        pass.dispatch(&self.nodes, &slots(state, phase));
    }
}
