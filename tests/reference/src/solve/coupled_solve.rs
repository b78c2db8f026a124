//! The coupled pressure system: (S^-1 + dt^2 C^T M^-1 C) X = S^-1 X* + dt C^T V* - dt b, by Jacobi PCG.

use crate::boundary::{behind, open_faces};
use crate::gas::intermediate_pressure::Intermediate;
use crate::grid::{add, shift, subtract};
use crate::interface::{self, Interface};
use crate::solid::p2g::Nodes;
use crate::solid::particle_sort::{self, Bins};
use crate::solve::element;
use crate::{GAS, GHOST, Pair, Problem, SOLID, WALL};

/// Gas pressure.
pub const P: usize = 0;
/// Interface pressure.
pub const H: usize = 1;
/// Ghost pressure of the solid.
pub const Q: usize = 2;

/// One row of C: a velocity component of one node of one phase.
pub struct Row {
    /// It is a velocity of bodies rather than of gas.
    pub solid: bool,
    /// Axis of the velocity.
    pub axis: usize,
    /// Index of the node.
    pub node: usize,
    /// Mass of the node, kg.
    pub mass: f64,
    /// Velocity before the solve, m/s.
    pub velocity: f64,
    /// (unknown, coefficient).
    pub entries: Vec<(usize, f64)>,
}

/// The assembled system. Unknown = field * slots + vertex.
pub struct System {
    /// Velocities that the pressures drive.
    pub rows: Vec<Row>,
    /// Compliance of each unknown, m^3/Pa.
    pub compliance: Vec<f64>,
    /// Pressure of each unknown at the start, Pa.
    pub start: Vec<f64>,
    /// Divergence of each unknown by the velocity of open sides.
    pub open: Vec<f64>,
    /// Diagonal of the system.
    pub diagonal: Vec<f64>,
    /// Time step, s.
    pub dt: f64,
}

/// Solved pressures and solid velocities.
pub struct Solution {
    /// P, h, Q at vertices.
    pub pressure: [Vec<f64>; 3],
    /// Node velocity of the solid after the pressure kick.
    pub solid_velocity: Vec<[f64; 3]>,
    /// Iterations that were needed.
    pub iterations: usize,
    /// False where the iteration limit was met first.
    pub converged: bool,
}

/// Everything the assembly reads.
pub struct Inputs<'a> {
    /// What is solved.
    pub problem: &'a Problem,
    /// Faces between gas and bodies.
    pub interface: &'a Interface,
    /// Particles by cell.
    pub bins: &'a Bins,
    /// Gas after its advection.
    pub intermediate: &'a Intermediate,
    /// Solid nodes with the velocity that enters the solve.
    pub nodes: &'a Nodes,
    /// Time step, s.
    pub dt: f64,
}

/// Unknown of a field at a vertex: shared vertices have one.
pub fn unknown(interface: &Interface, field: usize, vertex: usize) -> usize {
    if interface.shared[vertex] { vertex } else { field * interface.shared.len() + vertex }
}

/// Coefficients of one row: [own field, h] by vertex offset from the node, -1..=2 per axis.
fn row_block(problem: &Problem, cells: &[u32], node: [i32; 3], axis: usize, kind: u32) -> [[f64; 64]; 2] {
    let grid = &problem.grid;
    let pair = if kind == SOLID { Pair::B2b1 } else { problem.numerics.pair };
    let (gradient, overlap) = (element::gradient(pair), element::overlap(pair));
    let mut block = [[0.0; 64]; 2];
    let corners = grid.offsets(0, 1);
    for (cell, off) in interface::elements_of(problem, node) {
        if cells[grid.slot(cell)] != kind {
            continue;
        }
        for corner in &corners {
            let at = local(subtract(add(cell, *corner), node));
            let across = grid.area() * element::tangential(grid, &overlap, axis, off, *corner);
            block[0][at] += gradient[(off[axis] + 1) as usize][corner[axis] as usize] * across;
            let normal = 2 * corner[axis] - 1;
            if off[axis] != 0 && off[axis] != normal {
                continue;
            }
            let face = f64::from(normal) * 0.5 * across;
            match (kind, cells[grid.slot(shift(cell, axis, normal))]) {
                (GAS, WALL | GHOST) => block[0][at] += face,
                (GAS, SOLID) | (SOLID, GAS) => block[1][at] += face,
                _ => {}
            }
        }
    }
    block
}

fn local(offset: [i32; 3]) -> usize {
    ((offset[0] + 1) + 4 * ((offset[1] + 1) + 4 * (offset[2] + 1))) as usize
}

