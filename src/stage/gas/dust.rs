//! `dust`: where does the gas carry dust? Optional, before the gas moves.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::scene::Scene;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage, and of its sums.
#[derive(Debug)]
pub struct Dust {
    kernels: [Bound; 3],
    sum: Bound,
    record: Bound,
}

impl Dust {
    /// Binds, in scenes with dust.
    pub fn new(state: &State, scene: &Scene) -> Result<Option<Self>> {
        let Some(dust) = &scene.gas.dust else { return Ok(None) };
        let switches = [("DUST_THRESHOLD", dust.threshold), ("DUST_RATE", dust.rate / dust.amount)];
        let bind = |entry: &str| state.bind("gas/dust.wgsl", entry, &[], &switches);
        let kernels = [bind("dust_lift")?, bind("dust_carry")?, bind("dust_keep")?];
        Ok(Some(Self { kernels, sum: bind("dust_sum")?, record: bind("dust_record")? }))
    }

    /// Carries it over the step that begins.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Dust.name());
        for kernel in &self.kernels {
            pass.dispatch(kernel, &state.extent(Phase::Begin, Over::Slots));
        }
    }

    /// Adds its sums to the record of the step that has just ended.
    pub fn record_totals(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Totals.name());
        pass.dispatch(&self.sum, &state.extent(Phase::End, Over::Reduce));
        pass.dispatch(&self.record, &state.extent(Phase::End, Over::Single));
    }
}
