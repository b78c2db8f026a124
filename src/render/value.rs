//! The value under a point of the picture drawn last.

use super::Renderer;
use super::kernels::NO_VALUE;
use crate::Result;
use crate::gpu::readback;

impl Renderer {
    /// What the picture drawn last shows in the cell at a point \[m\]; none outside of the domain, where there is no gas, and in 1D.
    ///
    /// # Errors
    /// What the device reports.
    pub fn value_at(&self, point: [f64; 3]) -> Result<Option<f64>> {
        let Some(drawing) = &self.drawing else { return Ok(None) };
        let (grid, low) = (&self.sources.grid, self.sources.grid.low());
        let (mut index, mut stride) = (0, 1);
        for axis in 0..grid.dimension as usize {
            let place = (point[axis] - low[axis]) / f64::from(grid.spacing);
            if !(0.0..f64::from(grid.cells[axis])).contains(&place) {
                return Ok(None);
            }
            (index, stride) = (index + stride * place as usize, stride * grid.cells[axis] as usize);
        }
        let value = readback::read_range(&self.gpu, &drawing.gas.field, index, 1)?[0];
        Ok((value > NO_VALUE).then_some(f64::from(value)))
    }
}
