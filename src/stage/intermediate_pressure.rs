//! `intermediate_pressure`: which pressure does the advected gas have, and how stiff is what it meets?
//! [Cao et al. 2022, eqs. 9, 17, 22, 24]

use super::{Parts, extent, record_both};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// Kernels of the stage.
#[derive(Debug)]
pub struct IntermediatePressure {
    cells: [Bound; 2],
    open_faces: Bound,
    clear: Bound,
    vertices: [Bound; 2],
}

impl IntermediatePressure {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        Ok(Self {
            cells: parts.both("intermediate_pressure.wgsl", "pressure_star", &[], &[])?,
            open_faces: state.bind(gpu, "solve_open.wgsl", "open_faces", &[], &[("LISTED", 1.0)])?,
            clear: state.bind(gpu, "vertex_pressure.wgsl", "vertex_clear", &[], &[("LISTED", 0.0)])?,
            vertices: parts.both("vertex_pressure.wgsl", "vertex_pressure", &[], &[])?,
        })
    }

    /// Cell pressures, then vertex pressures and stiffness, in a phase.
    pub fn record(&self, pass: &mut Pass, state: &State, phase: &str) {
        pass.stage(Stage::IntermediatePressure.name());
        record_both(pass, state, phase, &self.cells);
        pass.dispatch(&self.open_faces, &extent(state, phase, Entry::Listed));
        pass.dispatch(&self.clear, &extent(state, phase, Entry::Reduce));
        record_both(pass, state, phase, &self.vertices);
    }
}
