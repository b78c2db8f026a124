//! `odd_even`: a conservative filter of the mode that alternates from cell to cell; optional, after the step.

use super::Parts;
use super::time_step::slots;
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::stages::Stage;

/// Kernels of the filter.
#[derive(Debug)]
pub struct OddEven {
    kernels: [Bound; 2],
}

impl OddEven {
    /// Binds; `share` of the mode is removed per step.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, share: f64) -> Result<Self> {
        let bind = |entry: &str| parts.state.bind(parts.gpu, "odd_even.wgsl", entry, &[], &[("FILTER", share)]);
        Ok(Self { kernels: [bind("odd_even_find")?, bind("odd_even_remove")?] })
    }

    /// Removes its share of the mode, if a step has just ended that wants it.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::OddEven.name());
        for kernel in &self.kernels {
            pass.dispatch(kernel, &slots(state, "FILTER"));
        }
    }
}
