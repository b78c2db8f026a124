//! What an `outlet` remembers: the gas that lies at a side at the start.

use std::collections::HashMap;

use super::{Boundary, GasState, Scene};

/// Different states that outlets can remember.
pub const MAX_REMEMBERED: usize = 960;

/// States by the face that they lie at.
#[derive(Clone, Debug, Default)]
pub struct Remembered {
    /// All that differ.
    pub states: Vec<GasState>,
    places: HashMap<[u64; 5], usize>,
}

impl Remembered {
    fn note(&mut self, state: GasState) {
        let next = self.states.len();
        if *self.places.entry(key(&state)).or_insert(next) == next {
            self.states.push(state);
        }
    }

    /// Place of a state among them.
    #[must_use]
    pub fn place(&self, state: &GasState) -> Option<usize> {
        self.places.get(&key(state)).copied()
    }
}

fn key(state: &GasState) -> [u64; 5] {
    let [u, v, w] = state.velocity;
    [state.density, u, v, w, state.pressure].map(f64::to_bits)
}

impl Scene {
    /// The gas of the start at the face of a side next to a cell: that of the last region around the centre of the cell, without waves
    /// and vortices, which are what leaves; under gravity at the height of the face. Sides are numbered as in [`super::Boundaries::sides`].
    #[must_use]
    pub fn gas_beyond(&self, side: usize, cell: [u32; 3]) -> GasState {
        let mut state = self.still_gas(self.domain.cell_center(cell), self.domain.face_center(side, cell));
        for flow in &self.gas.radial_flows {
            flow.add(&mut state, self.domain.cell_center(cell));
        }
        state
    }

    /// All states that the outlets of the scene remember, but no more than one above [`MAX_REMEMBERED`].
    #[must_use]
    pub fn remembered(&self) -> Remembered {
        let mut remembered = Remembered::default();
        for (index, side) in self.boundary.sides().into_iter().enumerate().take(2 * self.domain.axes()) {
            let rules = side.rules();
            if !rules.contains(&&Boundary::Outlet) {
                continue;
            }
            for cell in self.domain.cells_at(index) {
                if *rules[side.rule_at(self.domain.face_center(index, cell))] == Boundary::Outlet {
                    remembered.note(self.gas_beyond(index, cell));
                }
                if remembered.states.len() > MAX_REMEMBERED || self.is_even_at_sides() {
                    break;
                }
            }
        }
        remembered
    }

    /// Whether one state lies at all sides.
    pub(super) fn is_even_at_sides(&self) -> bool {
        self.gas.regions.is_empty() && self.gas.radial_flows.is_empty() && !self.is_stratified()
    }
}

impl super::Domain {
    /// The cells next to a side, x fastest.
    pub fn cells_at(&self, side: usize) -> impl Iterator<Item = [u32; 3]> + '_ {
        let mut count = self.cells;
        let far = if side.is_multiple_of(2) { 0 } else { count[side / 2] - 1 };
        count[side / 2] = 1;
        let [nx, ny, nz] = count;
        (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z]))).map(move |mut cell| {
            cell[side / 2] = far;
            cell
        })
    }
}
