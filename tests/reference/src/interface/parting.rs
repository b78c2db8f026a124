//! Who pays for the work of the pressure where the velocities of two cells part.

use crate::grid::{add, shift, subtract};
use crate::interface::Interface;
use crate::solve::coupled_solve::{H, P, Solution};
use crate::solve::element;
use crate::{GAS, GHOST, Gas, Pair, Problem, SOLID};

/// What the shares follow from: the gas after the pressure has pushed it, its pressures before the solve, what was solved, the
/// velocity of bodies that the power between gas and body is taken with.
pub struct Parting<'a> {
    /// What is solved.
    pub problem: &'a Problem,
    /// Faces between gas and bodies.
    pub interface: &'a Interface,
    /// Gas before the update.
    pub gas: &'a Gas,
    /// Pressure of each cell before the solve, Pa.
    pub pressure: &'a [f64],
    /// What the solve found.
    pub solution: &'a Solution,
    /// Velocity of bodies at each node, m/s.
    pub solid: &'a [[f64; 3]],
    /// Time step, s.
    pub dt: f64,
}

impl Parting<'_> {
    fn kind(&self, c: [i32; 3]) -> u32 {
        self.interface.cells[self.problem.grid.slot(c)]
    }

    fn speed(&self, slot: usize, axis: usize) -> f64 {
        self.gas.velocity(slot)[axis]
    }

    /// Power through the face of two gas cells beside that of its velocity: each pays in proportion to its pressure, not to the mass of
    /// the other.
    pub fn shift_between(&self, p: f64, axis: usize, low: usize, high: usize) -> f64 {
        if self.problem.materials.is_empty() {
            return 0.0;
        }
        let jump = (self.speed(high, axis) - self.speed(low, axis)).max(0.0);
        let mass = self.gas.conserved[high][0] / (self.gas.conserved[low][0] + self.gas.conserved[high][0]);
        p * jump * (self.pressure[low] / (self.pressure[low] + self.pressure[high]) - mass)
    }

    /// Velocity of a body beyond the face of gas cell c, as the vertex v sees it.
    fn body_speed(&self, v: [i32; 3], c: [i32; 3], axis: usize, beyond: [i32; 3]) -> f64 {
        let grid = &self.problem.grid;
        let overlap = element::overlap(Pair::B2b1);
        let (mut sum, mut weights) = (0.0, 0.0);
        for off in grid.offsets(-1, 1).into_iter().filter(|off| off[axis] == 0) {
            let weight = element::tangential(grid, &overlap, axis, off, subtract(v, c));
            let nodes = [c, beyond].map(|at| self.solid[grid.slot(add(at, off))][axis]);
            sum += weight * 0.5 * (nodes[0] + nodes[1]);
            weights += weight;
        }
        sum / weights
    }

    /// What gas cell c would pay at vertex v beyond its own pressure, for all of its faces there.
    fn beyond(&self, v: [i32; 3], c: [i32; 3]) -> f64 {
        let grid = &self.problem.grid;
        let (own, slot) = (self.pressure[grid.slot(c)], grid.slot(c));
        let mut sum = 0.0;
        for axis in 0..grid.dimension {
            let sign = if v[axis] > c[axis] { 1 } else { -1 };
            let other = shift(c, axis, sign);
            let far = grid.slot(other);
            let solved = |field: usize| self.solution.pressure[field][grid.slot(v)];
            let (excess, there) = match self.kind(other) {
                GHOST => continue,
                GAS => {
                    let both = own + self.pressure[far];
                    ((solved(P) - both).max(0.0) * own / both, self.speed(far, axis))
                }
                SOLID => ((solved(H) - 2.0 * own).max(0.0), self.body_speed(v, c, axis, other)),
                _ => ((solved(P) - 2.0 * own).max(0.0), 0.0),
            };
            sum += excess * (f64::from(sign) * (there - self.speed(slot, axis))).max(0.0);
        }
        sum / f64::from(1 << (grid.dimension - 1))
    }

    /// Whether a cell is gas with gas beside it at a vertex.
    fn takes_part(&self, v: [i32; 3], c: [i32; 3]) -> bool {
        let beside = |axis: usize| self.kind(shift(c, axis, if v[axis] > c[axis] { 1 } else { -1 })) == GAS;
        self.kind(c) == GAS && (0..self.problem.grid.dimension).any(beside)
    }

    /// What a vertex may ask over the sum of the pressures around it: at all vertices of a cell together half of its internal energy.
    fn most_asked(&self) -> f64 {
        let vertices = f64::from(1 << self.problem.grid.dimension);
        0.5 * self.problem.grid.spacing / (vertices * (self.problem.gamma - 1.0) * self.dt)
    }

    /// Power that each cell gets back at its vertices less what it pays there in proportion to its pressure, per area of a face; and how many
    /// vertices get less than they ask.
    pub fn heat_at_vertices(&self) -> (Vec<f64>, usize) {
        let grid = &self.problem.grid;
        let (mut heat, mut limited) = (vec![0.0; grid.slots()], 0);
        if self.problem.materials.is_empty() {
            return (heat, limited);
        }
        for v in grid.vertices() {
            let around = grid.offsets(0, 1).into_iter().map(|corner| subtract(v, corner));
            let payers: Vec<_> = around.filter(|c| self.takes_part(v, *c)).collect();
            let asked: Vec<f64> = payers.iter().map(|c| self.beyond(v, *c)).collect();
            let all: f64 = payers.iter().map(|c| self.pressure[grid.slot(*c)]).sum();
            let wanted: f64 = asked.iter().sum();
            let most = self.most_asked() * all;
            limited += usize::from(wanted > most);
            let share = if wanted > most { most / wanted } else { 1.0 };
            for (c, back) in payers.iter().zip(&asked) {
                heat[grid.slot(*c)] += share * (back - self.pressure[grid.slot(*c)] / all * wanted);
            }
        }
        (heat, limited)
    }
}
