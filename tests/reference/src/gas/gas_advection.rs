//! Gas advection: WENO of fifth order, of third where the gas is compressed or no gas is near, local Lax-Friedrichs split by |u|,
//! TVD-RK2, positivity limiter.

pub use crate::boundary::fill_ghosts;
use crate::gas::carrier::{Carrier, conserved_of, primitive_of};
use crate::grid::shift;
use crate::interface::Interface;
use crate::{GAS, GHOST, Gas, Pair, Problem, SOLID, Weno, internal_energy};

/// Fluxes of (rho, m, E) through the faces of each axis, stored at the low cell.
pub type Fluxes = [Vec<[f64; 5]>; 3];

/// Speed that the gas may lose from cell to cell, over that of sound, up to where shocks are suspected.
const STEEP: f64 = 0.1;

/// The six cells across a face, which lies between the third and fourth.
type Stencil = [[f64; 5]; 6];

/// What a face takes from its six cells, as `Stencil` of `flux.wgsl` has it: the share of the fifth-order form, that of density, velocity and
/// internal energy among what is reconstructed, and the least speed of the dissipation.
#[derive(Clone, Copy)]
pub struct Shock {
    even: f64,
    level: f64,
    spread: f64,
}

/// Next to anything but gas.
const NARROW: Shock = Shock { even: 0.0, level: 0.0, spread: 0.0 };

/// Least speed of the dissipation in a shock, over that of sound; and with B2B1 where faces have one velocity.
const SHOCK_SPREAD: [f64; 2] = [0.6, 1.2];

/// The face in the middle of six cells; the dissipation crosses at most a third of a cell per `dt`.
fn shock(problem: &Problem, dt: f64, stencil: &Stencil, axis: usize) -> Shock {
    let (gamma, numerics) = (problem.gamma, &problem.numerics);
    let least = SHOCK_SPREAD[usize::from(numerics.pair == Pair::B2b1 && numerics.consistent)];
    let most = problem.grid.spacing / (3.0 * dt);
    let speed = stencil.map(|u| u[1 + axis] / u[0]);
    let steepest = |sign: f64| speed.windows(2).fold(0.0, |most, pair| f64::max(most, sign * (pair[0] - pair[1])));
    let heat = 0.5 * (internal_energy(stencil[2]) / stencil[2][0] + internal_energy(stencil[3]) / stencil[3][0]);
    let sound = (gamma * (gamma - 1.0) * heat).sqrt();
    let [share, parting] = [1.0, -1.0].map(|sign| f64::min(1.0, (steepest(sign) / (STEEP * sound)).powi(2)));
    let level = (1.0 - share) * (1.0 - parting);
    Shock { even: 1.0 - share, level, spread: f64::min(least * share * sound, most) }
}

/// Value at the face between the third and fourth of six cells in a row, the first upwind; the last only tells how large values are. The
/// share `even` is the fifth-order one.
pub fn reconstruct(weno: Weno, even: f64, values: [f64; 6]) -> f64 {
    let scale = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    if scale == 0.0 {
        return 0.0;
    }
    let [a, b, c, d, e, _] = values.map(|value| value / scale);
    let rough = |beta: f64| 1.0 / (weno.steep + beta).powi(2);
    let (outer, inner) = (rough((c - b).powi(2)), 2.0 * rough((d - c).powi(2)));
    let third = (outer * (1.5 * c - 0.5 * b) + inner * 0.5 * (c + d)) / (outer + inner);
    let Some(smooth) = weno.even else { return scale * third };
    let curved = |u: f64, v: f64, w: f64| 13.0 / 12.0 * (u - 2.0 * v + w).powi(2);
    let beta = [
        curved(a, b, c) + 0.25 * (a - 4.0 * b + 3.0 * c).powi(2),
        curved(b, c, d) + 0.25 * (b - d).powi(2),
        curved(c, d, e) + 0.25 * (3.0 * c - 4.0 * d + e).powi(2),
    ];
    let parabolas = [2.0 * a - 7.0 * b + 11.0 * c, 5.0 * c - b + 2.0 * d, 2.0 * c + 5.0 * d - e];
    let tau = (beta[0] - beta[2]).abs();
    let linear = [0.1, 0.6, 0.3];
    let weights = [0, 1, 2].map(|k| linear[k] * (1.0 + (tau / (beta[k] + smooth)).powi(2)));
    let fifth = (0..3).map(|k| weights[k] * parabolas[k] / 6.0).sum::<f64>() / weights.iter().sum::<f64>();
    scale * (third + even * (fifth - third))
}

