//! From shapes to cells.

use rayon::prelude::*;

use crate::scene::{Conserved, GasState, Scene};

/// Sub-samples per axis in cells that the surface of a region crosses.
const SAMPLES: u32 = 4;

impl Scene {
    /// What is conserved in every cell, x fastest, without padding.
    ///
    /// A cell that the surface of a region crosses, and every cell under waves, vortices or radial flows, holds the mean over 4^dimension
    /// points; every other cell is exact. Where bodies cover some of these points the others count: a region that ends within a wall leaves
    /// nothing on its other side.
    #[must_use]
    pub fn initial_gas(&self) -> Vec<Conserved> {
        let mut cells = self.gas_without_noise();
        if self.gas.noise > 0.0 {
            let axes = self.domain.axes();
            cells.par_iter_mut().enumerate().for_each(|(cell, state)| self.gas.disturb(cell, axes, state));
        }
        cells
    }

    fn gas_without_noise(&self) -> Vec<Conserved> {
        let gas = &self.gas;
        let gases = gas.equation_of_state();
        if !(gas.waves.is_empty() && gas.vortices.is_empty() && gas.radial_flows.is_empty()) {
            return self.each_cell(|center| self.mean_over(center, |point| self.conserved_at(point)));
        }
        let states = self.gas.regions.iter().map(|region| gases.conserved(&region.state)).collect::<Vec<_>>();
        let charges = self.charges.iter().filter_map(|charge| charge.shape.as_ref()).collect::<Vec<_>>();
        let reach = self.cell_radius();
        self.each_cell(|center| {
            let ambient = gases.conserved(&self.ambient_at(center));
            let mut state = ambient;
            let mut mixed = false;
            for (region, inside) in self.gas.regions.iter().zip(&states) {
                let distance = region.shape.distance(center);
                mixed = if distance < -reach { false } else { mixed || distance < reach };
                if distance < 0.0 {
                    state = *inside;
                }
            }
            if charges.iter().any(|shape| shape.distance(center) < reach) {
                return self.mean_over(center, |point| self.conserved_at(point));
            }
            if mixed { self.mean_state(center, &ambient, &states) } else { state }
        })
    }

    /// Mean over regular points of a cell, the last region at each point.
    fn mean_state(&self, center: [f64; 3], ambient: &Conserved, states: &[Conserved]) -> Conserved {
        self.mean_over(center, |point| {
            let last = self.gas.regions.iter().zip(states).rev().find(|(region, _)| region.shape.distance(point) < 0.0);
            *last.map_or(ambient, |(_, state)| state)
        })
    }

    /// Mean of a state over regular points of a cell.
    fn mean_over(&self, center: [f64; 3], state: impl Fn([f64; 3]) -> Conserved) -> Conserved {
        self.mean_outside(center, |point| self.bodies.iter().any(|body| body.shape.distance(point) < 0.0), state)
    }

    /// Mean over those of the points that are not covered, or over all if all are.
    fn mean_outside(
        &self,
        center: [f64; 3],
        is_covered: impl Fn([f64; 3]) -> bool,
        state: impl Fn([f64; 3]) -> Conserved,
    ) -> Conserved {
        let place = |offset: [f64; 3]| std::array::from_fn(|d| center[d] + offset[d] * self.domain.spacing());
        let points: Vec<[f64; 3]> = lattice(self.domain.axes(), SAMPLES).into_iter().map(place).collect();
        let outside: Vec<[f64; 3]> = points.iter().copied().filter(|&point| !is_covered(point)).collect();
        let seen = if outside.is_empty() { points } else { outside };
        let mut sum = [0.0; 7];
        for &point in &seen {
            for (total, entry) in sum.iter_mut().zip(state(point)) {
                *total += entry;
            }
        }
        sum.map(|total| total / seen.len() as f64)
    }

    /// The mean over the part of a cell that lies outside of the obstacles.
    #[must_use]
    pub fn initial_gas_beside_obstacles(&self, cell: [u32; 3]) -> Conserved {
        self.mean_outside(
            self.domain.cell_center(cell),
            |point| self.inside_obstacle(point),
            |point| self.conserved_at(point),
        )
    }

    /// Which cells are obstacle: those whose centre lies inside one. x fastest, without padding.
    #[must_use]
    pub fn obstacle_cells(&self) -> Vec<bool> {
        self.each_cell(|center| self.inside_obstacle(center))
    }

    /// From the centre to the corners of a cell \[m\].
    pub(crate) fn cell_radius(&self) -> f64 {
        0.5 * self.domain.spacing() * f64::from(self.domain.dimension).sqrt()
    }

    pub(crate) fn inside_obstacle(&self, point: [f64; 3]) -> bool {
        self.obstacle_distance(point) < 0.0
    }

    /// One value per cell from its centre, x fastest.
    fn each_cell<T: Send>(&self, value: impl Fn([f64; 3]) -> T + Sync) -> Vec<T> {
        let [nx, ny, _] = self.domain.cells.map(|n| n as usize);
        let at = |cell: usize| [cell % nx, cell / nx % ny, cell / (nx * ny)].map(|n| n as u32);
        (0..self.domain.cell_count()).into_par_iter().map(|cell| value(self.domain.cell_center(at(cell)))).collect()
    }

    /// State of the regions at a point, without what is added to it; the ambient one at the height of another.
    pub(crate) fn still_gas(&self, point: [f64; 3], height: [f64; 3]) -> GasState {
        let last = self.gas.regions.iter().rev().find(|region| region.shape.distance(point) < 0.0);
        last.map_or_else(|| self.ambient_at(height), |region| region.state)
    }

    /// What is conserved at a point at the start.
    fn conserved_at(&self, point: [f64; 3]) -> Conserved {
        let gas = || self.gas.equation_of_state().conserved(&self.gas_at(point));
        self.unburned_at(point).unwrap_or_else(gas)
    }

    /// Initial state at a point, without charges.
    #[must_use]
    pub fn gas_at(&self, point: [f64; 3]) -> GasState {
        let mut state = self.still_gas(point, point);
        for wave in &self.gas.waves {
            wave.add(&mut state, point);
        }
        for vortex in &self.gas.vortices {
            vortex.add(&mut state, self.gas.gamma, point);
        }
        for flow in &self.gas.radial_flows {
            flow.add(&mut state, point);
        }
        state
    }
}

/// `count` regular points per axis of the unit cell around 0; 0 along inactive axes. x fastest.
pub(crate) fn lattice(axes: usize, count: u32) -> Vec<[f64; 3]> {
    let total = count.pow(axes as u32);
    let offset = |index: u32, d: usize| {
        if d < axes { (f64::from(index / count.pow(d as u32) % count) + 0.5) / f64::from(count) - 0.5 } else { 0.0 }
    };
    (0..total).map(|index| std::array::from_fn(|d| offset(index, d))).collect()
}
