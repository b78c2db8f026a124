//! `time_step`: how far may we go? [Kwatra et al. 2009, eq. 20] And the device's control of the step.

use crate::error::Result;
use crate::gpu::{Bound, Extent, Pass};
use crate::scene::Scene;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct TimeStep {
    gas: Bound,
    particles: Bound,
    choose: Bound,
    openings: Option<Bound>,
    decisions: Vec<Bound>,
}

/// What the device decides between stages, a kernel of one thread each.
#[derive(Clone, Copy, Debug)]
pub enum Decision {
    /// Opens the marks of the start.
    Start,
    /// Takes the length of the list of slots that are not deep inside the gas.
    Listed,
    /// Opens the correction of the advection where the limiter acted.
    Limiter,
    /// Opens the energy floor deep inside the gas where it may have to act.
    Cold,
    /// Opens the updates if the solve has finished, and the first explicit elastic sub-step.
    Solved,
    /// Opens the second advection and solve if the first is done.
    Second,
    /// Opens one more elastic sub-step if one is due, or the end of the elastic solve.
    Substep,
    /// Closes the step if it is complete.
    Finish,
}

impl Decision {
    /// Entry points of `shaders/step/step_control.wgsl`, in the order of the variants.
    const ENTRIES: [&str; 8] = [
        "control_start", "control_listed", "control_limiter", "control_cold", "control_solved", "control_second",
        "control_substep", "control_finish",
    ];
}

impl TimeStep {
    /// Binds; `pcg` holds the outcome of the solve.
    pub fn new(state: &State, scene: &Scene, pcg: &wgpu::Buffer) -> Result<Self> {
        let maxima = [("maxima", state.partials.raw())];
        let time = |entry: &str| state.bind("step/time_step.wgsl", entry, &maxima, &[]);
        let filtered = [("FILTER_COURANT", scene.filter().map_or(f64::from(f32::MAX), |filter| filter.least_courant))];
        let control = |entry: &str| state.bind("step/step_control.wgsl", entry, &[("pcg", pcg)], &filtered);
        Ok(Self {
            gas: time("time_step_gas")?,
            particles: time("time_step_particles")?,
            choose: time("time_step_choose")?,
            openings: if state.knots.is_empty() {
                None
            } else {
                Some(state.bind("gas/openings.wgsl", "openings_now", &[], &[])?)
            },
            decisions: Decision::ENTRIES.into_iter().map(control).collect::<Result<_>>()?,
        })
    }

    /// Chooses dt and opens the step, if one is due.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::TimeStep.name());
        pass.dispatch(&self.gas, &Extent::Groups([state.params.groups, 1, 1]));
        if state.has_solids() {
            pass.dispatch(&self.particles, &Extent::Groups([state.params.groups, 1, 1]));
        }
        pass.dispatch(&self.choose, &Extent::Groups([1, 1, 1]));
        if let Some(openings) = &self.openings {
            pass.dispatch(openings, &state.extent(Phase::Begin, Over::Single));
        }
    }

    /// Lets the device decide.
    pub fn decide(&self, pass: &mut Pass, decision: Decision) {
        pass.dispatch(&self.decisions[decision as usize], &Extent::Groups([1, 1, 1]));
    }
}
