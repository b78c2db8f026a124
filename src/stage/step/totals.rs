//! Totals after a step: not part of the method, but of every record of it.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the totals.
#[derive(Debug)]
pub struct Totals {
    gas: Bound,
    particles: Option<Bound>,
    record: Bound,
    probes: Option<Bound>,
}

impl Totals {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let bind = |entry: &str| state.bind("step/diagnostics.wgsl", entry, &[], &[]);
        Ok(Self {
            gas: bind("totals_gas")?,
            particles: if state.has_solids() { Some(bind("totals_particles")?) } else { None },
            record: bind("totals_record")?,
            probes: if state.params.probes > 0 { Some(bind("totals_probes")?) } else { None },
        })
    }

    /// One record of the history ring, if a step has just ended.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Totals.name());
        pass.dispatch(&self.gas, &state.extent(Phase::End, Over::Reduce));
        if let Some(particles) = &self.particles {
            pass.dispatch(particles, &state.extent(Phase::End, Over::Reduce));
        }
        pass.dispatch(&self.record, &state.extent(Phase::End, Over::Single));
        if let Some(probes) = &self.probes {
            pass.dispatch(probes, &state.extent(Phase::End, Over::Single));
        }
    }
}
