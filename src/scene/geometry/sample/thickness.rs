//! How thick bodies are, in cells: those thinner than two hold gas apart and little more.

use std::ops::Range;

use rayon::prelude::*;

use super::super::distance::length;
use super::{Scene, Shape, lattice};
use crate::scene::Obstacle;

/// Cells across that bending and breaking need at least.
const RESOLVED: f64 = 2.0;
/// Points of a body that are looked at, at most.
const POINTS: usize = 1000;
/// A body with this part of its points in places that are too thin is thin.
const SHARE: f64 = 0.25;
/// An obstacle that loses this part of itself is told.
const LOST: f64 = 0.01;
/// Points per cell and axis that look for obstacles, in 1D, 2D and 3D.
const FINE: [u32; 3] = [16, 8, 4];
/// Relative error of a thickness.
const EXACT: f64 = 0.01;
/// 2^64 over the golden ratio: high bits of its multiples are spread evenly.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
/// Steps from a point to the deepest place near it, at most.
const STEPS: usize = 60;

/// A body that is thinner than two cells, or a large part of which is.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ThinBody {
    /// Name of the body.
    pub body: String,
    /// Median thickness of its thin part, in cells.
    pub cells: f64,
    /// Part of the body that is so thin.
    pub share: f64,
}

/// An obstacle that the grid does not hold as a whole.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ThinObstacle {
    /// Name of the obstacle.
    pub obstacle: String,
    /// Median thickness of what is lost, in cells; 0 if it is thinner than the lattice that looks for it.
    pub cells: f64,
    /// Part of the obstacle that is lost.
    pub share: f64,
}

impl Scene {
    /// Bodies that are too thin for the grid to bend or break them as it should.
    #[must_use]
    pub fn thin_bodies(&self) -> Vec<ThinBody> {
        (0..self.bodies.len()).filter_map(|index| self.thin_body(index)).collect()
    }

    fn thin_body(&self, index: usize) -> Option<ThinBody> {
        let body = &self.bodies[index];
        let points: Vec<_> = self.seed_particles_of(index).map(|seed| seed.position).collect();
        let looked_at = points.iter().step_by(points.len().div_ceil(POINTS).max(1));
        let across: Vec<f64> = looked_at.map(|point| self.middle_near(&body.shape, *point).1).collect();
        let mut thin: Vec<f64> = across.iter().copied().filter(|cells| *cells < RESOLVED * (1.0 - EXACT)).collect();
        thin.sort_by(f64::total_cmp);
        let share = thin.len() as f64 / across.len().max(1) as f64;
        (share >= SHARE).then(|| ThinBody { body: body.name.clone(), cells: thin[thin.len() / 2], share })
    }

    /// Obstacles parts of which are in no cell, so that gas passes them.
    #[must_use]
    pub fn thin_obstacles(&self) -> Vec<ThinObstacle> {
        (0..self.obstacles.len()).into_par_iter().filter_map(|index| self.thin_obstacle(index)).collect()
    }

    fn thin_obstacle(&self, index: usize) -> Option<ThinObstacle> {
        let Obstacle { name, shape } = &self.obstacles[index];
        let (deep, near) = self.cells_of(shape);
        let stride = near.len().div_ceil(POINTS).max(1);
        let offsets = lattice(self.domain.axes(), FINE[self.domain.axes() - 1]);
        let points_in = |center: &[f64; 3]| {
            let place = |o: &[f64; 3]| std::array::from_fn(|d| center[d] + o[d] * self.domain.spacing());
            offsets.iter().map(place).filter(|point| shape.distance(*point) < 0.0).collect::<Vec<[f64; 3]>>()
        };
        // one cell of each stretch, from no fixed place: a row has as many cells as the next one
        let shifted = |k: usize| k * stride + ((k as u64).wrapping_mul(GOLDEN) >> 33) as usize % stride;
        let chosen = (0..near.len().div_ceil(stride)).map(shifted).filter(|&k| k < near.len());
        let points: Vec<_> =
            chosen.collect::<Vec<_>>().into_par_iter().flat_map_iter(|k| points_in(&near[k])).collect();
        let looked_at: Vec<_> = points.iter().step_by(points.len().div_ceil(POINTS).max(1)).collect();
        // beside what the cells hold a stair may leave points out: what counts is the middle between the surfaces
        let middles = looked_at.iter().map(|point| self.middle_near(shape, **point));
        let is_lost =
            |(middle, cells): &([f64; 3], f64)| *cells < RESOLVED * (1.0 - EXACT) && !self.holds_obstacle(*middle);
        let mut lost: Vec<f64> = middles.filter(is_lost).map(|(_, cells)| cells).collect();
        lost.sort_by(f64::total_cmp);
        let (thin, whole) = (points.len() * stride, deep * offsets.len());
        let of_thin = if thin == 0 { 1.0 } else { lost.len() as f64 / looked_at.len() as f64 };
        let share = if whole == 0 { of_thin } else { of_thin * thin as f64 / (thin + whole) as f64 };
        let cells = lost.get(lost.len() / 2).copied().unwrap_or(0.0);
        (share >= LOST).then(|| ThinObstacle { obstacle: name.clone(), cells, share })
    }

    /// How many cells lie so deep in a shape that nothing in them is thin, and the centres of the others that it may touch.
    fn cells_of(&self, shape: &Shape) -> (usize, Vec<[f64; 3]>) {
        let thick = self.cell_radius() + 0.5 * RESOLVED * self.domain.spacing();
        let of_row = |(range, row): (Range<u32>, [u32; 2])| {
            let (mut deep, mut near) = (0, Vec::new());
            self.cells_near(shape, range, row, &mut |center| {
                if shape.distance(center) < -thick { deep += 1 } else { near.push(center) }
            });
            (deep, near)
        };
        let rows: Vec<_> = self.rows_near(shape).collect::<Vec<_>>().into_par_iter().map(of_row).collect();
        (rows.iter().map(|(deep, _)| deep).sum(), rows.into_iter().flat_map(|(_, near)| near).collect())
    }

    /// The deepest place on the way away from the surface, from a point inside, and twice its depth: the cells across the shape there, up
    /// to [`RESOLVED`].
    fn middle_near(&self, shape: &Shape, mut point: [f64; 3]) -> ([f64; 3], f64) {
        let spacing = self.domain.spacing();
        let depth_at = |point: [f64; 3]| -shape.distance(point) / spacing;
        let moved = |point: [f64; 3], d: usize, by: f64| {
            let mut there = point;
            there[d] += by * spacing;
            there
        };
        let (mut deepest, mut step) = (depth_at(point), 0.25);
        for _ in 0..STEPS {
            if 2.0 * deepest >= RESOLVED || step < 0.5 * EXACT {
                break;
            }
            // on a ridge, as in a corner, both sides count
            let mut inward = [0.0; 3];
            for (d, slope) in inward.iter_mut().enumerate().take(self.domain.axes()) {
                *slope = depth_at(moved(point, d, 0.05)) - depth_at(moved(point, d, -0.05));
            }
            let steepness = length(inward).max(f64::MIN_POSITIVE);
            let next = std::array::from_fn(|d| point[d] + step * spacing * inward[d] / steepness);
            let depth = depth_at(next);
            if depth > deepest {
                (point, deepest) = (next, depth);
            } else {
                step *= 0.5;
            }
        }
        (point, (2.0 * deepest).min(RESOLVED))
    }
}
