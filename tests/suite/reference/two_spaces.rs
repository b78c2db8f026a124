//! The twin of the two-space preconditioner: D^-1 r and, on every level, both hat functions and hat functions with alternating sign.

use super::Problem;
use super::coupled_solve::{P, Q, System, dot, unknown};
use super::interface::{self, Interface};
use super::{GAS, Pair, SOLID};

/// Vertices of a level along x and y, and whether their ends meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    pub(crate) count: [usize; 2],
    pub(crate) wraps: [bool; 2],
}

impl Size {
    /// Vertices of the grid.
    pub(crate) fn of(problem: &Problem) -> Self {
        let grid = &problem.grid;
        let count = [0, 1].map(|d| grid.cells[d] as usize + usize::from(!grid.periodic[d]));
        Self { count, wraps: [grid.periodic[0], grid.periodic[1]] }
    }

    /// The next coarser level: every other vertex, and one beyond where the last was left out.
    pub(crate) fn coarser(self) -> Self {
        let wraps = [0, 1].map(|d| self.wraps[d] && self.count[d].is_multiple_of(2));
        let count = [0, 1].map(|d| self.count[d] / 2 + usize::from(!wraps[d]));
        Self { count, wraps }
    }

    pub(crate) fn length(self) -> usize {
        self.count[0] * self.count[1]
    }

    /// Coarse vertices that a vertex lies between, along one axis, with their weights.
    fn between(coarse: Self, axis: usize, v: usize) -> [(usize, f64); 2] {
        if v.is_multiple_of(2) {
            [(v / 2, 1.0), (v / 2, 0.0)]
        } else {
            [(v / 2, 0.5), ((v / 2 + 1) % coarse.count[axis], 0.5)]
        }
    }

    /// Every pair of a vertex and a coarse vertex with its weight.
    fn each(self, mut act: impl FnMut(usize, usize, f64)) {
        let coarse = self.coarser();
        for y in 0..self.count[1] {
            for x in 0..self.count[0] {
                for (i, a) in Self::between(coarse, 0, x) {
                    for (j, b) in Self::between(coarse, 1, y).into_iter().filter(|(_, b)| a * b > 0.0) {
                        act(x + self.count[0] * y, i + coarse.count[0] * j, a * b);
                    }
                }
            }
        }
    }

    fn restricted(self, fine: &[f64]) -> Vec<f64> {
        let mut coarse = vec![0.0; self.coarser().length()];
        self.each(|v, c, weight| coarse[c] += weight * fine[v]);
        coarse
    }

    fn prolonged(self, coarse: &[f64]) -> Vec<f64> {
        let mut fine = vec![0.0; self.length()];
        self.each(|v, c, weight| fine[v] += weight * coarse[c]);
        fine
    }
}

/// How the coarse diagonals are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Diagonals {
    /// Those of the Galerkin operators.
    Exact,
    /// From row sums and the fine diagonal.
    Sums,
}

/// The preconditioner.
pub(crate) struct TwoSpaces {
    size: Size,
    /// Unknowns of each vertex that take part.
    fields: Vec<Vec<usize>>,
    inverse: Vec<f64>,
    /// Per level, per space.
    pub(crate) levels: Vec<[Vec<f64>; 2]>,
}

/// (-1)^(i+j), or 1.
fn sign(size: Size, space: usize, v: usize) -> f64 {
    if space == 1 && (v % size.count[0] + v / size.count[0]) % 2 == 1 { -1.0 } else { 1.0 }
}

/// Slot of each vertex.
fn slots(problem: &Problem) -> Vec<usize> {
    let size = Size::of(problem);
    (0..size.length()).map(|v| problem.grid.slot([(v % size.count[0]) as i32, (v / size.count[0]) as i32, 0])).collect()
}

/// Levels follow until the Courant number of the next is below this, and while there are so many vertices along an axis.
const SMOOTH: f64 = 0.7;
const FEWEST: usize = 4;

/// Square of the force of a vertex in units of the mean inverse mass, of the plain hat function, of the signed one, on wide grids.
const NARROW: [f64; 3] = [2.0, 8.0 / 3.0, 8.0 / 3.0];
const WIDE: [f64; 3] = [0.4707, 8.0 / 3.0, 0.0494 * 8.0 / 3.0];

fn stencil(problem: &Problem, interface: &Interface, slot: usize) -> [f64; 3] {
    let v = problem.grid.coordinates(slot);
    let touches = |kind| interface::touches(problem, &interface.cells, v, kind);
    let wide = problem.numerics.pair == Pair::B2b1 || (touches(SOLID) && !touches(GAS));
    if wide { WIDE } else { NARROW }
}

