//! Two solves per step for gas alone: the implicit half of ARS(2,2,2) [Ascher, Ruuth & Spiteri 1997, section 2.6], the explicit one of
//! Wicker and Skamarock [2002], in the stages' own terms.

use crate::gas::fluid_update;
use crate::gas::gas_advection;
use crate::gas::intermediate_pressure;
use crate::grid::shift;
use crate::interface::Interface;
use crate::solid::p2g::Nodes;
use crate::solid::particle_sort::Bins;
use crate::solve::coupled_solve::{Inputs, Solution, coupled_solve};
use crate::step::Report;
use crate::{Gas, Problem, State, boundary};

/// What is left of the advected gas without the central heat of `held` that `carrying` has carried over the span of a solve.
fn without_central_heat(problem: &Problem, faces: &Interface, [advected, carrying, held]: [&Gas; 3], dt: f64) -> Gas {
    let heat = gas_advection::central_heat(problem, faces, [carrying, held]);
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

/// `start` and `factor` times what the first solve added.
fn returned(start: &Gas, [before, after]: [&Gas; 2], factor: f64) -> Gas {
    let mut gas = start.clone();
    for slot in 0..gas.energy.len() {
        let (u, c, v) = (start.get(slot), before.get(slot), after.get(slot));
        gas.set(slot, [0, 1, 2, 3, 4].map(|k| u[k] + factor * (v[k] - c[k])));
    }
    gas
}

/// Advances the gas by dt; returns the report of both solves and the solution of the second.
pub fn two_solves(
    problem: &Problem,
    faces: &Interface,
    (bins, nodes): (&Bins, &Nodes),
    state: &mut State,
    dt: f64,
) -> (Report, Solution) {
    let a = 1.0 - 0.5_f64.sqrt();
    let first = state.gas.clone();
    let solve = |[advected, carrying]: [&Gas; 2],
                 counted: f64,
                 open: &mut boundary::Memory,
                 ledger: &mut [[f64; 5]]| {
        let cold = without_central_heat(problem, faces, [advected, carrying, &first], a * dt);
        let [star, kept] = [advected, &cold].map(|gas| gas_advection::with_gravity(problem, &faces.cells, gas, a * dt));
        let intermediate =
            intermediate_pressure::intermediate(problem, faces, (advected, &star), Some(carrying), open, a * dt);
        let solution =
            coupled_solve(&Inputs { problem, interface: faces, bins, intermediate: &intermediate, nodes, dt: a * dt });
        let (carried, pressed) = ((&kept, Some(&first), &intermediate), (&solution, nodes));
        let (mut gas, _) = fluid_update::fluid_update(problem, faces, carried, pressed, a * dt);
        *open = boundary::remember(problem, &faces.cells, &intermediate.open, &solution.pressure[0]);
        let mut floored = vec![[0.0; 5]; ledger.len()];
        let count = fluid_update::energy_floor(problem, &faces.cells, &star, &mut gas, &mut floored);
        for (held, taken) in ledger.iter_mut().flatten().zip(floored.iter().flatten()) {
            *held += counted * taken;
        }
        gas_advection::fill_ghosts(problem, &faces.cells, &mut gas);
        (gas, cold, solution, count)
    };
    let stage = |gas: &Gas, start: &Gas, span: f64, implicit: f64, ledger: &mut [[f64; 5]]| {
        // only the last stage is part of the result
        let share = f64::from(u8::from(span == dt));
        let (mut next, limited) =
            gas_advection::stage(problem, faces, [gas, start], span, (share, (implicit, &first)), ledger);
        gas_advection::fill_ghosts(problem, &faces.cells, &mut next);
        (next, limited)
    };
    let (advected, limited_one) = stage(&first, &first, a * dt, 0.0, &mut state.ledger);
    let (one, kept, solution_one, floored_one) =
        solve([&advected, &first], (1.0 - a) / a, &mut state.open, &mut state.ledger);
    let (middle, limited_middle) =
        stage(&one, &returned(&first, [&kept, &one], 0.5 / a), 0.5 * dt, 1.0, &mut state.ledger);
    let (advected, limited_two) =
        stage(&middle, &returned(&first, [&kept, &one], (1.0 - a) / a), dt, 1.0 - a, &mut state.ledger);
    let (gas, _, mut solution, floored_two) = solve([&advected, &middle], 1.0, &mut state.open, &mut state.ledger);
    state.gas = gas;
    solution.iterations += solution_one.iterations;
    solution.converged &= solution_one.converged;
    state.time += dt;
    let (limited, floored) = (limited_one + limited_middle + limited_two, floored_one + floored_two);
    let (iterations, converged) = (solution.iterations, solution.converged);
    (Report { dt, iterations, converged, limited, floored, substeps: 1 }, solution)
}