/// WENO flux and first-order flux through the face in the middle of six cells.
fn split_flux(weno: Weno, shock: Shock, stencil: &Stencil, axis: usize) -> ([f64; 5], [f64; 5]) {
    let speed = stencil.map(|u| u[1 + axis] / u[0]);
    let alpha = speed.iter().fold(shock.spread, |most, s| most.max(s.abs()));
    let (mut high, mut first) = ([0.0; 5], [0.0; 5]);
    for k in 0..5 {
        let plus = [0, 1, 2, 3, 4].map(|i| 0.5 * (speed[i] + alpha) * stencil[i][k]);
        let minus = [5, 4, 3, 2, 1].map(|i| 0.5 * (speed[i] - alpha) * stencil[i][k]);
        let [up, down] = [plus, minus].map(|side| {
            let [a, b, c, d, e] = side;
            reconstruct(weno, shock.even, [a, b, c, d, e, e])
        });
        high[k] = up + down;
        first[k] = plus[2] + minus[2];
    }
    (high, first)
}

/// The same with one velocity of the face: a value from each side of the state itself, which is made of density, velocity and internal
/// energy but in shocks and where gas parts.
fn carried_flux(weno: Weno, shock: Shock, stencil: &Stencil, carried: f64, alpha: f64) -> ([f64; 5], [f64; 5]) {
    let (mut high, mut first) = ([0.0; 5], [0.0; 5]);
    let spread = carried.abs().max(alpha).max(shock.spread);
    let (up, down) = (0.5 * (carried + spread), 0.5 * (carried - spread));
    let sides = |stencil: &Stencil| {
        let mut reversed = *stencil;
        reversed.reverse();
        [*stencil, reversed].map(|cells| [0, 1, 2, 3, 4].map(|k| reconstruct(weno, shock.even, cells.map(|u| u[k]))))
    };
    let [low, far] = sides(&stencil.map(primitive_of)).map(conserved_of);
    let [steep_low, steep_far] = sides(stencil);
    for k in 0..5 {
        let smooth = up * low[k] + down * far[k];
        let steep = up * steep_low[k] + down * steep_far[k];
        high[k] = steep + shock.level * (smooth - steep);
        first[k] = up * stencil[2][k] + down * stencil[3][k];
    }
    (high, first)
}

/// Both fluxes of a face that is closed by a share `blocked` and moves; both middle cells of the stencil are the one of gas.
fn closed_flux(weno: Weno, stencil: &Stencil, axis: usize, [blocked, velocity]: [f64; 2]) -> ([f64; 5], [f64; 5]) {
    let (high, first) = split_flux(weno, NARROW, stencil, axis);
    let blend =
        |open: [f64; 5]| [0, 1, 2, 3, 4].map(|k| blocked * velocity * stencil[2][k] + (1.0 - blocked) * open[k]);
    (blend(high), blend(first))
}

/// The cell that stands for one on a line along an axis: what it is the image of, or the nearest in the ring; and the sign of its momentum
/// along the line, the other one beyond a plane of symmetry.
fn place(problem: &Problem, axis: usize, c: [i32; 3]) -> ([i32; 3], f64) {
    let mut own = problem.mirrored(c);
    let sign = if own == c { 1.0 } else { -1.0 };
    if !problem.grid.periodic[axis] {
        own[axis] = own[axis].clamp(-1, problem.grid.cells[axis]);
    }
    (own, sign)
}

