//! The velocity that carries the gas through its faces: what the pressure solve sees of it. Gas only.

use crate::grid::{add, shift};
use crate::{GAS, GHOST, Gas, Pair, Problem, WALL, boundary, internal_energy};

/// Per cell: velocity averaged over the other axes, and the sum of its differences across the faces.
pub struct Carrier {
    /// Velocity of each cell that carries its gas, m/s.
    pub velocity: Vec<[f64; 3]>,
    divergence: Vec<f64>,
    /// Share of the difference of the divergences that the faces get back.
    given_back: f64,
}

fn velocity_at(problem: &Problem, cells: &[u32], gas: &Gas, c: [i32; 3], offset: [i32; 3]) -> [f64; 3] {
    let grid = &problem.grid;
    let at = add(c, offset);
    let slot = grid.slot(at);
    if cells[slot] == GAS {
        return gas.velocity(slot);
    }
    if let Some(velocity) = Some(at).filter(|_| cells[slot] == GHOST).and_then(|at| boundary::prescribed(problem, at)) {
        return velocity;
    }
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for axis in (0..grid.dimension).filter(|axis| offset[*axis] != 0) {
        let mut nearer = offset;
        nearer[axis] = 0;
        let slot = grid.slot(add(c, nearer));
        if nearer != [0; 3] && cells[slot] == GAS {
            let v = gas.velocity(slot);
            sum = [0, 1, 2].map(|d| sum[d] + v[d]);
            count += 1.0;
        }
    }
    if count > 0.0 { sum.map(|s| s / count) } else { gas.velocity(grid.slot(c)) }
}

impl Carrier {
    /// Of a state, or None where the cells' own velocities carry.
    pub fn new(problem: &Problem, cells: &[u32], gas: &Gas) -> Option<Self> {
        if !problem.numerics.consistent {
            return None;
        }
        let grid = &problem.grid;
        let given_back = match problem.numerics.pair {
            Pair::B1b0 if problem.numerics.fourth => 1.0 / 3.0,
            Pair::B2b1 if problem.numerics.fourth => 0.16,
            Pair::B1b0 => 0.25,
            Pair::B2b1 if problem.numerics.two_solves => 1.0 / 12.0,
            Pair::B2b1 => 0.23,
        };
        let (velocity, divergence) = (vec![[0.0; 3]; grid.slots()], vec![0.0; grid.slots()]);
        let mut carrier = Self { velocity, divergence, given_back };
        let inside: Vec<_> = grid.interior().into_iter().filter(|c| cells[grid.slot(*c)] == GAS).collect();
        for c in &inside {
            for axis in 0..grid.dimension {
                for offset in grid.offsets(-1, 1).into_iter().filter(|offset| offset[axis] == 0) {
                    let others = (0..grid.dimension).filter(|d| *d != axis);
                    let share: f64 = others.map(|d| if offset[d] == 0 { 0.5 } else { 0.25 }).product();
                    carrier.velocity[grid.slot(*c)][axis] += share * velocity_at(problem, cells, gas, *c, offset)[axis];
                }
            }
        }
        for c in grid.all().into_iter().filter(|c| cells[grid.slot(*c)] == GHOST) {
            let nearest = boundary::nearest(problem, c);
            carrier.velocity[grid.slot(c)] = boundary::prescribed(problem, c).unwrap_or(carrier.velocity[nearest]);
        }
        for (cell, axis, upper) in boundary::open_faces(problem, cells) {
            let ring = boundary::behind(problem, (cell, axis, upper));
            carrier.velocity[ring][axis] += gas.surplus.get(&ring).copied().unwrap_or(0.0);
        }
        let mut divergence = vec![0.0; grid.slots()];
        for c in &inside {
            for axis in 0..grid.dimension {
                for normal in [-1, 1] {
                    let (own, other) = (grid.slot(*c), grid.slot(shift(*c, axis, normal)));
                    let face = match cells[other] {
                        WALL => 0.0,
                        GHOST => carrier.velocity[other][axis],
                        _ => carrier.between(gas, axis, own, other),
                    };
                    divergence[own] += f64::from(normal) * face;
                }
            }
        }
        carrier.divergence = divergence;
        Some(carrier)
    }

    /// Velocity of the face between two gas cells.
    pub fn between(&self, gas: &Gas, axis: usize, low: usize, high: usize) -> f64 {
        let (a, b) = (gas.conserved[low][0], gas.conserved[high][0]);
        let mean = (a * self.velocity[low][axis] + b * self.velocity[high][axis]) / (a + b);
        mean - self.given_back * (self.divergence[high] - self.divergence[low])
    }

    /// Sum of the differences of the face velocities of a gas cell.
    pub fn corrected_divergence(&self, problem: &Problem, cells: &[u32], c: [i32; 3]) -> f64 {
        self.divergence[problem.grid.slot(c)] - self.given_back * self.shortfall(problem, cells, c)
    }

    /// What of it the solve does not see; but for sound of fourth order that is left as it is.
    pub fn unseen_divergence(&self, problem: &Problem, cells: &[u32], c: [i32; 3]) -> f64 {
        let seen = match problem.numerics.pair {
            _ if !problem.numerics.fourth => self.given_back,
            Pair::B1b0 => 0.25,
            Pair::B2b1 => 1.0 / 12.0,
        };
        (seen - self.given_back) * self.shortfall(problem, cells, c)
    }

    /// Sum over the neighbours of what their divergence exceeds that of a gas cell.
    fn shortfall(&self, problem: &Problem, cells: &[u32], c: [i32; 3]) -> f64 {
        let grid = &problem.grid;
        let own = self.divergence[grid.slot(c)];
        let neighbours = (0..grid.dimension).flat_map(|axis| [-1, 1].map(|by| grid.slot(shift(c, axis, by))));
        neighbours.filter(|n| cells[*n] == GAS).map(|n| self.divergence[n] - own).sum::<f64>()
    }
}

/// Density, velocity and internal energy of a state.
pub fn primitive_of(u: [f64; 5]) -> [f64; 5] {
    [u[0], u[1] / u[0], u[2] / u[0], u[3] / u[0], internal_energy(u)]
}

/// And back.
pub fn conserved_of(p: [f64; 5]) -> [f64; 5] {
    let kinetic = 0.5 * p[0] * (p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    [p[0], p[0] * p[1], p[0] * p[2], p[0] * p[3], p[4] + kinetic]
}
