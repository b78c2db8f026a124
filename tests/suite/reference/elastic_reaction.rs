//! The part of the elastic force that bears the load of a node, and the impulse that the elastic sub-steps share.

use super::coupled_solve::{Inputs, assemble};
use super::grid::{Grid, add, shift};
use super::mpm_grid_update::walls;
use super::p2g::Nodes;
use super::{Problem, SOLID, interface};

/// Most that is taken for the reaction to a load, and that a node takes of an impulse as its mass moves on: times that.
const MOST: f64 = 2.0;

type Vectors = Vec<[f64; 3]>;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// (V . grad) V by differences between nodes with mass.
fn carried_away(grid: &Grid, mass: &[f64], velocity: &[[f64; 3]], c: [i32; 3]) -> [f64; 3] {
    let own = velocity[grid.slot(c)];
    let mut sum = [0.0; 3];
    for axis in 0..grid.dimension {
        let sides = [-1, 1].map(|side| (f64::from(side), shift(c, axis, side)));
        let near: Vec<_> = sides.into_iter().filter(|(_, at)| grid.stored(*at) && mass[grid.slot(*at)] > 0.0).collect();
        for (side, at) in &near {
            let other = velocity[grid.slot(*at)];
            for d in 0..3 {
                sum[d] += own[axis] * side * (other[d] - own[d]) / (near.len() as f64 * grid.spacing);
            }
        }
    }
    sum
}

/// Acceleration of the solid nodes by the pressures before the solve.
fn pressed(inputs: &Inputs) -> Vectors {
    let system = assemble(inputs);
    let mut push = vec![[0.0; 3]; inputs.nodes.mass.len()];
    for (row, force) in system.rows.iter().zip(system.force(&system.start)).filter(|(row, _)| row.solid) {
        push[row.node][row.axis] = -force / row.mass;
    }
    push
}

/// The reaction e. `inputs` has the nodes with films and gravity, `start` their velocity before; `inertia` is the mass of the solve.
pub(crate) fn reaction(inputs: &Inputs, start: &[[f64; 3]], inertia: &[f64]) -> Vectors {
    let (problem, nodes, dt) = (inputs.problem, inputs.nodes, inputs.dt);
    let (grid, cells) = (&problem.grid, &inputs.interface.cells);
    let elastic = |slot: usize| nodes.force[slot].map(|f| f / inertia[slot]);
    let free = |slot: usize| nodes.mass[slot] > 0.0;
    if problem.numerics.shared_volume {
        return (0..nodes.mass.len()).map(|slot| if free(slot) { elastic(slot) } else { [0.0; 3] }).collect();
    }
    let push = pressed(inputs);
    let mut moved = nodes.velocity.clone();
    for c in grid.all() {
        let slot = grid.slot(c);
        let solid = interface::elements_of(problem, c).any(|(cell, _)| cells[grid.slot(cell)] == SOLID);
        let load = [0, 1, 2].map(|d| (nodes.velocity[slot][d] - start[slot][d]) / dt + push[slot][d]);
        if !free(slot) || !solid || load == [0.0; 3] {
            continue;
        }
        let away = carried_away(grid, &nodes.mass, start, c);
        let seen = [0, 1, 2].map(|d| elastic(slot)[d] - away[d]);
        let share = (-dot(seen, load) / dot(load, load)).clamp(0.0, MOST);
        moved[slot] = [0, 1, 2].map(|d| moved[slot][d] - dt * share * load[d]);
    }
    let before = moved.clone();
    walls(problem, cells, &mut moved);
    let solid = |c: [i32; 3]| interface::elements_of(problem, c).any(|(cell, _)| cells[grid.slot(cell)] == SOLID);
    for c in grid.all().into_iter().filter(|c| !solid(*c)) {
        moved[grid.slot(c)] = before[grid.slot(c)];
    }
    let gain = |slot: usize| [0, 1, 2].map(|d| (moved[slot][d] - nodes.velocity[slot][d]) / dt);
    (0..moved.len()).map(|slot| if free(slot) { gain(slot) } else { [0.0; 3] }).collect()
}

/// What is spread over the sub-steps: acceleration of the nodes and the masses it is for.
pub(crate) struct Spread {
    pub(crate) push: Vectors,
    pub(crate) mass: Vec<f64>,
}

impl Spread {
    /// Velocity of the nodes, whose masses are those of now, by a sub-step's share.
    pub(crate) fn kick(&self, problem: &Problem, nodes: &mut Nodes, time: f64) {
        let grid = &problem.grid;
        for (slot, mass) in nodes.mass.iter().enumerate().filter(|(_, mass)| **mass > 0.0) {
            let share = time * (self.mass[slot] / mass).min(MOST);
            nodes.velocity[slot] = [0, 1, 2].map(|d| nodes.velocity[slot][d] + share * self.push[slot][d]);
        }
        for c in grid.all() {
            let slot = grid.slot(c);
            let left = self.mass[slot] - MOST * nodes.mass[slot];
            if left <= 0.0 {
                continue;
            }
            let near = grid.offsets(-1, 1).into_iter().map(|o| add(c, o)).filter(|at| grid.stored(*at));
            let near: Vec<usize> = near.map(|at| grid.slot(at)).filter(|at| nodes.mass[*at] > 0.0).collect();
            let around: f64 = near.iter().map(|at| nodes.mass[*at]).sum();
            for at in near {
                let gain = [0, 1, 2].map(|d| time * left / around * self.push[slot][d]);
                nodes.velocity[at] = [0, 1, 2].map(|d| nodes.velocity[at][d] + gain[d]);
            }
        }
    }
}