/// Both fluxes of one face over a stage of `dt`, None where no gas touches it.
pub fn face_flux(
    problem: &Problem,
    interface: &Interface,
    gas: &Gas,
    carrier: Option<&Carrier>,
    dt: f64,
    (axis, low): (usize, [i32; 3]),
) -> Option<([f64; 5], [f64; 5])> {
    let grid = &problem.grid;
    let weno = problem.numerics.weno;
    let place = |by: i32| place(problem, axis, shift(low, axis, by));
    let at = |by: i32| grid.slot(place(by).0);
    let kind = |by: i32| interface.cells[at(by)];
    let readable = |by: i32| matches!(kind(by), GAS | GHOST);
    if kind(0) != GAS && kind(1) != GAS {
        return None;
    }
    let value = |by: i32| {
        let mut u = gas.get(at(by));
        u[1 + axis] *= place(by).1;
        u
    };
    let pick = |by: i32, otherwise: i32| value(if readable(by) { by } else { otherwise });
    let narrow = |[b, c, d, e]: [[f64; 5]; 4]| [b, b, c, d, e, e];
    // Next to anything but gas the outer cells of the stencil are copies, and the order is the third.
    let inside = |by: i32| grid.contains(place(by).0) && kind(by) == GAS;
    let wide = weno.even.is_some() && (-2..=3).all(inside);
    let across = || {
        if wide { [-2, -1, 0, 1, 2, 3].map(value) } else { narrow([pick(-1, 0), value(0), value(1), pick(2, 1)]) }
    };
    let shock_at = |stencil| if wide { shock(problem, dt, stencil, axis) } else { NARROW };
    if let Some(carrier) = carrier {
        if !readable(0) || !readable(1) {
            return Some(([0.0; 5], [0.0; 5]));
        }
        let speed = |by: i32| place(by).1 * carrier.velocity[at(by)][axis];
        let alpha = if speed(1) > speed(0) { speed(0).abs().max(speed(1).abs()) } else { 0.0 };
        let carried = match (kind(0), kind(1)) {
            _ if at(0) == at(1) => 0.0,
            (GAS, GAS) => carrier.between(gas, axis, at(0), at(1)),
            (GAS, _) => speed(1),
            _ => speed(0),
        };
        let stencil = across();
        return Some(carried_flux(weno, shock_at(&stencil), &stencil, carried, alpha));
    }
    if readable(0) && readable(1) {
        let stencil = across();
        return Some(split_flux(weno, shock_at(&stencil), &stencil, axis));
    }
    let (own, other) = if kind(0) == GAS { (0, 1) } else { (1, 0) };
    let value = gas.get(at(own));
    let stencil = narrow(if own == 0 { [pick(-1, 0), value, value, value] } else { [value, value, value, pick(2, 1)] });
    let blocked = if kind(other) == SOLID { interface.blocked[at(other)] } else { 1.0 };
    let velocity = if kind(other) == SOLID { interface.face_velocity[axis][at(0)] } else { 0.0 };
    Some(closed_flux(weno, &stencil, axis, [blocked, velocity]))
}

/// All fluxes: WENO and first order.
pub fn fluxes(problem: &Problem, interface: &Interface, gas: &Gas, dt: f64) -> (Fluxes, Fluxes) {
    let grid = &problem.grid;
    let empty = || vec![[0.0; 5]; grid.slots()];
    let mut weno = [empty(), empty(), empty()];
    let mut first = [empty(), empty(), empty()];
    let carrier = Carrier::new(problem, &interface.cells, gas);
    for axis in 0..grid.dimension {
        for low in grid.faces(axis) {
            if let Some((high_order, low_order)) = face_flux(problem, interface, gas, carrier.as_ref(), dt, (axis, low))
            {
                weno[axis][grid.slot(low)] = high_order;
                first[axis][grid.slot(low)] = low_order;
            }
        }
    }
    (weno, first)
}

fn updated(problem: &Problem, gas: &Gas, fluxes: &Fluxes, c: [i32; 3], dt: f64) -> [f64; 5] {
    let grid = &problem.grid;
    let mut value = gas.get(grid.slot(c));
    for (axis, through) in fluxes.iter().enumerate().take(grid.dimension) {
        let (low, high) = (through[grid.slot(shift(c, axis, -1))], through[grid.slot(c)]);
        for k in 0..5 {
            value[k] -= dt / grid.spacing * (high[k] - low[k]);
        }
    }
    value
}

