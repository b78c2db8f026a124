//! `gas_advection`: where does the gas carry itself? WENO with local Lax-Friedrichs splitting, TVD-RK2, conservative limiter.
//! [Cao et al. 2022, eqs. 10-12]

use super::time_step::slots;
use super::{Parts, TimeStep, record_both};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;

/// Kernels of the stage: two Runge-Kutta stages, each with its correction by the limiter.
#[derive(Debug)]
pub struct GasAdvection {
    advect: [[Bound; 2]; 2],
    limited: Option<[Bound; 2]>,
}

impl GasAdvection {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, limiter: bool) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let theta = [("theta", state.pcg.product.raw())];
        let advect = |second: f64| parts.both("gas_advection.wgsl", "advect_gas", &theta, &[("SECOND", second)]);
        let bind = |entry: &str, second: f64| {
            state.bind(gpu, "gas_advection.wgsl", entry, &theta, &[("SECOND", second), ("LISTED", 0.0)])
        };
        let limited = if limiter { Some([bind("advect_limited", 0.0)?, bind("advect_limited", 1.0)?]) } else { None };
        Ok(Self { advect: [advect(0.0)?, advect(1.0)?], limited })
    }

    /// Advances the conserved variables by their own motion.
    pub fn record(&self, pass: &mut Pass, state: &State, control: &TimeStep) {
        pass.stage("gas_advection");
        for (stage, advect) in self.advect.iter().enumerate() {
            record_both(pass, state, "BEGIN", advect);
            if let Some(limited) = &self.limited {
                control.record_limiter(pass);
                pass.dispatch(&limited[stage], &slots(state, "LIMIT"));
            }
        }
    }
}
