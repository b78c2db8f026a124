//! Where gas and solid meet: cell kinds, interface faces, shared vertices, film traction at walls.

pub mod ledger;
pub mod parting;
pub mod sides;

use crate::grid::{add, shift, subtract};
use crate::solid::p2g::Nodes;
use crate::solid::particle_sort::Bins;
use crate::solve::element;
use crate::{GAS, GHOST, Pair, Problem, SOLID, Shared, Side, WALL};

/// Result of the interface stage.
pub struct Interface {
    /// Kind per slot.
    pub cells: Vec<u32>,
    /// Normal solid velocity of gas/solid faces, by axis, at the low cell: mean of the two nodes by mass.
    pub face_velocity: [Vec<f64>; 3],
    /// Blocked fraction of solid cells.
    pub blocked: Vec<f64>,
    /// Vertices with one pressure for P, h and Q.
    pub shared: Vec<bool>,
}

/// A thin wall, in volumes at which a cell is full: what two cells side by side hold together, how much more than the two beyond
/// them, and how little lies beside the edge of a body.
const WALL_HOLDS: f64 = 1.4;
const WALL_STANDS_OUT: f64 = 0.8;
const WALL_ENDS: f64 = 0.7;
/// A cell that closes the corner of a wall holds more than this.
const WALL_CORNER: f64 = 0.1;
/// Shares of a cell that differ by less are equal.
const WALL_TIES: f64 = 0.1;

/// Volume of the thin wall that a cell, not full, is the solid part of: itself and a cell beside it; 0: of none.
fn thin_wall(problem: &Problem, bins: &Bins, before: &[u32], c: [i32; 3]) -> f64 {
    let grid = &problem.grid;
    let full = problem.numerics.solid_threshold * grid.volume();
    let fill = |at: [i32; 3]| if grid.contains(at) { bins.volume[grid.slot(at)] } else { 0.0 };
    let free = |at: [i32; 3]| grid.contains(at) && !problem.obstacles[grid.slot(at)];
    let was = |at: [i32; 3]| grid.contains(at) && before[grid.slot(at)] == SOLID;
    let is_edge = |n: [i32; 3], along: usize| {
        (0..grid.dimension).filter(|axis| *axis != along).any(|axis| {
            [-1, 1].into_iter().any(|side| {
                let [a, b] = [c, n].map(|at| fill(shift(at, axis, side)));
                let other: f64 = [c, n].map(|at| fill(shift(at, axis, -side))).iter().sum();
                a.min(b) > full && other < WALL_ENDS * full && free(shift(c, axis, -side))
            })
        })
    };
    let pairs = (0..grid.dimension).flat_map(|axis| [(axis, -1), (axis, 1)]);
    pairs.fold(0.0, |found, (axis, side)| {
        let n = shift(c, axis, side);
        let (own, next) = (fill(c), fill(n));
        let beyond = fill(shift(c, axis, -side)) + fill(shift(n, axis, side));
        let least = WALL_TIES * grid.volume();
        let stands = own + next >= WALL_HOLDS * full && own + next - beyond >= WALL_STANDS_OUT * full;
        let holds = stands && next <= full + least;
        let ties = (own - next).abs() <= least && (was(c) || !was(n));
        let solid = holds && (ties || own > next + least) && !is_edge(n, axis);
        if solid { f64::max(found, own + next) } else { found }
    })
}

/// Volume of a wall that goes on from one cell beside this one to another across a corner that this one closes; 0: none.
fn corner_of_wall(problem: &Problem, bins: &Bins, closed: &[f64], c: [i32; 3]) -> f64 {
    let grid = &problem.grid;
    let own = bins.volume[grid.slot(c)];
    let ignored = closed[grid.slot(c)] > 0.0 || own <= WALL_CORNER * problem.numerics.solid_threshold * grid.volume();
    if ignored {
        return 0.0;
    }
    let volume = |at: [i32; 3]| if grid.contains(at) { closed[grid.slot(at)] } else { 0.0 };
    let beside = |at: [i32; 3], o: [i32; 3], sign: i32| {
        let steps = (0..3).filter(|axis| o[*axis] != 0).map(|axis| volume(shift(at, axis, sign * o[axis])));
        steps.fold(f64::INFINITY, f64::min)
    };
    let mut found = 0.0;
    for offset in grid.offsets(-1, 1).into_iter().filter(|o| o.iter().map(|x| x.abs()).sum::<i32>() >= 2) {
        let across = add(c, offset);
        if !grid.contains(across) || problem.obstacles[grid.slot(across)] || volume(across) > 0.0 {
            continue;
        }
        if own >= bins.volume[grid.slot(across)] - WALL_TIES * grid.volume() {
            found = f64::max(found, beside(c, offset, 1).max(beside(across, offset, -1)));
        }
    }
    found
}

