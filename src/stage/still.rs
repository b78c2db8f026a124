//! `still`: where does nothing move? Marching kernels before the solve leave out gas that stays at rest.

use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;

/// Kernels of the stage, in order.
#[derive(Debug)]
pub struct Still {
    kernels: [Bound; 2],
}

impl Still {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let busy = [("busy", parts.state.pcg.product.raw())]; // free until the advection, whose theta it becomes
        let bind = |entry: &str| parts.state.bind(parts.gpu, "still.wgsl", entry, &busy, &[]);
        Ok(Self { kernels: [bind("still_find")?, bind("still_spread")?] })
    }

    /// Marks the columns in which the advection has nothing to do.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage("still");
        for kernel in &self.kernels {
            pass.dispatch(kernel, &extent(state, "BEGIN", Entry::Reduce));
        }
    }
}
