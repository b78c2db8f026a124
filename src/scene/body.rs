//! Deformable solids: what they are, how they start, what holds them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Color, Scene, Shape, vector};

/// A deformable solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name in tables and messages, unique.
    pub name: String,
    /// What it fills.
    pub shape: Shape,
    /// Name of an entry of `materials`.
    pub material: String,
    /// Density `[kg m^-3]`, positive; that of the preset when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Velocity at the start `[m s^-1]`.
    #[serde(default, deserialize_with = "vector::point")]
    #[schemars(with = "Vec<f64>")]
    pub velocity: [f64; 3],
    /// Angular velocity about the centre of mass at the start `[rad s^-1]`: a number about z, or three about x, y and z.
    #[serde(default, deserialize_with = "vector::spin")]
    #[schemars(with = "vector::Spin")]
    pub spin: [f64; 3],
    /// Particles per cell along each axis, 1 to 8; 4 in 1D and 2 otherwise when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub particles_per_cell: Option<u32>,
    /// Colour in pictures, `#rrggbb`; that of the preset of its material, or one of a palette, when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Where particles lie within the lattice.
    #[serde(default)]
    pub sampling: Sampling,
    /// What holds it back along walls and obstacles.
    #[serde(default)]
    pub friction: Friction,
    /// The part that is held where it is, or moves as `motion` says: what of the body lies in this shape at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clamped: Option<Shape>,
    /// Cracks at the start: what of the body lies in these shapes is broken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cracks: Vec<Shape>,
    /// A prescribed motion: of the clamped part, or of the whole body if there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
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
    #[serde(default, deserialize_with = "vector::point")]
    #[schemars(with = "Vec<f64>")]
    pub velocity: [f64; 3],
    /// Angular velocity `[rad s^-1]`: a number about z, or three about x, y and z.
    #[serde(default, deserialize_with = "vector::spin")]
    #[schemars(with = "vector::Spin")]
    pub spin: [f64; 3],
    /// The point that it turns about, at the start `[m]`; the origin when left out.
    #[serde(default, deserialize_with = "vector::point")]
    #[schemars(with = "Vec<f64>")]
    pub about: [f64; 3],
    /// Velocities over time instead of the two above: linear between the entries, constant before the first and after the last.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<MotionAt>,
}

/// A prescribed motion at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionAt {
    /// When `[s]`.
    pub time: f64,
    /// Velocity `[m s^-1]`.
    #[serde(default, deserialize_with = "vector::point")]
    #[schemars(with = "Vec<f64>")]
    pub velocity: [f64; 3],
    /// Angular velocity `[rad s^-1]`: a number about z, or three about x, y and z.
    #[serde(default, deserialize_with = "vector::spin")]
    #[schemars(with = "vector::Spin")]
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
