//! `time_step`: how far may we go? [Kwatra et al. 2009, eq. 20] And the device's control of the step.

use crate::error::Result;
use crate::gpu::{Bound, Extent, Pass};
use crate::scene::Scene;
use crate::stage::sweep::Sweep;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct TimeStep {
    gas: Sweep,
    particles: Bound,
    choose: Bound,
    openings: Option<Bound>,
    start: Bound,
    listed: Bound,
    limiter: Bound,
    cold: Bound,
    solved: Bound,
    second: Bound,
    substep: Bound,
    finish: Bound,
}

impl TimeStep {
    /// Binds; `pcg` holds the outcome of the solve.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(state: &State, scene: &Scene, pcg: &wgpu::Buffer) -> Result<Self> {
        let maxima = [("maxima", state.partials.raw())];
        let time = |entry: &str| state.bind("step/time_step.wgsl", entry, &maxima, &[]);
        let filtered = [("FILTER_COURANT", scene.filter().map_or(f64::from(f32::MAX), |filter| filter.least_courant))];
        let control = |entry: &str| state.bind("step/step_control.wgsl", entry, &[("pcg", pcg)], &filtered);
        Ok(Self {
            gas: Sweep::over(state, Over::Interior, ["step/time_step.wgsl", "time_step_gas"], &maxima)?,
            particles: time("time_step_particles")?,
            choose: time("time_step_choose")?,
            openings: if state.knots.is_empty() {
                None
            } else {
                Some(state.bind("gas/openings.wgsl", "openings_now", &[], &[])?)
            },
            start: control("control_start")?,
            listed: control("control_listed")?,
            limiter: control("control_limiter")?,
            cold: control("control_cold")?,
            solved: control("control_solved")?,
            second: control("control_second")?,
            substep: control("control_substep")?,
            finish: control("control_finish")?,
        })
    }

    /// Chooses dt and opens the step, if one is due.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::TimeStep.name());
        // The listed form leaves its maxima first, the plain form adds to them.
        for form in [&self.gas.listed, &self.gas.plain] {
            pass.dispatch(&form.kernel, &Extent::Groups([state.params.groups, 1, 1]));
        }
        if state.has_solids() {
            pass.dispatch(&self.particles, &Extent::Groups([state.params.groups, 1, 1]));
        }
        pass.dispatch(&self.choose, &Extent::Groups([1, 1, 1]));
        if let Some(openings) = &self.openings {
            pass.dispatch(openings, &state.extent(Phase::Begin, Over::Single));
        }
    }

    /// Opens the marks of the start.
    pub fn record_start(&self, pass: &mut Pass) {
        pass.dispatch(&self.start, &Extent::Groups([1, 1, 1]));
    }

    /// Takes the length of the list of slots that are not deep inside the gas.
    pub fn record_listed(&self, pass: &mut Pass) {
        pass.dispatch(&self.listed, &Extent::Groups([1, 1, 1]));
    }

    /// Opens the correction of the advection where the limiter acted.
    pub fn record_limiter(&self, pass: &mut Pass) {
        pass.dispatch(&self.limiter, &Extent::Groups([1, 1, 1]));
    }

    /// Opens the energy floor deep inside the gas where it may have to act.
    pub fn record_cold(&self, pass: &mut Pass) {
        pass.dispatch(&self.cold, &Extent::Groups([1, 1, 1]));
    }

    /// Opens the updates if the solve has finished.
    pub fn record_solved(&self, pass: &mut Pass) {
        pass.dispatch(&self.solved, &Extent::Groups([1, 1, 1]));
    }

    /// Opens the second advection and solve if the first is done.
    pub fn record_second(&self, pass: &mut Pass) {
        pass.dispatch(&self.second, &Extent::Groups([1, 1, 1]));
    }

    /// Opens one elastic sub-step if one is due.
    pub fn record_substep(&self, pass: &mut Pass) {
        pass.dispatch(&self.substep, &Extent::Groups([1, 1, 1]));
    }

    /// Closes the step if it is complete.
    pub fn record_finish(&self, pass: &mut Pass) {
        pass.dispatch(&self.finish, &Extent::Groups([1, 1, 1]));
    }
}
