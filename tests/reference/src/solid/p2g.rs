//! Particles to nodes: mass, momentum (APIC), elastic force. Quadratic B-splines on cell centres.

use crate::grid::{Grid, add};
use crate::{Particle, Problem};
use glam::DVec3;

/// Solid on the grid.
pub struct Nodes {
    /// Mass of each node, kg.
    pub mass: Vec<f64>,
    /// Velocity of each node, m/s.
    pub velocity: Vec<[f64; 3]>,
    /// Elastic force.
    pub force: Vec<[f64; 3]>,
}

/// One node in the support of a particle.
pub struct Support {
    /// Node of the grid.
    pub node: [i32; 3],
    /// Weight of the particle at the node.
    pub weight: f64,
    /// Gradient of the weight, 1/m.
    pub gradient: DVec3,
    /// Node minus particle, 0 on inactive axes.
    pub distance: DVec3,
}

/// Weights and gradients of the 3^d nodes around a position; 1 and 0 on inactive axes.
pub fn support(grid: &Grid, position: DVec3) -> Vec<Support> {
    let cell = grid.cell_of(position.to_array());
    let centre = DVec3::from_array(grid.centre(cell));
    let mut weights = [[0.0; 3]; 3];
    let mut slopes = [[0.0; 3]; 3];
    for d in 0..grid.dimension {
        let x = (position[d] - centre[d]) / grid.spacing;
        weights[d] = [0.5 * (0.5 - x).powi(2), 0.75 - x * x, 0.5 * (0.5 + x).powi(2)];
        slopes[d] = [x - 0.5, -2.0 * x, x + 0.5].map(|slope| slope / grid.spacing);
    }
    let entry = |off: [i32; 3]| {
        let at = |d: usize| weights[d][(off[d] + 1) as usize];
        let active = || 0..grid.dimension;
        let mut gradient = DVec3::ZERO;
        let mut distance = DVec3::ZERO;
        for d in active() {
            gradient[d] = slopes[d][(off[d] + 1) as usize] * active().filter(|e| *e != d).map(at).product::<f64>();
            distance[d] = centre[d] + f64::from(off[d]) * grid.spacing - position[d];
        }
        Support { node: add(cell, off), weight: active().map(at).product(), gradient, distance }
    };
    grid.offsets(-1, 1).into_iter().map(entry).collect()
}

/// The stage.
pub fn p2g(problem: &Problem, particles: &[Particle]) -> Nodes {
    let grid = &problem.grid;
    let empty = || vec![[0.0; 3]; grid.slots()];
    let mut nodes = Nodes { mass: vec![0.0; grid.slots()], velocity: empty(), force: empty() };
    for particle in particles.iter().filter(|particle| particle.active) {
        let stress = problem.stress(particle, particle.deformation, particle.ghost_pressure) * particle.volume0;
        for s in support(grid, particle.position) {
            let slot = grid.slot(s.node);
            let share = s.weight * particle.mass;
            let momentum = (particle.velocity + particle.affine * s.distance) * share;
            let force = stress * s.gradient;
            nodes.mass[slot] += share;
            for d in 0..grid.dimension {
                nodes.velocity[slot][d] += momentum[d];
                nodes.force[slot][d] -= force[d];
            }
        }
    }
    for (velocity, mass) in nodes.velocity.iter_mut().zip(&nodes.mass).filter(|(_, mass)| **mass > 0.0) {
        *velocity = velocity.map(|momentum| momentum / mass);
    }
    nodes
}
