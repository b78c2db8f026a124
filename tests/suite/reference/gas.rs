//! Twins of the stages of the gas.

pub(crate) mod carrier;
pub(crate) mod fluid_update;
pub(crate) mod gas_advection;
pub(crate) mod intermediate_pressure;
