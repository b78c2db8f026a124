//! Signed distances of primitive shapes and the vector algebra they need.

type Vector = [f64; 3];
type Bounds = (Vector, Vector);

pub(crate) fn plus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|d| a[d] + b[d])
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|d| a[d] - b[d])
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The direction of a vector; checked scenes hold no zero vector.
pub(crate) fn unit(a: Vector) -> Vector {
    let norm = length(a);
    a.map(|x| x / norm)
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Height along an axis through the origin and distance from it.
pub(crate) fn cylindrical(point: Vector, axis: Vector) -> (f64, f64) {
    let axis = unit(axis);
    let along = dot(point, axis);
    (along, length(minus(point, axis.map(|x| x * along))))
}

/// Distance of the intersection of two perpendicular slabs from the distances to each.
pub(crate) fn corner(a: f64, b: f64) -> f64 {
    a.max(b).min(0.0) + a.max(0.0).hypot(b.max(0.0))
}

/// A box around the origin with edges rounded by `round`, which must not exceed half the smallest size.
pub(crate) fn cuboid(point: Vector, size: Vector, round: f64) -> f64 {
    let outside: Vector = std::array::from_fn(|d| point[d].abs() - 0.5 * size[d] + round);
    let inner = outside.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b)).min(0.0);
    inner + length(outside.map(|x| x.max(0.0))) - round
}

/// Exact distance to an ellipsoid around the origin; infinite radii drop their axis.
///
/// The nearest surface point is x_i = r_i^2 y_i / (t + r_i^2) with sum (x_i / r_i)^2 = 1. The sum falls with t; the largest root counts. [Eberly, Distance from a Point to an Ellipsoid, 2013]
pub(crate) fn ellipsoid(point: Vector, radii: Vector) -> f64 {
    let axes = || (0..3).filter(|&d| radii[d].is_finite());
    let smallest = axes().map(|d| radii[d]).fold(f64::INFINITY, f64::min);
    // on a plane of symmetry the largest root can be double; a point this close to the plane has the same distance to rounding
    let nudge = 1e-12 * smallest;
    let y: Vector = std::array::from_fn(|d| point[d].abs().max(nudge));
    // s = t + smallest^2 keeps its digits where t + r_i^2 would lose them
    let excess: Vector = radii.map(|r| (r - smallest) * (r + smallest));
    // the sum is convex: Newton's iteration from the left of the root rises to it
    let mut s = axes().filter(|&d| excess[d] == 0.0).map(|d| radii[d] * y[d]).fold(0.0, f64::max);
    for _ in 0..100 {
        let (mut sum, mut slope) = (-1.0, 0.0);
        for d in axes() {
            let term = (radii[d] * y[d] / (s + excess[d])).powi(2);
            sum += term;
            slope += 2.0 * term / (s + excess[d]);
        }
        let next = s + sum / slope;
        if next <= s * (1.0 + 1e-15) {
            break;
        }
        s = next;
    }
    let gap = axes().map(|d| (y[d] - radii[d] * radii[d] * y[d] / (s + excess[d])).powi(2)).sum::<f64>().sqrt();
    let level = axes().map(|d| (y[d] / radii[d]).powi(2)).sum::<f64>();
    if level < 1.0 { -gap } else { gap }
}

/// Distance to a line segment.
pub(crate) fn segment(point: Vector, from: Vector, to: Vector) -> f64 {
    let along = minus(to, from);
    let square = dot(along, along);
    let t = if square > 0.0 { (dot(minus(point, from), along) / square).clamp(0.0, 1.0) } else { 0.0 };
    length(minus(minus(point, from), along.map(|x| x * t)))
}

