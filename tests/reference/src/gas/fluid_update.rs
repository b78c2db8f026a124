//! Momentum and energy of the gas from the solved pressures; internal-energy floor, kinetic energy first.

use crate::boundary;
use crate::gas::carrier::Carrier;
use crate::gas::intermediate_pressure::{Intermediate, face_velocity};
use crate::grid::{add, shift};
use crate::interface::parting::Parting;
use crate::interface::{self, Interface};
use crate::solid::p2g::Nodes;
use crate::solve::coupled_solve::{H, P, Solution};
use crate::solve::element;
use crate::{GAS, Gas, Pair, Problem, SOLID, internal_energy, kinetic_energy};

/// Pressure of the face above `low`.
pub fn face_pressure(problem: &Problem, interface: &Interface, solution: &Solution, axis: usize, low: [i32; 3]) -> f64 {
    let grid = &problem.grid;
    let high = shift(low, axis, 1);
    let (a, b) = (interface.cells[grid.slot(low)], interface.cells[grid.slot(high)]);
    let image = problem.mirrored(low) != low || problem.mirrored(high) != high;
    if (image || a == GAS && b == GAS)
        && problem.numerics.pair == Pair::B2b1
        && let Some(smooth) = smooth_pressure(problem, interface, &solution.pressure[P], axis, high)
    {
        return smooth;
    }
    let field = if a == SOLID || b == SOLID { H } else { P };
    let corners: Vec<_> = grid.offsets(0, 1).into_iter().filter(|k| k[axis] == 0).collect();
    corners.iter().map(|k| solution.pressure[field][grid.slot(add(high, *k))]).sum::<f64>() / corners.len() as f64
}

/// The face pressure whose difference is the B2B1 force; None where it needs a vertex without gas.
fn smooth_pressure(
    problem: &Problem,
    interface: &Interface,
    pressure: &[f64],
    axis: usize,
    high: [i32; 3],
) -> Option<f64> {
    let grid = &problem.grid;
    let mut sum = 0.0;
    for off in grid.offsets(-1, 2).into_iter().filter(|o| o[axis] < 2) {
        let vertex = problem.mirrored_vertex(add(high, off));
        let stored = (0..grid.dimension).all(|d| grid.periodic[d] || (vertex[d] >= 0 && vertex[d] <= grid.cells[d]));
        if !stored || !interface::touches(problem, &interface.cells, vertex, GAS) {
            return None;
        }
        let weight: f64 = (0..grid.dimension)
            .map(|d| match (d == axis, off[d]) {
                (true, 0) => 2.0 / 3.0,
                (true, _) => 1.0 / 6.0,
                (false, 0 | 1) => 11.0 / 24.0,
                (false, _) => 1.0 / 24.0,
            })
            .product();
        sum += weight * pressure[grid.slot(vertex)];
    }
    Some(sum)
}

/// Work per time that the gas does through an interface face: sum h_v int N_v V.n, with n out of the gas.
fn solid_power(problem: &Problem, solution: &Solution, velocity: &[[f64; 3]], axis: usize, low: [i32; 3]) -> f64 {
    let grid = &problem.grid;
    let overlap = element::overlap(Pair::B2b1);
    let high = shift(low, axis, 1);
    let mut power = 0.0;
    for corner in grid.offsets(0, 1).into_iter().filter(|k| k[axis] == 0) {
        let h = solution.pressure[H][grid.slot(add(high, corner))];
        for off in grid.offsets(-1, 1).into_iter().filter(|o| o[axis] < 1) {
            let weight = 0.5 * grid.area() * element::tangential(grid, &overlap, axis, off, corner);
            power += h * weight * velocity[grid.slot(add(high, off))][axis];
        }
    }
    power
}

/// Solid velocity that the interface power is taken with: the mean of the old and the new one.
fn working_velocity(problem: &Problem, solution: &Solution, before: &[[f64; 3]]) -> Vec<[f64; 3]> {
    if problem.numerics.shared_volume {
        return solution.solid_velocity.clone();
    }
    let midpoint = |(old, new): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|d| 0.5 * (old[d] + new[d]));
    before.iter().zip(&solution.solid_velocity).map(midpoint).collect()
}

