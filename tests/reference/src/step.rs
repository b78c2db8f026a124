//! One step in the order of the method.

pub mod time_step;
pub mod two_spaces;

use crate::gas::fluid_update;
use crate::gas::gas_advection;
use crate::gas::intermediate_pressure;
use crate::interface::ledger;
use crate::solid::elastic_reaction;
use crate::solid::elastic_reaction::Spread;
use crate::solid::elastic_solve;
use crate::solid::g2p;
use crate::solid::mpm_grid_update;
use crate::solid::p2g;
use crate::solid::p2g::Nodes;
use crate::solid::particle_sort;
use crate::solve::coupled_solve::{Inputs, Solution, coupled_solve};
use crate::{Problem, State};
use crate::{ablation, ars222, boundary, interface};

/// What a step did.
#[derive(Clone, Copy, Debug, Default)]
pub struct Report {
    /// Time step, s.
    pub dt: f64,
    /// Iterations of the solve.
    pub iterations: usize,
    /// The solve reached its tolerance.
    pub converged: bool,
    /// Cells whose fluxes and faces whose heat were limited.
    pub limited: usize,
    /// Cells at the floor of entropy.
    pub floored: usize,
    /// Elastic sub-steps.
    pub substeps: usize,
}

/// What a step leaves besides the state.
pub struct Trace {
    /// What the solve found.
    pub solution: Solution,
    /// After the last elastic sub-step.
    pub nodes: Nodes,
    /// Vertices with one pressure.
    pub shared: Vec<bool>,
}

/// Advances the state by dt.
pub fn step(problem: &Problem, state: &mut State, dt: f64) -> Report {
    traced_step(problem, state, dt).0
}

/// Advances the state by dt and keeps what the stages made on the way.
pub fn traced_step(problem: &Problem, state: &mut State, dt: f64) -> (Report, Trace) {
    let mut bins = particle_sort::bin(problem, &state.particles);
    let mut nodes = p2g::p2g(problem, &state.particles);
    let kinds = interface::kinds(problem, &mut bins, &state.cells);
    let faces = interface::interface(problem, kinds, &bins, &nodes);
    ledger::change_kinds(problem, state, &faces, (&bins, &nodes), dt);
    elastic_reaction::fill(problem, &faces.cells, &mut nodes);
    if problem.numerics.two_solves {
        let (report, solution) = ars222::two_solves(problem, &faces, (&bins, &nodes), state, dt);
        return (report, Trace { solution, nodes, shared: faces.shared });
    }
    let (advected, limited) = gas_advection::advect(problem, &faces, &state.gas, dt, &mut state.ledger);
    let star = gas_advection::with_gravity(problem, &faces.cells, &advected, dt);
    let intermediate = intermediate_pressure::intermediate(problem, &faces, (&advected, &star), None, &state.open, dt);

    let film = interface::film_force(problem, &faces.cells, &bins, &intermediate.vertex_pressure);
    let inertia = particle_sort::inertia(problem, &bins, &nodes.mass);
    let some = |(mass, inertia): (&f64, &f64)| if *mass > 0.0 { *inertia } else { 0.0 };
    let floored: Vec<f64> = nodes.mass.iter().zip(&inertia).map(some).collect();
    let start = nodes.velocity.clone();
    ablation::elastic_first(problem, &faces.cells, &mut nodes, dt);
    mpm_grid_update::add_gravity(problem, &mut nodes, dt);
    mpm_grid_update::add_forces(&mut nodes.velocity, &floored, &film, dt);
    let kick: Vec<_> = film.iter().zip(&inertia).map(|(f, m)| f.map(|f| dt * f / m)).collect();
    mpm_grid_update::share_left(problem, &nodes.mass, &inertia, &kick, &mut nodes.velocity);

    let (interface, inner) = (&faces, &intermediate);
    let before = nodes.velocity.clone();
    let loaded = Inputs { problem, interface, bins: &bins, intermediate: inner, nodes: &nodes, dt };
    let reaction = match problem.numerics.coupling_last {
        true => vec![[0.0; 3]; before.len()],
        false => elastic_reaction::reaction(&loaded, &start, &inertia),
    };
    add_scaled(&mut nodes.velocity, &reaction, dt);
    let inputs = Inputs { problem, interface, bins: &bins, intermediate: inner, nodes: &nodes, dt };
    let mut solution = coupled_solve(&inputs);
    if problem.numerics.gradients {
        ablation::by_gradients(&inputs, &mut solution, &inertia);
    }
    let kick = differences(&solution.solid_velocity, &nodes.velocity);
    nodes.velocity = before;
    let mut followed = star.clone();
    fluid_update::late_flux(problem, &faces, &mut followed, (&solution, &nodes), dt, &mut state.ledger);
    let (gas, pressed) = ((&followed, None, &intermediate), (&solution, &nodes));
    let (next, short) = fluid_update::fluid_update(problem, &faces, gas, pressed, dt);
    state.gas = next;
    state.open = boundary::remember(problem, &faces.cells, &intermediate.open, &solution.pressure[0]);
    let touched = fluid_update::energy_floor(problem, &faces.cells, &star, &mut state.gas, &mut state.ledger);

    mpm_grid_update::share_left(problem, &nodes.mass, &inertia, &kick, &mut solution.solid_velocity);
    let change = g2p::ghost_change(problem, &faces, &bins, &solution.pressure[2]);
    nodes.velocity.clone_from(&solution.solid_velocity);
    let spread = spread(problem, &mut nodes, (start, reaction), dt);
    let substeps = elastic_substeps(problem, &faces.cells, (&change, spread.as_ref()), &mut nodes, state, dt);
    gas_advection::fill_ghosts(problem, &faces.cells, &mut state.gas);
    state.time += dt;
    let (iterations, converged) = (solution.iterations, solution.converged);
    let report = Report { dt, iterations, converged, limited: limited + short, floored: touched, substeps };
    (report, Trace { solution, nodes, shared: faces.shared })
}

