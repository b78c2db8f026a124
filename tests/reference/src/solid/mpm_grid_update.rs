//! Node velocities of the solid: elastic forces, walls, film, gravity.

use crate::grid::{add, shift};
use crate::solid::p2g::Nodes;
use crate::{Problem, Side, WALL};

/// Adds dt f/m.
pub fn add_forces(velocity: &mut [[f64; 3]], mass: &[f64], force: &[[f64; 3]], dt: f64) {
    for ((v, m), f) in velocity.iter_mut().zip(mass).zip(force).filter(|((_, m), _)| **m > 0.0) {
        *v = [0, 1, 2].map(|d| v[d] + dt * f[d] / m);
    }
}

/// What nodes lighter than the floor of the solve leave of a kick goes to the nodes around them, by mass.
pub fn share_left(problem: &Problem, mass: &[f64], inertia: &[f64], kick: &[[f64; 3]], velocity: &mut [[f64; 3]]) {
    let grid = &problem.grid;
    let mut gain = vec![[0.0; 3]; mass.len()];
    for c in grid
        .all()
        .into_iter()
        .filter(|c| mass[grid.slot(*c)] < inertia[grid.slot(*c)] && kick[grid.slot(*c)] != [0.0; 3])
    {
        let slot = grid.slot(c);
        let near = grid.offsets(-1, 1).into_iter().map(|o| add(c, o)).filter(|at| grid.stored(*at));
        let near: Vec<usize> = near.map(|at| grid.slot(at)).filter(|at| mass[*at] > 0.0).collect();
        let total: f64 = near.iter().map(|at| mass[*at]).sum();
        for at in near {
            gain[at] = [0, 1, 2].map(|d| gain[at][d] + kick[slot][d] * (inertia[slot] - mass[slot]) / total);
        }
    }
    for (v, gain) in velocity.iter_mut().zip(gain) {
        *v = [0, 1, 2].map(|d| v[d] + gain[d]);
    }
}

/// Adds gravity on nodes with mass.
pub fn add_gravity(problem: &Problem, nodes: &mut Nodes, dt: f64) {
    for (v, _) in nodes.velocity.iter_mut().zip(&nodes.mass).filter(|(_, mass)| **mass > 0.0) {
        for (v, gravity) in v.iter_mut().zip(problem.gravity).take(problem.grid.dimension) {
            *v += dt * gravity;
        }
    }
}

/// One-sided walls: no outward normal velocity beyond a wall side, none into an obstacle.
pub fn walls(problem: &Problem, cells: &[u32], velocity: &mut [[f64; 3]]) {
    let grid = &problem.grid;
    for c in grid.all() {
        let slot = grid.slot(c);
        let wall = |at: [i32; 3]| grid.stored(at) && cells[grid.slot(at)] == WALL;
        let surface = (0..grid.dimension).any(|axis| !wall(shift(c, axis, -1)) || !wall(shift(c, axis, 1)));
        for axis in 0..grid.dimension {
            let v = &mut velocity[slot][axis];
            if c[axis] < 0 || c[axis] >= grid.cells[axis] {
                let upper = c[axis] >= 0;
                if matches!(problem.sides[2 * axis + usize::from(upper)], Side::Wall) {
                    *v = if upper { v.min(0.0) } else { v.max(0.0) };
                }
            } else if grid.contains(c) && wall(c) {
                match (wall(shift(c, axis, -1)), wall(shift(c, axis, 1))) {
                    (false, true) => *v = v.min(0.0),
                    (true, false) => *v = v.max(0.0),
                    (true, true) if !surface => *v = 0.0,
                    _ => {}
                }
            }
        }
    }
}
