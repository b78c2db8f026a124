//! Backward Euler for the nodes of the solids: M (V^ - V) + dt f(V) = 0 by Newton's method with a dense Jacobian from differences.

use crate::solid::mpm_grid_update::walls;
use crate::solid::p2g::{Nodes, support};
use crate::solid::particle_sort::linear_weights;
use crate::{Particle, Problem};
use glam::{DMat3, DVec3};

/// Elastic force if the nodes move with these velocities for dt; `change`: that of the ghost pressure at vertices.
fn force(
    problem: &Problem,
    velocity: &[[f64; 3]],
    (particles, change): (&[Particle], &[f64]),
    dt: f64,
) -> Vec<[f64; 3]> {
    let grid = &problem.grid;
    let mut force = vec![[0.0; 3]; grid.slots()];
    for particle in particles.iter().filter(|particle| particle.active) {
        let nodes = support(grid, particle.position);
        let mut gradient = DMat3::ZERO;
        for s in &nodes {
            let v = DVec3::from_array(velocity[grid.slot(s.node)]);
            gradient += DMat3::from_cols(v * s.gradient.x, v * s.gradient.y, v * s.gradient.z);
        }
        let trial = particle.deformation + gradient * particle.deformation * dt;
        let material = &problem.materials[particle.material];
        let rise: f64 = linear_weights(grid, particle.position).iter().map(|(v, w)| w * change[grid.slot(*v)]).sum();
        let (f, q) = (material.plastic_return(trial).0, particle.ghost_pressure + rise);
        let stress = problem.stress(particle, f, q) * particle.volume0;
        for s in &nodes {
            let push = stress * s.gradient;
            (0..grid.dimension).for_each(|d| force[grid.slot(s.node)][d] -= push[d]);
        }
    }
    force
}

/// Solves a dense system by elimination with row exchange.
fn eliminate(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).expect("rows are left");
        a.swap(k, pivot);
        b.swap(k, pivot);
        let row = a[k].clone();
        for i in k + 1..n {
            let factor = a[i][k] / row[k];
            if factor != 0.0 {
                (k..n).for_each(|j| a[i][j] -= factor * row[j]);
                b[i] -= factor * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

/// The stage: turns the velocities after the kick into those at the end of the step.
pub fn elastic_solve(problem: &Problem, cells: &[u32], nodes: &mut Nodes, particles: (&[Particle], &[f64]), dt: f64) {
    let (mass, kicked) = (nodes.mass.clone(), nodes.velocity.clone());
    let imbalance = |v: &[[f64; 3]]| -> Vec<[f64; 3]> {
        let force = force(problem, v, particles, dt);
        (0..v.len()).map(|i| [0, 1, 2].map(|d| mass[i] * (kicked[i][d] - v[i][d]) + dt * force[i][d])).collect()
    };
    walls(problem, cells, &mut nodes.velocity);
    for _ in 0..30 {
        let r = imbalance(&nodes.velocity);
        let mut pushed = nodes.velocity.clone();
        for (slot, v) in pushed.iter_mut().enumerate().filter(|(slot, _)| mass[*slot] > 0.0) {
            *v = [0, 1, 2].map(|d| v[d] + 1e-3 * r[slot][d] / mass[slot]);
        }
        let mut stopped = pushed.clone();
        walls(problem, cells, &mut stopped);
        let all = (0..mass.len()).flat_map(|slot| (0..problem.grid.dimension).map(move |d| (slot, d)));
        let (held, free): (Vec<_>, Vec<_>) =
            all.filter(|(slot, _)| mass[*slot] > 0.0).partition(|(slot, d)| pushed[*slot][*d] != stopped[*slot][*d]);
        held.iter().for_each(|(slot, d)| nodes.velocity[*slot][*d] = 0.0);
        let r = imbalance(&nodes.velocity);
        let mut jacobian = vec![vec![0.0; free.len()]; free.len()];
        for (column, (slot, d)) in free.iter().enumerate() {
            let mut moved = nodes.velocity.clone();
            moved[*slot][*d] += 1e-6;
            let changed = imbalance(&moved);
            for (row, (i, e)) in free.iter().enumerate() {
                jacobian[row][column] = (r[*i][*e] - changed[*i][*e]) / 1e-6;
            }
        }
        let change = eliminate(jacobian, free.iter().map(|(slot, d)| r[*slot][*d]).collect());
        let largest = change.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        free.iter().zip(change).for_each(|((slot, d), change)| nodes.velocity[*slot][*d] += change);
        if largest < 1e-10 {
            return;
        }
    }
    panic!("the reference finds no balance");
}