fn differences(after: &[[f64; 3]], before: &[[f64; 3]]) -> Vec<[f64; 3]> {
    after.iter().zip(before).map(|(a, b)| [0, 1, 2].map(|d| a[d] - b[d])).collect()
}

fn add_scaled(velocity: &mut [[f64; 3]], change: &[[f64; 3]], factor: f64) {
    for (v, change) in velocity.iter_mut().zip(change) {
        *v = [0, 1, 2].map(|d| v[d] + factor * change[d]);
    }
}

/// What of the solved velocities the sub-steps share, and the velocities that they start from; the reaction comes with the elastic force.
fn spread(
    problem: &Problem,
    nodes: &mut Nodes,
    (start, reaction): (Vec<[f64; 3]>, Vec<[f64; 3]>),
    dt: f64,
) -> Option<Spread> {
    add_scaled(&mut nodes.velocity, &reaction, -dt);
    if problem.numerics.coupling_last || problem.numerics.implicit {
        return None;
    }
    let solved = std::mem::replace(&mut nodes.velocity, start);
    let push = solved.iter().zip(&nodes.velocity).map(|(v, start)| [0, 1, 2].map(|d| (v[d] - start[d]) / dt));
    Some(Spread { push: push.collect(), mass: nodes.mass.clone() })
}

/// Moves the particles; `spread`: what the sub-steps share. Returns their number.
fn elastic_substeps(
    problem: &Problem,
    cells: &[u32],
    (change, spread): (&[f64], Option<&Spread>),
    nodes: &mut Nodes,
    state: &mut State,
    dt: f64,
) -> usize {
    if problem.numerics.implicit {
        elastic_solve::elastic_solve(problem, cells, nodes, (&state.particles, change), dt);
        g2p::g2p(problem, &nodes.velocity, change, 1.0, dt, &mut state.particles);
        return 1;
    }
    let substeps = time_step::substeps(problem, time_step::fastest_wave(problem, state), dt);
    let sub_dt = dt / substeps as f64;
    for index in 0..if state.particles.is_empty() { 0 } else { substeps } {
        if index > 0 {
            *nodes = p2g::p2g(problem, &state.particles);
        }
        if let Some(spread) = spread {
            spread.kick(problem, nodes, sub_dt);
        }
        if problem.numerics.coupling_last {
            mpm_grid_update::walls(problem, cells, &mut nodes.velocity);
        } else {
            mpm_grid_update::add_forces(&mut nodes.velocity, &nodes.mass, &nodes.force, sub_dt);
            mpm_grid_update::wall_faces(problem, cells, &nodes.mass, &mut nodes.velocity);
        }
        let whole = if index == 0 { 1.0 } else { 0.0 };
        let share = if problem.numerics.shared_volume { 1.0 / substeps as f64 } else { whole };
        g2p::g2p(problem, &nodes.velocity, change, share, sub_dt, &mut state.particles);
    }
    substeps
}

/// Runs to a time with steps by rule; the last one is shortened.
pub fn advance_to(problem: &Problem, state: &mut State, time: f64) -> Vec<Report> {
    let mut reports = Vec::new();
    while state.time < time * (1.0 - 1e-12) {
        let rule = time_step::time_step(problem, state);
        state.previous_dt = rule.min(time - state.time);
        reports.push(step(problem, state, state.previous_dt));
    }
    reports
}
