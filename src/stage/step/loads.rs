//! Loads of the gas on bodies, obstacles and walls: not part of the method, but of every record of it.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the loads but for that of the faces, which belongs between those of `fluid_update`.
#[derive(Debug)]
pub struct Loads {
    owners: Option<Bound>,
    record: Bound,
}

impl Loads {
    /// Binds, where something is held, driven or fixed.
    pub fn new(state: &State) -> Result<Option<Self>> {
        if state.load_count == [0; 3] {
            return Ok(None);
        }
        let bind = |entry: &str| state.bind("step/loads.wgsl", entry, &[], &[]);
        let owners = if state.load_count[0] > 0 { Some(bind("load_owners")?) } else { None };
        Ok(Some(Self { owners, record: bind("load_record")? }))
    }

    /// Which body has each covered slot.
    pub fn record_owners(&self, pass: &mut Pass, state: &State) {
        if let Some(owners) = &self.owners {
            pass.dispatch(owners, &state.extent(Phase::Begin, Over::Slots));
        }
    }

    /// The loads of the step that has just ended, into their history ring.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Totals.name());
        pass.dispatch(&self.record, &state.extent(Phase::End, Over::Single));
    }
}
