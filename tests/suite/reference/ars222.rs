//! Two solves per step for gas alone: ARS(2,2,2) [Ascher, Ruuth & Spiteri 1997, section 2.6], in the stages' own terms.

use super::coupled_solve::{Inputs, Solution, coupled_solve};
use super::grid::shift;
use super::interface::Interface;
use super::p2g::Nodes;
use super::particle_sort::Bins;
use super::step::Report;
use super::{Gas, Problem, State, boundary, fluid_update, gas_advection, intermediate_pressure};

/// What is left of the advected gas without the central heat that `carrying` has carried over the span of a solve.
fn without_central_heat(problem: &Problem, faces: &Interface, [advected, carrying]: [&Gas; 2], dt: f64) -> Gas {
    let heat = gas_advection::central_heat(problem, faces, carrying);
    let mut cold = advected.clone();
    for c in problem.grid.interior() {
        let slot = problem.grid.slot(c);
        for (axis, heat) in heat.iter().enumerate().take(problem.grid.dimension) {
            let below = problem.grid.slot(shift(c, axis, -1));
            cold.energy[slot] += dt / problem.grid.spacing * (heat[slot] - heat[below]);
        }
    }
    cold
}

/// Advances the gas by dt; returns the report of both solves and the solution of the second.
pub(crate) fn two_solves(
    problem: &Problem,
    faces: &Interface,
    (bins, nodes): (&Bins, &Nodes),
    state: &mut State,
    dt: f64,
) -> (Report, Solution) {
    let a = 1.0 - 0.5_f64.sqrt();
    let e = 1.0 - 1.0 / (2.0 * a);
    let first = state.gas.clone();
    let cold = |advected: &Gas, carrying: &Gas| without_central_heat(problem, faces, [advected, carrying], a * dt);
    let solve = |[advected, cold, carrying]: [&Gas; 3],
                 booked: f64,
                 open: &mut boundary::Memory,
                 ledger: &mut [[f64; 5]]| {
        let [star, cold] = [advected, cold].map(|gas| gas_advection::with_gravity(problem, &faces.cells, gas, a * dt));
        let intermediate =
            intermediate_pressure::intermediate(problem, faces, (advected, &star), Some(carrying), open, a * dt);
        let solution =
            coupled_solve(&Inputs { problem, interface: faces, bins, intermediate: &intermediate, nodes, dt: a * dt });
        let (carried, pressed) = ((&cold, &intermediate), (&solution, nodes));
        let mut gas = fluid_update::fluid_update(problem, faces, carried, pressed, a * dt, ledger);
        *open = boundary::remember(problem, &faces.cells, &intermediate.open, &solution.pressure[0]);
        let mut floored = vec![[0.0; 5]; ledger.len()];
        let count = fluid_update::energy_floor(problem, &faces.cells, &star, &mut gas, &mut floored);
        for (held, taken) in ledger.iter_mut().flatten().zip(floored.iter().flatten()) {
            *held += booked * taken;
        }
        gas_advection::fill_ghosts(problem, &faces.cells, &mut gas);
        (gas, solution, count)
    };
    let (mut advected, limited_one) =
        gas_advection::stage(problem, faces, [&first, &first], a * dt, [a, 0.0], &mut state.ledger);
    gas_advection::fill_ghosts(problem, &faces.cells, &mut advected);
    let kept = cold(&advected, &first);
    let (middle, solution_one, floored_one) =
        solve([&advected, &kept, &first], (1.0 - a) / a, &mut state.open, &mut state.ledger);
    // U0 + dt e A0 + dt (1 - a) I1, with A0 and I1 from what the first half added.
    let mut start = first.clone();
    for slot in 0..start.energy.len() {
        let (u0, c, u1) = (first.get(slot), kept.get(slot), middle.get(slot));
        start.set(slot, [0, 1, 2, 3, 4].map(|k| u0[k] + e / a * (c[k] - u0[k]) + (1.0 - a) / a * (u1[k] - c[k])));
    }
    let shares = [1.0 - e, 1.0 - a / (1.0 - e)];
    let (mut advected, limited_two) =
        gas_advection::stage(problem, faces, [&middle, &start], (1.0 - e) * dt, shares, &mut state.ledger);
    gas_advection::fill_ghosts(problem, &faces.cells, &mut advected);
    let rest = cold(&advected, &middle);
    let (gas, mut solution, floored_two) = solve([&advected, &rest, &middle], 1.0, &mut state.open, &mut state.ledger);
    state.gas = gas;
    solution.iterations += solution_one.iterations;
    solution.converged &= solution_one.converged;
    state.time += dt;
    let (limited, floored) = (limited_one + limited_two, floored_one + floored_two);
    let (iterations, converged) = (solution.iterations, solution.converged);
    (Report { dt, iterations, converged, limited, floored, substeps: 1 }, solution)
}
