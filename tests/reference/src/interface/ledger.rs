//! Gas owed to or held by cells: covering, uncovering, settling.

use crate::grid::{Grid, add, shift};
use crate::interface::Interface;
use crate::interface::sides::Walls;
use crate::solid::p2g::Nodes;
use crate::solid::particle_sort::Bins;
use crate::{GAS, Problem, SOLID, State, internal_energy};

/// Replaces the cell kinds before a step of dt: covered cells put their gas on the ledger, uncovered ones are filled from it.
pub fn change_kinds(problem: &Problem, state: &mut State, faces: &Interface, (bins, nodes): (&Bins, &Nodes), dt: f64) {
    let (grid, kinds) = (&problem.grid, &faces.cells);
    let (before, volume) = (state.cells.clone(), grid.volume());
    let old = state.gas.clone();
    for c in grid.interior() {
        let slot = grid.slot(c);
        if before[slot] == GAS && kinds[slot] == SOLID {
            let held = old.get(slot);
            (0..5).for_each(|k| state.ledger[slot][k] += held[k] * volume);
        } else if before[slot] == SOLID && kinds[slot] == GAS {
            let mean = |offsets: Vec<[i32; 3]>| {
                let near = offsets.into_iter().map(|o| add(c, o)).filter(|n| grid.contains(*n));
                let near: Vec<usize> = near.map(|n| grid.slot(n)).filter(|n| before[*n] == GAS).collect();
                let total = |k: usize| near.iter().map(|n| old.get(*n)[k]).sum::<f64>() / near.len() as f64;
                (!near.is_empty()).then(|| [0, 1, 2, 3, 4].map(total))
            };
            let fill = mean(across(grid)).or_else(|| mean(grid.offsets(-1, 1))).or_else(|| mean(grid.offsets(-2, 2)));
            let fill = fill.unwrap_or_else(|| pocket(problem, state, bins, c));
            state.gas.set(slot, fill);
            let above = std::mem::take(&mut state.above[slot]);
            (0..5).for_each(|k| state.ledger[slot][k] += above[k] - fill[k] * volume);
        }
    }
    let sound = |slot: usize| {
        let u = old.get(slot);
        (problem.gamma * (problem.gamma - 1.0) * internal_energy(u) / u[0]).sqrt()
    };
    let gas = grid.interior().into_iter().map(|c| grid.slot(c)).filter(|slot| before[*slot] == GAS);
    let walls = Walls { grid, faces, nodes, before: &before, sound: gas.map(sound).fold(0.0, f64::max) };
    walls.sort(state, &old, state.passed_dt);
    state.passed_dt = dt;
    state.cells.clone_from(kinds);
    settle(problem, state, &walls);
}

fn across(grid: &Grid) -> Vec<[i32; 3]> {
    (0..grid.dimension).flat_map(|axis| [shift([0; 3], axis, -1), shift([0; 3], axis, 1)]).collect()
}

/// Gas of an uncovered cell without gas around it: at the ghost pressure, isentropic from ambient, with the solid.
fn pocket(problem: &Problem, state: &State, bins: &Bins, c: [i32; 3]) -> [f64; 5] {
    let grid = &problem.grid;
    let corners: Vec<usize> = grid.offsets(0, 1).into_iter().map(|o| grid.slot(add(c, o))).collect();
    let weight: f64 = corners.iter().map(|v| bins.ghost_weight[*v]).sum();
    let sum: f64 = corners.iter().map(|v| bins.ghost_weight[*v] * bins.ghost_pressure[*v]).sum();
    let (density, ambient) = problem.ambient;
    let pressure = if weight > 0.0 { (sum / weight).max(0.01 * ambient) } else { ambient };
    let close = |p: &&crate::Particle| {
        let cell = grid.cell_of(p.position.to_array());
        p.active && (0..3).all(|d| (cell[d] - c[d]).abs() <= 1)
    };
    let (mut velocity, mut mass) = (glam::DVec3::ZERO, 0.0);
    for particle in state.particles.iter().filter(close) {
        velocity += particle.velocity * particle.mass;
        mass += particle.mass;
    }
    let velocity = if mass > 0.0 { velocity / mass } else { velocity };
    let density = density * (pressure / ambient).powf(1.0 / problem.gamma);
    crate::Gas::conserved_from_primitive(density, velocity.to_array(), pressure, problem.gamma)
}

