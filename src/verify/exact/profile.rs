//! States along a line, and what can be measured on them.

use crate::riemann::ExactRiemann;
use crate::scene::Scene;
use crate::snapshot::Snapshot;

/// Density, velocity and pressure in equal cells along x.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Low end \[m\].
    pub origin: f64,
    /// Width of a cell \[m\].
    pub spacing: f64,
    /// Density \[kg m^-3\], velocity \[m s^-1\] and pressure \[Pa\] of each cell.
    pub state: [Vec<f64>; 3],
}

/// Index of the density in [`Profile::state`].
pub(in crate::verify) const DENSITY: usize = 0;
/// Index of the velocity.
pub(in crate::verify) const VELOCITY: usize = 1;
/// Index of the pressure.
pub(in crate::verify) const PRESSURE: usize = 2;

impl Profile {
    /// The gas of a 1D run, or of the first row of cells in 2D and 3D.
    pub fn of(scene: &Scene, snapshot: &Snapshot) -> Self {
        let cells = scene.domain.cells[0] as usize;
        let wide = |values: &[f32]| values[..cells].iter().map(|&value| f64::from(value)).collect::<Vec<_>>();
        let velocity = snapshot.velocity[..cells].iter().map(|v| f64::from(v[0])).collect();
        let state = [wide(&snapshot.density), velocity, wide(&snapshot.pressure)];
        Profile { origin: scene.domain.origin[0], spacing: scene.domain.spacing(), state }
    }

    /// Cell means of an exact solution on the grid of `scene`, for waves that left `start` a time `age` ago.
    pub fn exact(scene: &Scene, exact: &ExactRiemann, start: f64, age: f64) -> Self {
        let (origin, spacing) = (scene.domain.origin[0], scene.domain.spacing());
        let mut state = [const { Vec::new() }; 3];
        for cell in 0..scene.domain.cells[0] {
            let low = origin + f64::from(cell) * spacing;
            let (density, velocity, pressure) = exact.cell_average(low, low + spacing, start, age);
            for (values, value) in state.iter_mut().zip([density, velocity, pressure]) {
                values.push(value);
            }
        }
        Profile { origin, spacing, state }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.state[DENSITY].len()
    }

    /// Centre of a cell \[m\].
    pub fn center(&self, cell: usize) -> f64 {
        self.origin + (cell as f64 + 0.5) * self.spacing
    }

    /// Means over groups of cells, so that `cells` remain; `cells` must divide their number. Velocity and pressure are plain means.
    pub fn coarsened(&self, cells: usize) -> Self {
        let group = (self.cells() / cells.max(1)).max(1);
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let state = [0, 1, 2].map(|k| self.state[k].chunks(group).map(mean).collect());
        Profile { origin: self.origin, spacing: self.spacing * group as f64, state }
    }

    /// Sum of |q - reference| dx over the line.
    pub fn l1(&self, reference: &Profile, quantity: usize) -> f64 {
        let pairs = self.state[quantity].iter().zip(&reference.state[quantity]);
        pairs.map(|(a, b)| (a - b).abs() * self.spacing).sum()
    }

    /// Normalised squared deviation of the density. [Cao et al. 2022, eq. 38]
    pub fn density_deviation(&self, reference: &Profile) -> f64 {
        let pairs = self.state[DENSITY].iter().zip(&reference.state[DENSITY]);
        let squares: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
        squares / reference.state[DENSITY].iter().sum::<f64>().powi(2)
    }

    /// Where a quantity crosses `level`, between cell centres, from the low end on.
    pub fn crossings(&self, quantity: usize, level: f64) -> impl DoubleEndedIterator<Item = f64> {
        let values = &self.state[quantity];
        let crosses = move |k: &usize| (values[*k] < level) != (values[*k + 1] < level);
        let cells = 0..values.len().saturating_sub(1);
        cells
            .filter(crosses)
            .map(move |k| self.center(k) + self.spacing * (level - values[k]) / (values[k + 1] - values[k]))
    }

    /// The crossing of `level` next to `place`.
    pub fn nearest_crossing(&self, quantity: usize, level: f64, place: f64) -> f64 {
        let crossings = self.crossings(quantity, level);
        crossings.min_by(|a, b| (a - place).abs().total_cmp(&(b - place).abs())).unwrap_or(f64::NAN)
    }

    /// Least and largest value among cells whose centre lies in an interval.
    pub fn extremes(&self, quantity: usize, [low, high]: [f64; 2]) -> [f64; 2] {
        let inside = (0..self.cells()).filter(|k| (low..=high).contains(&self.center(*k)));
        inside.map(|k| self.state[quantity][k]).fold([f64::NAN; 2], |[a, b], value| [a.min(value), b.max(value)])
    }

    /// Largest |q - value| among cells whose centre lies in an interval; not a number if there is none.
    pub fn largest_deviation(&self, quantity: usize, value: f64, [low, high]: [f64; 2]) -> f64 {
        let inside = (0..self.cells()).filter(|k| (low..=high).contains(&self.center(*k)));
        inside.map(|k| (self.state[quantity][k] - value).abs()).fold(f64::NAN, f64::max)
    }

    /// Largest value among cells whose centre lies in an interval, and that centre.
    pub fn peak(&self, quantity: usize, [low, high]: [f64; 2]) -> (f64, f64) {
        let inside = (0..self.cells()).map(|k| (self.state[quantity][k], self.center(k)));
        let inside = inside.filter(|(_, place)| (low..=high).contains(place));
        inside.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::NAN, f64::NAN))
    }

    /// Points (x, q) for a plot.
    pub fn points(&self, quantity: usize) -> Vec<[f64; 2]> {
        self.state[quantity].iter().enumerate().map(|(cell, value)| [self.center(cell), *value]).collect()
    }
}
