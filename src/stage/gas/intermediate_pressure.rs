//! `intermediate_pressure`: which pressure does the advected gas have, and how stiff is what it meets?
//! [Cao et al. 2022, eqs. 9, 17, 22, 24]

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::stage::sweep::{Form, Sweep};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the stage.
#[derive(Debug)]
pub struct IntermediatePressure {
    cells: Sweep,
    open_faces: Form,
    clear: Bound,
    vertices: Sweep,
}

impl IntermediatePressure {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        Ok(Self {
            cells: Sweep::new(state, "gas/intermediate_pressure.wgsl", "pressure_star")?,
            open_faces: Form::listed(state, "solve/solve_open.wgsl", "open_faces")?,
            clear: state.bind("solve/vertex_pressure.wgsl", "vertex_clear", &[], &[])?,
            vertices: Sweep::new(state, "solve/vertex_pressure.wgsl", "vertex_pressure")?,
        })
    }

    /// Cell pressures, then vertex pressures and stiffness, in a phase.
    pub fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.stage(Stage::IntermediatePressure.name());
        self.cells.record(pass, state, phase);
        self.open_faces.record(pass, state, phase);
        pass.dispatch(&self.clear, &state.extent(phase, Over::Reduce));
        self.vertices.record(pass, state, phase);
    }
}
