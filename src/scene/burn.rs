//! When a detonation passes the cells of charges that stand on the grid.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rayon::prelude::*;
use serde::Serialize;

use super::geometry::fill::lattice;
use super::{Charge, Conserved, Domain, GasState, Scene, Shape};
use crate::explosive::Explosive;

/// Points per axis of a cell that tell how much of it is explosive.
const SAMPLES: u32 = 4;
/// Cells around a charge that burn with it: some of it may have come there.
const AROUND: u32 = 8;
/// A time that no run reaches \[s\].
pub(crate) const NEVER: f32 = 1e12;
/// Cells over which explosive burns, the detonation being in their middle.
pub(crate) const BURN_WIDTH: f64 = 3.0;
/// Looks per cell along a straight line, and by how much of a cell it may leave the charge.
const LOOKS: f64 = 4.0;
const GRAZE: f64 = 0.5;

/// A charge with a shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shaped<'a> {
    charge: &'a Charge,
    shape: &'a Shape,
    explosive: &'static Explosive,
}

impl Domain {
    /// Indices along the axes of a cell by its number, x fastest.
    fn cell_at(&self, cell: usize) -> [u32; 3] {
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        [cell % nx, cell / nx % ny, cell / (nx * ny)].map(|n| n as u32)
    }

    /// Cells that share a face with one, each with the axis across the face.
    fn cells_beside(&self, cell: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let place = self.cell_at(cell);
        (0..self.axes()).flat_map(move |axis| {
            let step: usize = self.cells[..axis].iter().map(|n| *n as usize).product();
            let low = (place[axis] > 0).then(|| (axis, cell - step));
            let high = (place[axis] + 1 < self.cells[axis]).then(|| (axis, cell + step));
            low.into_iter().chain(high)
        })
    }
}

/// What is to be known of a charge that stands on the grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GridCharge {
    /// Its name.
    pub charge: String,
    /// What it is made of.
    pub explosive: String,
    /// As the cells hold it \[kg\]; in 2D per metre, in 1D per square metre.
    pub mass: f64,
    /// Of the thickest place.
    pub cells_across: f64,
    /// When the detonation has reached all of it \[s\].
    pub burned_after: f64,
}

/// Fewer cells across show no detonation: it is three cells wide itself.
const FEWEST_ACROSS: f64 = 6.0;

impl GridCharge {
    /// What is wrong with it.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let Self { charge, cells_across, .. } = self;
        (*cells_across < FEWEST_ACROSS).then(|| {
            format!(
                "charge `{charge}` is {cells_across:.1} cells across, and a detonation three: use smaller cells, at least {FEWEST_ACROSS} \
                 across, or mass and center in place of the shape"
            )
        })
    }
}

impl Charge {
    /// The charge as one that stands on the grid, if it has a shape and a known explosive.
    pub(crate) fn shaped(&self) -> Option<Shaped<'_>> {
        Some(Shaped { charge: self, shape: self.shape.as_ref()?, explosive: self.made_of()? })
    }

    /// Where it is set off: at the places that it names, else in its middle.
    pub(crate) fn detonators(&self) -> Vec<[f64; 3]> {
        let middle = || {
            let (low, high) = self.shape.as_ref()?.bounds();
            Some(std::array::from_fn(|d| 0.5 * (low[d] + high[d])))
        };
        if self.detonate_at.is_empty() { middle().into_iter().collect() } else { self.detonate_at.clone() }
    }
}

