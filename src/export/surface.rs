//! Closed surfaces: of particles as wholes, and of shapes by their distance.
//!
//! Space is cut into blocks of cells, of which only those near the surface are looked at. Each is meshed by naive surface nets
//! [Gibson 1998; crate `fast-surface-nets`]; what neighbours have both is one vertex.

use std::collections::{BTreeMap, HashMap};

use fast_surface_nets::ndshape::{ConstShape, ConstShape3u32};
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use rayon::prelude::*;

use crate::bodies::Groups;

/// Cells of a block along an axis, and its nodes with those that it shares.
const BLOCK: i32 = 16;
const NODES: u32 = BLOCK as u32 + 2;
type Shape = ConstShape3u32<NODES, NODES, NODES>;

/// Reach of a particle, in distances of particles. With it the surface of a plane layer of particles is plane, and lies half
/// a distance above it, however many layers there are.
const REACH: f32 = 1.75;
/// Distance from the mean of the near particles to the surface.
const RADIUS: f32 = 0.5;
/// Farthest that a particle may be from the inside: without it there are specks half way between particles that part.
const FARTHEST: f32 = 1.1;
/// Distances of particles in a cell of the mesh.
const FINENESS: f32 = 0.5;

/// Volume of what is no part, over that of a particle: cells where the field only just changes its sign.
const SPECK: f64 = 0.02;

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

/// What is known at the nodes of a block: distance over the edge of a cell, negative inside, and the nearest particle.
struct Field {
    distance: Vec<f32>,
    nearest: Vec<u32>,
}

impl Surface {
    /// That of particles with this distance from each other, by the distance from their weighted mean. [Zhu and Bridson 2005]
    #[must_use]
    pub fn of_particles(places: &[[f32; 3]], distance: f32) -> Self {
        let cell = FINENESS * distance;
        let reach = REACH / FINENESS;
        let scaled: Vec<[f32; 3]> = places.iter().map(|place| place.map(|x| x / cell)).collect();
        let mut blocks: BTreeMap<[i32; 3], Vec<u32>> = BTreeMap::new();
        for (index, place) in scaled.iter().enumerate() {
            let low = place.map(|x| ((x - reach).floor() as i32 - NODES as i32 + 1).div_euclid(BLOCK));
            let high = place.map(|x| ((x + reach).ceil() as i32).div_euclid(BLOCK));
            for z in low[2]..=high[2] {
                for y in low[1]..=high[1] {
                    for x in low[0]..=high[0] {
                        blocks.entry([x, y, z]).or_default().push(index as u32);
                    }
                }
            }
        }
        let blocks: Vec<_> = blocks.into_iter().collect();
        let field = |(block, own): &([i32; 3], Vec<u32>)| (*block, around(*block, own, &scaled));
        let surface = joined(blocks.par_iter().map(field).map(meshed).collect(), cell);
        surface.without_specks(SPECK * f64::from(distance).powi(3))
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
        let field = |block: &[i32; 3]| {
            let at =
                |node: [u32; 3]| std::array::from_fn(|axis| f64::from(block[axis] * BLOCK + node[axis] as i32) * cell);
            let values = (0..Shape::SIZE).map(|node| (distance(at(Shape::delinearize(node))) / cell) as f32);
            (*block, Field { distance: values.collect(), nearest: vec![0; Shape::USIZE] })
        };
        joined(blocks.par_iter().filter(|block| near(block)).map(field).map(meshed).collect(), cell as f32)
    }

    /// Volume inside \[m^3\].
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.triangles.iter().map(|three| self.beneath(three)).sum()
    }

    /// Volume between a triangle and the first corner \[m^3\].
    fn beneath(&self, three: &[u32; 3]) -> f64 {
        let corner = |index: u32| glam::DVec3::from(self.points[index as usize].map(f64::from));
        let [a, b, c] = three.map(|index| corner(index) - corner(0));
        a.dot(b.cross(c)) / 6.0
    }

    /// Without parts that hang together and enclose, or leave out, no more than a volume \[m^3\].
    fn without_specks(&self, least: f64) -> Self {
        let mut groups = Groups::of(self.points.len());
        for [a, b, c] in &self.triangles {
            groups.join(*a as usize, *b as usize);
            groups.join(*a as usize, *c as usize);
        }
        let mut volumes = vec![0.0; self.points.len()];
        for three in &self.triangles {
            volumes[groups.root(three[0] as usize)] += self.beneath(three);
        }
        let (mut kept, mut numbers) = (Self::default(), vec![u32::MAX; self.points.len()]);
        for (index, number) in numbers.iter_mut().enumerate() {
            if volumes[groups.root(index)].abs() > least {
                *number = kept.points.len() as u32;
                kept.points.push(self.points[index]);
                kept.nearest.push(self.nearest[index]);
            }
        }
        let triangles = self.triangles.iter().map(|three| three.map(|corner| numbers[corner as usize]));
        kept.triangles = triangles.filter(|three| three[0] != u32::MAX).collect();
        kept
    }
}

