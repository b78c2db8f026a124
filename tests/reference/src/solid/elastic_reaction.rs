//! The part of the elastic force that bears the load of a node, and the impulse that the elastic sub-steps share.

use crate::grid::{Grid, add, shift};
use crate::solid::mpm_grid_update::walls;
use crate::solid::p2g::Nodes;
use crate::solve::coupled_solve::{Inputs, assemble};
use crate::{Problem, SOLID, interface};

/// Most that is taken for the reaction to a load, and that a node takes of an impulse as its mass moves on: times that.
const MOST: f64 = 2.0;
/// Share of the mass around a node of a body from which on its velocity is all its own.
const OWN_MASS: f64 = 1e-4;

type Vectors = Vec<[f64; 3]>;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Nodes of bodies with next to no mass move with those around them; not where elasticity comes first.
pub fn fill(problem: &Problem, cells: &[u32], nodes: &mut Nodes) {
    if problem.numerics.coupling_last {
        return;
    }
    let grid = &problem.grid;
    let start = nodes.velocity.clone();
    for c in grid.all().into_iter().filter(|c| is_solid(problem, cells, *c)) {
        let slot = grid.slot(c);
        let near = grid.offsets(-1, 1).into_iter().map(|o| add(c, o)).filter(|at| grid.stored(*at));
        let near: Vec<usize> = near.map(|at| grid.slot(at)).collect();
        let around: f64 = near.iter().map(|at| nodes.mass[*at]).sum();
        let own = (nodes.mass[slot] / (OWN_MASS * around)).min(1.0);
        if around > 0.0 {
            let mean = |d: usize| near.iter().map(|at| nodes.mass[*at] * start[*at][d]).sum::<f64>() / around;
            nodes.velocity[slot] = [0, 1, 2].map(|d| own * start[slot][d] + (1.0 - own) * mean(d));
        }
    }
}

fn is_solid(problem: &Problem, cells: &[u32], node: [i32; 3]) -> bool {
    interface::elements_of(problem, node).any(|(cell, _)| cells[problem.grid.slot(cell)] == SOLID)
}

/// (V . grad) V by differences between nodes, of which lighter ones count by their mass.
fn carried_away(grid: &Grid, mass: &[f64], velocity: &[[f64; 3]], c: [i32; 3]) -> [f64; 3] {
    let own = velocity[grid.slot(c)];
    let mut sum = [0.0; 3];
    for axis in 0..grid.dimension {
        let sides = [-1, 1].map(|side| (f64::from(side), shift(c, axis, side)));
        let near = sides.into_iter().filter(|(_, at)| grid.stored(*at)).map(|(side, at)| (side, grid.slot(at)));
        let near: Vec<_> = near.map(|(side, at)| (side, at, (mass[at] / mass[grid.slot(c)]).min(1.0))).collect();
        let count = near.iter().map(|(_, _, weight)| weight).sum::<f64>().max(1.0);
        for (side, at, weight) in near {
            for d in 0..3 {
                sum[d] += own[axis] * side * weight * (velocity[at][d] - own[d]) / (count * grid.spacing);
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
pub fn reaction(inputs: &Inputs, start: &[[f64; 3]], inertia: &[f64]) -> Vectors {
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
        let load = [0, 1, 2].map(|d| (nodes.velocity[slot][d] - start[slot][d]) / dt + push[slot][d]);
        if !free(slot) || !is_solid(problem, cells, c) || load == [0.0; 3] {
            continue;
        }
        let away = carried_away(grid, &nodes.mass, start, c);
        let seen = [0, 1, 2].map(|d| (nodes.force[slot][d] - nodes.mass[slot] * away[d]) / inertia[slot]);
        let share = (-dot(seen, load) / dot(load, load)).clamp(0.0, MOST);
        moved[slot] = [0, 1, 2].map(|d| moved[slot][d] - dt * share * load[d]);
    }
    let before = moved.clone();
    walls(problem, cells, &mut moved);
    for c in grid.all().into_iter().filter(|c| !is_solid(problem, cells, *c)) {
        moved[grid.slot(c)] = before[grid.slot(c)];
    }
    let gain = |slot: usize| [0, 1, 2].map(|d| (moved[slot][d] - nodes.velocity[slot][d]) / dt);
    (0..moved.len()).map(|slot| if free(slot) { gain(slot) } else { [0.0; 3] }).collect()
}

/// What is spread over the sub-steps: acceleration of the nodes and the masses it is for.
pub struct Spread {
    /// Acceleration of each node, m/s^2.
    pub push: Vectors,
    /// Mass of each node that it is for, kg.
    pub mass: Vec<f64>,
}

impl Spread {
    /// Velocity of the nodes, whose masses are those of now, by a sub-step's share.
    pub fn kick(&self, problem: &Problem, nodes: &mut Nodes, time: f64) {
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
