//! Totals after a step: not part of the method, but of every record of it.

use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

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
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let bind = |entry: &str| state.bind(gpu, "diagnostics.wgsl", entry, &[], &[]);
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
        pass.dispatch(&self.gas, &extent(state, "END", Entry::Reduce));
        if let Some(particles) = &self.particles {
            pass.dispatch(particles, &extent(state, "END", Entry::Reduce));
        }
        pass.dispatch(&self.record, &extent(state, "END", Entry::Single));
        if let Some(probes) = &self.probes {
            pass.dispatch(probes, &extent(state, "END", Entry::Single));
        }
    }
}