/// The same of a node and its images beyond planes of symmetry, whose velocity across them is opposite, and nodes beyond open sides that
/// go with it.
pub fn block_with_images(problem: &Problem, cells: &[u32], node: [i32; 3], axis: usize, kind: u32) -> [[f64; 64]; 2] {
    if kind == SOLID {
        return row_block(problem, cells, node, axis, kind);
    }
    let grid = &problem.grid;
    let mut sum = [[0.0; 64]; 2];
    for off in grid.offsets(-1, 1) {
        let image = add(node, off);
        if problem.node_of(image) != node {
            continue;
        }
        let sign = if problem.mirrored(image)[axis] == image[axis] { 1.0 } else { -1.0 };
        let block = row_block(problem, cells, image, axis, kind);
        for corner in grid.offsets(-1, 2) {
            let from = subtract(add(node, corner), image);
            if from.iter().any(|k| !(-1..=2).contains(k)) {
                continue;
            }
            for (sum, block) in sum.iter_mut().zip(&block) {
                sum[local(corner)] += sign * block[local(from)];
            }
        }
    }
    sum
}

fn rows(inputs: &Inputs) -> Vec<Row> {
    let (problem, interface) = (inputs.problem, inputs.interface);
    let grid = &problem.grid;
    let inertia = particle_sort::inertia(problem, inputs.bins, &inputs.nodes.mass);
    let vertices = grid.offsets(-1, 2);
    let mut rows = Vec::new();
    for kind in [GAS, SOLID] {
        if kind == SOLID && inputs.bins.density == 0.0 {
            continue;
        }
        for node in grid.all() {
            let slot = grid.slot(node);
            if kind == GAS && problem.node_of(node) != node {
                continue;
            }
            let touched = interface::elements_of(problem, node).any(|(c, _)| interface.cells[grid.slot(c)] == kind);
            for axis in (0..grid.dimension).filter(|_| touched) {
                let block = block_with_images(problem, &interface.cells, node, axis, kind);
                let mut entries: Vec<(usize, f64)> = Vec::new();
                for off in &vertices {
                    let values = [block[0][local(*off)], block[1][local(*off)]];
                    if values == [0.0; 2] {
                        continue;
                    }
                    let vertex = grid.slot(add(node, *off));
                    let own = unknown(interface, if kind == GAS { P } else { Q }, vertex);
                    let other = unknown(interface, H, vertex);
                    if own == other {
                        entries.push((own, values[0] + values[1]));
                    } else {
                        entries.extend([(own, values[0]), (other, values[1])].iter().filter(|e| e.1 != 0.0));
                    }
                }
                let (mass, velocity) = if kind == GAS {
                    (inputs.intermediate.node_mass[slot], inputs.intermediate.node_velocity[slot][axis])
                } else {
                    (inertia[slot], inputs.nodes.velocity[slot][axis])
                };
                rows.push(Row { solid: kind == SOLID, axis, node: slot, mass, velocity, entries });
            }
        }
    }
    rows
}

/// Assembles the system.
pub fn assemble(inputs: &Inputs) -> System {
    let (problem, interface) = (inputs.problem, inputs.interface);
    let grid = &problem.grid;
    let slots = grid.slots();
    let mut compliance = vec![0.0; 3 * slots];
    let mut weighted = vec![0.0; 3 * slots];
    let mut start = vec![0.0; 3 * slots];
    let share = grid.volume() / 2.0_f64.powi(grid.dimension as i32);
    for vertex in grid.vertices() {
        let slot = grid.slot(vertex);
        let mut phases = [0.0; 2];
        for c in interface::around(problem, vertex).filter(|c| grid.contains(*c)).map(|c| grid.slot(c)) {
            match interface.cells[c] {
                GAS => phases[0] += share / (problem.gamma * inputs.intermediate.pressure[c]),
                SOLID => phases[1] += share * inputs.bins.compliance[c],
                _ => {}
            }
        }
        let values = [inputs.intermediate.vertex_pressure[slot], inputs.bins.ghost_pressure[slot]];
        start[H * slots + slot] = values[0];
        for (phase, field) in [P, Q].into_iter().enumerate() {
            let index = unknown(interface, field, slot);
            compliance[index] += phases[phase];
            weighted[index] += phases[phase] * values[phase];
        }
    }
    for index in (0..3 * slots).filter(|index| compliance[*index] > 0.0) {
        start[index] = weighted[index] / compliance[index];
    }
    let open = open_term(inputs, &start, &mut compliance);
    let rows = rows(inputs);
    let mut diagonal = compliance.clone();
    for row in &rows {
        for (index, value) in &row.entries {
            diagonal[*index] += inputs.dt * inputs.dt * value * value / row.mass;
        }
    }
    System { rows, compliance, start, open, diagonal, dt: inputs.dt }
}

