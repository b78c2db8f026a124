//! `[[charges]]`: explosives that go off during the run.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::geometry::fill::lattice;
use super::{Boundary, GasState, Scene, Shape, vector};
use crate::explosive::{Explosive, NearField, explosive};

/// The near field is computed apart until its front has come so many cells far, or to this scaled distance \[m kg^(-1/3)\], where products
/// have burned: the farther of both, unless something stands nearer.
const NEAR_CELLS: f64 = 8.0;
const NEAR_SCALED: f64 = 1.6;
/// What stands nearer than so many cells is inside the near field.
const FEWEST_NEAR_CELLS: f64 = 3.0;
/// The same in radii of the charge.
const NEAR_RADII: f64 = 1.5;
/// Points per axis of the box around the near field that say how much of it is gas.
pub(super) const SAMPLES: u32 = 20;
/// Least part of the near field that must be gas.
const LEAST_SHARE: f64 = 0.02;
/// Points per axis of the box around a shape that tell its volume, in 1D, 2D and 3D.
const VOLUME_SAMPLES: [u32; 3] = [4096, 256, 64];
/// Rounds in which a shape is brought to its mass, and how near \[1\].
const SCALINGS: usize = 40;
const MASS_ERROR: f64 = 1e-3;

/// A charge. With `mass` and `center` it is a ball of explosive, in 2D a rod along z, in 1D a slab: it burns from its middle, and how its
/// products expand among still gas is computed apart, until it spans some cells. With `shape` it stands on the grid from the start, and a
/// detonation passes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Charge {
    /// Name in messages, unique.
    pub name: String,
    /// What it is made of: `tnt`, `c4`, `petn` or `comp_b`.
    pub explosive: String,
    /// Mass of what lies in the domain, outside of obstacles `[kg]`; in 2D per metre along z, in 1D per square metre. A shape is made larger or
    /// smaller about its middle until it has this mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = 1e-9, "maximum" = 1e9))]
    pub mass: Option<f64>,
    /// Its middle `[m]`, in gas.
    #[serde(default, deserialize_with = "vector::optional_point", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<vector::Point>")]
    pub center: Option<[f64; 3]>,
    /// What it fills, in place of `center`. Its `species` are the products of its explosive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Points where a charge with a shape is set off `[m]`; its middle when left out.
    #[serde(default, deserialize_with = "vector::points", skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<vector::Point>")]
    pub detonate_at: Vec<[f64; 3]>,
    /// When it is set off `[s]`.
    #[serde(default)]
    #[schemars(extend("minimum" = 0))]
    pub time: f64,
    /// Whether its products burn on in the air, as long as the near field is computed apart.
    #[serde(default)]
    pub afterburn: bool,
    /// Name of the second gas that its products are; without it they are the first gas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<String>,
    /// How uneven the ball of products is when it takes the place of the gas, as a share of its radius. Real ones have jets, and an even one
    /// grows lobes along the axes of the grid.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 0.3, "default" = 0))]
    pub roughness: f64,
    /// Radius up to which the near field is computed apart `[m]`; as far as it is free when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub near_field: Option<f64>,
}

/// How a charge is put into the gas.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// The ball, whole: where obstacles and sides cut a part of it off, its mass is larger than that of the charge.
    pub ball: NearField,
    /// Radius of the near field \[m\].
    pub reach: f64,
    /// Part of the near field that is gas.
    pub share: f64,
}

impl Charge {
    /// A charge of TNT that is set off at the start of the run, or as soon as it is asked for.
    #[must_use]
    pub fn tnt(name: impl Into<String>, mass: f64, center: [f64; 3]) -> Self {
        let (name, explosive) = (name.into(), "tnt".to_owned());
        Self {
            name,
            explosive,
            mass: Some(mass),
            center: Some(center),
            shape: None,
            detonate_at: Vec::new(),
            time: 0.0,
            afterburn: false,
            species: None,
            roughness: 0.0,
            near_field: None,
        }
    }

    /// Mass \[kg\] and middle \[m\] of a ball; none of a charge with a shape.
    #[must_use]
    pub fn ball(&self) -> Option<(f64, [f64; 3])> {
        if self.shape.is_some() { None } else { Some((self.mass?, self.center?)) }
    }