/// Share of the gas cell at a face above `low` that half of what a body gains in the solve carries upwards.
fn late_share(
    problem: &Problem,
    interface: &Interface,
    (solution, nodes): (&Solution, &Nodes),
    (axis, low): (usize, [i32; 3]),
    dt: f64,
) -> f64 {
    let at = [low, shift(low, axis, 1)].map(|c| problem.grid.slot(c));
    let mass = at.map(|slot| nodes.mass[slot]);
    if mass[0] + mass[1] == 0.0 {
        return 0.0;
    }
    let gain = at.map(|slot| solution.solid_velocity[slot][axis] - nodes.velocity[slot][axis]);
    let gain = (mass[0] * gain[0] + mass[1] * gain[1]) / (mass[0] + mass[1]);
    let blocked = interface.blocked[at[usize::from(interface.cells[at[1]] == SOLID)]];
    (0.5 * gain * blocked * dt / problem.grid.spacing).clamp(-0.1, 0.1)
}

/// Gas that follows the bodies, between cells and the ledger. `nodes` as in [`fluid_update`].
pub fn late_flux(
    problem: &Problem,
    interface: &Interface,
    gas: &mut Gas,
    pressed: (&Solution, &Nodes),
    dt: f64,
    ledger: &mut [[f64; 5]],
) {
    if !problem.numerics.late_flux {
        return;
    }
    let grid = &problem.grid;
    let mut left = vec![0.0; grid.slots()];
    for axis in 0..grid.dimension {
        for low in grid.faces(axis) {
            let [below, above] = [low, shift(low, axis, 1)].map(|c| grid.slot(c));
            let both = grid.contains(low) && grid.contains(shift(low, axis, 1));
            let (cell, body, sign) = match (interface.cells[below], interface.cells[above]) {
                (GAS, SOLID) if both => (below, above, 1.0),
                (SOLID, GAS) if both => (above, below, -1.0),
                _ => continue,
            };
            let share = sign * late_share(problem, interface, pressed, (axis, low), dt);
            left[cell] += share;
            for (owed, u) in ledger[body].iter_mut().zip(gas.get(cell)) {
                *owed += share * u * grid.volume();
            }
        }
    }
    for (slot, left) in left.into_iter().enumerate().filter(|(_, left)| *left != 0.0) {
        gas.set(slot, gas.get(slot).map(|u| (1.0 - left) * u));
    }
}

/// The face pressures per axis, and the gas with the momentum that they give it.
fn push(problem: &Problem, interface: &Interface, star: &Gas, solution: &Solution, dt: f64) -> ([Vec<f64>; 3], Gas) {
    let grid = &problem.grid;
    let kind = |c: [i32; 3]| interface.cells[grid.slot(c)];
    let touching = |low: [i32; 3], axis: usize| kind(low) == GAS || kind(shift(low, axis, 1)) == GAS;
    let mut pressure = [vec![0.0; grid.slots()], vec![0.0; grid.slots()], vec![0.0; grid.slots()]];
    let mut next = star.clone();
    for (axis, pressure) in pressure.iter_mut().enumerate().take(grid.dimension) {
        for low in grid.faces(axis).into_iter().filter(|low| touching(*low, axis)) {
            pressure[grid.slot(low)] = face_pressure(problem, interface, solution, axis, low);
        }
        for c in grid.interior().into_iter().filter(|c| kind(*c) == GAS) {
            let (below, above) = (grid.slot(shift(c, axis, -1)), grid.slot(c));
            next.conserved[above][1 + axis] -= dt / grid.spacing * (pressure[above] - pressure[below]);
        }
    }
    (pressure, next)
}

/// What carries the gas that the solve has moved, which notes by how much open faces are faster.
fn carrier_of(
    problem: &Problem,
    cells: &[u32],
    gas: &mut Gas,
    solved: (&boundary::OpenFaces, &[f64]),
) -> Option<Carrier> {
    gas.surplus.clear();
    let carrier = Carrier::new(problem, cells, gas)?;
    gas.surplus = boundary::surplus(problem, cells, solved, &carrier.velocity);
    Carrier::new(problem, cells, gas)
}

