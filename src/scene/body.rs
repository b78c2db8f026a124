//! Deformable solids: what they are, how they start, what holds them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Color, Scene, Shape, vector};

/// A deformable solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name in tables, unique; no commas or quotes.
    pub name: String,
    /// What it fills; hollow bodies use `shell`.
    pub shape: Shape,
    /// What it is made of: a name under `materials`, or a preset in SI units.
    pub material: String,
    /// Density `[kg m^-3]`; that of the preset when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: Option<f64>,
    /// Velocity at the start `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Angular velocity about the centre of mass at the start `[rad s^-1]`: a number about z, or three.
    #[serde(default, with = "vector::Spin")]
    pub spin: [f64; 3],
    /// Rate at which it grows from its centre of mass at the start, along every axis `[s^-1]`: the velocity over the distance from there.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub expansion: f64,
    /// Particles per cell along each axis, so that 2 makes 8 per cell in 3D; 4 in 1D and 2 otherwise when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = 1, "maximum" = 8))]
    pub particles_per_cell: Option<u32>,
    /// Colour in pictures, sRGB; that of its preset, or one of a palette, when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Where particles lie.
    #[serde(default)]
    pub sampling: Sampling,
    /// What holds it back at walls and obstacles: nothing (`slip`), Coulomb's friction by its coefficient, or it neither slides nor lifts off
    /// (`stick`).
    #[serde(default)]
    pub friction: Friction,
    /// What of the body lies in it at the start is held where it is, or moves as `motion` says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clamped: Option<Shape>,
    /// What of the body lies in them is broken from the start. A gap that should part a body is at least three cells wide, a crack one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cracks: Vec<Shape>,
    /// A prescribed motion of the clamped part, or of the whole body where nothing is clamped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Whether it has joined the scene at work: it takes the place of no body at the start, and none takes its place.
    #[serde(skip)]
    pub joined: bool,
}

/// Where the particles of a body lie at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sampling {
    /// On the points of a regular lattice.
    #[default]
    Regular,
    /// At random, up to a quarter of the lattice's spacing beside its points.
    Jittered,
}

/// What walls and obstacles do to a body that touches them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"slip\", \"stick\" or a coefficient of friction")]
pub enum Friction {
    /// A friction of this name.
    Named(Contact),
    /// Coulomb friction: the coefficient.
    #[schemars(extend("minimum" = 0))]
    Coulomb(f64),
}

impl Default for Friction {
    fn default() -> Self {
        Friction::Named(Contact::Slip)
    }
}

/// Contacts without a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Contact {
    /// Slides freely, and lifts off.
    Slip,
    /// Neither slides nor lifts off.
    Stick,
}

/// A prescribed motion of rigid kind: a velocity and a turning about a point that moves along.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Angular velocity `[rad s^-1]`: a number about z, or three.
    #[serde(default, with = "vector::Spin")]
    pub spin: [f64; 3],
    /// The point that it turns about and that moves along, at the start `[m]`.
    #[serde(default, with = "vector::Point")]
    pub about: [f64; 3],
    /// Velocities over time instead of the two above: linear between the entries, constant before the first and after the last.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<MotionAt>,
}

/// A prescribed motion at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionAt {
    /// When `[s]`, in ascending order.
    pub time: f64,
    /// Velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Angular velocity `[rad s^-1]`: a number about z, or three.
    #[serde(default, with = "vector::Spin")]
    pub spin: [f64; 3],
}

impl Scene {
    /// Density of a body `[kg m^-3]`: its own, or that of the preset of its material.
    #[must_use]
    pub fn density_of(&self, body: &Body) -> Option<f64> {
        body.density.or_else(|| self.materials.get(&body.material)?.density())
    }

    /// Particles of a body along each axis of a cell: its own number, or 4 in 1D and 2 otherwise.
    #[must_use]
    pub fn particles_along_axis(&self, body: &Body) -> u32 {
        body.particles_per_cell.unwrap_or(if self.domain.dimension == 1 { 4 } else { 2 })
    }

    /// Whether some body is clamped, driven, or does not slip at walls.
    #[must_use]
    pub fn has_supports(&self) -> bool {
        self.bodies.iter().any(|body| body.is_driven() || body.friction.coefficient() > 0.0)
    }
}

impl Body {
    /// Whether some part of it is clamped or moves as prescribed.
    #[must_use]
    pub fn is_driven(&self) -> bool {
        self.clamped.is_some() || self.motion.is_some()
    }

    /// Whether what starts at a point is driven.
    #[must_use]
    pub fn drives(&self, point: [f64; 3]) -> bool {
        match &self.clamped {
            Some(part) => part.distance(point) < 0.0,
            None => self.motion.is_some(),
        }
    }

    /// The motion of the driven part over time; one entry if it is constant.
    #[must_use]
    pub fn driven_motion(&self) -> Vec<MotionAt> {
        match &self.motion {
            Some(motion) if !motion.table.is_empty() => motion.table.clone(),
            Some(Motion { velocity, spin, .. }) => vec![MotionAt { time: 0.0, velocity: *velocity, spin: *spin }],
            None => vec![MotionAt { time: 0.0, velocity: [0.0; 3], spin: [0.0; 3] }],
        }
    }
}

impl Friction {
    /// Coefficient of friction `[1]`; infinite for a body that sticks.
    #[must_use]
    pub fn coefficient(&self) -> f64 {
        match *self {
            Friction::Named(Contact::Slip) => 0.0,
            Friction::Named(Contact::Stick) => f64::INFINITY,
            Friction::Coulomb(coefficient) => coefficient,
        }
    }
}