/// The field of a block from the particles that reach into it; lengths are in cells.
fn around(block: [i32; 3], own: &[u32], places: &[[f32; 3]]) -> Field {
    let scale = 1.0 / FINENESS;
    let reach = REACH * scale;
    let mut sums = vec![[0.0_f32; 4]; Shape::USIZE];
    let mut near = vec![(f32::INFINITY, 0); Shape::USIZE];
    for &index in own {
        let place: [f32; 3] = std::array::from_fn(|axis| places[index as usize][axis] - (block[axis] * BLOCK) as f32);
        let low = place.map(|x| (x - reach).ceil().max(0.0) as u32);
        let high = place.map(|x| (x + reach).floor().min((NODES - 1) as f32));
        if high.iter().any(|x| *x < 0.0) {
            continue;
        }
        for z in low[2]..=high[2] as u32 {
            for y in low[1]..=high[1] as u32 {
                for x in low[0]..=high[0] as u32 {
                    let apart: [f32; 3] = std::array::from_fn(|axis| [x, y, z][axis] as f32 - place[axis]);
                    let square: f32 = apart.iter().map(|part| part * part).sum();
                    let node = Shape::linearize([x, y, z]) as usize;
                    let weight = (1.0 - square / (reach * reach)).max(0.0).powi(3);
                    for axis in 0..3 {
                        sums[node][axis] += weight * apart[axis];
                    }
                    sums[node][3] += weight;
                    if square < near[node].0 {
                        near[node] = (square, index);
                    }
                }
            }
        }
    }
    let value = |(sum, (square, _)): (&[f32; 4], &(f32, u32))| {
        let [x, y, z] = [sum[0], sum[1], sum[2]].map(|part| part / sum[3].max(f32::MIN_POSITIVE));
        let farthest = square.sqrt().min(reach) - FARTHEST * scale;
        ((x * x + y * y + z * z).sqrt() - RADIUS * scale).max(farthest)
    };
    let distance = sums.iter().zip(&near).map(value).collect();
    Field { distance, nearest: near.into_iter().map(|(_, index)| index).collect() }
}

/// The mesh of a block: corners with their cells, in cells from the block's corner, and their nearest particles.
struct Part {
    block: [i32; 3],
    points: Vec<([f32; 3], [i32; 3], u32)>,
    triangles: Vec<[u32; 3]>,
}

fn meshed((block, field): ([i32; 3], Field)) -> Part {
    let mut buffer = SurfaceNetsBuffer::default();
    surface_nets(&field.distance, &Shape {}, [0; 3], [NODES - 1; 3], &mut buffer);
    let places = buffer.positions.iter().zip(&buffer.surface_points);
    let points = places.map(|(place, cell)| {
        let nearest = field.nearest[Shape::linearize(*cell) as usize];
        (*place, std::array::from_fn(|axis| block[axis] * BLOCK + cell[axis] as i32), nearest)
    });
    let points = points.collect();
    let triangles = buffer.indices.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect();
    Part { block, points, triangles }
}

/// One surface of all parts: a corner for each cell. Cells in the outermost layers of blocks are those of neighbours, too.
fn joined(parts: Vec<Part>, cell: f32) -> Surface {
    let (mut surface, mut known) = (Surface::default(), HashMap::new());
    for Part { block, points, triangles } in parts {
        let mut numbers = Vec::with_capacity(points.len());
        for (place, own, nearest) in points {
            let mut new = || {
                surface.points.push(std::array::from_fn(|axis| (place[axis] + (block[axis] * BLOCK) as f32) * cell));
                surface.nearest.push(nearest);
                surface.points.len() as u32 - 1
            };
            let is_shared = (0..3).any(|axis| own[axis].rem_euclid(BLOCK) == 0);
            numbers.push(if is_shared { *known.entry(own).or_insert_with(new) } else { new() });
        }
        surface.triangles.extend(triangles.iter().map(|three| three.map(|corner| numbers[corner as usize])));
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn shapes_are_closed_too() {
        let ball = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt() - 1.0;
        let surface = Surface::of_distance([[-1.0; 3], [1.0; 3]], 0.05, ball);
        let volume = 4.0 / 3.0 * std::f64::consts::PI;
        assert!(is_closed(&surface) && (surface.volume() / volume - 1.0).abs() < 0.01, "{}", surface.volume());
    }
}
