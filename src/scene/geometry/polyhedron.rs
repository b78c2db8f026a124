//! The part of a cube that lies outside of an obstacle: a polyhedron whose corners are corners of the cube and the places where its
//! surface crosses the edges. Its moments follow from the tetrahedra between its faces and the centre of the cube.

use crate::scene::geometry::distance::{cross, dot, minus, plus};

type Point = [f64; 3];

/// What is left of the unit cube around the origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// Volume.
    pub volume: f64,
    /// Means of x, y, z.
    pub center: Point,
    /// Means of yz, zx, xy.
    pub mixed: Point,
    /// Open area of the faces x-, x+, y-, y+, z-, z+.
    pub apertures: [f64; 6],
    /// Centroids of these areas; in the place of the coordinate across the face the mean product of the two along it.
    pub middles: [Point; 6],
}

impl Part {
    /// The opening of a face is that of another part's face.
    pub(crate) fn take_face(&mut self, face: usize, from: &Self, of: usize) {
        self.apertures[face] = from.apertures[of];
        self.middles[face] = from.middles[of];
    }
}

/// Corner k of the cube: bit d says low or high along axis d.
pub(crate) fn corner(k: usize) -> Point {
    std::array::from_fn(|d| if k >> d & 1 == 1 { 0.5 } else { -0.5 })
}

/// The corners of a face, counter-clockwise seen from outside.
fn face_corners(axis: usize, high: bool) -> [usize; 4] {
    let (a, b) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
    let base = usize::from(high) << axis;
    if high { [base, base | a, base | a | b, base | b] } else { [base, base | b, base | a | b, base | a] }
}

/// Sums of volume, volume times position, and volume times products of coordinates.
#[derive(Default)]
struct Sums {
    volume: f64,
    first: Point,
    mixed: Point,
}

impl Sums {
    /// Adds the tetrahedron between the origin and a triangle.
    fn add(&mut self, [p, q, r]: [Point; 3]) {
        let volume = dot(p, cross(q, r)) / 6.0;
        let sum = plus(plus(p, q), r);
        self.volume += volume;
        for d in 0..3 {
            let (a, b) = ((d + 1) % 3, (d + 2) % 3);
            let products = p[a] * p[b] + q[a] * q[b] + r[a] * r[b];
            self.first[d] += volume * sum[d] / 4.0;
            self.mixed[d] += volume * (products + sum[a] * sum[b]) / 20.0;
        }
    }
}

/// What lies outside of the obstacle. `gas` tells it for the corners; `crossing` finds the surface on the edge between two of them.
pub(crate) fn part(gas: [bool; 8], crossing: impl Fn(usize, usize) -> Point) -> Part {
    let mut part = Part::default();
    let mut sums = Sums::default();
    let mut cuts: Vec<[Point; 2]> = Vec::new();
    for face in 0..6 {
        let corners = face_corners(face / 2, face % 2 == 1);
        let mut outline: Vec<(Point, bool)> = Vec::new();
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % 4];
            if gas[from] {
                outline.push((corner(from), false));
            }
            if gas[from] != gas[to] {
                outline.push((crossing(from.min(to), from.max(to)), true));
            }
        }
        for (k, &(from, on_surface)) in outline.iter().enumerate() {
            let (to, also) = outline[(k + 1) % outline.len()];
            if on_surface && also {
                cuts.push([from, to]);
            }
        }
        add_face(&mut part, &mut sums, face, &outline);
    }
    // The surface: a fan over the cuts of the faces, each run through the other way.
    let count = (2 * cuts.len()).max(1) as f64;
    let middle = cuts.iter().flatten().fold([0.0; 3], |sum, point| plus(sum, point.map(|x| x / count)));
    for [from, to] in cuts {
        sums.add([to, from, middle]);
    }
    part.volume = sums.volume;
    if sums.volume > 0.0 {
        part.center = sums.first.map(|x| x / sums.volume);
        part.mixed = sums.mixed.map(|x| x / sums.volume);
    }
    part
}

/// Area and centroid of a face, and what it adds to the volume.
fn add_face(part: &mut Part, sums: &mut Sums, face: usize, outline: &[(Point, bool)]) {
    let axis = face / 2;
    let outward = if face % 2 == 1 { 1.0 } else { -1.0 };
    for k in 2..outline.len() {
        let [p, q, r] = [outline[0].0, outline[k - 1].0, outline[k].0];
        let area = 0.5 * outward * cross(minus(q, p), minus(r, p))[axis];
        part.apertures[face] += area;
        let sum = plus(plus(p, q), r);
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let products = p[a] * p[b] + q[a] * q[b] + r[a] * r[b];
        for d in [a, b] {
            part.middles[face][d] += area * sum[d] / 3.0;
        }
        part.middles[face][axis] += area * (products + sum[a] * sum[b]) / 12.0;
        sums.add([p, q, r]);
    }
    if part.apertures[face] > 0.0 {
        part.middles[face] = part.middles[face].map(|x| x / part.apertures[face]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The part of the cube above a plane n . x = level.
    fn above(normal: Point, level: f64) -> Part {
        let height = |k: usize| dot(normal, corner(k)) - level;
        part(std::array::from_fn(|k| height(k) > 0.0), |a, b| {
            let t = height(a) / (height(a) - height(b));
            std::array::from_fn(|d| corner(a)[d] + t * (corner(b)[d] - corner(a)[d]))
        })
    }

    #[test]
    fn a_plane_leaves_the_moments_of_the_sampled_part() {
        for (normal, level) in [([1.0, 2.0, 0.0], 0.1), ([-0.3, 0.5, 0.8], -0.2), ([0.2, -0.9, 0.4], 0.45)] {
            let found = above(normal, level);
            let count = 60;
            let (mut volume, mut center, mut mixed) = (0.0, [0.0; 3], [0.0; 3]);
            for k in 0..count * count * count {
                let place = [k % count, k / count % count, k / count / count];
                let x: Point = place.map(|i| (f64::from(i) + 0.5) / f64::from(count) - 0.5);
                if dot(normal, x) > level {
                    volume += 1.0;
                    center = plus(center, x);
                    mixed = plus(mixed, [x[1] * x[2], x[2] * x[0], x[0] * x[1]]);
                }
            }
            assert!((found.volume - volume / f64::from(count * count * count)).abs() < 2e-3, "{found:?}");
            for d in 0..3 {
                assert!((found.center[d] - center[d] / volume).abs() < 4e-3, "{found:?} {center:?}");
                assert!((found.mixed[d] - mixed[d] / volume).abs() < 4e-3, "{found:?} {mixed:?}");
            }
        }
    }

    #[test]
    fn open_faces_and_the_wall_close_the_surface() {
        // the wall of a plane is parallel to its normal, so the open faces are too
        let normal = [0.6, -0.64, 0.48];
        let found = above(normal, 0.07);
        let open: Point = std::array::from_fn(|d| found.apertures[2 * d + 1] - found.apertures[2 * d]);
        let along = dot(open, normal);
        assert!(along > 0.5);
        for d in 0..3 {
            assert!((open[d] - along * normal[d]).abs() < 1e-12, "{open:?}");
        }
    }
}
