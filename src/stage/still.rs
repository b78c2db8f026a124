//! `still`: where does nothing move? Kernels before the solve leave out gas that motion does not reach by then; and all leave out gas that
//! sleeps through the whole step.

use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// Kernels of the stage.
#[derive(Debug)]
pub struct Still {
    mark: [Bound; 3],
    wake: Bound,
    /// The lists of what is awake, where something may sleep.
    list: Vec<(Bound, Entry)>,
}

impl Still {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let bind = |entry: &str| parts.state.bind(parts.gpu, "still.wgsl", entry, &[], &[]);
        Ok(Self {
            mark: [bind("still_find")?, bind("still_along")?, bind("still_spread")?],
            wake: bind("still_wake")?,
            list: if parts.state.sleeps() {
                vec![
                    (bind("still_count")?, Entry::Reduce),
                    (bind("still_places")?, Entry::Single),
                    (bind("still_list")?, Entry::Reduce),
                ]
            } else {
                Vec::new()
            },
        })
    }

    /// Marks the rows in which there is something to do, and lists the slots that are awake.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Still.name());
        for kernel in &self.mark {
            pass.dispatch(kernel, &extent(state, "BEGIN", Entry::Reduce));
        }
        self.record_list(pass, state, "BEGIN");
    }

    /// Wakes all, in the phase that opens for it.
    pub fn record_wake(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.wake, &extent(state, "WAKE", Entry::Reduce));
        self.record_list(pass, state, "WAKE");
    }

    fn record_list(&self, pass: &mut Pass, state: &State, phase: &str) {
        for (kernel, entry) in &self.list {
            pass.dispatch(kernel, &extent(state, phase, *entry));
        }
    }
}