    /// What it is made of.
    #[must_use]
    pub fn made_of(&self) -> Option<&'static Explosive> {
        explosive(&self.explosive)
    }
}

impl Scene {
    /// The charge of TNT that a click sets off: its products are those of the scene's charges, or the gas called `products`.
    #[must_use]
    pub fn clicked(&self, mass: f64, center: [f64; 3]) -> Charge {
        let products = || self.gas.species.keys().find(|name| *name == "products").cloned();
        let species = self.charges.iter().find_map(|own| own.species.clone()).or_else(products);
        Charge { species, ..Charge::tnt("click", mass, center) }
    }

    /// How a charge is put into the gas at the start; none if its explosive is unknown, or too little of it is gas.
    #[must_use]
    pub fn placed(&self, charge: &Charge) -> Option<Placed> {
        let (mass, center) = charge.ball()?;
        let ball = self.ball(charge, charge.made_of()?)?;
        let cell = self.domain.spacing();
        let reach_of = |ball: &NearField| {
            let most = (NEAR_CELLS * cell).max(NEAR_SCALED * ball.scale());
            let around = || self.free_distance(center, ball.radius()).clamp(FEWEST_NEAR_CELLS * cell, most);
            charge.near_field.unwrap_or_else(around).max(NEAR_RADII * ball.radius())
        };
        let share = self.gas_share(center, reach_of(&ball));
        if share < LEAST_SHARE {
            return None;
        }
        let ball = NearField { mass: mass / share, ..ball };
        let reach = reach_of(&ball);
        Some(Placed { ball, reach, share: self.gas_share(center, reach) })
    }

    /// Whether a charge is smaller than the domain, in it, and in gas at the start.
    #[must_use]
    pub fn has_room_for(&self, charge: &Charge) -> bool {
        let ball = charge.made_of().and_then(|explosive| self.ball(charge, explosive));
        ball.is_some_and(|ball| ball.mass > 0.0 && 2.0 * ball.radius() < self.longest_side())
            && self.placed(charge).is_some()
    }

    /// Gives charges with a shape the size of their mass, if they name one. What cannot be had stays as it is, for a check to tell.
    pub(super) fn scale_charges(&mut self) {
        for index in 0..self.charges.len() {
            if let Some(shape) = self.scaled_to_mass(&self.charges[index]) {
                (self.charges[index].shape, self.charges[index].mass) = (Some(shape), None);
            }
        }
    }

    /// The shape of a charge, with its mass.
    fn scaled_to_mass(&self, charge: &Charge) -> Option<Shape> {
        let (shape, axes) = (charge.shape.as_ref()?, self.domain.axes());
        let wanted = charge.mass.filter(|mass| *mass > 0.0 && mass.is_finite())? / charge.made_of()?.density;
        let (low, high) = shape.bounds();
        let size: [f64; 3] = std::array::from_fn(|d| if d < axes { high[d] - low[d] } else { 0.0 });
        let about = std::array::from_fn(|d| if d < axes { 0.5 * (low[d] + high[d]) } else { 0.0 });
        if !size[..axes].iter().all(|edge| edge.is_finite() && *edge > 0.0) {
            return None;
        }
        let place = |offset: [f64; 3]| std::array::from_fn(|d| offset[d] * size[d]);
        let arms: Vec<[f64; 3]> = lattice(axes, VOLUME_SAMPLES[axes - 1]).into_iter().map(place).collect();
        let at = |arm: &[f64; 3], factor: f64| std::array::from_fn(|d| about[d] + factor * arm[d]);
        let inside: Vec<[f64; 3]> = arms.par_iter().copied().filter(|arm| shape.distance(at(arm, 1.0)) < 0.0).collect();
        let room = size[..axes].iter().product::<f64>() / arms.len() as f64;
        let volume = |factor: f64| {
            let count = inside.par_iter().filter(|arm| self.is_gas(at(arm, factor))).count();
            room * factor.powi(axes as i32) * count as f64
        };
        let mut factor = 1.0;
        for _ in 0..SCALINGS {
            let ratio = wanted / volume(factor);
            if !ratio.is_finite() {
                return None;
            }
            if (ratio - 1.0).abs() < MASS_ERROR {
                return Some(Shape::Scale { factor, about, shape: Box::new(shape.clone()) });
            }
            factor *= ratio.powf(1.0 / axes as f64);
        }
        None
    }

