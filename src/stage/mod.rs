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
mod sweep;
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
