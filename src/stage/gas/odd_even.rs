//! `odd_even`: a conservative filter of the mode that alternates from cell to cell; optional, after the step.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the filter.
#[derive(Debug)]
pub struct OddEven {
    kernels: [Bound; 2],
}

impl OddEven {
    /// Binds; `share` of the mode is removed per step.
    pub fn new(state: &State, share: f64) -> Result<Self> {
        let bind = |entry: &str| state.bind("gas/odd_even.wgsl", entry, &[], &[("FILTER", share)]);
        Ok(Self { kernels: [bind("odd_even_find")?, bind("odd_even_remove")?] })
    }

    /// Removes its share of the mode, if a step has just ended that wants it.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::OddEven.name());
        for kernel in &self.kernels {
            pass.dispatch(kernel, &state.extent(Phase::Filter, Over::Slots));
        }
    }
}