    /// Longest edge of the domain \[m\].
    pub(super) fn longest_side(&self) -> f64 {
        self.domain.size[..self.domain.axes()].iter().copied().fold(0.0, f64::max)
    }

    /// The charge as a whole ball in the gas around it.
    pub(super) fn ball(&self, charge: &Charge, explosive: &'static Explosive) -> Option<NearField> {
        let (mass, center) = charge.ball()?;
        let GasState { density, pressure, mass_fraction, .. } = self.still_gas(center, center);
        let gases = self.gas.equation_of_state();
        let (axes, afterburn) = (self.domain.axes(), charge.afterburn);
        let gamma = gases.gamma_at(gases.volume_fraction(mass_fraction));
        Some(NearField { explosive, mass, axes, density, pressure, gamma, afterburn })
    }

    /// Distance \[m\] from a point to the nearest body, obstacle, probe or wall that does not lie within `touching`, or to the nearest open
    /// side.
    fn free_distance(&self, center: [f64; 3], touching: f64) -> f64 {
        let shapes = self.bodies.iter().map(|body| &body.shape).chain(self.obstacles.iter().map(|own| &own.shape));
        let probes = self
            .probes
            .iter()
            .map(|probe| probe.position.iter().zip(center).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt());
        let things = shapes.map(|shape| shape.distance(center)).chain(self.walls(center)).chain(probes);
        let near = things.filter(|distance| *distance > touching).fold(f64::INFINITY, f64::min);
        near.min(self.open_distance(center))
    }

    /// Distances to the sides of the domain that are walls, at least in part.
    fn walls(&self, center: [f64; 3]) -> impl Iterator<Item = f64> {
        self.side_distances(center).filter(|(_, open)| !open).map(|(distance, _)| distance)
    }

    /// Distance to the nearest side that is no wall.
    pub(super) fn open_distance(&self, center: [f64; 3]) -> f64 {
        let open = self.side_distances(center).filter(|(_, open)| *open);
        open.map(|(distance, _)| distance).fold(f64::INFINITY, f64::min)
    }

    /// Distance to each side, and whether it is no wall as a whole.
    fn side_distances(&self, center: [f64; 3]) -> impl Iterator<Item = (f64, bool)> {
        let domain = &self.domain;
        let sides = self.boundary.sides().into_iter().take(2 * domain.axes()).enumerate();
        sides.map(move |(side, rule)| {
            let low = center[side / 2] - domain.origin[side / 2];
            (if side.is_multiple_of(2) { low } else { domain.size[side / 2] - low }, *rule != Boundary::Wall)
        })
    }

    /// Part of a ball that is gas at the start.
    fn gas_share(&self, center: [f64; 3], radius: f64) -> f64 {
        let axes = self.domain.axes();
        let points = lattice(axes, SAMPLES).into_iter().filter_map(|at| {
            let inside = at.iter().map(|x| x * x).sum::<f64>() < 0.25;
            inside.then(|| std::array::from_fn(|d| center[d] + 2.0 * radius * at[d]))
        });
        let (mut all, mut gas) = (0.0, 0.0);
        for point in points {
            all += 1.0;
            gas += f64::from(self.is_gas(point));
        }
        gas / f64::max(all, 1.0)
    }

    /// Whether a point is in the domain, outside of obstacles and bodies.
    fn is_gas(&self, point: [f64; 3]) -> bool {
        let domain = &self.domain;
        let within = |d: usize| (domain.origin[d]..=domain.origin[d] + domain.size[d]).contains(&point[d]);
        (0..domain.axes()).all(within)
            && !self.inside_obstacle(point)
            && self.bodies.iter().all(|body| body.shape.distance(point) >= 0.0)
    }
}
