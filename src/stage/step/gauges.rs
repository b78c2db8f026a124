//! Points of bodies with gauges: not part of the method, but of every record of it.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernel of the points.
#[derive(Debug)]
pub struct Gauges(Bound);

impl Gauges {
    /// Binds, where some point has a gauge.
    pub fn new(state: &State) -> Result<Option<Self>> {
        let points = state.gauges.start.len();
        if points == 0 || !state.has_solids() {
            return Ok(None);
        }
        let bound = state.bind("step/gauges.wgsl", "gauge_record", &[], &[("GAUGES", points as f64)])?;
        Ok(Some(Self(bound)))
    }

    /// The points after the step that has just ended, into their history ring.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Totals.name());
        pass.dispatch(&self.0, &state.extent(Phase::End, Over::Single));
    }
}
