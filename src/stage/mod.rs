//! The stages of a step, in order. Each owns its kernels with their buffers: `new` binds, `record` dispatches.
//! [`crate::state::stages`] lists them with the questions that they answer.
//!
//! Stages do not know each other. They communicate through the buffers of [`crate::state::State`] only, in the order written
//! in [`crate::simulation::Simulation::record_step`].

mod carrier;
mod coupled_solve;
mod detonate;
mod elastic_first;
mod elastic_reaction;
mod elastic_solve;
mod fluid_update;
mod g2p;
mod gas_advection;
mod gauges;
mod interface;
mod intermediate_pressure;
mod loads;
mod maps;
mod mpm_grid_update;
mod odd_even;
mod p2g;
mod particle_sort;
mod still;
mod supports;
mod time_step;
mod totals;
pub mod traffic;

pub use carrier::{Carried, CarrierVelocity};
pub use coupled_solve::CoupledSolve;
pub use detonate::Detonate;
pub use elastic_first::ElasticFirst;
pub use elastic_reaction::ElasticReaction;
pub use elastic_solve::{ElasticSolve, MAX_ITERATIONS as MAX_ELASTIC_ITERATIONS};
pub use fluid_update::FluidUpdate;
pub use g2p::G2p;
pub use gas_advection::GasAdvection;
pub use gauges::Gauges;
pub use interface::InterfaceStage;
pub use intermediate_pressure::IntermediatePressure;
pub use loads::Loads;
pub use maps::Maps;
pub use mpm_grid_update::MpmGridUpdate;
pub use odd_even::OddEven;
pub use p2g::{P2g, Transfer};
pub use particle_sort::ParticleSort;
pub use still::Still;
pub use supports::Supports;
pub use time_step::TimeStep;
pub use totals::Totals;

use crate::error::Result;
use crate::gpu::{Bound, Extent, Gpu, Pass};
use crate::state::State;
use crate::state::constants::{Entry, SCAN_DISPATCHES, extent_offset};

/// Device and buffers, as every stage's `new` takes them.
#[derive(Clone, Copy, Debug)]
pub struct Parts<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// The buffers.
    pub state: &'a State,
}

impl Parts<'_> {
    /// The two forms of a kernel: plain, over the slots deep inside the gas, and LISTED, over all others.
    fn both(
        &self,
        shader: &str,
        entry: &str,
        renamed: &[(&str, &wgpu::Buffer)],
        switches: &[(&str, f64)],
    ) -> Result<[Bound; 2]> {
        let form = |listed: f64| {
            let switches: Vec<_> = switches.iter().copied().chain([("LISTED", listed)]).collect();
            self.state.bind(self.gpu, shader, entry, renamed, &switches)
        };
        Ok([form(0.0)?, form(1.0)?])
    }
}

/// Records both forms of a kernel.
fn record_both(pass: &mut Pass, state: &State, phase: &str, [plain, listed]: &[Bound; 2]) {
    pass.dispatch(plain, &extent(state, phase, Entry::Slots));
    pass.dispatch(listed, &extent(state, phase, Entry::Listed));
}

/// Group counts of a phase, which the device opens and closes.
#[must_use]
pub(crate) fn extent<'a>(state: &'a State, phase: &str, entry: Entry) -> Extent<'a> {
    Extent::Indirect(&state.extents, extent_offset(phase, entry))
}

/// Group counts of a prefix sum over all slots, in a phase.
#[must_use]
pub(crate) fn scan_extents<'a>(state: &'a State, phase: &str) -> Vec<Extent<'a>> {
    let first = extent_offset(phase, Entry::Scan);
    (0..SCAN_DISPATCHES as u64).map(|k| Extent::Indirect(&state.extents, first + 16 * k)).collect()
}
