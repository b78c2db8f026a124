//! Closed surfaces: of particles as wholes, and of shapes by their distance.
//!
//! Space is cut into blocks of cells, of which only those near the surface are looked at. Each is meshed by naive surface nets
//! [Gibson 1998; crate `fast-surface-nets`]; what neighbours have both is one vertex.

mod field;
mod parts;

use fast_surface_nets::SurfaceNetsBuffer;
use fast_surface_nets::ndshape::{ConstShape, ConstShape3u32};
use rayon::prelude::*;

use field::{FINENESS, Field, REACHED};
use parts::{Part, joined};

/// Cells of a block along an axis, and its nodes with those that it shares.
const BLOCK: i32 = 16;
const NODES: u32 = BLOCK as u32 + 2;
type Shape = ConstShape3u32<NODES, NODES, NODES>;

/// Volume of what is no part, over that of a particle: cells where the field only just changes its sign.
const SPECK: f64 = 0.02;
/// Triangles that are summed by one thread.
const TOGETHER: usize = 1 << 14;

/// A surface of triangles, counterclockwise from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners \[m\].
    pub points: Vec<[f32; 3]>,
    /// The particle next to each corner.
    pub nearest: Vec<u32>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// That of particles with this distance from each other, by the distance from their weighted mean. [Zhu and Bridson 2005]
    #[must_use]
    pub fn of_particles(places: &[[f32; 3]], distance: f32) -> Self {
        let cell = FINENESS * distance;
        let scaled: Vec<[f32; 3]> = places.iter().map(|place| place.map(|x| x / cell)).collect();
        let at = |place: &[f32; 3]| place.map(|x| (x.floor() as i32).div_euclid(BLOCK));
        let mut sorted: Vec<([i32; 3], u32)> = scaled.par_iter().map(at).zip(0..scaled.len() as u32).collect();
        sorted.par_sort_unstable();
        let homes: Vec<_> = sorted.chunk_by(|one, two| one.0 == two.0).collect();
        let mut blocks: Vec<[i32; 3]> = homes.iter().flat_map(|home| around(home[0].0)).collect();
        blocks.sort_unstable();
        blocks.dedup();
        let home = |block| homes.binary_search_by_key(&block, |home| home[0].0).map_or(&[][..], |at| homes[at]);
        let start = || (Field::new(), SurfaceNetsBuffer::default());
        let meshed = |(field, buffer): &mut (Field, SurfaceNetsBuffer), block: &[i32; 3]| {
            let near = around(*block).flat_map(home);
            let is_reached = field.fill(*block, near.map(|(_, index)| (*index, scaled[*index as usize])));
            is_reached.then(|| Part::of(*block, &field.distance, |cell| field.nearest(cell), buffer))
        };
        let parts: Vec<Part> = blocks.par_iter().map_init(start, meshed).flatten_iter().collect();
        joined(&parts, cell, SPECK * f64::from(FINENESS).powi(-3))
    }

    /// That of what has a negative distance between two corners, by cells of this edge \[m\].
    #[must_use]
    pub fn of_distance([low, high]: [[f64; 3]; 2], cell: f64, distance: impl Fn([f64; 3]) -> f64 + Sync) -> Self {
        let [low, high] = [low.map(|x| (x / cell).floor() as i32 - 1), high.map(|x| (x / cell).ceil() as i32 + 1)];
        let [low, high] = [low, high].map(|corner| corner.map(|x| x.div_euclid(BLOCK)));
        let low = low.map(|x| x - 1);
        let mut blocks = Vec::new();
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                blocks.extend((low[0]..=high[0]).map(|x| [x, y, z]));
            }
        }
        // a distance is never steeper than one: most blocks have no surface
        let half = 0.5 * f64::from(NODES);
        let near = |block: &[i32; 3]| {
            distance(block.map(|x| (f64::from(x * BLOCK) + half) * cell)).abs() <= 3.0_f64.sqrt() * half * cell
        };
        let meshed = |buffer: &mut SurfaceNetsBuffer, block: &[i32; 3]| {
            let at =
                |node: [u32; 3]| std::array::from_fn(|axis| f64::from(block[axis] * BLOCK + node[axis] as i32) * cell);
            let values = (0..Shape::SIZE).map(|node| (distance(at(Shape::delinearize(node))) / cell) as f32);
            Part::of(*block, &values.collect::<Vec<_>>(), |_| 0, buffer)
        };
        let parts: Vec<Part> =
            blocks.par_iter().filter(|block| near(block)).map_init(SurfaceNetsBuffer::default, meshed).collect();
        joined(&parts, cell as f32, 0.0)
    }

    /// Volume inside \[m^3\].
    #[must_use]
    pub fn volume(&self) -> f64 {
        let beneath = |some: &[[u32; 3]]| some.iter().map(|three| self.beneath(three)).sum::<f64>();
        let all: Vec<f64> = self.triangles.par_chunks(TOGETHER).map(beneath).collect();
        all.iter().sum() // in order
    }

    /// Volume between a triangle and the first corner \[m^3\].
    fn beneath(&self, three: &[u32; 3]) -> f64 {
        let corner = |index: u32| glam::DVec3::from(self.points[index as usize].map(f64::from));
        let [a, b, c] = three.map(|index| corner(index) - corner(0));
        a.dot(b.cross(c)) / 6.0
    }
}

