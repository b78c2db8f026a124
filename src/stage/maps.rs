//! Maps of the largest values so far: not part of the method, but of what engineers look at.

use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// Kernels of the maps.
#[derive(Debug)]
pub struct Maps {
    gas: Bound,
    particles: Option<Bound>,
}

impl Maps {
    /// Binds, where the scene asks for maps.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Option<Self>> {
        let Parts { gpu, state } = parts;
        if state.maps.is_empty() {
            return Ok(None);
        }
        let bind = |entry: &str| state.bind(gpu, "maps.wgsl", entry, &[], &[]);
        let particles = if state.has_solids() { Some(bind("map_particles")?) } else { None };
        Ok(Some(Self { gas: bind("map_gas")?, particles }))
    }

    /// Takes in the step that has just ended.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Totals.name());
        pass.dispatch(&self.gas, &extent(state, "END", Entry::Slots));
        if let Some(particles) = &self.particles {
            pass.dispatch(particles, &extent(state, "END", Entry::Particles));
        }
    }
}
