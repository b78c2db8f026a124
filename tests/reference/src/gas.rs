//! Twins of the stages of the gas.

pub mod carrier;
pub mod fluid_update;
pub mod gas_advection;
pub mod intermediate_pressure;
