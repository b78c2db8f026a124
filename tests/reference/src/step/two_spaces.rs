//! The twin of the preconditioner with coarse spaces: D^-1 r and, on every level, hat functions and hat functions with alternating sign.

use crate::Problem;
use crate::interface::{self, Interface};
use crate::solve::coupled_solve::{P, Q, System, dot, unknown};
use crate::{GAS, Pair, SOLID};

/// Functions of one kind: the axes that their levels coarsen, and whether their sign alternates along these.
#[derive(Clone, Copy, Debug)]
pub struct Space {
    coarsens: [bool; 3],
    signed: bool,
}

/// Hat functions, then those that alternate along two axes; these are hats along the two alone.
fn spaces(dimension: usize) -> Vec<Space> {
    let plain = Space { coarsens: [0, 1, 2].map(|axis| axis < dimension), signed: false };
    let pairs = [[true, true, false], [false, true, true], [true, false, true]];
    let signed = pairs[..if dimension == 3 { 3 } else { 1 }].iter().map(|&coarsens| Space { coarsens, signed: true });
    std::iter::once(plain).chain(signed).collect()
}

/// Vertices of a level along the axes, and whether their ends meet.
#[derive(Clone, Copy, Debug)]
struct Size {
    count: [usize; 3],
    wraps: [bool; 3],
}

impl Size {
    /// Vertices of the grid.
    fn of(problem: &Problem) -> Self {
        let grid = &problem.grid;
        let beyond = |d: usize| usize::from(d < grid.dimension && !grid.periodic[d]);
        Self { count: [0, 1, 2].map(|d| grid.cells[d] as usize + beyond(d)), wraps: grid.periodic }
    }

    /// The next coarser level: every other vertex, and one beyond where the last was left out.
    fn coarser(self, space: Space) -> Self {
        let even = |d: usize| self.wraps[d] && self.count[d].is_multiple_of(2);
        let wraps = [0, 1, 2].map(|d| if space.coarsens[d] { even(d) } else { self.wraps[d] });
        let along = |d: usize| self.count[d] / 2 + usize::from(!wraps[d]);
        Self { count: [0, 1, 2].map(|d| if space.coarsens[d] { along(d) } else { self.count[d] }), wraps }
    }

    fn length(self) -> usize {
        self.count.iter().product()
    }

    fn place(self, at: [usize; 3]) -> usize {
        at[0] + self.count[0] * (at[1] + self.count[1] * at[2])
    }

    fn coordinates(self, v: usize) -> [usize; 3] {
        [v % self.count[0], v / self.count[0] % self.count[1], v / (self.count[0] * self.count[1])]
    }

    /// Coarse vertices that a vertex lies between, along one axis, with their weights.
    fn between(coarse: Self, space: Space, axis: usize, v: usize) -> [(usize, f64); 2] {
        match (space.coarsens[axis], v.is_multiple_of(2)) {
            (false, _) => [(v, 1.0), (v, 0.0)],
            (true, true) => [(v / 2, 1.0), (v / 2, 0.0)],
            (true, false) => [(v / 2, 0.5), ((v / 2 + 1) % coarse.count[axis], 0.5)],
        }
    }

    /// Every pair of a vertex and a coarse vertex with its weight.
    fn each(self, space: Space, mut act: impl FnMut(usize, usize, f64)) {
        let coarse = self.coarser(space);
        for v in 0..self.length() {
            let at = self.coordinates(v);
            let near = [0, 1, 2].map(|axis| Self::between(coarse, space, axis, at[axis]));
            for k in 0..8 {
                let pick = [0, 1, 2].map(|axis| near[axis][k >> axis & 1]);
                let weight: f64 = pick.iter().map(|(_, weight)| weight).product();
                if weight > 0.0 {
                    act(v, coarse.place(pick.map(|(place, _)| place)), weight);
                }
            }
        }
    }

    fn restricted(self, space: Space, fine: &[f64]) -> Vec<f64> {
        let mut coarse = vec![0.0; self.coarser(space).length()];
        self.each(space, |v, c, weight| coarse[c] += weight * fine[v]);
        coarse
    }

    fn prolonged(self, space: Space, coarse: &[f64]) -> Vec<f64> {
        let mut fine = vec![0.0; self.length()];
        self.each(space, |v, c, weight| fine[v] += weight * coarse[c]);
        fine
    }
}

