//! `fluid_update`: what does the solved pressure do to the gas? Local gradients, flux form. [Kwatra et al. 2009; eqs. 3, 14]

use super::{Carried, CarrierVelocity, Parts, TimeStep, extent, record_both};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::scene::Scene;
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// Kernels of the stage.
#[derive(Debug)]
pub struct FluidUpdate {
    /// Gas that follows the bodies, as their slots get it.
    late_flux: Option<Bound>,
    momentum: [Bound; 2],
    /// In scenes with bodies.
    parting: Option<[Bound; 2]>,
    energy: [Bound; 2],
    /// What faces of bodies, obstacles and walls bear.
    loads: Option<Bound>,
    floor: [Bound; 2],
}

impl FluidUpdate {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, scene: &Scene) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let follows = state.has_solids() && scene.late_flux();
        let late_flux = || state.bind(gpu, "late_flux.wgsl", "late_flux", &[], &[("LISTED", 1.0)]);
        let loads = || state.bind(gpu, "loads.wgsl", "load_faces", &[], &[("LISTED", 1.0)]);
        let parting = || parts.both("parting.wgsl", "parting_surplus", &[], &[]);
        Ok(Self {
            late_flux: follows.then(late_flux).transpose()?,
            momentum: parts.both("fluid_update.wgsl", "fluid_momentum", &[], &[])?,
            parting: state.has_solids().then(parting).transpose()?,
            loads: (state.load_count != [0; 3]).then(loads).transpose()?,
            energy: parts.both("fluid_update.wgsl", "fluid_energy", &[], &[])?,
            floor: parts.both("fluid_floor.wgsl", "fluid_floor", &[], &[])?,
        })
    }

    /// Gas that follows bodies, momentum; who pays where velocities part; energy; floor.
    pub fn record(&self, pass: &mut Pass, state: &State, carrier: &CarrierVelocity, control: &TimeStep) {
        pass.stage(Stage::FluidUpdate.name());
        if let Some(late_flux) = &self.late_flux {
            pass.dispatch(late_flux, &extent(state, "UPDATE", Entry::Listed));
        }
        record_both(pass, state, "UPDATE", &self.momentum);
        carrier.record(pass, state, Carried::Solved, "UPDATE");
        pass.stage(Stage::FluidUpdate.name());
        if let Some(parting) = &self.parting {
            record_both(pass, state, "UPDATE", parting);
        }
        record_both(pass, state, "UPDATE", &self.energy);
        if let Some(loads) = &self.loads {
            pass.dispatch(loads, &extent(state, "UPDATE", Entry::Listed));
        }
        control.record_cold(pass);
        let [plain, listed] = &self.floor;
        pass.dispatch(plain, &extent(state, "FLOOR", Entry::Slots));
        pass.dispatch(listed, &extent(state, "UPDATE", Entry::Listed));
    }
}