/// Kind of every cell and ring cell, and in the bins the volume of what closes cells; `before`: kinds of the step before.
pub fn kinds(problem: &Problem, bins: &mut Bins, before: &[u32]) -> Vec<u32> {
    let grid = &problem.grid;
    let mut closed = vec![0.0; grid.slots()];
    for c in grid.interior() {
        let slot = grid.slot(c);
        let full = bins.volume[slot] > problem.numerics.solid_threshold * grid.volume();
        closed[slot] = if full { bins.volume[slot] } else { thin_wall(problem, bins, before, c) };
    }
    let mut cells = vec![GAS; grid.slots()];
    let corners: Vec<([i32; 3], f64)> =
        grid.interior().into_iter().map(|c| (c, corner_of_wall(problem, bins, &closed, c))).collect();
    for c in grid.all() {
        let slot = grid.slot(c);
        cells[slot] = if !grid.contains(c) {
            let outside = (0..grid.dimension).filter(|d| c[*d] < 0 || c[*d] >= grid.cells[*d]);
            let mut sides = outside.map(|d| problem.sides[2 * d + usize::from(c[d] >= 0)]);
            if sides.any(|side| matches!(side, Side::Wall | Side::Periodic)) { WALL } else { GHOST }
        } else if problem.obstacles[slot] {
            WALL
        } else if bins.count[slot] == 0 {
            GAS
        } else if closed[slot] > 0.0 || !grid.offsets(-1, 1).into_iter().any(|o| closed[grid.slot(add(c, o))] > 0.0) {
            SOLID
        } else {
            GAS
        };
    }
    for (c, volume) in corners.into_iter().filter(|(_, volume)| *volume > 0.0) {
        cells[grid.slot(c)] = SOLID;
        closed[grid.slot(c)] = volume;
    }
    bins.closed = closed;
    cells
}

/// Cells around a vertex.
pub fn around(problem: &Problem, vertex: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    problem.grid.offsets(-1, 0).into_iter().map(move |o| add(vertex, o))
}

/// Does a vertex touch a cell of this kind inside the domain?
pub fn touches(problem: &Problem, cells: &[u32], vertex: [i32; 3], kind: u32) -> bool {
    around(problem, vertex).any(|c| problem.grid.contains(c) && cells[problem.grid.slot(c)] == kind)
}

/// Interface faces and vertices for given kinds.
pub fn interface(problem: &Problem, cells: Vec<u32>, bins: &Bins, nodes: &Nodes) -> Interface {
    let grid = &problem.grid;
    let mut face_velocity = [vec![0.0; grid.slots()], vec![0.0; grid.slots()], vec![0.0; grid.slots()]];
    for (axis, velocities) in face_velocity.iter_mut().enumerate().take(grid.dimension) {
        for low in grid.faces(axis) {
            let (a, b) = (grid.slot(low), grid.slot(shift(low, axis, 1)));
            if (cells[a] == GAS && cells[b] == SOLID) || (cells[a] == SOLID && cells[b] == GAS) {
                let momentum = |slot: usize| nodes.mass[slot] * nodes.velocity[slot][axis];
                let mass = nodes.mass[a] + nodes.mass[b];
                velocities[a] = if mass > 0.0 { (momentum(a) + momentum(b)) / mass } else { 0.0 };
            }
        }
    }
    let blocked =
        (0..grid.slots()).map(|slot| blocked_fraction(problem, bins.volume[slot].max(bins.closed[slot]))).collect();
    let mut shared = vec![false; grid.slots()];
    for vertex in grid.vertices() {
        let both = touches(problem, &cells, vertex, GAS) && touches(problem, &cells, vertex, SOLID);
        shared[grid.slot(vertex)] = both
            && match problem.numerics.shared {
                Shared::H => false,
                Shared::Single => true,
                Shared::Resolved => resolved(problem, bins, vertex),
            };
    }
    Interface { cells, face_velocity, blocked, shared }
}