impl Scene {
    /// Charges that stand on the grid.
    #[must_use]
    pub fn charges_on_grid(&self) -> Vec<GridCharge> {
        let shaped: Vec<_> = self.charges.iter().filter_map(Charge::shaped).collect();
        let gas = if shaped.is_empty() { Vec::new() } else { self.initial_gas() };
        let of = |own: &Shaped<'_>| {
            let cells: Vec<usize> = (0..gas.len()).into_par_iter().filter(|cell| self.touches(own, *cell)).collect();
            let depth = |cell: &usize| -own.shape.distance(self.domain.cell_center(self.domain.cell_at(*cell)));
            let times = self.burn_of(own);
            let end = |cell: &usize| times[*cell].filter(|time| time.is_finite());
            GridCharge {
                charge: own.charge.name.clone(),
                explosive: own.explosive.name.to_owned(),
                mass: self.domain.cell_volume() * cells.iter().map(|cell| gas[*cell][5]).sum::<f64>(),
                cells_across: 2.0 * cells.iter().map(depth).fold(0.0, f64::max) / self.domain.spacing(),
                burned_after: cells.iter().filter_map(end).fold(0.0, f64::max),
            }
        };
        shaped.iter().map(of).collect()
    }

    /// What a charge is before it burns, at a point: at rest, with the pressure of the gas around it.
    pub(crate) fn unburned_at(&self, point: [f64; 3]) -> Option<Conserved> {
        let shaped = self.charges.iter().filter_map(Charge::shaped);
        let own = shaped.filter(|own| own.shape.distance(point) < 0.0).last()?;
        let GasState { pressure, .. } = self.ambient_at(point);
        let state = GasState { density: own.explosive.density, velocity: [0.0; 3], pressure, mass_fraction: 1.0 };
        let gases = self.gas.equation_of_state();
        Some(gases.conserved_of(&state, gases.full_charge()))
    }

    /// When each cell begins to burn \[s\]: as [`Scene::burn_times`], less the half of what it takes. f32 for the device; a number that
    /// no run reaches where it never does.
    pub(crate) fn burn_starts(&self) -> Vec<Option<f32>> {
        let Some(own) = self.gas.products() else { return Vec::new() };
        let half = 0.5 * BURN_WIDTH * self.domain.spacing() / own.detonation_speed;
        let start = |time: f64| ((time - half) as f32).min(NEVER);
        self.burn_times().into_iter().map(|time| time.map(start)).collect()
    }

    /// When the detonation reaches the middle of each cell \[s\], x fastest, without padding: infinite where it never does, nothing where no
    /// explosive is near.
    #[must_use]
    pub fn burn_times(&self) -> Vec<Option<f64>> {
        let mut times = vec![None; self.domain.cell_count()];
        for shaped in self.charges.iter().filter_map(Charge::shaped) {
            for (time, own) in times.iter_mut().zip(self.burn_of(&shaped)) {
                *time = [*time, own].into_iter().flatten().reduce(f64::min);
            }
        }
        times
    }

    /// The same of one charge: by straight lines from the detonators as far as these see, then around corners.
    fn burn_of(&self, shaped: &Shaped<'_>) -> Vec<Option<f64>> {
        let cells = 0..self.domain.cell_count();
        let inside: Vec<bool> = cells.clone().into_par_iter().map(|cell| self.touches(shaped, cell)).collect();
        let seen = |cell: usize| if inside[cell] { self.straight_length(shaped, cell) } else { None };
        let mut lengths: Vec<Option<f64>> = cells.clone().into_par_iter().map(seen).collect();
        self.march(&mut lengths, &inside);
        for cell in cells.filter(|cell| inside[*cell]) {
            lengths[cell].get_or_insert(f64::INFINITY);
        }
        let near = (0..AROUND).fold(inside, |inside, _| self.grown(&inside));
        self.march(&mut lengths, &near);
        let time = |length: f64| shaped.charge.time + length / shaped.explosive.detonation_speed;
        lengths.into_iter().map(|length| length.map(time)).collect()
    }

    /// Whether some of a cell is explosive.
    fn touches(&self, shaped: &Shaped<'_>, cell: usize) -> bool {
        let center = self.domain.cell_center(self.domain.cell_at(cell));
        let away = shaped.shape.distance(center);
        let reach = self.cell_radius();
        let place = |offset: [f64; 3]| std::array::from_fn(|d| center[d] + offset[d] * self.domain.spacing());
        let point = |offset| shaped.shape.distance(place(offset)) < 0.0;
        away < -reach || away < reach && lattice(self.domain.axes(), SAMPLES).into_iter().any(point)
    }

    /// Length of the shortest straight line from a detonator within the charge \[m\].
    fn straight_length(&self, shaped: &Shaped<'_>, cell: usize) -> Option<f64> {
        let center = self.domain.cell_center(self.domain.cell_at(cell));
        let spacing = self.domain.spacing();
        let lines = shaped.charge.detonators().into_iter().filter_map(|from| {
            let arm: [f64; 3] = std::array::from_fn(|d| center[d] - from[d]);
            let length = arm.iter().map(|x| x * x).sum::<f64>().sqrt();
            let looks = (LOOKS * length / spacing).ceil();
            let within = |look: usize| {
                let part = look as f64 / looks.max(1.0);
                shaped.shape.distance(std::array::from_fn(|d| from[d] + part * arm[d])) < GRAZE * spacing
            };
            (0..=looks as usize).all(within).then_some(length)
        });
        lines.reduce(f64::min)
    }

    /// Carries lengths on into open cells that have none, with a slope of one. [Sethian 1996]
    fn march(&self, lengths: &mut [Option<f64>], open: &[bool]) {
        // the bits of numbers that are not negative are in their order
        let known =
            lengths.iter().enumerate().filter_map(|(cell, length)| Some(Reverse((length.as_ref()?.to_bits(), cell))));
        let mut front: BinaryHeap<_> = known.collect();
        let given: Vec<bool> = lengths.iter().map(Option::is_some).collect();
        while let Some(Reverse((bits, cell))) = front.pop() {
            if lengths[cell].map(f64::to_bits) != Some(bits) {
                continue;
            }
            for (_, other) in self.domain.cells_beside(cell) {
                if !open[other] || given[other] {
                    continue;
                }
                let length = self.carried_length(lengths, other);
                if lengths[other].is_none_or(|known| length < known) {
                    lengths[other] = Some(length);
                    front.push(Reverse((length.to_bits(), other)));
                }
            }
        }
    }

    /// The length that the neighbours of a cell give it.
    fn carried_length(&self, lengths: &[Option<f64>], cell: usize) -> f64 {
        let mut beside = vec![f64::INFINITY; self.domain.axes()];
        for (axis, other) in self.domain.cells_beside(cell) {
            beside[axis] = beside[axis].min(lengths[other].unwrap_or(f64::INFINITY));
        }
        beside.sort_by(f64::total_cmp);
        let spacing = self.domain.spacing();
        let mut length = beside[0] + spacing;
        for used in 2..=beside.len() {
            let (count, sum) = (used as f64, beside[..used].iter().sum::<f64>());
            let squares = beside[..used].iter().map(|x| x * x).sum::<f64>();
            let root = sum * sum - count * (squares - spacing * spacing);
            if length <= beside[used - 1] || root < 0.0 || !root.is_finite() {
                break;
            }
            length = (sum + root.sqrt()) / count;
        }
        length
    }

    /// Cells of a set, and those beside them.
    fn grown(&self, cells: &[bool]) -> Vec<bool> {
        let near = |cell: usize| cells[cell] || self.domain.cells_beside(cell).any(|(_, other)| cells[other]);
        (0..cells.len()).into_par_iter().map(near).collect()
    }
}
