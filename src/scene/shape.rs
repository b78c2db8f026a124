//! Shapes: the geometry of regions, bodies and obstacles as signed distances.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Mesh, Named, vector};

/// A set of points, given by its signed distance `[m]`: negative inside, and never steeper than 1.
///
/// Vectors may leave out the inactive axes of the scene. What has no extent along an axis goes on forever there: in 2D a box
/// of size `[w, h]` is a prism, and since the plane of the scene is z = 0, a sphere is a disc.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A box along the axes.
    Box {
        /// Middle `[m]`.
        #[serde(with = "vector::Point")]
        center: [f64; 3],
        /// Full edge lengths `[m]`; endless along axes that are left out.
        #[serde(with = "vector::Extent")]
        size: [f64; 3],
        /// Radius of the edges `[m]`; the size stays.
        #[serde(default)]
        round: f64,
    },
    /// A ball; a disc in 2D, an interval in 1D.
    Sphere {
        /// Middle `[m]`.
        #[serde(with = "vector::Point")]
        center: [f64; 3],
        /// Radius `[m]`.
        radius: f64,
    },
    /// An ellipsoid along the axes.
    Ellipsoid {
        /// Middle `[m]`.
        #[serde(with = "vector::Point")]
        center: [f64; 3],
        /// Half axes `[m]`; endless along axes that are left out.
        #[serde(with = "vector::Extent")]
        radii: [f64; 3],
    },
    /// A circular cylinder with flat ends.
    Cylinder {
        /// Middle `[m]`.
        #[serde(with = "vector::Point")]
        center: [f64; 3],
        /// Direction.
        #[serde(default = "along_z", with = "vector::Point")]
        axis: [f64; 3],
        /// Radius `[m]`.
        radius: f64,
        /// Full height along the axis `[m]`; endless when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        height: Option<f64>,
    },
    /// All points within a radius of a line segment.
    Capsule {
        /// One end of the segment `[m]`.
        #[serde(with = "vector::Point")]
        from: [f64; 3],
        /// The other end `[m]`.
        #[serde(with = "vector::Point")]
        to: [f64; 3],
        /// Radius `[m]`.
        radius: f64,
    },
    /// Straight pieces from point to point, round and as thick as the radii at their ends: limbs, ears, stems.
    Chain {
        /// The points `[m]`, at least two.
        points: Vec<[f64; 3]>,
        /// One radius for each point, or one for all `[m]`.
        radii: Vec<f64>,
    },
    /// A circular cone, or a frustum if `top_radius` is given.
    Cone {
        /// Middle of the base `[m]`.
        #[serde(with = "vector::Point")]
        center: [f64; 3],
        /// Direction from the base to the tip.
        #[serde(default = "along_z", with = "vector::Point")]
        axis: [f64; 3],
        /// Radius of the base `[m]`.
        radius: f64,
        /// Radius of the top `[m]`.
        #[serde(default)]
        top_radius: f64,
        /// Distance from base to top `[m]`.
        height: f64,
    },
    /// A ring with a round cross-section.
    Torus {
        /// Middle `[m]`.
        #[serde(with = "vector::Point")]
        center: [f64; 3],
        /// Axis of revolution.
        #[serde(default = "along_z", with = "vector::Point")]
        axis: [f64; 3],
        /// Distance from the axis to the middle of the cross-section `[m]`.
        major: f64,
        /// Radius of the cross-section `[m]`.
        minor: f64,
    },
    /// Everything behind a plane.
    HalfSpace {
        /// A point of the plane `[m]`.
        #[serde(with = "vector::Point")]
        point: [f64; 3],
        /// Direction out of the shape.
        #[serde(with = "vector::Point")]
        normal: [f64; 3],
    },
    /// A polygon in the plane of x and y, extruded along z.
    Polygon {
        /// Corners in the plane of x and y `[m]`, without self-intersection.
        points: Vec<[f64; 2]>,
        /// z of the lower face `[m]`.
        #[serde(default)]
        base: f64,
        /// Length of the extrusion `[m]`; endless to both sides when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        height: Option<f64>,
    },
    /// A polygon that is turned about an axis: pots, wheels, barrels.
    Revolve {
        /// The point of the axis at height 0 `[m]`.
        #[serde(default, with = "vector::Point")]
        center: [f64; 3],
        /// Direction of the axis.
        #[serde(default = "along_z", with = "vector::Point")]
        axis: [f64; 3],
        /// Corners: distance from the axis, height along it `[m]`.
        points: Vec<[f64; 2]>,
    },
    /// A shape and its mirror image.
    Mirror {
        /// A point of the mirror `[m]`.
        #[serde(default, with = "vector::Point")]
        point: [f64; 3],
        /// Direction across the mirror.
        #[serde(with = "vector::Point")]
        normal: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// Copies of a shape, each moved by the same offset from the one before.
    Repeat {
        /// How many.
        count: u32,
        /// From one to the next `[m]`.
        #[serde(with = "vector::Point")]
        offset: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// Copies of a shape around an axis, evenly over the circle.
    Around {
        /// How many.
        count: u32,
        /// Direction of the axis.
        #[serde(default = "along_z", with = "vector::Point")]
        axis: [f64; 3],
        /// A point of the axis `[m]`.
        #[serde(default, with = "vector::Point")]
        about: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// A shape by its name, placed.
    Use(Named),
    /// What a mesh file encloses, placed.
    Mesh(Mesh),
    /// A shape, moved.
    Translate {
        /// By how much `[m]`.
        #[serde(with = "vector::Point")]
        offset: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// A shape, turned by the right-hand rule.
    Rotate {
        /// Direction of the axis.
        #[serde(default = "along_z", with = "vector::Point")]
        axis: [f64; 3],
        /// Angle `[degrees]`.
        degrees: f64,
        /// A point of the axis `[m]`.
        #[serde(default, with = "vector::Point")]
        about: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// A shape, larger or smaller.
    Scale {
        /// Ratio of lengths.
        factor: f64,
        /// The point that stays `[m]`.
        #[serde(default, with = "vector::Point")]
        about: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// Points in any of the shapes.
    Union(Vec<Shape>),
    /// Points in all of the shapes.
    Intersection(Vec<Shape>),
    /// Points of the first shape that are in none of the others.
    Difference(Vec<Shape>),
    /// Like a union, with fillets where shapes meet.
    SmoothUnion {
        /// Distance over which shapes blend `[m]`.
        radius: f64,
        /// Which.
        shapes: Vec<Shape>,
    },
    /// The layer just inside the surface of a shape: distances from -thickness to 0. The rest of the inside is hollow.
    Shell {
        /// Thickness of the layer `[m]`.
        thickness: f64,
        /// What.
        shape: Box<Shape>,
    },
}

pub(super) fn along_z() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}