/// Part of its ledger that a gas cell applies at once. In the open the ledger may take half more than the cell holds, and 0.3 of the
/// speed of sound per step; enclosed on two faces or more it must leave a quarter, and a tenth. Nothing owed takes the entropy below the least.
pub fn settled_part(u: [f64; 5], owed: [f64; 5], volume: f64, open: bool, (gamma, least_entropy): (f64, f64)) -> f64 {
    let with = |part: f64| [0, 1, 2, 3, 4].map(|k| u[k] + part * owed[k] / volume);
    let (internal, all) = (internal_energy(u), with(1.0));
    let (left, speed) = if open { (-0.5, 0.3) } else { (0.25, 0.1) };
    if all[0] < left * u[0] || internal_energy(all) < left * internal {
        return 0.0;
    }
    let sound = (gamma * (gamma - 1.0) * internal / u[0]).sqrt();
    let velocity = |u: [f64; 5]| glam::dvec3(u[1], u[2], u[3]) / u[0];
    let entropy = |u: [f64; 5]| (gamma - 1.0) * internal_energy(u) / u[0].powf(gamma);
    let coldest = least_entropy.min(0.9999 * entropy(u));
    let stands = |after: [f64; 5]| {
        entropy(after) >= coldest
            && (internal_energy(after) - internal).abs() <= 0.1 * internal
            && (velocity(after) - velocity(u)).length() <= speed * sound
    };
    let mut part = f64::min(1.0, 0.1 * u[0] * volume / owed[0].abs());
    for _ in 0..12 {
        if stands(with(part)) {
            return part;
        }
        part *= 0.5;
    }
    0.0
}

/// Gas cells apply a part of their ledger and hand the rest to gas neighbours. Solid cells hand on as [`Walls::handed`] says.
fn settle(problem: &Problem, state: &mut State, walls: &Walls<'_>) {
    let grid = &problem.grid;
    let (mut next, mut above) = (vec![[0.0; 5]; grid.slots()], vec![[0.0; 5]; grid.slots()]);
    let mut give = |to: usize, amount: [f64; 5], upper: bool| {
        let book = if upper { &mut above } else { &mut next };
        (0..5).for_each(|k| book[to][k] += amount[k]);
    };
    let mut gas = state.gas.clone();
    for c in grid.interior() {
        let slot = grid.slot(c);
        if state.cells[slot] == SOLID {
            let handed = walls.handed(state, c);
            let taken = |upper| match &handed {
                Some(handed) if handed.upper == upper => handed.each.map(|x| x * handed.receivers.len() as f64),
                _ => [0.0; 5],
            };
            let left = |held: [f64; 5], taken: [f64; 5]| [0, 1, 2, 3, 4].map(|k| held[k] - taken[k]);
            give(slot, left(state.ledger[slot], taken(false)), false);
            give(slot, left(state.above[slot], taken(true)), true);
            for (to, upper) in handed.iter().flat_map(|handed| &handed.receivers) {
                give(*to, handed.as_ref().map_or([0.0; 5], |handed| handed.each), *upper);
            }
            continue;
        }
        let owed = state.ledger[slot];
        if owed == [0.0; 5] {
            continue;
        }
        let ahead = walls.followers(&state.gas, c);
        if !ahead.is_empty() {
            let each = owed.map(|x| x / ahead.len() as f64);
            ahead.into_iter().for_each(|(to, upper)| give(to, each, upper));
            continue;
        }
        let near = across(grid).into_iter().map(|o| add(c, o)).filter(|n| grid.contains(*n));
        let mut targets: Vec<_> = near.map(|n| grid.slot(n)).filter(|n| state.cells[*n] == GAS).collect();
        let u = state.gas.get(slot);
        let open = targets.len() + 1 >= 2 * grid.dimension;
        let part = settled_part(u, owed, grid.volume(), open, (problem.gamma, problem.least_entropy));
        gas.set(slot, [0, 1, 2, 3, 4].map(|k| u[k] + part * owed[k] / grid.volume()));
        if targets.is_empty() {
            targets.push(slot);
        }
        let share = (1.0 - part) / targets.len() as f64;
        targets.into_iter().for_each(|target| give(target, owed.map(|x| share * x), false));
    }
    (state.gas, state.ledger, state.above) = (gas, next, above);
}