/// How the coarse diagonals are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Diagonals {
    /// Those of the Galerkin operators.
    Exact,
    /// From row sums and the fine diagonal.
    Sums,
}

/// The preconditioner.
pub struct TwoSpaces {
    size: Size,
    spaces: Vec<Space>,
    /// Unknowns of each vertex that take part.
    fields: Vec<Vec<usize>>,
    inverse: Vec<f64>,
    /// Coarse levels in use.
    pub levels: usize,
    /// Inverse diagonals, per space, per level.
    diagonals: Vec<Vec<Vec<f64>>>,
}

/// -1 or 1.
fn sign(size: Size, space: Space, v: usize) -> f64 {
    let along = size.coordinates(v);
    let sum: usize = (0..3).filter(|axis| space.coarsens[*axis]).map(|axis| along[axis]).sum();
    if space.signed && !sum.is_multiple_of(2) { -1.0 } else { 1.0 }
}

/// Slot of each vertex.
fn slots(problem: &Problem) -> Vec<usize> {
    let size = Size::of(problem);
    (0..size.length()).map(|v| problem.grid.slot(size.coordinates(v).map(|c| c as i32))).collect()
}

/// Levels follow until the Courant number of the next is below this, and while there are so many vertices along an axis.
const SMOOTH: f64 = 0.7;
const FEWEST: usize = 4;

/// Weight of the alternating spaces in 3D, which have much in common.
const COMMON_WEIGHT: f64 = 0.4;

/// Sums of squares of an axis' coefficients, slopes and means, and the energy of a long wave with alternating sign in units of that of
/// the wave itself.
const NARROW: [f64; 3] = [2.0, 0.5, 1.0];
const WIDE: [f64; 3] = [20.0 / 36.0, 244.0 / 576.0, 4.0 / 81.0];

/// What the elements around a vertex make of unit inverse masses.
#[derive(Clone, Copy)]
struct Stencil {
    /// Energy of the vertex.
    own: f64,
    /// Energy of hat functions, over their sum and the square of their slope.
    hat: [f64; 2],
    /// Share of a function along a third axis that a layer of it alone has.
    layer: f64,
}

fn stencil(problem: &Problem, interface: &Interface, slot: usize) -> Stencil {
    let v = problem.grid.coordinates(slot);
    let touches = |kind| interface::touches(problem, &interface.cells, v, kind);
    let wide = problem.numerics.pair == Pair::B2b1 || (touches(SOLID) && !touches(GAS));
    let [slope, mean, signed] = if wide { WIDE } else { NARROW };
    let dimension = problem.grid.dimension as i32;
    let layer = mean.powi(dimension - 2);
    let own = f64::from(dimension) * slope * mean * layer;
    Stencil { own, hat: [8.0 / 3.0, 8.0 / 3.0 * signed * layer], layer }
}

/// Largest Courant number of the unknowns, bodies included.
pub fn courant(problem: &Problem, interface: &Interface, system: &System) -> f64 {
    let square = |slot: usize, at: usize| {
        let s = system.compliance[at];
        if s > 0.0 { (system.diagonal[at] - s) / (s * stencil(problem, interface, slot).own) } else { 0.0 }
    };
    let of = |slot: usize| [P, Q].map(|field| square(slot, unknown(interface, field, slot)));
    slots(problem).into_iter().flat_map(of).fold(0.0, f64::max).sqrt()
}

impl TwoSpaces {
    /// Both spaces of the preconditioner for a system.
    pub fn new(problem: &Problem, interface: &Interface, system: &System, diagonals: Diagonals) -> Self {
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
        let spaces = spaces(problem.grid.dimension);
        let mut result = Self { size, spaces, fields, inverse, levels: 0, diagonals: Vec::new() };
        let number = |size: Size| size.count[..problem.grid.dimension].iter().copied().min().unwrap();
        let (mut courant, mut at) = (courant(problem, interface, system), size);
        while courant >= SMOOTH && number(at) >= FEWEST {
            (courant, at) = (0.5 * courant, at.coarser(result.spaces[0]));
            result.levels += 1;
        }
        let stencils: Vec<Stencil> = slots.iter().map(|slot| stencil(problem, interface, *slot)).collect();
        let of = |space: &Space| match diagonals {
            Diagonals::Exact => result.exact(system, *space),
            Diagonals::Sums => result.sums(system, &stencils, *space),
        };
        result.diagonals = result.spaces.iter().map(of).collect();
        if problem.grid.dimension == 3 {
            result.diagonals[1..].iter_mut().flatten().flatten().for_each(|inverse| *inverse *= COMMON_WEIGHT);
        }
        result
    }

