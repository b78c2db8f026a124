//! What the fault word of the device means.

use super::Simulation;
use crate::error::Error;
use crate::math::plain;
use crate::state::Control;
use crate::state::stages::Stage;

/// What is usually wrong where nothing has moved yet.
const FIRST: &str = "in the first step that is usually the start state";
/// Cells whose start is looked at.
const MOST_CELLS: usize = 100_000;

impl Simulation {
    /// The fault of the run as an error.
    pub(super) fn fault(&self, control: &Control) -> Error {
        let (stage, at) = ((control.fault >> 27) as usize, control.fault & 0x07ff_ffff);
        let stage = Stage::ALL.get(stage).copied();
        let name = stage.map_or("unknown", Stage::name);
        let (place, reason) = match stage {
            Some(Stage::G2p) => (
                format!("particle {at}"),
                "it is turned inside out or not finite; try a smaller numerics.expert.elastic_cfl",
            ),
            Some(Stage::CoupledSolve) => (
                "all cells".to_owned(),
                "the pressure solve did not converge; try a larger numerics.tolerance or a smaller time.cfl",
            ),
            Some(Stage::Interface) => {
                (self.cell(at), "more surface vertices of fragments than there is room for; try a finer resolution")
            }
            _ => (self.cell(at), "density or pressure is not positive and finite; try a smaller time.cfl"),
        };
        let step = u64::from(control.step) + 1;
        let reason = match (step, stage) {
            (1, Some(Stage::Interface)) | (2.., _) => reason.to_owned(),
            (_, Some(Stage::G2p | Stage::CoupledSolve)) => format!("{reason}; {FIRST}: {}", self.start_text()),
            _ => format!("density or pressure is not positive and finite; {FIRST}: {}", self.start_text_at(at)),
        };
        Error::Diverged { step, stage: name, place, reason }
    }

    /// The gas that the scene starts with in a cell.
    fn start_text_at(&self, slot: u32) -> String {
        let grid = &self.state.grid;
        let gas = self.scene.gas_at(grid.in_scene(grid.centre(grid.cell(slot))));
        let speed = gas.velocity.iter().map(|u| u * u).sum::<f64>().sqrt();
        let [density, pressure, temperature, speed] =
            [gas.density, gas.pressure, gas.pressure / gas.density, speed].map(plain);
        format!("density {density}, pressure {pressure}, temperature p / rho {temperature}, speed {speed} there")
    }

    /// The same for all cells, or so many of them as are looked at in no time.
    fn start_text(&self) -> String {
        let grid = &self.state.grid;
        let every = grid.cell_count().div_ceil(MOST_CELLS);
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for index in (0..grid.cell_count()).step_by(every) {
            let [nx, ny] = [grid.cells[0] as usize, grid.cells[1] as usize];
            let cell = [index % nx, index / nx % ny, index / (nx * ny)].map(|x| x as i32);
            let gas = self.scene.gas_at(grid.in_scene(grid.centre(cell)));
            for (range, value) in ranges.iter_mut().zip([gas.density, gas.pressure, gas.pressure / gas.density]) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
        let [density, pressure, temperature] = ranges.map(|[low, high]| format!("{} to {}", plain(low), plain(high)));
        format!("density {density}, pressure {pressure}, temperature p / rho {temperature} in all of the gas")
    }

    fn cell(&self, slot: u32) -> String {
        format!("cell {:?}", self.state.grid.cell(slot))
    }
}