/// b: int u.n N_v over open faces, with X* in u; the admittance of the faces goes to the compliance.
fn open_term(inputs: &Inputs, start: &[f64], compliance: &mut [f64]) -> Vec<f64> {
    let (problem, cells) = (inputs.problem, &inputs.interface.cells);
    let grid = &problem.grid;
    let mut open = vec![0.0; 3 * grid.slots()];
    let share = grid.area() / 2.0_f64.powi(grid.dimension as i32 - 1);
    for (c, axis, upper) in open_faces(problem, cells) {
        let face = inputs.intermediate.open[&behind(problem, (c, axis, upper))];
        let normal = if upper { 1.0 } else { -1.0 };
        for corner in grid.offsets(0, 1).into_iter().filter(|k| (k[axis] == 1) == upper) {
            let index = unknown(inputs.interface, P, grid.slot(add(c, corner)));
            // the reference is that of the middle of the face
            let along = (0..grid.dimension).filter(|d| *d != axis);
            let way: f64 = along.map(|d| problem.gravity[d] * (f64::from(corner[d]) - 0.5)).sum();
            let weight = inputs.intermediate.density[grid.slot(c)] * grid.spacing * way;
            open[index] +=
                share * (normal * face.velocity + face.admittance * (start[index] - face.reference - weight));
            compliance[index] += inputs.dt * share * face.admittance;
        }
    }
    open
}

impl System {
    /// C x, per row.
    pub fn force(&self, x: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.entries.iter().map(|(index, value)| value * x[*index]).sum()).collect()
    }

    /// C^T v.
    pub fn divergence(&self, v: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.compliance.len()];
        for (row, v) in self.rows.iter().zip(v) {
            for (index, value) in &row.entries {
                y[*index] += value * v;
            }
        }
        y
    }

    /// A x.
    pub fn apply(&self, x: &[f64]) -> Vec<f64> {
        let scaled: Vec<f64> = self.force(x).iter().zip(&self.rows).map(|(f, row)| f / row.mass).collect();
        let mut y = self.divergence(&scaled);
        for (index, y) in y.iter_mut().enumerate() {
            *y = self.compliance[index] * x[index] + self.dt * self.dt * *y;
        }
        y
    }

    /// Right-hand side of the increment form.
    pub fn right_hand_side(&self) -> Vec<f64> {
        let force = self.force(&self.start);
        let kicked: Vec<f64> =
            self.rows.iter().zip(&force).map(|(row, f)| row.velocity - self.dt * f / row.mass).collect();
        self.divergence(&kicked).iter().zip(&self.open).map(|(d, b)| self.dt * (d - b)).collect()
    }

    /// Solves for X; returns X, iterations and convergence.
    pub fn solve(&self, tolerance: f64, limit: usize) -> (Vec<f64>, usize, bool) {
        let precondition = |r: &[f64]| -> Vec<f64> {
            r.iter().zip(&self.diagonal).map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 }).collect()
        };
        let mut r = self.right_hand_side();
        let full: Vec<f64> = (0..r.len()).map(|i| self.compliance[i] * self.start[i] + r[i]).collect();
        let target = tolerance * tolerance * dot(&full, &precondition(&full));
        let mut x = vec![0.0; r.len()];
        let mut z = precondition(&r);
        let mut direction = z.clone();
        let mut rho = dot(&r, &z);
        let mut iterations = 0;
        while rho > target && iterations < limit {
            let image = self.apply(&direction);
            let alpha = rho / dot(&direction, &image);
            for i in 0..x.len() {
                x[i] += alpha * direction[i];
                r[i] -= alpha * image[i];
            }
            z = precondition(&r);
            let next = dot(&r, &z);
            let beta = next / rho;
            for i in 0..x.len() {
                direction[i] = z[i] + beta * direction[i];
            }
            rho = next;
            iterations += 1;
        }
        (x.iter().zip(&self.start).map(|(d, s)| d + s).collect(), iterations, rho <= target)
    }
}

/// Inner product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The stage: pressures and the kicked solid velocity.
pub fn coupled_solve(inputs: &Inputs) -> Solution {
    let numerics = &inputs.problem.numerics;
    let system = assemble(inputs);
    let (x, iterations, converged) = system.solve(numerics.tolerance, numerics.max_iterations);
    let slots = inputs.problem.grid.slots();
    let pressure = [P, H, Q].map(|field| (0..slots).map(|v| x[unknown(inputs.interface, field, v)]).collect());
    let mut solid_velocity = inputs.nodes.velocity.clone();
    for (row, force) in system.rows.iter().zip(system.force(&x)).filter(|(row, _)| row.solid) {
        solid_velocity[row.node][row.axis] -= inputs.dt * force / row.mass;
    }
    Solution { pressure, solid_velocity, iterations, converged }
}
