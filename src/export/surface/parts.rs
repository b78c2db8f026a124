//! The meshes of blocks, and one surface of all of them.

use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::DVec3;
use rayon::prelude::*;

use super::{BLOCK, NODES, Shape, Surface};
use crate::bodies::Groups;

/// The mesh of a block.
#[derive(Default)]
pub(super) struct Part {
    /// Corners, in cells.
    points: Vec<[f32; 3]>,
    /// The particle next to each.
    nearest: Vec<u32>,
    /// Triangles by places in `points`.
    triangles: Vec<[u32; 3]>,
    /// Cells of corners that neighbours may have, too, and places of the corners.
    shared: Vec<([i32; 3], u32)>,
    /// What hangs together in the block, by corner, and the volume between each and the origin, in cells.
    group: Vec<u32>,
    volumes: Vec<f64>,
}

impl Part {
    /// Of distances at the nodes of a block; `nearest` knows a particle for each of its cells.
    pub(super) fn of(
        block: [i32; 3],
        distance: &[f32],
        nearest: impl Fn([u32; 3]) -> u32,
        buffer: &mut SurfaceNetsBuffer,
    ) -> Self {
        surface_nets(distance, &Shape {}, [0; 3], [NODES - 1; 3], buffer);
        let place = |place: &[f32; 3]| std::array::from_fn(|axis| place[axis] + (block[axis] * BLOCK) as f32);
        let cells = buffer.surface_points.iter().zip(0..);
        let is_shared = |cell: &[u32; 3]| cell.iter().any(|at| at % BLOCK as u32 == 0);
        let cell = |own: &[u32; 3]| std::array::from_fn(|axis| block[axis] * BLOCK + own[axis] as i32);
        let mut part = Self {
            points: buffer.positions.iter().map(place).collect(),
            nearest: buffer.surface_points.iter().map(|cell| nearest(*cell)).collect(),
            triangles: buffer.indices.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect(),
            shared: cells.filter(|(own, _)| is_shared(own)).map(|(own, at)| (cell(own), at)).collect(),
            ..Self::default()
        };
        part.group();
        part
    }

    /// Finds what hangs together.
    fn group(&mut self) {
        let mut groups = Groups::of(self.points.len());
        for [a, b, c] in &self.triangles {
            groups.join(*a as usize, *b as usize);
            groups.join(*a as usize, *c as usize);
        }
        self.group = vec![0; self.points.len()];
        for at in 0..self.points.len() {
            let root = groups.root(at); // no later than `at`
            if root == at {
                self.group[at] = self.volumes.len() as u32;
                self.volumes.push(0.0);
            }
            self.group[at] = self.group[root];
        }
        let corner = |at: u32| DVec3::from(self.points[at as usize].map(f64::from));
        for three in &self.triangles {
            let [a, b, c] = three.map(corner);
            self.volumes[self.group[three[0] as usize] as usize] += a.dot(b.cross(c)) / 6.0;
        }
    }
}

/// One surface of all parts, by cells of this edge \[m\]: a corner for each cell; without what hangs together and encloses, or leaves
/// out, no more cells than `least`.
pub(super) fn joined(parts: &[Part], cell: f32, least: f64) -> Surface {
    let aliases = aliases(parts);
    let kept = kept(parts, &aliases, least);
    let mut numbers: Vec<Vec<u32>> = parts.iter().map(|part| vec![0; part.points.len()]).collect();
    aliases.iter().for_each(|&([part, at], _)| numbers[part as usize][at as usize] = u32::MAX);
    let mut count = 0;
    for (own, (part, kept)) in numbers.iter_mut().zip(parts.iter().zip(&kept)) {
        for (number, group) in own.iter_mut().zip(&part.group) {
            if *number == 0 && kept[*group as usize] {
                *number = count;
                count += 1;
            } else {
                *number = u32::MAX;
            }
        }
    }
    let own = |k: usize| numbers[k].iter().enumerate().filter(|(_, number)| **number != u32::MAX).map(|(at, _)| at);
    let place = |k: usize| own(k).map(move |at| parts[k].points[at].map(|x| x * cell));
    let points = (0..parts.len()).into_par_iter().flat_map_iter(place).collect();
    let nearest = (0..parts.len()).into_par_iter().flat_map_iter(|k| own(k).map(move |at| parts[k].nearest[at]));
    let nearest = nearest.collect();
    for &([part, at], [first, other]) in &aliases {
        numbers[part as usize][at as usize] = numbers[first as usize][other as usize];
    }
    let triangles = parts.par_iter().zip(&numbers).flat_map_iter(|(part, numbers)| {
        let numbered = |three: &[u32; 3]| three.map(|corner| numbers[corner as usize]);
        part.triangles.iter().map(numbered).filter(|three| three[0] != u32::MAX)
    });
    let triangles = triangles.collect();
    Surface { points, nearest, triangles }
}

/// Corners that an earlier part has, too: part and place, and those of the first.
fn aliases(parts: &[Part]) -> Vec<([u32; 2], [u32; 2])> {
    let of = |(k, part): (usize, &Part)| part.shared.clone().into_iter().map(move |(cell, at)| (cell, [k as u32, at]));
    let mut all: Vec<([i32; 3], [u32; 2])> = parts.par_iter().enumerate().flat_map_iter(of).collect();
    all.par_sort_unstable();
    let same = all.chunk_by(|one, two| one.0 == two.0);
    same.flat_map(|same| same[1..].iter().map(|(_, at)| (*at, same[0].1))).collect()
}

/// Whether what hangs together has more cells than `least`, by part and group.
fn kept(parts: &[Part], aliases: &[([u32; 2], [u32; 2])], least: f64) -> Vec<Vec<bool>> {
    let mut first = vec![0];
    first.extend(parts.iter().scan(0, |sum, part| {
        *sum += part.volumes.len();
        Some(*sum)
    }));
    let mut groups = Groups::of(first[parts.len()]);
    let number = |[part, at]: [u32; 2]| first[part as usize] + parts[part as usize].group[at as usize] as usize;
    aliases.iter().for_each(|(one, other)| groups.join(number(*one), number(*other)));
    let mut volumes = vec![0.0; first[parts.len()]];
    let own = parts.iter().flat_map(|part| &part.volumes).enumerate();
    own.for_each(|(group, volume)| volumes[groups.root(group)] += volume);
    let mut is_kept = |group: usize| f64::abs(volumes[groups.root(group)]) > least;
    parts
        .iter()
        .zip(&first)
        .map(|(part, from)| (*from..from + part.volumes.len()).map(&mut is_kept).collect())
        .collect()
}
