//! Length of the next step.

use crate::boundary::fill_ghosts;
use crate::grid::shift;
use crate::{GAS, GHOST, Gas, Problem, State};

/// Rate of one gas cell: material speed and pressure differences, summed over the axes.
pub fn cell_rate(problem: &Problem, cells: &[u32], gas: &Gas, c: [i32; 3]) -> f64 {
    let grid = &problem.grid;
    let (slot, dx) = (grid.slot(c), grid.spacing);
    let pressure = gas.pressure(slot, problem.gamma);
    (0..grid.dimension)
        .map(|axis| {
            let mut a = gas.velocity(slot)[axis].abs() / dx;
            let mut b = 0.0_f64;
            for by in [-1, 1] {
                let other = grid.slot(shift(c, axis, by));
                if cells[other] == GHOST {
                    a = a.max(gas.velocity(other)[axis].abs() / dx);
                }
                if matches!(cells[other], GAS | GHOST) {
                    let jump = (gas.pressure(other, problem.gamma) - pressure).abs();
                    if jump >= 1e-6 * pressure {
                        b = b.max(jump / (dx * dx * gas.conserved[slot][0].min(gas.conserved[other][0])));
                    }
                }
            }
            0.5 * (a + (a * a + 4.0 * b).sqrt())
        })
        .sum()
}

/// Step by rule: gas rate, particle speed, sound cap, elastic sub-step limit, growth.
pub fn time_step(problem: &Problem, state: &State) -> f64 {
    let (grid, numerics) = (&problem.grid, &problem.numerics);
    let (mut rate, mut sound) = (0.0_f64, 0.0_f64);
    let mut gas = state.gas.clone();
    fill_ghosts(problem, &state.cells, &mut gas);
    for c in grid.interior() {
        let slot = grid.slot(c);
        if state.cells[slot] == GAS {
            rate = rate.max(cell_rate(problem, &state.cells, &gas, c));
            let pressure = state.gas.pressure(slot, problem.gamma);
            sound = sound.max((problem.gamma * pressure / state.gas.conserved[slot][0]).sqrt());
        }
    }
    let mut dt = (numerics.cfl / rate).min(numerics.max_courant * grid.spacing / sound);
    for particle in state.particles.iter().filter(|particle| particle.active) {
        dt = dt.min(numerics.cfl * grid.spacing / particle.velocity.length());
    }
    let elastic = fastest_wave(problem, state);
    dt = dt.min(numerics.max_substeps as f64 * numerics.elastic_cfl * grid.spacing / elastic);
    if state.previous_dt > 0.0 { dt.min(numerics.max_growth * state.previous_dt) } else { dt }
}

/// Largest elastic wave speed of the particles, or the cell edge times their velocity gradient; 0 without particles.
pub fn fastest_wave(problem: &Problem, state: &State) -> f64 {
    let speeds = state.particles.iter().filter(|particle| particle.active);
    let limit = |p: &crate::Particle| {
        let gradient = p.affine.to_cols_array().iter().map(|c| c * c).sum::<f64>().sqrt();
        problem.materials[p.material]
            .body_wave_speed(p.deformation, p.mass / p.volume0)
            .max(gradient * problem.grid.spacing)
    };
    speeds.map(limit).fold(0.0, f64::max)
}

/// Elastic sub-steps of a step.
pub fn substeps(problem: &Problem, wave_speed: f64, dt: f64) -> usize {
    let numerics = &problem.numerics;
    let count = (dt * wave_speed / (numerics.elastic_cfl * problem.grid.spacing)).ceil() as usize;
    count.clamp(1, numerics.max_substeps)
}
