//! What the particles mean for the cells they lie in, and their ghost pressure at the vertices.

use crate::grid::{Grid, add};
use crate::{Particle, Problem};
use glam::DVec3;

/// Sums over the particles of each cell, and vertex means.
pub struct Bins {
    /// Active particles per cell.
    pub count: Vec<u32>,
    /// Sum of vol0 J per cell.
    pub volume: Vec<f64>,
    /// Volume of what closes the cell: of its own where it is full, of a thin wall; 0 before the interface knows.
    pub closed: Vec<f64>,
    /// Mean of 1/(lambda_g J^g) per cell.
    pub compliance: Vec<f64>,
    /// Mean ghost pressure per vertex, 0 without particles.
    pub ghost_pressure: Vec<f64>,
    /// Sum of the weights behind `ghost_pressure`.
    pub ghost_weight: Vec<f64>,
    /// Largest mass / vol0.
    pub density: f64,
    /// Least mass / vol0 per cell.
    pub least_density: Vec<f64>,
}

/// Mass that the pressure solve gives to each node: at least a share of what a cell full of the lightest particles
/// around it weighs, and of the heaviest node next to it.
pub fn inertia(problem: &Problem, bins: &Bins, mass: &[f64]) -> Vec<f64> {
    let grid = &problem.grid;
    let most = problem.numerics.mass_floor * grid.volume() * bins.density;
    let mut inertia: Vec<f64> = mass.iter().map(|mass| mass.max(most)).collect();
    for c in grid.all() {
        let near = grid.offsets(-1, 1).into_iter().map(|offset| add(c, offset)).filter(|at| grid.contains(*at));
        let least = near.map(|at| bins.least_density[grid.slot(at)]).fold(f64::INFINITY, f64::min);
        let near = grid.offsets(-1, 1).into_iter().map(|offset| add(c, offset)).filter(|at| grid.stored(*at));
        let heaviest = near.map(|at| mass[grid.slot(at)]).fold(0.0, f64::max);
        if heaviest == 0.0 {
            continue;
        }
        let slot = grid.slot(c);
        let floor = problem.numerics.mass_floor * grid.volume() * least;
        inertia[slot] = mass[slot].max(floor.min(problem.numerics.mass_beside[grid.dimension - 1] * heaviest));
    }
    inertia
}

/// Linear weights of a position on the vertices of its cell.
pub fn linear_weights(grid: &Grid, position: DVec3) -> Vec<([i32; 3], f64)> {
    let cell = grid.cell_of(position.to_array());
    let corners = grid.offsets(0, 1);
    corners
        .into_iter()
        .map(|corner| {
            let weight = (0..grid.dimension)
                .map(|d| {
                    let x = (position[d] - grid.origin[d]) / grid.spacing - f64::from(cell[d]);
                    if corner[d] == 1 { x } else { 1.0 - x }
                })
                .product();
            (add(cell, corner), weight)
        })
        .collect()
}

/// Bins the particles.
pub fn bin(problem: &Problem, particles: &[Particle]) -> Bins {
    let grid = &problem.grid;
    let zeros = || vec![0.0; grid.slots()];
    let mut bins = Bins {
        count: vec![0; grid.slots()],
        volume: zeros(),
        closed: zeros(),
        compliance: zeros(),
        ghost_pressure: zeros(),
        ghost_weight: zeros(),
        density: 0.0,
        least_density: vec![f64::INFINITY; grid.slots()],
    };
    for particle in particles.iter().filter(|particle| particle.active) {
        let slot = grid.slot(grid.cell_of(particle.position.to_array()));
        bins.count[slot] += 1;
        bins.volume[slot] += particle.volume0 * particle.deformation.determinant();
        bins.compliance[slot] += problem.materials[particle.material].compliance(particle.ghost_pressure);
        bins.density = bins.density.max(particle.mass / particle.volume0);
        bins.least_density[slot] = bins.least_density[slot].min(particle.mass / particle.volume0);
        for (vertex, weight) in linear_weights(grid, particle.position) {
            let vertex = grid.slot(vertex);
            bins.ghost_pressure[vertex] += weight * particle.volume0 * particle.ghost_pressure;
            bins.ghost_weight[vertex] += weight * particle.volume0;
        }
    }
    for slot in 0..grid.slots() {
        if bins.count[slot] > 0 {
            bins.compliance[slot] /= f64::from(bins.count[slot]);
        }
        if bins.ghost_weight[slot] > 0.0 {
            bins.ghost_pressure[slot] /= bins.ghost_weight[slot];
        }
    }
    bins
}
