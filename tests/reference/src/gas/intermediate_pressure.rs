//! Pressure, node masses and node velocities of the gas after advection.

use crate::gas::carrier::Carrier;
use crate::grid::{add, shift};
use crate::interface::{self, Interface};
use crate::solve::element;
use crate::{GAS, GHOST, Gas, Pair, Problem, SOLID, boundary};

/// What the solve needs from the advected gas.
pub struct Intermediate {
    /// Density of gas cells.
    pub density: Vec<f64>,
    /// EOS pressure of gas cells.
    pub pressure: Vec<f64>,
    /// The same after the predictor.
    pub predicted_pressure: Vec<f64>,
    /// What the solve is told about open faces.
    pub open: boundary::OpenFaces,
    /// P* at vertices.
    pub vertex_pressure: Vec<f64>,
    /// Lumped mass of gas nodes.
    pub node_mass: Vec<f64>,
    /// Velocity of gas nodes.
    pub node_velocity: Vec<[f64; 3]>,
}

/// Velocity of the face above `low`, which touches at least one gas cell. `star` is the state after advection.
pub fn face_velocity(
    problem: &Problem,
    interface: &Interface,
    gas: &Gas,
    star: &Gas,
    axis: usize,
    low: [i32; 3],
) -> f64 {
    let grid = &problem.grid;
    let high = shift(low, axis, 1);
    let (a, b) = (grid.slot(low), grid.slot(high));
    match (interface.cells[a], interface.cells[b]) {
        (GAS, GAS) => {
            let (ra, rb) = (gas.conserved[a], gas.conserved[b]);
            (ra[1 + axis] + rb[1 + axis]) / (ra[0] + rb[0])
        }
        (GAS, GHOST) => boundary::carried_velocity(problem, star, axis, true, low),
        (GHOST, GAS) => boundary::carried_velocity(problem, star, axis, false, high),
        (GAS, SOLID) | (SOLID, GAS) => interface.face_velocity[axis][a],
        _ => 0.0,
    }
}

/// Factor on the cell pressure by the consistent predictor.
pub fn predicted(
    problem: &Problem,
    interface: &Interface,
    star: &Gas,
    carrier: Option<&Carrier>,
    cell: [i32; 3],
    dt: f64,
) -> f64 {
    let mut divergence = carrier.map_or(0.0, |c| c.corrected_divergence(problem, &interface.cells, cell));
    for axis in (0..problem.grid.dimension).filter(|_| carrier.is_none()) {
        let below = face_velocity(problem, interface, star, star, axis, shift(cell, axis, -1));
        divergence += face_velocity(problem, interface, star, star, axis, cell) - below;
    }
    let d = dt * divergence / problem.grid.spacing;
    let switch = if d >= 0.0 { 1.0 } else { (1.0 + 30.0 * d).max(0.0) };
    let unseen = carrier.map_or(0.0, |c| c.unseen_divergence(problem, &interface.cells, cell));
    (1.0 + switch * d - problem.gamma * dt * unseen / problem.grid.spacing).max(0.1)
}

/// Node velocity: gas cell, ghost, or the nearest gas cells by class (faces, edges, corners).
fn node_velocity(problem: &Problem, cells: &[u32], star: &Gas, node: [i32; 3]) -> [f64; 3] {
    let grid = &problem.grid;
    let known = match cells[grid.slot(node)] {
        GAS => Some(star.velocity(grid.slot(node))),
        GHOST => boundary::node_velocity(problem, cells, star, node),
        _ => None,
    };
    if let Some(velocity) = known {
        return velocity;
    }
    for class in 1..=grid.dimension as i32 {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for off in grid.offsets(-1, 1).into_iter().filter(|o| o.iter().map(|x| x.abs()).sum::<i32>() == class) {
            let c = add(node, off);
            if grid.contains(c) && cells[grid.slot(c)] == GAS {
                let v = star.velocity(grid.slot(c));
                sum = [0, 1, 2].map(|d| sum[d] + v[d]);
                count += 1.0;
            }
        }
        if count > 0.0 {
            return sum.map(|s| s / count);
        }
    }
    [0.0; 3]
}

/// Density with which a gas cell counts in a node: of the node's own cell where the velocity is constant per cell, in gas alone.
fn seen_density(problem: &Problem, interface: &Interface, star: &Gas, node: [i32; 3], slot: usize) -> f64 {
    let own = problem.grid.slot(node);
    let alone = problem.numerics.pair == Pair::B1b0 && problem.materials.is_empty() && interface.cells[own] == GAS;
    star.conserved[if alone { own } else { slot }][0]
}

/// The stage. The predictor sees what advection compressed, without the kick of gravity that `star` has. With two solves per step
/// `carrying` is the gas that carried itself: its velocity compressed, and its pressure stands in for one that is lost.
pub fn intermediate(
    problem: &Problem,
    interface: &Interface,
    (advected, star): (&Gas, &Gas),
    carrying: Option<&Gas>,
    memory: &boundary::Memory,
    dt: f64,
) -> Intermediate {
    let grid = &problem.grid;
    let mut pressure = vec![0.0; grid.slots()];
    let mut predicted_pressure = vec![0.0; grid.slots()];
    let mut node_mass = vec![0.0; grid.slots()];
    let carrier = Carrier::new(problem, &interface.cells, carrying.unwrap_or(advected));
    for c in grid.interior() {
        let slot = grid.slot(c);
        if interface.cells[slot] != GAS {
            continue;
        }
        let least = carrying.map_or(0.0, |gas| 0.1 * gas.pressure(slot, problem.gamma));
        pressure[slot] = star.pressure(slot, problem.gamma).max(least);
        let factor = if problem.numerics.predictor {
            predicted(problem, interface, advected, carrier.as_ref(), c, dt)
        } else {
            1.0
        };
        predicted_pressure[slot] = factor * pressure[slot];
        for off in grid.offsets(-1, 1) {
            let share = element::node_weight(grid, problem.numerics.pair, off) * grid.volume();
            let node = problem.node_of(add(c, off));
            node_mass[grid.slot(node)] += share * seen_density(problem, interface, star, node, slot);
        }
    }
    let mut vertex_pressure = vec![0.0; grid.slots()];
    for vertex in grid.vertices() {
        let inside = interface::around(problem, vertex).filter(|c| grid.contains(*c));
        let gas: Vec<[i32; 3]> = inside.filter(|c| interface.cells[grid.slot(*c)] == GAS).collect();
        let balanced = gas.len() == 1 << grid.dimension || !problem.materials.is_empty();
        let value = |c: &[i32; 3]| {
            let way: f64 = (0..grid.dimension)
                .map(|axis| problem.gravity[axis] * (f64::from(vertex[axis] - c[axis]) - 0.5) * grid.spacing)
                .sum();
            let weight = if balanced { 0.0 } else { star.conserved[grid.slot(*c)][0] * way };
            predicted_pressure[grid.slot(*c)] + weight
        };
        if !gas.is_empty() {
            vertex_pressure[grid.slot(vertex)] = gas.iter().map(value).sum::<f64>() / gas.len() as f64;
        }
    }
    let mut velocities = vec![[0.0; 3]; grid.slots()];
    for node in grid.all().into_iter().filter(|node| node_mass[grid.slot(*node)] > 0.0) {
        velocities[grid.slot(node)] = node_velocity(problem, &interface.cells, star, node);
    }
    let open = boundary::faces(problem, &interface.cells, star, &predicted_pressure, memory, dt);
    let density = star.conserved.iter().map(|u| u[0]).collect();
    Intermediate { density, pressure, predicted_pressure, open, vertex_pressure, node_mass, node_velocity: velocities }
}
