//! `carrier`: which velocity carries the gas through its faces? One that compresses only what the pressure solve can see.

use super::{Parts, record_both};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;

/// The state whose velocity carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// The state now.
    Now = 0,
    /// After the first Runge-Kutta stage of the advection.
    First = 1,
    /// After the advection.
    Star = 2,
}

/// Kernels of the stage, for each state: average, divergence.
#[derive(Debug)]
pub struct CarrierVelocity {
    kernels: Option<[[[Bound; 2]; 2]; 3]>,
}

impl CarrierVelocity {
    /// Binds; if it is not `wanted`, its recordings are empty.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, wanted: bool) -> Result<Self> {
        let bind = |entry: &str, source: Carried| {
            parts.both("carrier.wgsl", entry, &[], &[("SOURCE", f64::from(source as u32))])
        };
        let of = |source: Carried| -> Result<[[Bound; 2]; 2]> {
            Ok([bind("carrier_average", source)?, bind("carrier_divergence", source)?])
        };
        let all = || Ok([of(Carried::Now)?, of(Carried::First)?, of(Carried::Star)?]);
        Ok(Self { kernels: if wanted { Some(all()?) } else { None } })
    }

    /// Carrier of a state, in a phase.
    pub fn record(&self, pass: &mut Pass, state: &State, source: Carried, phase: &str) {
        let Some(kernels) = &self.kernels else { return };
        for both in &kernels[source as usize] {
            record_both(pass, state, phase, both);
        }
    }
}
