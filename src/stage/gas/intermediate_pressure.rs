//! `intermediate_pressure`: which pressure does the advected gas have, and how stiff is what it meets?
//! [Cao et al. 2022, eqs. 9, 17, 22, 24]

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::stage::sweep::{Form, Sweep};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// A kernel of `shaders/solve/solve_open.wgsl`, in scenes with open sides.
pub(in crate::stage) fn open_sides(state: &State, entry: &str) -> Result<Option<Form>> {
    state.is_open().then(|| Form::listed(state, "solve/solve_open.wgsl", entry)).transpose()
}

/// Kernels of the stage.
#[derive(Debug)]
pub struct IntermediatePressure {
    cells: Sweep,
    /// With open sides.
    open_faces: Option<Form>,
    /// In scenes with bodies.
    clear: Option<Bound>,
    vertices: Sweep,
}

impl IntermediatePressure {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let clear = || state.bind("solve/vertex_pressure.wgsl", "vertex_clear", &[], &[]);
        Ok(Self {
            cells: Sweep::new(state, "gas/intermediate_pressure.wgsl", "pressure_star")?,
            open_faces: open_sides(state, "open_faces")?,
            clear: state.has_solids().then(clear).transpose()?,
            vertices: Sweep::new(state, "solve/vertex_pressure.wgsl", "vertex_pressure")?,
        })
    }

    /// Cell pressures, then vertex pressures and stiffness, in a phase.
    pub fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.stage(Stage::IntermediatePressure.name());
        self.cells.record(pass, state, phase);
        if let Some(open_faces) = &self.open_faces {
            open_faces.record(pass, state, phase);
        }
        if let Some(clear) = &self.clear {
            pass.dispatch(clear, &state.extent(phase, Over::Reduce));
        }
        self.vertices.record(pass, state, phase);
    }
}
