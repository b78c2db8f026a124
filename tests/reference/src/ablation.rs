//! The other forms of the coupling: local gradients, elasticity before the solve, shared volume.

use crate::grid::{add, shift};
use crate::interface::elements_of;
use crate::solid::mpm_grid_update::{add_forces, walls};
use crate::solid::p2g::Nodes;
use crate::solve::coupled_solve::{H, Inputs, P, Q, Solution};
use crate::solve::element;
use crate::{GAS, GHOST, Pair, Particle, Problem, SOLID, WALL};

/// Acceleration of a node by the gradient of its own cell; None at walls, which keep the forces of the solve.
pub fn local_gradient(inputs: &Inputs, pressure: &[Vec<f64>; 3], c: [i32; 3], mass: f64) -> Option<[f64; 3]> {
    let (problem, cells) = (inputs.problem, &inputs.interface.cells);
    let grid = &problem.grid;
    let kind = |at: [i32; 3]| if grid.stored(at) { cells[grid.slot(at)] } else { WALL };
    if grid.offsets(-1, 1).into_iter().any(|o| matches!(kind(add(c, o)), WALL | GHOST)) {
        return None;
    }
    let solid = elements_of(problem, c).filter(|(cell, _)| cells[grid.slot(*cell)] == SOLID);
    let share: f64 = solid.map(|(_, offset)| element::node_weight(grid, Pair::B2b1, offset)).sum();
    let own = kind(c);
    let mut push = [0.0; 3];
    for axis in 0..grid.dimension {
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let across = kind(shift(c, axis, 2 * side - 1));
            let field = match (own, across) {
                (GAS, SOLID) | (SOLID, GAS) => H,
                (SOLID, _) => Q,
                _ => P,
            };
            let corners: Vec<_> = grid.offsets(0, 1).into_iter().filter(|k| k[axis] == side).collect();
            let mean =
                corners.iter().map(|k| pressure[field][grid.slot(add(c, *k))]).sum::<f64>() / corners.len() as f64;
            push[axis] += sign * mean;
        }
    }
    Some(push.map(|difference| -difference * grid.area() * share / mass))
}

/// Replaces the pressure kick of all nodes that have a local gradient.
pub fn by_gradients(inputs: &Inputs, solution: &mut Solution, inertia: &[f64]) {
    let grid = &inputs.problem.grid;
    for c in grid.all() {
        let slot = grid.slot(c);
        let touches = elements_of(inputs.problem, c).any(|(cell, _)| inputs.interface.cells[grid.slot(cell)] == SOLID);
        if !touches {
            continue;
        }
        if let Some(push) = local_gradient(inputs, &solution.pressure, c, inertia[slot]) {
            solution.solid_velocity[slot] = [0, 1, 2].map(|d| inputs.nodes.velocity[slot][d] + inputs.dt * push[d]);
        }
    }
}

/// The whole elastic step before the solve.
pub fn elastic_first(problem: &Problem, cells: &[u32], nodes: &mut Nodes, dt: f64) {
    if problem.numerics.coupling_last {
        add_forces(&mut nodes.velocity, &nodes.mass, &nodes.force, dt);
        walls(problem, cells, &mut nodes.velocity);
    }
}

/// Shared volume: the ghost pressure goes to that of the law's volumetric part, within the time a wave takes for ten cells.
pub fn relax(problem: &Problem, particle: &mut Particle, dt: f64) {
    let material = &problem.materials[particle.material];
    let volume = particle.deformation.determinant();
    let swollen = problem.ambient.1 - material.lambda * volume.ln() / volume;
    let speed = material.wave_speed(particle.deformation, particle.mass / particle.volume0);
    let share = -(-dt * speed / (10.0 * problem.grid.spacing)).exp_m1();
    particle.ghost_pressure += share * (swollen - particle.ghost_pressure);
}
