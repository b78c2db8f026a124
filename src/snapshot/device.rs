//! The state of the device.

use super::{CellRows, ParticleRows, Snapshot, kind, turning};
use crate::error::Result;
use crate::gpu::{Gpu, readback};
use crate::scene::EquationOfState;
use crate::state::State;

impl Snapshot {
    /// Copies the state of the device at a time \[s\] after so many steps.
    ///
    /// # Errors
    /// Driver errors.
    pub(crate) fn read(gpu: &Gpu, state: &State, (time, step): (f64, u64), gases: EquationOfState) -> Result<Snapshot> {
        let grid = state.grid;
        let particles = &state.particles;
        let rows = ParticleRows {
            position: readback::read(gpu, &particles.position)?,
            velocity: readback::read(gpu, &particles.velocity)?,
            affine: readback::read(gpu, &particles.affine)?,
            deformation: readback::read(gpu, &particles.deformation)?,
            stress: readback::read(gpu, &particles.stress)?,
        };
        let everywhere = state.gas.owed_flow.len() == grid.slots();
        let owed = if everywhere { readback::read(gpu, &state.gas.owed_flow)? } else { Vec::new() };
        let cells = CellRows {
            owed: owed.iter().map(|entry| entry[0]).collect(),
            maps: readback::read(gpu, &state.maps)?,
            dust: readback::read_range(gpu, &state.dust, 0, if state.dust.is_empty() { 0 } else { grid.slots() })?,
            conserved: readback::read(gpu, &state.gas.conserved)?,
            energy: readback::read_range(gpu, &state.gas.energy, 0, grid.slots())?,
            species: state.gas.read_species(gpu, grid.slots())?,
            kind: readback::read(gpu, &state.interface.cells)?.iter().map(|word| *word as u8 & kind::MASK).collect(),
        };
        Ok(Snapshot { laws: state.laws()?, ..Self::of(grid, gases, (time, step), &cells, &rows) })
    }
}

/// Of the particles that have left the domain: number, velocity, and the mean square of the velocity around them.
pub(crate) fn gone(gpu: &Gpu, state: &State) -> Result<Vec<(usize, [f64; 4])>> {
    let particles = &state.particles;
    let velocity = readback::read(gpu, &particles.velocity)?;
    let affine = readback::read(gpu, &particles.affine)?;
    let deformation = readback::read(gpu, &particles.deformation)?;
    let of = |p: usize| {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(velocity[p][axis]));
        let turning = turning(&affine[3 * p..3 * p + state.grid.dimension as usize]);
        let square = x * x + y * y + z * z + 0.25 * f64::from(state.grid.spacing).powi(2) * f64::from(turning);
        (p, [x, y, z, square])
    };
    Ok((0..velocity.len()).filter(|&p| deformation[3 * p + 1][3] == 0.0).map(of).collect())
}
