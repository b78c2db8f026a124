//! Nodes to particles: velocity, affine matrix, deformation, plasticity, ghost pressure, position.

use crate::ablation;
use crate::grid::add;
use crate::interface::{Interface, touches};
use crate::solid::p2g::support;
use crate::solid::particle_sort::{Bins, linear_weights};
use crate::{Particle, Problem, SOLID, Side};
use glam::{DMat3, DVec3};

/// a b^T.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Change of the ghost pressure per vertex over the step; around vertices without solid cells it is continued.
pub fn ghost_change(problem: &Problem, interface: &Interface, bins: &Bins, solved: &[f64]) -> Vec<f64> {
    let grid = &problem.grid;
    let mut change = vec![0.0; grid.slots()];
    let solid = |v: [i32; 3]| touches(problem, &interface.cells, v, SOLID);
    let own = |v: [i32; 3]| solved[grid.slot(v)] - bins.ghost_pressure[grid.slot(v)];
    for vertex in grid.vertices() {
        let slot = grid.slot(vertex);
        if solid(vertex) {
            change[slot] = own(vertex);
        } else if bins.ghost_weight[slot] > 0.0 {
            let inside = |v: &[i32; 3]| (0..grid.dimension).all(|d| v[d] >= 0 && v[d] <= grid.cells[d]);
            let block = grid.offsets(-2, 2).into_iter().map(|o| add(vertex, o)).filter(inside);
            let values: Vec<f64> = block.filter(|v| solid(*v)).map(own).collect();
            if !values.is_empty() {
                change[slot] = values.iter().sum::<f64>() / values.len() as f64;
            }
        }
    }
    change
}

/// One sub-step of length dt; `share` of the ghost-pressure change is applied.
pub fn g2p(problem: &Problem, velocity: &[[f64; 3]], change: &[f64], share: f64, dt: f64, particles: &mut [Particle]) {
    let grid = &problem.grid;
    for particle in particles.iter_mut().filter(|particle| particle.active) {
        let (mut v, mut affine, mut gradient) = (DVec3::ZERO, DMat3::ZERO, DMat3::ZERO);
        for s in support(grid, particle.position) {
            let node = DVec3::from_array(velocity[grid.slot(s.node)]);
            v += node * s.weight;
            affine += outer(node * s.weight, s.distance);
            gradient += outer(node, s.gradient);
        }
        let rise: f64 = linear_weights(grid, particle.position).iter().map(|(v, w)| w * change[grid.slot(*v)]).sum();
        particle.velocity = v;
        particle.affine = affine * (4.0 / (grid.spacing * grid.spacing));
        particle.ghost_pressure += share * rise;
        let trial = particle.deformation + gradient * particle.deformation * dt;
        let (deformation, plastic) = problem.materials[particle.material].plastic_return(trial);
        particle.deformation = deformation;
        particle.plastic_strain += plastic;
        if problem.numerics.shared_volume {
            ablation::relax(problem, particle, dt);
        }
        particle.position += v * dt;
        confine(problem, particle);
    }
}

/// Keeps a particle off the outside of walls; one that leaves through an open side is done.
fn confine(problem: &Problem, particle: &mut Particle) {
    let grid = &problem.grid;
    for d in 0..grid.dimension {
        let extent = f64::from(grid.cells[d]) * grid.spacing;
        for (upper, edge) in [grid.origin[d], grid.origin[d] + extent].into_iter().enumerate() {
            let inward = if upper == 0 { 1.0 } else { -1.0 };
            let depth = inward * (particle.position[d] - edge);
            let gap = 1e-3 * grid.spacing;
            if matches!(problem.sides[2 * d + upper], Side::Wall) {
                if depth < gap {
                    particle.position[d] = edge + inward * gap;
                }
            } else if depth < 0.0 {
                particle.active = false;
            }
        }
    }
}