    fn spread(&self, space: Space, values: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.inverse.len()];
        for (v, fields) in self.fields.iter().enumerate() {
            fields.iter().for_each(|at| x[*at] = sign(self.size, space, v) * values[v]);
        }
        x
    }

    fn gathered(&self, space: Space, x: &[f64]) -> Vec<f64> {
        let sum =
            |(v, fields): (usize, &Vec<usize>)| sign(self.size, space, v) * fields.iter().map(|at| x[*at]).sum::<f64>();
        self.fields.iter().enumerate().map(sum).collect()
    }

    fn sizes(&self, space: Space) -> Vec<Size> {
        std::iter::successors(Some(self.size), |size| Some(size.coarser(space))).take(self.levels + 1).collect()
    }

    fn exact(&self, system: &System, space: Space) -> Vec<Vec<f64>> {
        let sizes = self.sizes(space);
        let mut place = vec![usize::MAX; self.inverse.len()];
        for (v, fields) in self.fields.iter().enumerate() {
            fields.iter().for_each(|at| place[*at] = v);
        }
        // weights of every vertex in the hat functions of a level
        let mut weights: Vec<Vec<(usize, f64)>> = (0..self.size.length()).map(|v| vec![(v, 1.0)]).collect();
        let mut all = Vec::new();
        for pair in sizes.windows(2) {
            let mut up: Vec<Vec<(usize, f64)>> = vec![Vec::new(); pair[0].length()];
            pair[0].each(space, |v, c, weight| up[v].push((c, weight)));
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

    fn sums(&self, system: &System, stencils: &[Stencil], space: Space) -> Vec<Vec<f64>> {
        let whole = self.gathered(space, &system.apply(&self.spread(space, &vec![1.0; stencils.len()])));
        let of = |fields: &[usize], of: &[f64]| -> f64 { fields.iter().map(|at| of[*at]).sum() };
        let layer = |stencil: &Stencil| if space.signed { stencil.layer } else { 1.0 };
        let (mut own, mut push) = (Vec::new(), Vec::new());
        for ((fields, stencil), whole) in self.fields.iter().zip(stencils).zip(whole) {
            let compliance = of(fields, &system.compliance);
            own.push(compliance + layer(stencil) * (whole - compliance));
            push.push(
                (of(fields, &system.diagonal) - compliance) * stencil.hat[usize::from(space.signed)] / stencil.own,
            );
        }
        let axes = space.coarsens.iter().filter(|coarsens| **coarsens).count();
        let square = (2.0_f64 / 3.0).powi(axes as i32);
        let mut all = Vec::new();
        for size in self.sizes(space).into_iter().take(self.levels) {
            own = size.restricted(space, &own);
            push = size.restricted(space, &push).iter().map(|value| 0.25 * value).collect();
            let diagonal = |(m, k): (&f64, &f64)| (square * m + k).max(0.25 * k);
            let inverse = |d: f64| if d > 0.0 { 1.0 / d } else { 0.0 };
            all.push(own.iter().zip(&push).map(|pair| inverse(diagonal(pair))).collect());
        }
        all
    }

    /// z from r, with so many of the spaces.
    pub fn apply(&self, r: &[f64], spaces: usize) -> Vec<f64> {
        let mut z: Vec<f64> = r.iter().zip(&self.inverse).map(|(r, d)| r * d).collect();
        for (space, diagonals) in self.spaces.iter().copied().zip(&self.diagonals).take(spaces) {
            let sizes = self.sizes(space);
            let mut residuals = vec![self.gathered(space, r)];
            for size in &sizes[..self.levels] {
                residuals.push(size.restricted(space, residuals.last().unwrap()));
            }
            let mut sum: Vec<f64> = vec![0.0; sizes.last().unwrap().length()];
            for level in (0..self.levels).rev() {
                let own = residuals[level + 1].iter().zip(&diagonals[level]).map(|(r, d)| r * d);
                sum = own.zip(&sum).map(|(a, b)| a + b).collect();
                sum = sizes[level].prolonged(space, &sum);
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
pub fn iterations(
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
