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
        for axis in 0..grid.dimension {
            let v = &mut velocity[grid.slot(c)][axis];
            if (c[axis] < 0 || c[axis] >= grid.cells[axis]) && is_wall(problem, axis, c[axis] >= 0) {
                *v = if c[axis] >= 0 { v.min(0.0) } else { v.max(0.0) };
            }
        }
    }
    obstacles(problem, cells, velocity);
}

/// Walls of the sub-steps: at a wall side the mean of the nodes on both sides of it does not go outward, in an obstacle no node.
pub fn wall_faces(problem: &Problem, cells: &[u32], mass: &[f64], velocity: &mut [[f64; 3]]) {
    let grid = &problem.grid;
    for (axis, upper) in (0..grid.dimension).flat_map(|axis| [(axis, false), (axis, true)]) {
        if !is_wall(problem, axis, upper) {
            continue;
        }
        let (last, way) = if upper { (grid.cells[axis] - 1, 1) } else { (0, -1) };
        for c in grid.all().into_iter().filter(|c| c[axis] == last) {
            let pair = [c, shift(c, axis, way)].map(|at| grid.slot(at));
            let outward: f64 =
                pair.iter().filter(|at| mass[**at] > 0.0).map(|at| f64::from(way) * velocity[*at][axis]).sum();
            if outward <= 0.0 || mass[pair[1]] <= 0.0 {
                continue;
            }
            let mobility = pair.map(|at| if mass[at] > 0.0 { 1.0 / mass[at] } else { 0.0 });
            let impulse = -f64::from(way) * outward / (mobility[0] + mobility[1]);
            pair.into_iter().zip(mobility).for_each(|(at, mobility)| velocity[at][axis] += impulse * mobility);
        }
    }
    obstacles(problem, cells, velocity);
}

fn is_wall(problem: &Problem, axis: usize, upper: bool) -> bool {
    matches!(problem.sides[2 * axis + usize::from(upper)], Side::Wall)
}

/// No node moves into an obstacle.
fn obstacles(problem: &Problem, cells: &[u32], velocity: &mut [[f64; 3]]) {
    let grid = &problem.grid;
    for c in grid.all().into_iter().filter(|c| grid.contains(*c)) {
        let slot = grid.slot(c);
        let wall = |at: [i32; 3]| grid.stored(at) && cells[grid.slot(at)] == WALL;
        let surface = (0..grid.dimension).any(|axis| !wall(shift(c, axis, -1)) || !wall(shift(c, axis, 1)));
        for axis in (0..grid.dimension).filter(|_| wall(c)) {
            let v = &mut velocity[slot][axis];
            match (wall(shift(c, axis, -1)), wall(shift(c, axis, 1))) {
                (false, true) => *v = v.min(0.0),
                (true, false) => *v = v.max(0.0),
                (true, true) if !surface => *v = 0.0,
                _ => {}
            }
        }
    }
}
