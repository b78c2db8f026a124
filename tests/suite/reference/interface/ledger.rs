//! Gas owed to or held by cells: covering, uncovering, settling.

use crate::reference::grid::{Grid, add, shift};
use crate::reference::solid::particle_sort::Bins;
use crate::reference::{GAS, Problem, SOLID, State, internal_energy};

/// Replaces the cell kinds: covered cells put their gas on the ledger, uncovered ones are filled from it.
pub(crate) fn change_kinds(problem: &Problem, state: &mut State, kinds: &[u32], bins: &Bins) {
    let grid = &problem.grid;
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
            let fill = mean(faces(grid)).or_else(|| mean(grid.offsets(-1, 1))).or_else(|| mean(grid.offsets(-2, 2)));
            let fill = fill.unwrap_or_else(|| pocket(problem, state, bins, c));
            state.gas.set(slot, fill);
            (0..5).for_each(|k| state.ledger[slot][k] -= fill[k] * volume);
        }
    }
    state.cells = kinds.to_vec();
    settle(problem, state);
}

fn faces(grid: &Grid) -> Vec<[i32; 3]> {
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
    let close = |p: &&crate::reference::Particle| {
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
    crate::reference::Gas::conserved_from_primitive(density, velocity.to_array(), pressure, problem.gamma)
}

/// Part of its ledger that a gas cell applies at once. In the open the ledger may take half more than the cell holds, and 0.3 of the
/// speed of sound per step; enclosed on two faces or more it must leave a quarter, and a tenth. Nothing owed takes the entropy below the least.
pub(crate) fn settled_part(
    u: [f64; 5],
    owed: [f64; 5],
    volume: f64,
    open: bool,
    (gamma, least_entropy): (f64, f64),
) -> f64 {
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

/// Gas cells apply a part of their ledger and hand the rest to gas neighbours. Solid cells at the surface keep up to 1.1 times what gas of
/// the density beside them would be, and hand the rest to it; buried ones hand all they have to the surface beside them, or to all sides.
pub(crate) fn settle(problem: &Problem, state: &mut State) {
    let grid = &problem.grid;
    let mut next = vec![[0.0; 5]; grid.slots()];
    let density: Vec<f64> = (0..grid.slots()).map(|slot| state.gas.get(slot)[0]).collect();
    let near = |c: [i32; 3]| faces(grid).into_iter().map(move |o| add(c, o)).filter(|n| grid.contains(*n));
    let cells = state.cells.clone();
    let beside = |c: [i32; 3], kind: u32| near(c).filter(|n| cells[grid.slot(*n)] == kind).collect::<Vec<_>>();
    for c in grid.interior() {
        let slot = grid.slot(c);
        let mut rest = state.ledger[slot];
        if rest == [0.0; 5] {
            continue;
        }
        let mut targets = beside(c, GAS);
        if state.cells[slot] == GAS {
            let u = state.gas.get(slot);
            let open = targets.len() + 1 >= 2 * grid.dimension;
            let part = settled_part(u, rest, grid.volume(), open, (problem.gamma, problem.least_entropy));
            state.gas.set(slot, [0, 1, 2, 3, 4].map(|k| u[k] + part * rest[k] / grid.volume()));
            rest = rest.map(|owed| (1.0 - part) * owed);
        } else if targets.is_empty() {
            targets = beside(c, SOLID);
            let surface: Vec<_> = targets.iter().copied().filter(|n| !beside(*n, GAS).is_empty()).collect();
            if !surface.is_empty() {
                targets = surface;
            }
        } else {
            let mean = targets.iter().map(|n| density[grid.slot(*n)]).sum::<f64>() / targets.len() as f64;
            let part = (1.0 - 1.1 * mean * grid.volume() / rest[0].abs()).max(0.0);
            (0..5).for_each(|k| next[slot][k] += (1.0 - part) * rest[k]);
            rest = rest.map(|held| part * held);
        }
        if targets.is_empty() {
            targets.push(c);
        }
        let share = 1.0 / targets.len() as f64;
        for target in targets {
            (0..5).for_each(|k| next[grid.slot(target)][k] += share * rest[k]);
        }
    }
    state.ledger = next;
}