/// Does the 4^d block of cells around a vertex hold enough solid?
pub fn resolved(problem: &Problem, bins: &Bins, vertex: [i32; 3]) -> bool {
    let grid = &problem.grid;
    let block = grid.offsets(-2, 1).into_iter().map(|o| add(vertex, o));
    let held: f64 = block.filter(|c| grid.contains(*c)).map(|c| bins.volume[grid.slot(c)]).sum();
    held >= 2.0 * 4.0_f64.powi(grid.dimension as i32 - 2) * grid.volume()
}

fn blocked_fraction(problem: &Problem, volume: f64) -> f64 {
    use std::f64::consts::PI;
    let dx = problem.grid.spacing;
    match problem.grid.dimension {
        1 => 1.0,
        2 => (2.0 * (volume / PI).sqrt() / dx).min(1.0),
        _ => (PI * (3.0 * volume / (4.0 * PI)).powf(2.0 / 3.0) / (dx * dx)).min(1.0),
    }
}

/// Pressure of the gas film at a vertex of a wall face normal to `axis`.
fn film_pressure(
    problem: &Problem,
    cells: &[u32],
    bins: &Bins,
    gas_pressure: &[f64],
    axis: usize,
    vertex: [i32; 3],
) -> f64 {
    let grid = &problem.grid;
    let own = bins.ghost_pressure[grid.slot(vertex)];
    for distance in 0..=16 {
        let mut found = (0.0, 0.0);
        for tangent in (0..grid.dimension).filter(|d| *d != axis) {
            for sign in [-1, 1] {
                let other = shift(vertex, tangent, sign * distance);
                let stored = other[tangent] >= 0 && other[tangent] <= grid.cells[tangent];
                if stored && touches(problem, cells, other, GAS) {
                    found = (found.0 + gas_pressure[grid.slot(other)], found.1 + 1.0);
                }
            }
        }
        if found.1 > 0.0 {
            return found.0 / found.1;
        }
    }
    own
}

/// Force of the film on the solid nodes: solid cells against walls, inlets and outlets.
pub fn film_force(problem: &Problem, cells: &[u32], bins: &Bins, gas_pressure: &[f64]) -> Vec<[f64; 3]> {
    let grid = &problem.grid;
    let overlap = element::overlap(Pair::B2b1);
    let mut force = vec![[0.0; 3]; grid.slots()];
    for c in grid.interior().into_iter().filter(|c| cells[grid.slot(*c)] == SOLID) {
        for axis in 0..grid.dimension {
            for normal in [-1, 1] {
                if !matches!(cells[grid.slot(shift(c, axis, normal))], WALL | GHOST) {
                    continue;
                }
                let on_face = |corner: &[i32; 3]| corner[axis] == (normal + 1) / 2;
                for corner in grid.offsets(0, 1).into_iter().filter(on_face) {
                    let pressure = film_pressure(problem, cells, bins, gas_pressure, axis, add(c, corner));
                    for off in grid.offsets(-1, 1) {
                        if off[axis] == 0 || off[axis] == normal {
                            let weight = 0.5 * grid.area() * element::tangential(grid, &overlap, axis, off, corner);
                            force[grid.slot(add(c, off))][axis] -= f64::from(normal) * weight * pressure;
                        }
                    }
                }
            }
        }
    }
    force
}

/// Cells that have a node in their element: the 3^d block of the node.
pub fn elements_of(problem: &Problem, node: [i32; 3]) -> impl Iterator<Item = ([i32; 3], [i32; 3])> {
    let grid = problem.grid.clone();
    problem.grid.offsets(-1, 1).into_iter().map(move |o| (subtract(node, o), o)).filter(move |(c, _)| grid.contains(*c))
}
