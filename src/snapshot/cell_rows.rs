//! Cells in the layout of the device.

use super::kind;
use crate::scene::{EquationOfState, held_energy};
use crate::state::Grid;

/// The cells in the layout of the device, ring included.
#[derive(Debug, Clone, Default)]
pub struct CellRows {
    /// Density and momentum per volume.
    pub conserved: Vec<[f32; 4]>,
    /// Total energy per volume.
    pub energy: Vec<f32>,
    /// Density of the second gas of all slots, its volume fraction, and with an explosive the density of what has not burned; empty without one.
    pub species: Vec<f32>,
    /// Mass owed \[kg\]; empty where only the ring has a ledger.
    pub owed: Vec<f32>,
    /// Maps, see [`crate::state::State::maps`]; empty where none are kept.
    pub maps: Vec<[f32; 4]>,
    /// Dust; empty without any.
    pub dust: Vec<f32>,
    /// Kinds.
    pub kind: Vec<u8>,
}

impl CellRows {
    /// Pressure of a slot.
    pub(super) fn pressure(&self, grid: &Grid, gases: &EquationOfState, slot: usize) -> f32 {
        let u = self.conserved[slot];
        let part = |k: usize| self.species.get(k * grid.slots() + slot).copied();
        if gases.products().is_some() {
            let [density, x, y, z] = u.map(f64::from);
            let [own, phi] = [0, 1].map(|k| f64::from(part(k).unwrap_or(0.0)));
            let state = [density, x, y, z, self.energy[slot].into(), own, phi];
            return gases.pressure(state, self.held(grid, slot).into()) as f32;
        }
        let kinetic = 0.5 * (u[1] * u[1] + u[2] * u[2] + u[3] * u[3]) / u[0];
        let grueneisen = part(1).map_or(gases.gamma as f32 - 1.0, |phi| gases.grueneisen(phi.into()) as f32);
        grueneisen * (self.energy[slot] - kinetic)
    }

    /// Maps of the cells without what rounding took.
    pub(super) fn kept_maps(&self, grid: &Grid) -> Vec<[f32; 3]> {
        if self.maps.is_empty() {
            return Vec::new();
        }
        let kept = |[peak, impulse, _, strain]: [f32; 4]| [peak, impulse, strain];
        grid.unpadded_by(|slot| kept(self.maps[slot]))
    }

    /// What the second gas in a slot holds, in energies of detonation.
    fn held(&self, grid: &Grid, slot: usize) -> f32 {
        let part = |k: usize| self.species.get(k * grid.slots() + slot).copied();
        part(2).zip(part(0)).map_or(0.0, |(unburned, density)| held_energy(density, unburned))
    }

    pub(super) fn species_fractions(&self, grid: &Grid) -> Vec<[f32; 3]> {
        if self.species.is_empty() {
            return Vec::new();
        }
        let (density, rest) = self.species.split_at(grid.slots());
        grid.unpadded_by(|slot| [density[slot] / self.conserved[slot][0], rest[slot], self.held(grid, slot)])
    }

    /// What cells owe per volume, and in covered cells all that they hold.
    pub(super) fn owed_density(&self, grid: &Grid) -> Vec<f32> {
        if self.owed.is_empty() {
            return vec![0.0; grid.cell_count()];
        }
        let volume = grid.spacing.powi(grid.dimension as i32);
        let held = |slot: usize| if self.kind[slot] == kind::SOLID { self.conserved[slot][0] } else { 0.0 };
        grid.unpadded_by(|slot| self.owed[slot] / volume + held(slot))
    }
}
