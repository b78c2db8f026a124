//! `particle_sort`: which particles touch which cell? A counting sort whose result does not depend on the order of atomics.

use super::{Parts, extent, scan_extents};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::numerics::Scan;
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

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
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let bind = |entry: &str| state.bind(gpu, "particle_sort.wgsl", entry, &[], &[]);
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
        let phase = "SORT";
        pass.stage(Stage::ParticleSort.name());
        pass.dispatch(&self.clear, &extent(state, phase, Entry::Slots));
        pass.dispatch(&self.count, &extent(state, phase, Entry::Particles));
        self.scan.record_with(pass, &scan_extents(state, phase));
        pass.dispatch(&self.place, &extent(state, phase, Entry::Particles));
        pass.dispatch(&self.within, &extent(state, phase, Entry::Slots));
    }
}
