//! `intermediate_pressure`: which pressure does the advected gas have, and how stiff is what it meets?
//! [Cao et al. 2022, eqs. 9, 17, 22, 24]

use super::time_step::slots;
use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;

/// Kernels of the stage.
#[derive(Debug)]
pub struct IntermediatePressure {
    cells: Bound,
    open: Bound,
    clear: Bound,
    vertices: Bound,
}

impl IntermediatePressure {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        Ok(Self {
            cells: state.bind(gpu, "intermediate_pressure.wgsl", "pressure_star", &[], &[])?,
            open: state.bind(gpu, "solve_open.wgsl", "open_faces", &[], &[("LISTED", 1.0)])?,
            clear: state.bind(gpu, "vertex_pressure.wgsl", "vertex_clear", &[], &[])?,
            vertices: state.bind(gpu, "vertex_pressure.wgsl", "vertex_pressure", &[], &[])?,
        })
    }

    /// Cell pressures, then vertex pressures and stiffness.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage("intermediate_pressure");
        pass.dispatch(&self.cells, &slots(state, "BEGIN"));
        pass.dispatch(&self.open, &extent(state, "BEGIN", Entry::Listed));
        pass.dispatch(&self.clear, &extent(state, "BEGIN", Entry::Reduce));
        pass.dispatch(&self.vertices, &slots(state, "BEGIN"));
    }
}
