//! Maps of the largest values so far: not part of the method, but of what engineers look at.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the maps.
#[derive(Debug)]
pub struct Maps {
    gas: Bound,
    particles: Option<Bound>,
}

impl Maps {
    /// Binds, where the scene asks for maps.
    pub fn new(state: &State) -> Result<Option<Self>> {
        if state.maps.is_empty() {
            return Ok(None);
        }
        let bind = |entry: &str| state.bind("step/maps.wgsl", entry, &[], &[]);
        let particles = if state.has_solids() { Some(bind("map_particles")?) } else { None };
        Ok(Some(Self { gas: bind("map_gas")?, particles }))
    }

    /// Takes in the step that has just ended.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Totals.name());
        pass.dispatch(&self.gas, &state.extent(Phase::End, Over::Slots));
        if let Some(particles) = &self.particles {
            pass.dispatch(particles, &state.extent(Phase::End, Over::Particles));
        }
    }
}
