//! `gas_advection`: where does the gas carry itself? WENO with local Lax-Friedrichs splitting, TVD-RK2 or, with two solves, three stages; conservative limiter.
//! [Cao et al. 2022, eqs. 10-12]

use super::time_step::slots;
use super::{Parts, TimeStep, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// Kernels of the stage: two Runge-Kutta stages, each with its correction by the limiter; with two solves one before the first and two
/// before the second.
#[derive(Debug)]
pub struct GasAdvection {
    stages: Vec<RungeKuttaStage>,
}

#[derive(Debug)]
struct RungeKuttaStage {
    interior: Bound,
    listed: Bound,
    limited: Option<Bound>,
}

impl RungeKuttaStage {
    fn new(parts: Parts<'_>, limiter: bool, stage: u32) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let bind = |entry: &str, listed: f64| {
            state.bind(gpu, "gas_advection.wgsl", entry, &[], &[("STAGE", f64::from(stage)), ("LISTED", listed)])
        };
        Ok(Self {
            interior: bind("advect_interior", 0.0)?,
            listed: bind("advect_listed", 1.0)?,
            limited: if limiter { Some(bind("advect_limited", 0.0)?) } else { None },
        })
    }
}

impl GasAdvection {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, limiter: bool, solves: u32) -> Result<Self> {
        let stage = |stage: u32| RungeKuttaStage::new(parts, limiter, stage);
        Ok(Self { stages: (0..=solves).map(stage).collect::<Result<_>>()? })
    }

    /// One of the stages, from 0, in a phase: two belong to one advection, or with two solves one to the first and two to the second.
    pub fn record(&self, pass: &mut Pass, state: &State, control: &TimeStep, stage: usize, phase: &str) {
        pass.stage(Stage::GasAdvection.name());
        let kernels = &self.stages[stage];
        pass.dispatch(&kernels.interior, &extent(state, phase, Entry::Marched));
        pass.dispatch(&kernels.listed, &extent(state, phase, Entry::Listed));
        if let Some(limited) = &kernels.limited {
            control.record_limiter(pass);
            pass.dispatch(limited, &slots(state, "LIMIT"));
        }
    }
}
