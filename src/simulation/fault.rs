//! What the fault word of the device means.

use super::Simulation;
use crate::error::Error;
use crate::state::Control;
use crate::state::constants::STAGES;

impl Simulation {
    /// The fault of the run as an error.
    pub(super) fn fault(&self, control: &Control) -> Error {
        let (stage, at) = ((control.fault >> 27) as usize, control.fault & 0x07ff_ffff);
        let name = STAGES.get(stage).copied().unwrap_or("unknown");
        let (place, reason) = match name {
            "g2p" => {
                (format!("particle {at}"), "it is turned inside out or not finite; try a smaller numerics.elastic_cfl")
            }
            "coupled_solve" => (
                "all cells".to_owned(),
                "the pressure solve did not converge; try a larger numerics.tolerance or a smaller time.cfl",
            ),
            "interface" => {
                (self.cell(at), "more surface vertices of fragments than there is room for; try a finer resolution")
            }
            _ => (self.cell(at), "density or pressure is not positive and finite; try a smaller time.cfl"),
        };
        Error::Diverged { step: u64::from(control.step) + 1, stage: name, place, reason: reason.to_owned() }
    }

    fn cell(&self, slot: u32) -> String {
        let grid = &self.state.grid;
        let (stride, padding) = (grid.strides(), grid.padding());
        let at = [slot % stride[0], slot / stride[0] % stride[1], slot / (stride[0] * stride[1])];
        let cell: [i32; 3] = std::array::from_fn(|axis| at[axis] as i32 - padding[axis] as i32);
        format!("cell {cell:?}")
    }
}