/// A block and its neighbours: a particle reaches no further.
fn around([x, y, z]: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    const _: () = assert!(REACHED < (BLOCK - 1) as f32);
    (0..27).map(move |k| [x + k / 9 - 1, y + k / 3 % 3 - 1, z + k % 3 - 1])
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::Vec3;

    use super::*;
    use crate::bodies::Groups;

    /// Whether each edge has two triangles, which go along it in opposite directions; four where two parts touch in an edge.
    fn is_closed(surface: &Surface) -> bool {
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for [a, b, c] in &surface.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from.min(to), *from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
        }
        !edges.is_empty() && edges.values().all(|sum| *sum == 0)
    }

    fn lattice(sides: [usize; 3], distance: f32) -> Vec<[f32; 3]> {
        let at = |k: usize| [k % sides[0], k / sides[0] % sides[1], k / sides[0] / sides[1]];
        (0..sides.iter().product()).map(|k| at(k).map(|x| (x as f32 + 0.3) * distance)).collect()
    }

    #[test]
    fn surfaces_are_closed_and_as_thick_as_their_particles() {
        for (sides, tolerance) in [([24, 24, 24], 0.02), ([40, 40, 2], 0.06), ([40, 40, 1], 0.06), ([1, 1, 1], 0.85)] {
            let surface = Surface::of_particles(&lattice(sides, 0.1), 0.1);
            let volume = sides.iter().product::<usize>() as f64 * 1e-3;
            assert!(is_closed(&surface), "{sides:?}");
            assert!((surface.volume() / volume - 1.0).abs() < tolerance, "{sides:?}: {} of {volume}", surface.volume());
        }
    }

    /// No specks between particles that part: one part for each.
    #[test]
    fn particles_far_apart_are_balls() {
        for gap in [0.24, 0.3, 0.36] {
            let surface = Surface::of_particles(&[[0.0; 3], [gap, 0.0, 0.0]], 0.1);
            let middle = surface.points.iter().filter(|point| (point[0] - 0.5 * gap).abs() < 0.02).count();
            assert!(is_closed(&surface) && middle == 0, "{gap}: {middle}");
        }
    }

    /// Particles of a shell of radius 1 and so many layers, a little out of order, where a part of it is kept.
    fn shell(layers: f32, distance: f32, kept: impl Fn(Vec3) -> bool) -> Vec<[f32; 3]> {
        let side = (2.6 / distance) as usize;
        let noise = |k: usize| (k as f32 * 12.9898).sin().mul_add(43758.547, 0.0).fract().abs() - 0.5;
        let all = lattice([side; 3], distance).into_iter().map(|place| Vec3::from(place) - 1.3);
        let own = all.filter(|place| (place.length() - 1.0).abs() < 0.5 * layers * distance && kept(*place));
        own.enumerate()
            .map(|(k, at)| (at + Vec3::from([0, 1, 2].map(|axis| noise(3 * k + axis))) * 0.15 * distance).into())
            .collect()
    }

    /// Parts that hang together, and V - E + F: 2 for each ball, 0 for each ring.
    fn parts_and_characteristic(surface: &Surface) -> (usize, i64) {
        let count = surface.points.len();
        let mut groups = Groups::of(count);
        let mut edges = std::collections::HashSet::new();
        for [a, b, c] in &surface.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                groups.join(*from as usize, *to as usize);
                edges.insert((from.min(to), from.max(to)));
            }
        }
        let parts = (0..count).filter(|point| groups.root(*point) == *point).count();
        (parts, count as i64 - edges.len() as i64 + surface.triangles.len() as i64)
    }

    /// No beads: a thin shell has a skin outside and one inside, a torn one the same skin around each part.
    #[test]
    fn thin_and_torn_shells_have_closed_skins() {
        let distance = 0.05;
        let holes = |count: usize| move |at: Vec3| (0..count).all(|k| at.distance(Vec3::AXES[k]) > 0.3);
        let skins = |places: &[[f32; 3]]| {
            let surface = Surface::of_particles(places, distance);
            assert!(is_closed(&surface));
            let area = surface.triangles.iter().map(|three| {
                let [a, b, c] = three.map(|index| Vec3::from(surface.points[index as usize]));
                f64::from(0.5 * (b - a).cross(c - a).length())
            });
            let thickness = 2.0 * surface.volume() / area.sum::<f64>() / f64::from(distance);
            (parts_and_characteristic(&surface), thickness)
        };
        let (whole, thickness) = skins(&shell(2.0, distance, |_| true));
        assert_eq!(whole, (2, 4), "one skin outside, one inside");
        assert!((1.8..2.2).contains(&thickness), "{thickness} particles thick");
        assert_eq!(skins(&shell(2.0, distance, holes(1))).0, (1, 2), "a hole joins both");
        assert_eq!(skins(&shell(2.0, distance, holes(3))).0, (1, -2), "three make two handles");
        let (halves, thickness) = skins(&shell(2.0, distance, |at| at.z.abs() > 2.0 * distance));
        assert_eq!(halves, (2, 4), "each half has a skin of its own");
        assert!((1.7..2.2).contains(&thickness), "{thickness} particles thick");
    }

    #[test]
    fn shapes_are_closed_too() {
        let ball = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt() - 1.0;
        let surface = Surface::of_distance([[-1.0; 3], [1.0; 3]], 0.05, ball);
        let volume = 4.0 / 3.0 * std::f64::consts::PI;
        assert!(is_closed(&surface) && (surface.volume() / volume - 1.0).abs() < 0.01, "{}", surface.volume());
    }
}
