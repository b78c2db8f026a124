//! One step in the order of the method.

use super::coupled_solve::{Inputs, Solution, coupled_solve};
use super::p2g::Nodes;
use super::{Problem, State};
use super::{
    ars222, boundary, fluid_update, g2p, gas_advection, interface, intermediate_pressure, ledger, mpm_grid_update, p2g,
    particle_sort, time_step,
};

/// What a step did.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Report {
    pub(crate) dt: f64,
    pub(crate) iterations: usize,
    pub(crate) converged: bool,
    pub(crate) limited: usize,
    pub(crate) floored: usize,
    pub(crate) substeps: usize,
}

/// What a step leaves besides the state.
pub(crate) struct Trace {
    pub(crate) solution: Solution,
    /// After the last elastic sub-step.
    pub(crate) nodes: Nodes,
    /// Vertices with one pressure.
    pub(crate) shared: Vec<bool>,
}

/// Advances the state by dt.
pub(crate) fn step(problem: &Problem, state: &mut State, dt: f64) -> Report {
    traced_step(problem, state, dt).0
}

/// Advances the state by dt and keeps what the stages made on the way.
pub(crate) fn traced_step(problem: &Problem, state: &mut State, dt: f64) -> (Report, Trace) {
    let bins = particle_sort::bin(problem, &state.particles);
    let mut nodes = p2g::p2g(problem, &state.particles);
    let kinds = interface::kinds(problem, &bins);
    ledger::change_kinds(problem, state, &kinds, &bins);
    let faces = interface::interface(problem, kinds, &bins, &nodes);

    if problem.numerics.two_solves {
        let (report, solution) = ars222::two_solves(problem, &faces, (&bins, &nodes), state, dt);
        return (report, Trace { solution, nodes, shared: faces.shared });
    }
    let (advected, limited) = gas_advection::advect(problem, &faces, &state.gas, dt, &mut state.ledger);
    let star = gas_advection::with_gravity(problem, &faces.cells, &advected, dt);
    let intermediate = intermediate_pressure::intermediate(problem, &faces, (&advected, &star), None, &state.open, dt);

    let film = interface::film_force(problem, &faces.cells, &bins, &intermediate.vertex_pressure);
    let floor = problem.numerics.mass_floor * bins.density * problem.grid.volume();
    let floored: Vec<f64> = nodes.mass.iter().map(|mass| if *mass > 0.0 { mass.max(floor) } else { 0.0 }).collect();
    mpm_grid_update::add_gravity(problem, &mut nodes, dt);
    mpm_grid_update::add_forces(&mut nodes.velocity, &floored, &film, dt);

    let solution = coupled_solve(&Inputs {
        problem,
        interface: &faces,
        bins: &bins,
        intermediate: &intermediate,
        nodes: &nodes,
        dt,
    });
    state.gas = fluid_update::fluid_update(problem, &faces, (&star, &intermediate), &solution, &nodes.velocity, dt);
    state.open = boundary::remember(problem, &faces.cells, &intermediate.open, &solution.pressure[0]);
    let touched = fluid_update::energy_floor(problem, &faces.cells, &star, &mut state.gas, &mut state.ledger);

    let substeps = time_step::substeps(problem, time_step::fastest_wave(problem, state), dt);
    let change = g2p::ghost_change(problem, &faces, &bins, &solution.pressure[2]);
    let (share, sub_dt) = (1.0 / substeps as f64, dt / substeps as f64);
    nodes.velocity.clone_from(&solution.solid_velocity);
    for index in 0..if state.particles.is_empty() { 0 } else { substeps } {
        if index > 0 {
            nodes = p2g::p2g(problem, &state.particles);
        }
        mpm_grid_update::add_forces(&mut nodes.velocity, &nodes.mass, &nodes.force, sub_dt);
        mpm_grid_update::walls(problem, &faces.cells, &mut nodes.velocity);
        g2p::g2p(problem, &nodes.velocity, &change, share, sub_dt, &mut state.particles);
    }
    gas_advection::fill_ghosts(problem, &faces.cells, &mut state.gas);
    state.time += dt;
    let report = Report {
        dt,
        iterations: solution.iterations,
        converged: solution.converged,
        limited,
        floored: touched,
        substeps,
    };
    (report, Trace { solution, nodes, shared: faces.shared })
}

/// Runs to a time with steps by rule; the last one is shortened.
pub(crate) fn advance_to(problem: &Problem, state: &mut State, time: f64) -> Vec<Report> {
    let mut reports = Vec::new();
    while state.time < time * (1.0 - 1e-12) {
        let rule = time_step::time_step(problem, state);
        state.previous_dt = rule.min(time - state.time);
        reports.push(step(problem, state, state.previous_dt));
    }
    reports
}
