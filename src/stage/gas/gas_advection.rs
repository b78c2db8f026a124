//! `gas_advection`: where does the gas carry itself? WENO with local Lax-Friedrichs splitting, TVD-RK2 or, with two solves, three stages; conservative limiter.
//! [Cao et al. 2022, eqs. 10-12] The form over marches runs first: the form over the list overwrites what it writes into listed slots.

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Pass, Settings};
use crate::stage::sweep::Form;
use crate::stage::{Decision, TimeStep};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage: two Runge-Kutta stages, each with its correction by the limiter; with two solves one before the first and two
/// before the second.
#[derive(Debug)]
pub struct GasAdvection {
    stages: Vec<RungeKuttaStage>,
}

#[derive(Debug)]
struct RungeKuttaStage {
    forms: [Form; 2],
    limited: Bound,
}

/// Tells a kernel to take the stage from its uniform.
const BY_UNIFORM: u32 = 3;

impl RungeKuttaStage {
    /// The form over the list is the dearest kernel to compile: one serves all stages and their corrections.
    fn new(state: &State, stage: u32) -> Result<Self> {
        let buffer = || Buffer::uniform(&state.gpu, "advection", 2);
        let [whole, limited] = [buffer()?, buffer()?];
        whole.write(&state.gpu, 0, &[stage, 0]);
        limited.write(&state.gpu, 0, &[stage, 1]);
        let form = |over: Over, entry: &str, by: u32, advection: &Buffer<u32>| {
            let (renamed, switches) = ([("advection", advection.raw())], [("RUNGE_KUTTA", f64::from(by))]);
            Form::new(state, over, ["gas/gas_advection.wgsl", entry], &renamed, &switches)
        };
        let listed = |advection: &Buffer<u32>| form(Over::Listed, "advect_listed", BY_UNIFORM, advection);
        Ok(Self {
            forms: [form(Over::Marches, "advect_interior", stage, &whole)?, listed(&whole)?],
            limited: listed(&limited)?.kernel.in_form("limited"),
        })
    }
}

impl GasAdvection {
    /// Binds.
    pub fn new(state: &State, solves: u32) -> Result<Self> {
        Ok(Self { stages: (0..=solves).map(|stage| RungeKuttaStage::new(state, stage)).collect::<Result<_>>()? })
    }

    /// One Runge-Kutta stage, from 0, in a phase, and its correction, which does nothing unless the limiter has acted: on a CPU
    /// `time_step` opens it then, on a GPU its groups end at once.
    pub fn record(&self, pass: &mut Pass, state: &State, time_step: &TimeStep, runge_kutta: usize, phase: Phase) {
        pass.stage(Stage::GasAdvection.name());
        let kernels = &self.stages[runge_kutta];
        for form in &kernels.forms {
            form.record(pass, state, phase);
        }
        if state.gpu.settings == Settings::Hardware {
            return pass.dispatch(&kernels.limited, &state.extent(phase, Over::Slots));
        }
        time_step.decide(pass, Decision::Limiter);
        pass.dispatch(&kernels.limited, &state.extent(Phase::Limit, Over::Slots));
    }
}
