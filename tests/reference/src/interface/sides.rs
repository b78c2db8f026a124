//! On which side of a body the gas lies that its cells hold.

use crate::grid::{Grid, shift};
use crate::interface::Interface;
use crate::solid::p2g::Nodes;
use crate::{GAS, Gas, SOLID, State};

/// Amounts of (mass, momentum, energy).
type Amounts = [f64; 5];

/// The grid and what the particles say of it now.
pub struct Walls<'a> {
    /// Cells of the domain.
    pub grid: &'a Grid,
    /// Faces between gas and bodies.
    pub faces: &'a Interface,
    /// Masses and velocities of bodies at nodes.
    pub nodes: &'a Nodes,
    /// Kinds of the step before.
    pub before: &'a [u32],
    /// Largest speed of sound at the end of the step before.
    pub sound: f64,
}

fn sum(a: Amounts, b: Amounts, factor: f64) -> Amounts {
    [0, 1, 2, 3, 4].map(|k| a[k] + factor * b[k])
}

impl Walls<'_> {
    /// Whether a body is so slow that it has no sides.
    fn is_still(&self, slot: usize) -> bool {
        glam::DVec3::from(self.nodes.velocity[slot]).length() <= 1e-3 * self.sound
    }

    /// The side behind a face of a slot: 1 upper, -1 lower, 0 along the motion. `turned`: upper is behind.
    fn side(&self, slot: usize, near: &Near, turned: bool) -> i32 {
        let v = glam::DVec3::from(self.nodes.velocity[slot]);
        let towards = f64::from(near.sign) * v[near.axis] * if turned { -1.0 } else { 1.0 };
        if towards.abs() <= 0.05 * v.length() || self.is_still(slot) { 0 } else { towards.signum() as i32 }
    }

    /// Whether the upper side is behind: where gas of these densities lies on both sides and that behind is denser.
    fn is_turned(&self, c: [i32; 3], kinds: &[u32], gas: &Gas) -> bool {
        let slot = self.grid.slot(c);
        let mean = |side: i32| {
            let near = self.around(c).into_iter().filter(|near| kinds[near.slot] == GAS);
            let there: Vec<f64> =
                near.filter(|near| self.side(slot, near, false) == side).map(|near| gas.get(near.slot)[0]).collect();
            (!there.is_empty()).then(|| there.iter().sum::<f64>() / there.len() as f64)
        };
        matches!((mean(1), mean(-1)), (Some(ahead), Some(behind)) if behind > 1.001 * ahead)
    }

    /// Neighbours inside the domain across faces.
    fn around(&self, c: [i32; 3]) -> Vec<Near> {
        let faces = (0..self.grid.dimension).flat_map(|axis| [(axis, -1), (axis, 1)]);
        let there = faces.map(|(axis, sign)| (shift(c, axis, sign), axis, sign));
        there
            .filter(|(cell, ..)| self.grid.contains(*cell))
            .map(|(cell, axis, sign)| Near { cell, slot: self.grid.slot(cell), axis, sign })
            .collect()
    }

    /// Velocity of the wall at a face of a solid cell.
    fn speed(&self, slot: usize, near: &Near) -> f64 {
        let momentum = |slot: usize| self.nodes.mass[slot] * self.nodes.velocity[slot][near.axis];
        let mass = self.nodes.mass[slot] + self.nodes.mass[near.slot];
        if mass > 0.0 { (momentum(slot) + momentum(near.slot)) / mass } else { 0.0 }
    }

    fn kind(&self, slot: usize) -> u32 {
        self.faces.cells[slot]
    }

    /// Sorts what solid cells hold after the step before, and what has just been covered, by sides. `gas` is that of the step before.
    pub fn sort(&self, state: &mut State, gas: &Gas, dt: f64) {
        for c in self.grid.interior() {
            let slot = self.grid.slot(c);
            if self.kind(slot) != SOLID {
                continue;
            }
            let covered = self.before[slot] == GAS;
            let turned = [self.is_turned(c, self.before, gas), self.is_turned(c, &self.faces.cells, &state.gas)];
            let was_gas = |near: &Near| self.before[near.slot] == GAS && (!covered || self.kind(near.slot) == GAS);
            let near: Vec<_> = self.around(c).into_iter().filter(was_gas).collect();
            let on = |side: i32| {
                near.iter()
                    .filter(|near| self.side(slot, near, turned[usize::from(covered)]) == side)
                    .collect::<Vec<_>>()
            };
            let (upper, lower) = (on(1), on(-1));
            let all = sum(state.ledger[slot], state.above[slot], 1.0);
            if covered {
                set(state, slot, all, upper.len() > lower.len() || (upper.len() == lower.len() && !turned[1]));
                continue;
            }
            if !upper.is_empty() && !lower.is_empty() {
                for near in upper {
                    let speed = -f64::from(near.sign) * self.speed(slot, near);
                    let way = speed * dt * self.faces.blocked[slot] * self.grid.area();
                    state.above[slot] = sum(state.above[slot], gas.get(near.slot), way);
                    state.ledger[slot] = sum(state.ledger[slot], gas.get(near.slot), -way);
                }
            } else if !upper.is_empty() || !lower.is_empty() {
                set(state, slot, all, lower.is_empty());
            }
            if turned[0] != turned[1] {
                std::mem::swap(&mut state.above[slot], &mut state.ledger[slot]);
            }
        }
    }

    /// Whether what comes from a neighbour is for the upper side of a solid cell.
    fn is_for_upper(&self, near: &Near, gas: &Gas) -> bool {
        self.side(near.slot, near, self.is_turned(near.cell, &self.faces.cells, gas)) > 0
    }

    /// Cells that a wall of one cell goes to from one that opens, with gas behind it, and whether what is owed is for their upper side.
    pub fn followers(&self, gas: &Gas, c: [i32; 3]) -> Vec<(usize, bool)> {
        let slot = self.grid.slot(c);
        if self.kind(slot) != GAS || self.before[slot] != SOLID {
            return Vec::new();
        }
        let around = self.around(c);
        let goes_on = |near: &&Near| {
            let covers = self.kind(near.slot) == SOLID && self.before[near.slot] == GAS;
            let behind = around.iter().find(|other| other.axis == near.axis && other.sign != near.sign);
            let left = |behind: &Near| self.kind(behind.slot) == GAS && self.before[behind.slot] == GAS;
            covers && behind.is_some_and(left) && self.side(near.slot, near, false) == 1
        };
        around.iter().filter(goes_on).map(|near| (near.slot, self.is_for_upper(near, gas))).collect()
    }

    /// What a solid cell hands on in this step, of one side.
    pub fn handed(&self, state: &State, c: [i32; 3]) -> Option<Handed> {
        let turned = self.is_turned(c, &self.faces.cells, &state.gas);
        let [lower, upper] = [false, true].map(|upper| self.offer(state, c, (upper, turned)));
        let stays = |offer: &Option<Handed>| offer.as_ref().is_none_or(|offer| offer.to_gas);
        let mass = |offer: &Option<Handed>| offer.as_ref().map_or(0.0, |offer| offer.each[0].abs());
        let above = if stays(&lower) == stays(&upper) { mass(&upper) > mass(&lower) } else { stays(&lower) };
        if above { upper } else { lower }
    }

    fn offer(&self, state: &State, c: [i32; 3], (upper, turned): (bool, bool)) -> Option<Handed> {
        let slot = self.grid.slot(c);
        let held = if upper { state.above[slot] } else { state.ledger[slot] };
        if held == [0.0; 5] {
            return None;
        }
        let serves = |near: &Near| match self.side(slot, near, turned) {
            0 => self.kind(near.slot) == GAS || self.is_still(slot),
            side => (side > 0) == upper,
        };
        let here = self.around(c).into_iter().filter(serves);
        let (gas, rest): (Vec<_>, Vec<_>) = here.partition(|near| self.kind(near.slot) == GAS);
        if !gas.is_empty() {
            let density = gas.iter().map(|near| state.gas.get(near.slot)[0]).sum::<f64>() / gas.len() as f64;
            let part = (1.0 - 1.1 * density * self.grid.volume() / held[0].abs()).max(0.0) / gas.len() as f64;
            let receivers = gas.into_iter().map(|near| (near.slot, false)).collect();
            return (part > 0.0).then(|| Handed { upper, each: held.map(|x| part * x), receivers, to_gas: true });
        }
        // one beside gas hands on only to what is covered ahead of it
        let at_surface = |c: [i32; 3]| self.around(c).iter().any(|next| self.kind(next.slot) == GAS);
        let buried = !at_surface(c);
        let follows = |near: &Near| self.kind(near.slot) == SOLID && (buried || self.before[near.slot] == GAS);
        let solid: Vec<_> = rest.into_iter().filter(follows).collect();
        let surface: Vec<_> = solid.iter().copied().filter(|near| at_surface(near.cell)).collect();
        let takers = if surface.is_empty() { solid } else { surface };
        let each = held.map(|x| x / takers.len().max(1) as f64);
        let receivers: Vec<_> = takers.iter().map(|near| (near.slot, self.is_for_upper(near, &state.gas))).collect();
        (!receivers.is_empty()).then_some(Handed { upper, each, receivers, to_gas: false })
    }
}

/// A neighbour across a face, in direction `sign` along an axis.
#[derive(Clone, Copy)]
struct Near {
    cell: [i32; 3],
    slot: usize,
    axis: usize,
    sign: i32,
}

/// What one side of a solid cell hands to each of some slots, and whether that is for their upper side.
pub struct Handed {
    /// It is the side of larger coordinates.
    pub upper: bool,
    /// What each receiver takes.
    pub each: Amounts,
    /// Slots, and whether it is for their upper side.
    pub receivers: Vec<(usize, bool)>,
    to_gas: bool,
}

fn set(state: &mut State, slot: usize, all: Amounts, upper: bool) {
    let none = [0.0; 5];
    (state.ledger[slot], state.above[slot]) = if upper { (none, all) } else { (all, none) };
}
