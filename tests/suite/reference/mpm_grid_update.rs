//! Node velocities of the solid: elastic forces, walls, film, gravity.

use super::grid::shift;
use super::p2g::Nodes;
use super::{Problem, Side, WALL};

/// Adds dt f/m.
pub(crate) fn add_forces(velocity: &mut [[f64; 3]], mass: &[f64], force: &[[f64; 3]], dt: f64) {
    for ((v, m), f) in velocity.iter_mut().zip(mass).zip(force).filter(|((_, m), _)| **m > 0.0) {
        *v = [0, 1, 2].map(|d| v[d] + dt * f[d] / m);
    }
}

/// Adds gravity on nodes with mass.
pub(crate) fn add_gravity(problem: &Problem, nodes: &mut Nodes, dt: f64) {
    for (v, _) in nodes.velocity.iter_mut().zip(&nodes.mass).filter(|(_, mass)| **mass > 0.0) {
        for (v, gravity) in v.iter_mut().zip(problem.gravity).take(problem.grid.dimension) {
            *v += dt * gravity;
        }
    }
}

/// One-sided walls: no outward normal velocity beyond a wall side, none into an obstacle.
pub(crate) fn walls(problem: &Problem, cells: &[u32], velocity: &mut [[f64; 3]]) {
    let grid = &problem.grid;
    for c in grid.all() {
        let slot = grid.slot(c);
        let wall = |at: [i32; 3]| grid.stored(at) && cells[grid.slot(at)] == WALL;
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
                    (true, true) => *v = 0.0,
                    (false, false) => {}
                }
            }
        }
    }
}