/// The stage: gas after the pressure step. `nodes` are the solid nodes that entered the solve. The new velocities of the faces carry the
/// internal energy of `held`, too. Also how many vertices got less than they asked.
pub fn fluid_update(
    problem: &Problem,
    interface: &Interface,
    (star, held, intermediate): (&Gas, Option<&Gas>, &Intermediate),
    (solution, nodes): (&Solution, &Nodes),
    dt: f64,
) -> (Gas, usize) {
    let grid = &problem.grid;
    let gas_slots: Vec<_> = grid.interior().into_iter().filter(|c| interface.cells[grid.slot(*c)] == GAS).collect();
    let kind = |c: [i32; 3]| interface.cells[grid.slot(c)];
    let touching = |low: [i32; 3], axis: usize| kind(low) == GAS || kind(shift(low, axis, 1)) == GAS;
    let (pressure, mut next) = push(problem, interface, star, solution, dt);
    let solid = working_velocity(problem, solution, &nodes.velocity);
    let mut work = pressure.clone();
    let carrier = carrier_of(problem, &interface.cells, &mut next, (&intermediate.open, &solution.pressure[P]));
    let gas = &next.clone();
    let (before, solid, carrier) = (&intermediate.predicted_pressure, &solid, carrier.as_ref());
    let parting = Parting { problem, interface, gas, pressure: before, solution, solid, dt };
    for axis in 0..grid.dimension {
        for low in grid.faces(axis).into_iter().filter(|low| touching(*low, axis)) {
            let slot = grid.slot(low);
            let closed = kind(low) == SOLID || kind(shift(low, axis, 1)) == SOLID;
            work[axis][slot] = if closed {
                solid_power(problem, solution, solid, axis, low) / grid.area()
            } else {
                let high = grid.slot(shift(low, axis, 1));
                let velocity = match carrier {
                    Some(carrier) if interface.cells[slot] == GAS && interface.cells[high] == GAS => {
                        carrier.between(&next, axis, slot, high)
                    }
                    _ => face_velocity(problem, interface, &next, star, axis, low),
                };
                let inside = interface.cells[slot] == GAS && interface.cells[high] == GAS;
                let heat = |gas: &Gas| 0.5 * (internal_energy(gas.get(slot)) + internal_energy(gas.get(high)));
                let p = pressure[axis][slot];
                let shift = if inside { parting.shift_between(p, axis, slot, high) } else { 0.0 };
                (p + held.filter(|_| inside).map_or(0.0, heat)) * velocity + shift
            };
        }
        for face in boundary::open_faces(problem, &interface.cells).into_iter().filter(|face| face.1 == axis) {
            let slot = grid.slot(if face.2 { face.0 } else { shift(face.0, axis, -1) });
            let p = pressure[axis][slot];
            let ring = boundary::behind(problem, face);
            let solved = boundary::solved_velocity(problem, &intermediate.open, face, p);
            let carrier = carrier.filter(|_| intermediate.open[&ring].admittance > 0.0);
            work[axis][slot] = p * carrier.map_or(solved, |carrier| carrier.velocity[ring][axis]);
        }
        for c in &gas_slots {
            let (below, above) = (grid.slot(shift(*c, axis, -1)), grid.slot(*c));
            next.energy[above] -= dt / grid.spacing * (work[axis][above] - work[axis][below]);
        }
    }
    let (heats, limited) = parting.heat_at_vertices();
    for (energy, heat) in next.energy.iter_mut().zip(heats) {
        *energy += dt / grid.spacing * heat;
    }
    (next, limited)
}

/// Keeps the internal energy above a tenth of its value after advection and the entropy above the least; returns how many cells it touched.
pub fn energy_floor(problem: &Problem, cells: &[u32], star: &Gas, gas: &mut Gas, ledger: &mut [[f64; 5]]) -> usize {
    let volume = problem.grid.volume();
    let mut touched = 0;
    for slot in
        (0..cells.len()).filter(|slot| cells[*slot] == GAS && problem.grid.contains(problem.grid.coordinates(*slot)))
    {
        let mut u = gas.get(slot);
        let coldest = problem.least_entropy * u[0].powf(problem.gamma) / (problem.gamma - 1.0);
        let floor = coldest.max(0.1 * internal_energy(star.get(slot)));
        if internal_energy(u) >= floor {
            continue;
        }
        touched += 1;
        let kept = if u[4] > floor { ((u[4] - floor) / kinetic_energy(u)).sqrt() } else { 0.0 };
        for k in 1..4 {
            ledger[slot][k] += (1.0 - kept) * u[k] * volume;
            u[k] *= kept;
        }
        if u[4] < floor {
            ledger[slot][4] -= (floor - u[4]) * volume;
            u[4] = floor;
        }
        gas.set(slot, u);
    }
    touched
}