/// Pieces from point to point whose radius changes evenly between them. The slope of a piece is bounded by scaling, so that the
/// distance is never steeper than 1.
pub(crate) fn chain(point: Vector, points: &[Vector], radii: &[f64]) -> f64 {
    let radius = |k: usize| radii.get(k).or(radii.last()).copied().unwrap_or(0.0);
    let piece = |k: usize| {
        let (from, along) = (points[k], minus(points[k + 1], points[k]));
        let (reach, change) = (length(along), radius(k + 1) - radius(k));
        let sine = if reach > 0.0 { change / reach } else { 1.0 };
        if sine.abs() >= 1.0 {
            // one end holds the other
            let whole = if change > 0.0 { k + 1 } else { k };
            return length(minus(point, points[whole])) - radius(whole);
        }
        let arm = minus(point, from);
        let height = dot(arm, along) / reach;
        let across = (dot(arm, arm) - height * height).max(0.0).sqrt();
        // the nearest point of the cone's mantle lies on a line that leans by its slope
        let t = ((height + across * sine / (1.0 - sine * sine).sqrt()) / reach).clamp(0.0, 1.0);
        across.hypot(height - t * reach) - (radius(k) + t * change)
    };
    (0..points.len().saturating_sub(1)).map(piece).fold(f64::INFINITY, f64::min)
}

/// Bounds of a chain.
pub(crate) fn chain_bounds(points: &[Vector], radii: &[f64]) -> Bounds {
    let radius = |k: usize| radii.get(k).or(radii.last()).copied().unwrap_or(0.0);
    let balls = points.iter().enumerate().map(|(k, point)| around(*point, [radius(k); 3]));
    balls.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), join)
}

/// The mirror image of a point.
pub(crate) fn mirrored(point: Vector, origin: Vector, normal: Vector) -> Vector {
    let normal = unit(normal);
    let height = dot(minus(point, origin), normal);
    minus(point, normal.map(|x| 2.0 * height * x))
}

/// Bounds of the mirror images of the eight corners; a box without end has none in its mirror image.
pub(crate) fn mirrored_bounds(bounds: Bounds, origin: Vector, normal: Vector) -> Bounds {
    let (low, high) = bounds;
    if low.iter().chain(&high).any(|x| !x.is_finite()) {
        return ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
    }
    let corner = |k: usize| std::array::from_fn(|d| if k >> d & 1 == 1 { high[d] } else { low[d] });
    let image = |k: usize| mirrored(corner(k), origin, normal);
    (0..8).map(|k| (image(k), image(k))).fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), join)
}

/// Bounds of a polygon that is turned about an axis.
pub(crate) fn revolved_bounds(center: Vector, axis: Vector, points: &[[f64; 2]]) -> Bounds {
    let direction = unit(axis);
    let place = |height: f64| plus(center, direction.map(|x| x * height));
    let discs = points.iter().map(|[radius, height]| around_disc(place(*height), axis, radius.abs(), 0.0));
    discs.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), join)
}

/// A frustum: `point` holds distance from the axis and height above the base.
pub(crate) fn frustum(point: [f64; 2], base: f64, top: f64, height: f64) -> f64 {
    let [across, along] = point;
    let rim = |z: f64, radius: f64| (across - across.min(radius)).hypot(along - z);
    let slope = [top - base, height];
    let t =
        (((across - base) * slope[0] + along * slope[1]) / (slope[0] * slope[0] + slope[1] * slope[1])).clamp(0.0, 1.0);
    let side = (across - base - t * slope[0]).hypot(along - t * slope[1]);
    let nearest = rim(0.0, base).min(rim(height, top)).min(side);
    let inside = along > 0.0 && along < height && across < base + slope[0] * along / height;
    if inside { -nearest } else { nearest }
}

/// A polygon in the plane; the sign follows from the number of edges crossed by a ray.
pub(crate) fn polygon(point: [f64; 2], corners: &[[f64; 2]]) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut inside = false;
    for (index, &from) in corners.iter().enumerate() {
        let to = corners[(index + 1) % corners.len()];
        let flat = |p: [f64; 2]| [p[0], p[1], 0.0];
        nearest = nearest.min(segment(flat(point), flat(from), flat(to)));
        if (from[1] > point[1]) != (to[1] > point[1]) {
            let crossing = from[0] + (point[1] - from[1]) * (to[0] - from[0]) / (to[1] - from[1]);
            inside ^= point[0] < crossing;
        }
    }
    if inside { -nearest } else { nearest }
}

