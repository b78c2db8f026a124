//! Signed distances and bounds of shapes.

use crate::scene::Shape;
use crate::scene::geometry::distance;

impl Shape {
    /// Signed distance of a point `[m]`: negative inside. Exact for single shapes; after set operations a bound from below of the
    /// true distance's magnitude, never steeper than 1.
    #[must_use]
    pub fn distance(&self, point: [f64; 3]) -> f64 {
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
            combined => combined.combined_distance(point),
        }
    }

    /// The same for shapes made of shapes.
    fn combined_distance(&self, point: [f64; 3]) -> f64 {
        let least = |places: &mut dyn Iterator<Item = f64>| places.fold(f64::INFINITY, f64::min);
        match self {
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
            // single shapes are told by `distance`
            _ => f64::INFINITY,
        }
    }

    /// The shapes that this one is made of, each with its key below this shape's.
    pub(crate) fn parts(&self) -> Vec<(String, &Shape)> {
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
            combined => combined.combined_bounds(),
        }
    }

    /// The same for shapes made of shapes.
    fn combined_bounds(&self) -> ([f64; 3], [f64; 3]) {
        match self {
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
            // single shapes are told by `bounds`
            _ => ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]),
        }
    }
}

fn join_all(shapes: &[Shape]) -> ([f64; 3], [f64; 3]) {
    let nowhere = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    shapes.iter().map(Shape::bounds).fold(nowhere, distance::join)
}