/// What the high-order fluxes add to those of first order through every face of a cell.
fn excess_of(problem: &Problem, (weno, first): (&Fluxes, &Fluxes), c: [i32; 3], dt: f64) -> Vec<[f64; 5]> {
    let grid = &problem.grid;
    let faces = (0..grid.dimension).flat_map(|axis| [(axis, shift(c, axis, -1), 1.0), (axis, c, -1.0)]);
    let part = |(axis, low, sign): (usize, [i32; 3], f64)| {
        let (high_order, low_order) = (weno[axis][grid.slot(low)], first[axis][grid.slot(low)]);
        [0, 1, 2, 3, 4].map(|k| sign * dt / grid.spacing * (high_order[k] - low_order[k]))
    };
    faces.map(part).collect()
}

/// Largest share of the high-order parts of a cell's faces, `excess`, each of which may come with any smaller share, that keeps density
/// and internal energy above a tenth of those of the first-order update.
pub fn allowed_share(first: [f64; 5], excess: &[[f64; 5]], velocity: [f64; 3]) -> f64 {
    let slip_of = |u: &[f64; 5]| [0, 1, 2].map(|k| u[1 + k] - u[0] * velocity[k]);
    let (mut density, mut energy, mut slip) = (0.0, 0.0, [0.0; 3]);
    for part in excess {
        let own = slip_of(part);
        let work: f64 = (0..3).map(|k| velocity[k] * (part[1 + k] + own[k])).sum();
        density += (-part[0]).max(0.0);
        energy += (0.5 * work - part[4]).max(0.0);
        slip = [0, 1, 2].map(|k| slip[k] + own[k].abs());
    }
    let offset = slip_of(&first).map(f64::abs);
    let square = |share: f64| (0..3).map(|k| (offset[k] + share * slip[k]).powi(2)).sum::<f64>();
    let internal = internal_energy(first);
    let mut theta = f64::min(1.0, 0.9 * first[0] / density.max(1e-300));
    for _ in 0..12 {
        let available = internal + 0.5 * square(0.0) / first[0] - theta * energy;
        if available - 0.5 * square(theta) / (first[0] - theta * density) >= 0.1 * internal {
            return theta;
        }
        theta *= 0.5;
    }
    0.0
}

/// Flux of internal energy between gas cells that `gas` has and carries itself, by the mean of both sides: with two solves per step that
/// of the start belongs to the solve.
pub fn central_heat(problem: &Problem, interface: &Interface, [gas, held]: [&Gas; 2]) -> [Vec<f64>; 3] {
    let grid = &problem.grid;
    let carrier = Carrier::new(problem, &interface.cells, gas);
    let mut heat = [0; 3].map(|_| vec![0.0; grid.slots()]);
    for axis in 0..grid.dimension {
        for low in grid.faces(axis) {
            let (a, b) = (grid.slot(low), grid.slot(shift(low, axis, 1)));
            if interface.cells[a] != GAS || interface.cells[b] != GAS {
                continue;
            }
            let (ua, ub) = (gas.get(a), gas.get(b));
            let mean = (ua[1 + axis] + ub[1 + axis]) / (ua[0] + ub[0]);
            let velocity = carrier.as_ref().map_or(mean, |carrier| carrier.between(gas, axis, a, b));
            heat[axis][a] = 0.5 * velocity * (internal_energy(held.get(a)) + internal_energy(held.get(b)));
        }
    }
    heat
}