/// Minimum with a parabola where the two are within `radius`; lower than the minimum by at most radius / 4.
pub(crate) fn smooth_minimum(a: f64, b: f64, radius: f64) -> f64 {
    let overlap = (radius - (a - b).abs()).max(0.0) / radius;
    a.min(b) - 0.25 * overlap * overlap * radius
}

/// Turns a point about an axis by the right-hand rule. (Rodrigues)
pub(crate) fn turn(point: Vector, about: Vector, axis: Vector, degrees: f64) -> Vector {
    let axis = unit(axis);
    let arm = minus(point, about);
    let (sin, cos) = degrees.to_radians().sin_cos();
    let side = cross(axis, arm);
    let along = dot(axis, arm) * (1.0 - cos);
    std::array::from_fn(|d| about[d] + arm[d] * cos + side[d] * sin + axis[d] * along)
}

/// Bounds around a point.
pub(crate) fn around(center: Vector, half: Vector) -> Bounds {
    (minus(center, half), plus(center, half))
}

/// Bounds of a disc with a thickness of `half` to both sides.
pub(crate) fn around_disc(center: Vector, axis: Vector, radius: f64, half: f64) -> Bounds {
    let axis = unit(axis);
    // 0 times an endless height is no height
    let along = |d: usize| if axis[d] == 0.0 { 0.0 } else { axis[d].abs() * half };
    around(center, std::array::from_fn(|d| radius * (1.0 - axis[d] * axis[d]).max(0.0).sqrt() + along(d)))
}

/// Bounds of a half space: one side is closed if the normal lies along an axis.
pub(crate) fn half_space_bounds(point: Vector, normal: Vector) -> Bounds {
    let lies = |d: usize| (0..3).all(|other| other == d || normal[other] == 0.0);
    let low = std::array::from_fn(|d| if lies(d) && normal[d] < 0.0 { point[d] } else { f64::NEG_INFINITY });
    let high = std::array::from_fn(|d| if lies(d) && normal[d] > 0.0 { point[d] } else { f64::INFINITY });
    (low, high)
}

/// Bounds of an extruded polygon.
pub(crate) fn polygon_bounds(corners: &[[f64; 2]], base: f64, height: Option<f64>) -> Bounds {
    let least = |d: usize| corners.iter().map(|corner| corner[d]).fold(f64::INFINITY, f64::min);
    let most = |d: usize| corners.iter().map(|corner| corner[d]).fold(f64::NEG_INFINITY, f64::max);
    let (bottom, top) = height.map_or((f64::NEG_INFINITY, f64::INFINITY), |height| (base, base + height));
    ([least(0), least(1), bottom], [most(0), most(1), top])
}

/// Bounds of the eight turned corners; endless boxes keep only the extents that turning cannot mix.
pub(crate) fn turned_bounds(bounds: Bounds, about: Vector, axis: Vector, degrees: f64) -> Bounds {
    let (low, high) = bounds;
    // column d of the rotation
    let columns: [Vector; 3] = std::array::from_fn(|d| {
        let unit = std::array::from_fn(|e| if e == d { 1.0 } else { 0.0 });
        turn(unit, [0.0; 3], axis, degrees)
    });
    let term = |row: usize, d: usize, corner: f64| {
        let weight = columns[d][row];
        if weight.abs() < 1e-12 { 0.0 } else { weight * (corner - about[d]) }
    };
    let sum = |row: usize, pick: fn(f64, f64) -> f64| {
        about[row] + (0..3).map(|d| pick(term(row, d, low[d]), term(row, d, high[d]))).sum::<f64>()
    };
    (std::array::from_fn(|row| sum(row, f64::min)), std::array::from_fn(|row| sum(row, f64::max)))
}

/// Bounds of both.
pub(crate) fn join(a: Bounds, b: Bounds) -> Bounds {
    (std::array::from_fn(|d| a.0[d].min(b.0[d])), std::array::from_fn(|d| a.1[d].max(b.1[d])))
}

/// Bounds of what both hold.
pub(crate) fn overlap(a: Bounds, b: Bounds) -> Bounds {
    (std::array::from_fn(|d| a.0[d].max(b.0[d])), std::array::from_fn(|d| a.1[d].min(b.1[d])))
}
