//! `fluid_update`: what does the solved pressure do to the gas? Local gradients, flux form. [Kwatra et al. 2009; eqs. 3, 14]

use crate::error::Result;
use crate::gpu::{Pass, Settings};
use crate::scene::Scene;
use crate::stage::sweep::{Form, Sweep};
use crate::stage::{Carried, CarrierVelocity, Decision, TimeStep};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct FluidUpdate {
    /// Gas that follows the bodies, as their slots get it.
    late_flux: Option<Form>,
    momentum: Sweep,
    /// In scenes with bodies.
    parting: Option<Sweep>,
    energy: Sweep,
    /// What faces of bodies, obstacles and walls bear.
    loads: Option<Form>,
    floor: Sweep,
}

impl FluidUpdate {
    /// Binds.
    pub fn new(state: &State, scene: &Scene) -> Result<Self> {
        let follows = state.has_solids() && scene.late_flux();
        let late_flux = || Form::listed(state, "gas/late_flux.wgsl", "late_flux");
        let loads = || Form::listed(state, "step/loads.wgsl", "load_faces");
        let parting = || Sweep::new(state, "interface/parting.wgsl", "parting_surplus");
        Ok(Self {
            late_flux: follows.then(late_flux).transpose()?,
            momentum: Sweep::new(state, "gas/fluid_update.wgsl", "fluid_momentum")?,
            parting: state.has_solids().then(parting).transpose()?,
            loads: (state.load_count != [0; 3]).then(loads).transpose()?,
            energy: Sweep::new(state, "gas/fluid_update.wgsl", "fluid_energy")?,
            floor: Sweep::new(state, "gas/fluid_floor.wgsl", "fluid_floor")?,
        })
    }

    /// Gas that follows bodies, momentum; who pays where velocities part; energy; floor.
    pub fn record(&self, pass: &mut Pass, state: &State, carrier: &CarrierVelocity, time_step: &TimeStep) {
        pass.stage(Stage::FluidUpdate.name());
        if let Some(late_flux) = &self.late_flux {
            late_flux.record(pass, state, Phase::Update);
        }
        self.momentum.record(pass, state, Phase::Update);
        carrier.record(pass, state, Carried::Solved, Phase::Update);
        pass.stage(Stage::FluidUpdate.name());
        if let Some(parting) = &self.parting {
            parting.record(pass, state, Phase::Update);
        }
        self.energy.record(pass, state, Phase::Update);
        if let Some(loads) = &self.loads {
            loads.record(pass, state, Phase::Update);
        }
        if state.gpu.settings == Settings::Hardware {
            return self.floor.record(pass, state, Phase::Update);
        }
        time_step.decide(pass, Decision::Cold);
        for form in &self.floor.forms {
            form.record(pass, state, if form.over == Over::Interior { Phase::Floor } else { Phase::Update });
        }
    }
}