/// Fluxes of `gas` after the limiter, which looks at their change of `start`, and how many cells it touched. A share `implicit` of
/// [`central_heat`] with the internal energy of `held` is left to the solve.
pub fn limited(
    problem: &Problem,
    interface: &Interface,
    [gas, start]: [&Gas; 2],
    dt: f64,
    (implicit, held): (f64, &Gas),
) -> (Fluxes, usize) {
    let grid = &problem.grid;
    let (mut weno, mut first) = fluxes(problem, interface, gas, dt);
    if implicit != 0.0 {
        let heat = central_heat(problem, interface, [gas, held]);
        for (axis, slot) in (0..grid.dimension).flat_map(|axis| (0..grid.slots()).map(move |slot| (axis, slot))) {
            weno[axis][slot][4] -= implicit * heat[axis][slot];
            first[axis][slot][4] -= implicit * heat[axis][slot];
        }
    }
    let mut theta = vec![1.0; grid.slots()];
    let mut touched = 0;
    for c in grid.interior() {
        let slot = grid.slot(c);
        if interface.cells[slot] == GAS {
            let excess = excess_of(problem, (&weno, &first), c, dt);
            theta[slot] = allowed_share(updated(problem, start, &first, c, dt), &excess, gas.velocity(slot));
            touched += usize::from(theta[slot] < 1.0);
        }
    }
    for axis in 0..grid.dimension {
        for low in grid.faces(axis) {
            let slot = grid.slot(low);
            let t = f64::min(theta[slot], theta[grid.slot(shift(low, axis, 1))]);
            if t < 1.0 {
                let base = first[axis][slot];
                weno[axis][slot] = [0, 1, 2, 3, 4].map(|k| base[k] + t * (weno[axis][slot][k] - base[k]));
            }
        }
    }
    (weno, touched)
}

/// One Euler stage of `dt`: adds what `gas` carries to `start`, with `implicit` as [`limited`] takes it. The ledger gets what enters solid
/// cells in `share` of `dt`.
pub fn stage(
    problem: &Problem,
    interface: &Interface,
    [gas, start]: [&Gas; 2],
    dt: f64,
    (share, implicit): (f64, (f64, &Gas)),
    ledger: &mut [[f64; 5]],
) -> (Gas, usize) {
    let grid = &problem.grid;
    let (through, touched) = limited(problem, interface, [gas, start], dt, implicit);
    let mut next = start.clone();
    next.surplus.clone_from(&gas.surplus);
    for c in grid.interior() {
        let slot = grid.slot(c);
        if interface.cells[slot] == GAS {
            next.set(slot, updated(problem, start, &through, c, dt));
        } else if interface.cells[slot] == SOLID {
            let scale = share * dt * grid.area();
            for (axis, through) in through.iter().enumerate().take(grid.dimension) {
                let below = grid.slot(shift(c, axis, -1));
                let above = grid.slot(shift(c, axis, 1));
                for k in 0..5 {
                    if interface.cells[below] == GAS {
                        ledger[slot][k] += scale * through[below][k];
                    }
                    if interface.cells[above] == GAS {
                        ledger[slot][k] -= scale * through[slot][k];
                    }
                }
            }
        }
    }
    (next, touched)
}

/// Advects the gas over one step (TVD-RK2); returns the state after advection and the number of limited cells.
pub fn advect(problem: &Problem, interface: &Interface, gas: &Gas, dt: f64, ledger: &mut [[f64; 5]]) -> (Gas, usize) {
    let grid = &problem.grid;
    let mut before = gas.clone();
    fill_ghosts(problem, &interface.cells, &mut before);
    let (mut one, touched_one) = stage(problem, interface, [&before, &before], dt, (0.5, (0.0, &before)), ledger);
    fill_ghosts(problem, &interface.cells, &mut one);
    let (two, touched_two) = stage(problem, interface, [&one, &one], dt, (0.5, (0.0, &one)), ledger);
    let mut after = two.clone();
    for slot in (0..grid.slots()).filter(|slot| interface.cells[*slot] == GAS) {
        let (a, b) = (before.get(slot), two.get(slot));
        after.set(slot, [0, 1, 2, 3, 4].map(|k| 0.5 * (a[k] + b[k])));
    }
    fill_ghosts(problem, &interface.cells, &mut after);
    (after, touched_one + touched_two)
}

/// The gas after a kick of gravity.
pub fn with_gravity(problem: &Problem, cells: &[u32], advected: &Gas, dt: f64) -> Gas {
    let mut gas = advected.clone();
    for slot in (0..cells.len()).filter(|slot| cells[*slot] == GAS) {
        let mut u = gas.get(slot);
        for axis in 0..problem.grid.dimension {
            let kick = dt * u[0] * problem.gravity[axis];
            u[4] += dt * problem.gravity[axis] * (u[1 + axis] + 0.5 * kick);
            u[1 + axis] += kick;
        }
        gas.set(slot, u);
    }
    fill_ghosts(problem, cells, &mut gas);
    gas
}
