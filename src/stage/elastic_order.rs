//! `elastic_order`: what does the pressure solve know of elasticity? Nothing by default: it comes first. The stage exists for the
//! other orders, `numerics.ghost = "shared_volume"` and `numerics.coupling = "last"`. [Cao et al. 2022, section 2.8 and fig. 14]

use super::Parts;
use super::time_step::slots;
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::scene::{Coupling, Ghost, Scene};
use crate::state::State;

/// Kernels of the stage.
#[derive(Debug)]
pub struct ElasticOrder {
    inertia: Bound,
    start: Bound,
    before: Bound,
    /// With a shared volume: what the solve gives is spread over the sub-steps.
    after: Option<Bound>,
    substep: Bound,
}

impl ElasticOrder {
    /// Binds, if the scene wants another order than the default.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, scene: &Scene) -> Result<Option<Self>> {
        let Parts { gpu, state } = parts;
        let shared = scene.numerics.ghost == Ghost::SharedVolume;
        if !state.has_solids() || !(shared || scene.numerics.coupling == Coupling::Last) {
            return Ok(None);
        }
        let bind = |entry: &str| state.bind(gpu, "solid_elastic.wgsl", entry, &[], &[]);
        Ok(Some(Self {
            inertia: state.bind(gpu, "solid_inertia.wgsl", "solid_inertia", &[], &[])?,
            start: bind("elastic_start")?,
            before: bind("elastic_before")?,
            after: if shared { Some(bind("elastic_after")?) } else { None },
            substep: bind(if shared { "elastic_spread" } else { "elastic_walls" })?,
        }))
    }

    /// Whether elastic sub-steps follow the solve.
    #[must_use]
    pub fn has_substeps(&self) -> bool {
        self.after.is_some()
    }

    /// Keeps the elastic force that `p2g` has left.
    pub fn record_start(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.inertia, &slots(state, "BEGIN"));
        pass.dispatch(&self.start, &slots(state, "BEGIN"));
    }

    /// Gives it to the velocities that enter the solve, in a phase.
    pub fn record_before(&self, pass: &mut Pass, state: &State, phase: &str) {
        pass.stage("coupled_solve");
        pass.dispatch(&self.before, &slots(state, phase));
    }

    /// Takes it back after the solve.
    pub fn record_after(&self, pass: &mut Pass, state: &State) {
        if let Some(kernel) = &self.after {
            pass.dispatch(kernel, &slots(state, "UPDATE"));
        }
    }

    /// One sub-step, before the elastic force of `mpm_grid_update` or instead of it.
    pub fn record_substep(&self, pass: &mut Pass, state: &State) {
        pass.stage("mpm_grid_update");
        pass.dispatch(&self.substep, &slots(state, "SUBSTEP"));
    }
}
