//! What cases in the plane measure with: lines through the grid, fitted shocks.

use crate::snapshot::kind;
use crate::verify::exact::profile::Profile;
use crate::verify::harness::session::Run;

impl Profile {
    /// The gas of a 2D run along a line of `axis`, linear between the two rows of cell centres beside it; not a number where one of
    /// them holds no gas. `at` is the other coordinate; outside the outermost centres they stand for it. The velocity is that along
    /// the line.
    pub fn along(run: &Run, axis: usize, at: f64) -> Self {
        let (domain, gas) = (&run.scene.domain, &run.snapshot);
        let other = 1 - axis;
        let rows = domain.cells[other] as usize;
        let exact = (at - domain.origin[other]) / domain.spacing() - 0.5;
        // a centre, but for rounding, is that centre
        let place = if (exact - exact.round()).abs() < 1e-6 { exact.round() } else { exact };
        let place = place.clamp(0.0, (rows - 1) as f64);
        let row = (place.floor() as usize).min(rows.saturating_sub(2));
        let share = place - row as f64;
        let width = domain.cells[0] as usize;
        let mut state = [const { Vec::new() }; 3];
        for along in 0..domain.cells[axis] as usize {
            let cell = |row: usize| if axis == 0 { row * width + along } else { along * width + row };
            let values = |cell: usize| {
                let gone = if gas.kind[cell] & kind::MASK == kind::GAS { 0.0 } else { f64::NAN };
                [gas.density[cell], gas.velocity[cell][axis], gas.pressure[cell]].map(|value| f64::from(value) + gone)
            };
            let (near, far) = (values(cell(row)), values(cell((row + 1).min(rows - 1))));
            for (k, list) in state.iter_mut().enumerate() {
                // a row that does not count must not spoil the one that does
                list.push(match share {
                    0.0 => near[k],
                    1.0 => far[k],
                    _ => (1.0 - share) * near[k] + share * far[k],
                });
            }
        }
        Profile { origin: domain.origin[axis], spacing: domain.spacing(), state }
    }

    /// Mean of a quantity over cells whose centre lies in an interval; not a number if there is none.
    pub fn mean(&self, quantity: usize, [low, high]: [f64; 2]) -> f64 {
        let inside = (0..self.cells()).filter(|k| (low..=high).contains(&self.center(*k)));
        let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), k| (sum + self.state[quantity][k], count + 1.0));
        sum / count
    }

    /// Where a quantity rises most from one cell to the next, in an interval.
    pub fn steepest_rise(&self, quantity: usize, [low, high]: [f64; 2]) -> f64 {
        let values = &self.state[quantity];
        let inside = (0..values.len().saturating_sub(1)).filter(|k| (low..=high).contains(&self.center(*k)));
        let rise = |k: usize| values[k + 1] - values[k];
        let best = inside.filter(|k| rise(*k).is_finite()).max_by(|a, b| rise(*a).total_cmp(&rise(*b)));
        best.map_or(f64::NAN, |k| self.center(k) + 0.5 * self.spacing)
    }
}

/// Slope and offset of the straight line closest to points. [least squares]
pub(in crate::verify) fn fitted_line(points: &[[f64; 2]]) -> [f64; 2] {
    let count = points.len() as f64;
    let mean = [0, 1].map(|k| points.iter().map(|point| point[k]).sum::<f64>() / count);
    let product = |k: usize| points.iter().map(|point| (point[0] - mean[0]) * (point[k] - mean[k])).sum::<f64>();
    let slope = product(1) / product(0);
    [slope, mean[1] - slope * mean[0]]
}

/// Centres of all columns between two x, and where a quantity crosses `level` there last from below.
pub(in crate::verify) fn upper_crossings(
    run: &Run,
    quantity: usize,
    level: f64,
    [low, high]: [f64; 2],
) -> Vec<[f64; 2]> {
    let domain = &run.scene.domain;
    let columns = (0..domain.cells[0]).map(|column| domain.cell_center([column, 0, 0])[0]);
    let found = columns.filter(|x| (low..=high).contains(x)).filter_map(|x| {
        let line = Profile::along(run, 1, x);
        Some([x, line.crossings(quantity, level).rfind(|y| y.is_finite())?])
    });
    found.collect()
}

/// Largest difference of the density between a cell and its mirror image about the diagonal.
pub(in crate::verify) fn asymmetry(run: &Run) -> f64 {
    let n = run.scene.domain.cells[0] as usize;
    let density = |x: usize, y: usize| f64::from(run.snapshot.density[y * n + x]);
    let differences = (0..n).flat_map(|y| (0..y).map(move |x| (density(x, y) - density(y, x)).abs()));
    differences.fold(0.0, f64::max)
}

/// Angle and radius of the outermost points where the pressure crosses `level`, by rows below the diagonal.
pub(in crate::verify) fn front(run: &Run, level: f64) -> Vec<[f64; 2]> {
    let [nx, ny, _] = run.scene.domain.cells.map(|n| n as usize);
    let h = run.scene.domain.spacing();
    let mut points = Vec::new();
    for row in 0..ny {
        let pressure = |x: usize| f64::from(run.snapshot.pressure[row * nx + x]);
        let Some(x) = (0..nx - 1).rev().find(|x| pressure(*x) >= level) else { continue };
        let share = (pressure(x) - level) / (pressure(x) - pressure(x + 1));
        let (x, y) = ((x as f64 + 0.5 + share) * h, (row as f64 + 0.5) * h);
        if y <= x {
            points.push([y.atan2(x).to_degrees(), x.hypot(y)]);
        }
    }
    points
}
