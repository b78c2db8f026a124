//! `particle_sort`: which particles touch which cell? A counting sort whose result does not depend on the order of atomics.

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::numerics::Scan;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct ParticleSort {
    clear: Bound,
    count: Bound,
    scan: Scan,
    place: Bound,
    within: Bound,
}

impl ParticleSort {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let gpu = &state.gpu;
        let bind = |entry: &str| state.bind("solid/particle_sort.wgsl", entry, &[], &[]);
        Ok(Self {
            clear: bind("sort_clear")?,
            count: bind("sort_count")?,
            scan: Scan::over(
                gpu,
                state.lent("count"),
                state.particles.cell_start.raw(),
                state.params.slots,
                state.params.slots + 1,
            )?,
            place: bind("sort_place")?,
            within: bind("sort_within_cells")?,
        })
    }

    /// Sorts, if a particle may have left its cell since the last time.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        let phase = Phase::Sort;
        pass.stage(Stage::ParticleSort.name());
        pass.dispatch(&self.clear, &state.extent(phase, Over::Slots));
        pass.dispatch(&self.count, &state.extent(phase, Over::Particles));
        self.scan.record_with(pass, &state.scan_extents(phase));
        pass.dispatch(&self.place, &state.extent(phase, Over::Particles));
        pass.dispatch(&self.within, &state.extent(phase, Over::Slots));
    }
}
