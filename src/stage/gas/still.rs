//! `still`: where does nothing move? Kernels before the solve leave out gas that motion does not reach by then.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct Still {
    mark: Vec<Bound>,
}

impl Still {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let bind = |entry: &&str| state.bind("gas/still.wgsl", entry, &[], &[]);
        let entries = ["still_find", "still_along", "still_spread"];
        let count = if state.grid.dimension == 3 { 3 } else { 2 };
        Ok(Self { mark: entries[..count].iter().map(bind).collect::<Result<_>>()? })
    }

    /// Marks the rows in which there is something to do.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Still.name());
        for kernel in &self.mark {
            pass.dispatch(kernel, &state.extent(Phase::Begin, Over::Reduce));
        }
    }
}
