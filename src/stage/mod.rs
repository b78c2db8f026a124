//! The stages of a step, in order. Each owns its kernels with their buffers: `new` binds, with an error if a shader or a buffer is wrong;
//! `record` appends the dispatches to a pass.
//! [`crate::state::stages`] lists them with the questions that they answer.
//!
//! Stages do not know each other. They communicate through the buffers of [`crate::state::State`] only, in the order written
//! in [`crate::simulation::Simulation::record_step`].

mod gas;
mod interface;
mod solid;
mod solve;
mod step;
pub mod structures;
mod sweep;
pub mod traffic;

pub use gas::{
    Carried, CarrierVelocity, Detonate, Dust, FluidUpdate, GasAdvection, IntermediatePressure, OddEven, Still,
};
pub use interface::InterfaceStage;
pub use solid::{
    Debris, ElasticFirst, ElasticReaction, ElasticSolve, G2p, MAX_ELASTIC_ITERATIONS, MpmGridUpdate, P2g, ParticleSort,
    Push, Supports, Transfer,
};
pub use solve::CoupledSolve;
pub use step::{Decision, Gauges, Loads, Maps, TimeStep, Totals};