/// Largest Courant number of the unknowns, bodies included.
pub(crate) fn courant(problem: &Problem, interface: &Interface, system: &System) -> f64 {
    let square = |slot: usize, at: usize| {
        let s = system.compliance[at];
        if s > 0.0 { (system.diagonal[at] - s) / (s * stencil(problem, interface, slot)[0]) } else { 0.0 }
    };
    let of = |slot: usize| [P, Q].map(|field| square(slot, unknown(interface, field, slot)));
    slots(problem).into_iter().flat_map(of).fold(0.0, f64::max).sqrt()
}

impl TwoSpaces {
    pub(crate) fn new(problem: &Problem, interface: &Interface, system: &System, diagonals: Diagonals) -> Self {
        let size = Size::of(problem);
        let slots = slots(problem);
        let taken = |slot: usize| -> Vec<usize> {
            let mut all = vec![unknown(interface, P, slot), unknown(interface, Q, slot)];
            all.dedup();
            let whole = interface.shared[slot] || !touching(problem, interface, slot);
            all.retain(|at| system.diagonal[*at] > 0.0 && whole);
            all
        };
        let fields: Vec<Vec<usize>> = slots.iter().map(|slot| taken(*slot)).collect();
        let inverse = system.diagonal.iter().map(|d| if *d > 0.0 { 1.0 / d } else { 0.0 }).collect();
        let mut result = Self { size, fields, inverse, levels: Vec::new() };
        let number = |size: Size| size.count[0].min(size.count[1]);
        let (mut courant, mut at) = (courant(problem, interface, system), size);
        let mut wanted = 0;
        while courant >= SMOOTH && number(at) >= FEWEST {
            (courant, at, wanted) = (0.5 * courant, at.coarser(), wanted + 1);
        }
        let stencils: Vec<[f64; 3]> = slots.iter().map(|slot| stencil(problem, interface, *slot)).collect();
        let [plain, signed] = [0, 1].map(|space| match diagonals {
            Diagonals::Exact => result.exact(system, space, wanted),
            Diagonals::Sums => result.sums(system, &stencils, space, wanted),
        });
        result.levels = plain.into_iter().zip(signed).map(|(a, b)| [a, b]).collect();
        result
    }

