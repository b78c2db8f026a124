//! How thick bodies are, in cells: those thinner than two hold gas apart and little more.

use super::super::distance::length;
use super::{Scene, Shape};

/// Cells across that bending and breaking need at least.
const RESOLVED: f64 = 2.0;
/// Points of a body that are looked at, at most.
const POINTS: usize = 1000;
/// A body with this part of its points in places that are too thin is thin.
const SHARE: f64 = 0.25;
/// Relative error of a thickness.
const EXACT: f64 = 0.01;
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
        let across: Vec<f64> = looked_at.map(|point| self.cells_across(&body.shape, *point)).collect();
        let mut thin: Vec<f64> = across.iter().copied().filter(|cells| *cells < RESOLVED * (1.0 - EXACT)).collect();
        thin.sort_by(f64::total_cmp);
        let share = thin.len() as f64 / across.len().max(1) as f64;
        (share >= SHARE).then(|| ThinBody { body: body.name.clone(), cells: thin[thin.len() / 2], share })
    }

    /// Cells across a shape at a point inside, up to [`RESOLVED`]: twice the depth of the deepest place on the way away from the surface.
    fn cells_across(&self, shape: &Shape, mut point: [f64; 3]) -> f64 {
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
        (2.0 * deepest).min(RESOLVED)
    }
}
