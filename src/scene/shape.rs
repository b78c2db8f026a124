//! Shapes: the geometry of regions, bodies and obstacles as signed distances.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Mesh, Named, distance, vector};

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
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        center: [f64; 3],
        /// Full edge lengths `[m]`; endless along axes that are left out.
        #[serde(deserialize_with = "vector::extent", serialize_with = "vector::write_extent")]
        #[schemars(with = "Vec<f64>")]
        size: [f64; 3],
        /// Radius of rounded edges `[m]`; the size stays.
        #[serde(default)]
        round: f64,
    },
    /// A ball; a disc in 2D, an interval in 1D.
    Sphere {
        /// Middle `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        center: [f64; 3],
        /// Radius `[m]`.
        radius: f64,
    },
    /// An ellipsoid along the axes.
    Ellipsoid {
        /// Middle `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        center: [f64; 3],
        /// Half axes `[m]`; endless along axes that are left out.
        #[serde(deserialize_with = "vector::extent", serialize_with = "vector::write_extent")]
        #[schemars(with = "Vec<f64>")]
        radii: [f64; 3],
    },
    /// A circular cylinder with flat ends.
    Cylinder {
        /// Middle `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        center: [f64; 3],
        /// Direction, of any length; z when left out.
        #[serde(default = "along_z", deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
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
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        from: [f64; 3],
        /// The other end `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        to: [f64; 3],
        /// Radius `[m]`.
        radius: f64,
    },
    /// Straight pieces from point to point, round and as thick as the radii at their ends: limbs, ears, stems.
    Chain {
        /// The points `[m]`, at least two.
        points: Vec<[f64; 3]>,
        /// Radius at each point `[m]`, or one for all.
        radii: Vec<f64>,
    },
    /// A circular cone, or a frustum if `top_radius` is given.
    Cone {
        /// Middle of the base `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        center: [f64; 3],
        /// Direction from the base to the tip, of any length; z when left out.
        #[serde(default = "along_z", deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        axis: [f64; 3],
        /// Radius of the base `[m]`.
        radius: f64,
        /// Radius of the top `[m]`; 0 for a tip.
        #[serde(default)]
        top_radius: f64,
        /// Distance from base to top `[m]`.
        height: f64,
    },
    /// A ring with a round cross-section.
    Torus {
        /// Middle `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        center: [f64; 3],
        /// Axis of revolution, of any length; z when left out.
        #[serde(default = "along_z", deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        axis: [f64; 3],
        /// Distance from the axis to the middle of the cross-section `[m]`.
        major: f64,
        /// Radius of the cross-section `[m]`.
        minor: f64,
    },
    /// Everything behind a plane.
    HalfSpace {
        /// A point of the plane `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        point: [f64; 3],
        /// Direction out of the shape, of any length.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        normal: [f64; 3],
    },
    /// A polygon in the plane of x and y, extruded along z.
    Polygon {
        /// Corners `[m]`, in either direction of turning, without self-intersection.
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
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        center: [f64; 3],
        /// Direction of the axis, of any length; z when left out.
        #[serde(default = "along_z", deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        axis: [f64; 3],
        /// Corners: distance from the axis, height along it `[m]`.
        points: Vec<[f64; 2]>,
    },
    /// A shape and its mirror image.
    Mirror {
        /// A point of the mirror `[m]`; the origin when left out.
        #[serde(default, deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        point: [f64; 3],
        /// Direction across the mirror, of any length.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        normal: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// Copies of a shape, each moved by the same offset from the one before.
    Repeat {
        /// How many.
        count: u32,
        /// From one to the next `[m]`.
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        offset: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// Copies of a shape around an axis, evenly over the circle.
    Around {
        /// How many.
        count: u32,
        /// Direction of the axis, of any length; z when left out.
        #[serde(default = "along_z", deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        axis: [f64; 3],
        /// A point of the axis `[m]`; the origin when left out.
        #[serde(default, deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
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
        #[serde(deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        offset: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// A shape, turned by the right-hand rule.
    Rotate {
        /// Direction of the axis, of any length; z when left out.
        #[serde(default = "along_z", deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        axis: [f64; 3],
        /// Angle `[degrees]`.
        degrees: f64,
        /// A point of the axis `[m]`; the origin when left out.
        #[serde(default, deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
        about: [f64; 3],
        /// What.
        shape: Box<Shape>,
    },
    /// A shape, larger or smaller.
    Scale {
        /// Ratio of lengths, positive.
        factor: f64,
        /// The point that stays `[m]`; the origin when left out.
        #[serde(default, deserialize_with = "vector::point")]
        #[schemars(with = "Vec<f64>")]
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
        /// Distance over which shapes blend `[m]`, positive.
        radius: f64,
        /// Which.
        shapes: Vec<Shape>,
    },
    /// The layer just inside the surface of a shape: distances from -thickness to 0. The rest of the inside is hollow.
    Shell {
        /// Thickness of the layer `[m]`, positive.
        thickness: f64,
        /// What.
        shape: Box<Shape>,
    },
}

pub(super) fn along_z() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

impl Shape {
    /// Signed distance of a point `[m]`: negative inside. Exact for single shapes; after set operations a bound from below of the
    /// true distance's magnitude, never steeper than 1.
    #[must_use]
    pub fn distance(&self, point: [f64; 3]) -> f64 {
        let least = |places: &mut dyn Iterator<Item = f64>| places.fold(f64::INFINITY, f64::min);
        match self {
            Shape::Box { center, size, round } => distance::cuboid(distance::minus(point, *center), *size, *round),
            Shape::Sphere { center, radius } => distance::length(distance::minus(point, *center)) - radius,
            Shape::Ellipsoid { center, radii } => distance::ellipsoid(distance::minus(point, *center), *radii),
            Shape::Cylinder { center, axis, radius, height } => {
                let (along, across) = distance::cylindrical(distance::minus(point, *center), *axis);
                distance::corner(across - radius, height.map_or(f64::NEG_INFINITY, |height| along.abs() - 0.5 * height))
            }
            Shape::Capsule { from, to, radius } => distance::segment(point, *from, *to) - radius,
            Shape::Chain { points, radii } => distance::chain(point, points, radii),
            Shape::Cone { center, axis, radius, top_radius, height } => {
                let (along, across) = distance::cylindrical(distance::minus(point, *center), *axis);
                distance::frustum([across, along], *radius, *top_radius, *height)
            }
            Shape::Torus { center, axis, major, minor } => {
                let (along, across) = distance::cylindrical(distance::minus(point, *center), *axis);
                (across - major).hypot(along) - minor
            }
            Shape::HalfSpace { point: origin, normal } => {
                distance::dot(distance::minus(point, *origin), distance::unit(*normal))
            }
            Shape::Polygon { points, base, height } => {
                let faces =
                    height.map_or(f64::NEG_INFINITY, |height| (point[2] - base - 0.5 * height).abs() - 0.5 * height);
                distance::corner(distance::polygon([point[0], point[1]], points), faces)
            }
            Shape::Revolve { center, axis, points } => {
                let (along, across) = distance::cylindrical(distance::minus(point, *center), *axis);
                distance::polygon([across, along], points)
            }
            Shape::Mirror { point: origin, normal, shape } => {
                shape.distance(point).min(shape.distance(distance::mirrored(point, *origin, *normal)))
            }
            Shape::Repeat { count, offset, shape } => {
                let moved = |k: u32| distance::minus(point, offset.map(|x| x * f64::from(k)));
                least(&mut (0..*count).map(|k| shape.distance(moved(k))))
            }
            Shape::Around { count, axis, about, shape } => {
                let turned = |k: u32| distance::turn(point, *about, *axis, -360.0 * f64::from(k) / f64::from(*count));
                least(&mut (0..*count).map(|k| shape.distance(turned(k))))
            }
            Shape::Use(named) => named.distance(point),
            Shape::Mesh(mesh) => mesh.distance(point),
            Shape::Translate { offset, shape } => shape.distance(distance::minus(point, *offset)),
            Shape::Rotate { axis, degrees, about, shape } => {
                shape.distance(distance::turn(point, *about, *axis, -degrees))
            }
            Shape::Scale { factor, about, shape } => {
                let inner = std::array::from_fn(|d| about[d] + (point[d] - about[d]) / factor);
                shape.distance(inner) * factor
            }
            Shape::Union(shapes) => least(&mut shapes.iter().map(|shape| shape.distance(point))),
            Shape::Intersection(shapes) => {
                shapes.iter().map(|shape| shape.distance(point)).fold(f64::NEG_INFINITY, f64::max)
            }
            Shape::Difference(shapes) => {
                let mut distances = shapes.iter().map(|shape| shape.distance(point));
                let first = distances.next().unwrap_or(f64::INFINITY);
                distances.fold(first, |rest, cut| rest.max(-cut))
            }
            Shape::SmoothUnion { radius, shapes } => {
                let blend = |a, b| distance::smooth_minimum(a, b, *radius);
                shapes.iter().map(|shape| shape.distance(point)).fold(f64::INFINITY, blend)
            }
            Shape::Shell { thickness, shape } => {
                let distance = shape.distance(point);
                distance.max(-distance - thickness)
            }
        }
    }

    /// The shapes that this one is made of, each with its key below this shape's.
    pub(super) fn parts(&self) -> Vec<(String, &Shape)> {
        let (key, shapes) = match self {
            Shape::Translate { shape, .. } => ("translate.shape", std::slice::from_ref(&**shape)),
            Shape::Rotate { shape, .. } => ("rotate.shape", std::slice::from_ref(&**shape)),
            Shape::Scale { shape, .. } => ("scale.shape", std::slice::from_ref(&**shape)),
            Shape::Shell { shape, .. } => ("shell.shape", std::slice::from_ref(&**shape)),
            Shape::Mirror { shape, .. } => ("mirror.shape", std::slice::from_ref(&**shape)),
            Shape::Repeat { shape, .. } => ("repeat.shape", std::slice::from_ref(&**shape)),
            Shape::Around { shape, .. } => ("around.shape", std::slice::from_ref(&**shape)),
            Shape::Union(shapes) => ("union", &shapes[..]),
            Shape::Intersection(shapes) => ("intersection", &shapes[..]),
            Shape::Difference(shapes) => ("difference", &shapes[..]),
            Shape::SmoothUnion { shapes, .. } => ("smooth_union.shapes", &shapes[..]),
            _ => return Vec::new(),
        };
        let listed = !key.ends_with(".shape");
        let name = |k: usize| if listed { format!("{key}[{k}]") } else { key.to_owned() };
        shapes.iter().enumerate().map(|(k, shape)| (name(k), shape)).collect()
    }

    /// Corners of a box along the axes that holds the shape `[m]`; infinite where the shape has no end.
    #[must_use]
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        match self {
            Shape::Box { center, size, .. } => distance::around(*center, size.map(|edge| 0.5 * edge)),
            Shape::Sphere { center, radius } => distance::around(*center, [*radius; 3]),
            Shape::Ellipsoid { center, radii } => distance::around(*center, *radii),
            Shape::Cylinder { center, axis, radius, height } => {
                let half = 0.5 * height.unwrap_or(f64::INFINITY);
                distance::around_disc(*center, *axis, *radius, half)
            }
            Shape::Capsule { from, to, radius } => {
                distance::join(distance::around(*from, [*radius; 3]), distance::around(*to, [*radius; 3]))
            }
            Shape::Chain { points, radii } => distance::chain_bounds(points, radii),
            Shape::Cone { center, axis, radius, top_radius, height } => {
                let direction = distance::unit(*axis);
                let top = std::array::from_fn(|d| center[d] + height * direction[d]);
                distance::join(
                    distance::around_disc(*center, *axis, *radius, 0.0),
                    distance::around_disc(top, *axis, *top_radius, 0.0),
                )
            }
            Shape::Torus { center, axis, major, minor } => {
                let (low, high) = distance::around_disc(*center, *axis, *major, 0.0);
                (low.map(|x| x - minor), high.map(|x| x + minor))
            }
            Shape::HalfSpace { point, normal } => distance::half_space_bounds(*point, *normal),
            Shape::Polygon { points, base, height } => distance::polygon_bounds(points, *base, *height),
            Shape::Revolve { center, axis, points } => distance::revolved_bounds(*center, *axis, points),
            Shape::Mirror { point, normal, shape } => {
                let bounds = shape.bounds();
                distance::join(bounds, distance::mirrored_bounds(bounds, *point, *normal))
            }
            Shape::Repeat { count, offset, shape } => {
                let (low, high) = shape.bounds();
                let whole = offset.map(|x| x * f64::from(count.saturating_sub(1)));
                distance::join((low, high), (distance::plus(low, whole), distance::plus(high, whole)))
            }
            Shape::Around { count, axis, about, shape } => {
                let turned = |k: u32| 360.0 * f64::from(k) / f64::from(*count);
                let bounds = (0..*count).map(|k| distance::turned_bounds(shape.bounds(), *about, *axis, turned(k)));
                bounds.reduce(distance::join).unwrap_or(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]))
            }
            Shape::Use(named) => named.bounds(),
            Shape::Mesh(mesh) => mesh.bounds(),
            Shape::Translate { offset, shape } => {
                let (low, high) = shape.bounds();
                (distance::plus(low, *offset), distance::plus(high, *offset))
            }
            Shape::Rotate { axis, degrees, about, shape } => {
                distance::turned_bounds(shape.bounds(), *about, *axis, *degrees)
            }
            Shape::Scale { factor, about, shape } => {
                let (low, high) = shape.bounds();
                let scaled = |corner: [f64; 3]| std::array::from_fn(|d| about[d] + (corner[d] - about[d]) * factor);
                (scaled(low), scaled(high))
            }
            Shape::Union(shapes) => join_all(shapes),
            Shape::Intersection(shapes) => {
                let everywhere = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
                shapes.iter().map(Shape::bounds).fold(everywhere, distance::overlap)
            }
            Shape::Difference(shapes) => join_all(&shapes[..shapes.len().min(1)]),
            Shape::SmoothUnion { radius, shapes } => {
                // every blend lowers the distance by at most a quarter of the radius
                let (low, high) = join_all(shapes);
                let grow = 0.25 * radius * shapes.len() as f64;
                (low.map(|x| x - grow), high.map(|x| x + grow))
            }
            Shape::Shell { shape, .. } => shape.bounds(),
        }
    }
}

fn join_all(shapes: &[Shape]) -> ([f64; 3], [f64; 3]) {
    let nowhere = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    shapes.iter().map(Shape::bounds).fold(nowhere, distance::join)
}