    fn spread(&self, space: usize, values: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.inverse.len()];
        for (v, fields) in self.fields.iter().enumerate() {
            fields.iter().for_each(|at| x[*at] = sign(self.size, space, v) * values[v]);
        }
        x
    }

    fn gathered(&self, space: usize, x: &[f64]) -> Vec<f64> {
        let sum =
            |(v, fields): (usize, &Vec<usize>)| sign(self.size, space, v) * fields.iter().map(|at| x[*at]).sum::<f64>();
        self.fields.iter().enumerate().map(sum).collect()
    }

    fn sizes(&self, levels: usize) -> Vec<Size> {
        std::iter::successors(Some(self.size), |size| Some(size.coarser())).take(levels + 1).collect()
    }

    fn exact(&self, system: &System, space: usize, levels: usize) -> Vec<Vec<f64>> {
        let sizes = self.sizes(levels);
        let mut place = vec![usize::MAX; self.inverse.len()];
        for (v, fields) in self.fields.iter().enumerate() {
            fields.iter().for_each(|at| place[*at] = v);
        }
        // weights of every vertex in the hat functions of a level
        let mut weights: Vec<Vec<(usize, f64)>> = (0..self.size.length()).map(|v| vec![(v, 1.0)]).collect();
        let mut all = Vec::new();
        for pair in sizes.windows(2) {
            let mut up: Vec<Vec<(usize, f64)>> = vec![Vec::new(); pair[0].length()];
            pair[0].each(|v, c, weight| up[v].push((c, weight)));
            for own in &mut weights {
                let mut next: Vec<(usize, f64)> = Vec::new();
                for (v, weight) in own.iter() {
                    for (c, more) in &up[*v] {
                        match next.iter_mut().find(|(known, _)| known == c) {
                            Some((_, sum)) => *sum += weight * more,
                            None => next.push((*c, weight * more)),
                        }
                    }
                }
                *own = next;
            }
            let mut diagonal = vec![0.0; pair[1].length()];
            for (at, v) in place.iter().enumerate().filter(|(_, v)| **v != usize::MAX) {
                weights[*v].iter().for_each(|(c, weight)| diagonal[*c] += system.compliance[at] * weight * weight);
            }
            for row in &system.rows {
                let mut sums: Vec<(usize, f64)> = Vec::new();
                for (at, value) in row.entries.iter().filter(|(at, _)| place[*at] != usize::MAX) {
                    for (c, weight) in &weights[place[*at]] {
                        let term = value * weight * sign(self.size, space, place[*at]);
                        match sums.iter_mut().find(|(known, _)| known == c) {
                            Some((_, sum)) => *sum += term,
                            None => sums.push((*c, term)),
                        }
                    }
                }
                sums.iter().for_each(|(c, sum)| diagonal[*c] += system.dt * system.dt * sum * sum / row.mass);
            }
            all.push(diagonal.iter().map(|d| if *d > 0.0 { 1.0 / d } else { 0.0 }).collect());
        }
        all
    }

    fn sums(&self, system: &System, stencils: &[[f64; 3]], space: usize, levels: usize) -> Vec<Vec<f64>> {
        let mut own = self.gathered(space, &system.apply(&self.spread(space, &vec![1.0; stencils.len()])));
        let push = |(fields, stencil): (&Vec<usize>, &[f64; 3])| {
            let sum: f64 = fields.iter().map(|at| system.diagonal[*at] - system.compliance[*at]).sum();
            sum * stencil[1 + space] / stencil[0]
        };
        let mut push: Vec<f64> = self.fields.iter().zip(stencils).map(push).collect();
        let mut all = Vec::new();
        for size in self.sizes(levels).into_iter().take(levels) {
            own = size.restricted(&own);
            push = size.restricted(&push).iter().map(|value| 0.25 * value).collect();
            let diagonal = |(m, k): (&f64, &f64)| (4.0 / 9.0 * m + k).max(0.25 * k);
            let inverse = |d: f64| if d > 0.0 { 1.0 / d } else { 0.0 };
            all.push(own.iter().zip(&push).map(|pair| inverse(diagonal(pair))).collect());
        }
        all
    }

    /// z from r.
    pub(crate) fn apply(&self, r: &[f64], spaces: usize) -> Vec<f64> {
        let mut z: Vec<f64> = r.iter().zip(&self.inverse).map(|(r, d)| r * d).collect();
        let sizes = self.sizes(self.levels.len());
        for space in 0..spaces {
            let mut residuals = vec![self.gathered(space, r)];
            for size in &sizes[..self.levels.len()] {
                residuals.push(size.restricted(residuals.last().unwrap()));
            }
            let mut sum: Vec<f64> = vec![0.0; sizes.last().unwrap().length()];
            for level in (0..self.levels.len()).rev() {
                let own = residuals[level + 1].iter().zip(&self.levels[level][space]).map(|(r, d)| r * d);
                sum = own.zip(&sum).map(|(a, b)| a + b).collect();
                sum = sizes[level].prolonged(&sum);
            }
            self.spread(space, &sum).iter().zip(&mut z).for_each(|(more, z)| *z += more);
        }
        z
    }
}

fn touching(problem: &Problem, interface: &Interface, slot: usize) -> bool {
    let v = problem.grid.coordinates(slot);
    let touches = |kind| interface::touches(problem, &interface.cells, v, kind);
    touches(GAS) && touches(SOLID)
}

/// Iterations until sqrt(r . D^-1 r) <= tolerance sqrt(b . D^-1 b), and the solution.
pub(crate) fn iterations(
    system: &System,
    b: &[f64],
    tolerance: f64,
    precondition: impl Fn(&[f64]) -> Vec<f64>,
) -> (usize, Vec<f64>) {
    let norm = |r: &[f64]| -> f64 {
        r.iter().zip(&system.diagonal).map(|(r, d)| if *d > 0.0 { r * r / d } else { 0.0 }).sum()
    };
    let (mut x, mut r) = (vec![0.0; b.len()], b.to_vec());
    let target = tolerance * tolerance * norm(b);
    let mut z = precondition(&r);
    let mut direction = z.clone();
    let mut rho = dot(&r, &z);
    let mut count = 0;
    while norm(&r) > target && count < 1500 {
        let image = system.apply(&direction);
        let alpha = rho / dot(&direction, &image);
        x.iter_mut().zip(&direction).for_each(|(x, p)| *x += alpha * p);
        r.iter_mut().zip(&image).for_each(|(r, q)| *r -= alpha * q);
        z = precondition(&r);
        let next = dot(&r, &z);
        direction.iter_mut().zip(&z).for_each(|(p, z)| *p = z + next / rho * *p);
        (rho, count) = (next, count + 1);
    }
    (count, x)
}
