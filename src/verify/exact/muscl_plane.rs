//! The solver of [`muscl`](super::muscl) in the plane: both directions at once, every side lets through what reaches it. A velocity along
//! a face goes with the mass that passes the face. [Toro 2009, sections 10.4 and 16.4]

use rayon::prelude::*;

use super::muscl::{COURANT, GHOSTS, IdealGas, limited_slope};
use crate::scene::Scene;

/// Density, momentum along x and y, energy, per volume.
type Cell = [f64; 4];
/// Density, velocity along a line and across it, pressure.
type State = [f64; 4];

/// Density at the end of a 2D scene, x fastest.
pub fn solve(scene: &Scene) -> Vec<f64> {
    let start = scene.initial_gas().into_iter().map(|cell| [cell[0], cell[1], cell[2], cell[4]]);
    let plane = Plane {
        gas: IdealGas { gamma: scene.gas.gamma },
        spacing: scene.domain.spacing(),
        width: scene.domain.cells[0] as usize,
    };
    let mut cells: Vec<Cell> = start.collect();
    let mut time = 0.0;
    while time < scene.time.until {
        let dt = plane.time_step(&cells).min(scene.time.until - time);
        // Heun's method: the mean of the start and of two Euler steps
        let twice = plane.euler_step(&plane.euler_step(&cells, dt), dt);
        cells = cells.iter().zip(&twice).map(|(a, b)| std::array::from_fn(|k| 0.5 * (a[k] + b[k]))).collect();
        time = if dt == scene.time.until - time { scene.time.until } else { time + dt };
    }
    cells.iter().map(|cell| cell[0]).collect()
}

struct Plane {
    gas: IdealGas,
    spacing: f64,
    width: usize,
}

impl Plane {
    fn state(&self, &[density, x, y, energy]: &Cell) -> State {
        let pressure = (self.gas.gamma - 1.0) * (energy - 0.5 * (x * x + y * y) / density);
        [density, x / density, y / density, pressure]
    }

    fn time_step(&self, cells: &[Cell]) -> f64 {
        let speed = |cell: &Cell| {
            let [density, u, v, pressure] = self.state(cell);
            u.abs().max(v.abs()) + (self.gas.gamma * pressure / density).sqrt()
        };
        COURANT * self.spacing / cells.par_iter().map(speed).reduce(|| 0.0, f64::max)
    }

    fn euler_step(&self, cells: &[Cell], dt: f64) -> Vec<Cell> {
        let (width, height) = (self.width, cells.len() / self.width);
        let turned = |[a, b, c, d]: [f64; 4]| [a, c, b, d];
        let row = |y: usize| cells[y * width..(y + 1) * width].iter().map(|cell| self.state(cell)).collect::<Vec<_>>();
        let column = |x: usize| (0..height).map(|y| turned(self.state(&cells[y * width + x]))).collect::<Vec<_>>();
        let along: Vec<Vec<Cell>> = (0..height).into_par_iter().map(|y| self.changes(&row(y))).collect();
        let across: Vec<Vec<Cell>> = (0..width).into_par_iter().map(|x| self.changes(&column(x))).collect();
        let changed = |(index, cell): (usize, &Cell)| -> Cell {
            let (x, y) = (index % width, index / width);
            let other = turned(across[x][y]);
            std::array::from_fn(|k| cell[k] + dt / self.spacing * (along[y][x][k] + other[k]))
        };
        cells.iter().enumerate().map(changed).collect()
    }

    /// What the faces of each cell of a line bring it, times the length of a cell over the time.
    fn changes(&self, line: &[State]) -> Vec<Cell> {
        let inside = |k: usize| line[k.saturating_sub(GHOSTS).min(line.len() - 1)];
        let states: Vec<State> = (0..line.len() + 2 * GHOSTS).map(inside).collect();
        let slopes: Vec<State> = states.windows(3).map(limited_slope).collect();
        let fluxes: Vec<Cell> = (1..states.len() - 2)
            .map(|k| {
                let left = std::array::from_fn(|i| states[k][i] + 0.5 * slopes[k - 1][i]);
                let right = std::array::from_fn(|i| states[k + 1][i] - 0.5 * slopes[k][i]);
                self.flux(left, right)
            })
            .collect();
        fluxes.windows(2).map(|pair| std::array::from_fn(|k| pair[0][k] - pair[1][k])).collect()
    }

    fn flux(&self, left: State, right: State) -> Cell {
        let [mass, momentum, energy] = self.gas.hllc([left[0], left[1], left[3]], [right[0], right[1], right[3]]);
        let across = if mass >= 0.0 { left[2] } else { right[2] };
        [mass, momentum, mass * across, energy + 0.5 * mass * across * across]
    }
}
