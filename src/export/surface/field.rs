//! The field that the surface of particles is the zero of, at the nodes of a block.

use fast_surface_nets::ndshape::ConstShape;
use glam::Vec4;

use super::{BLOCK, NODES, Shape};

/// Reach of a particle, in distances of particles. With it the surface of a plane layer of particles is plane, and lies half
/// a distance above it, however many layers there are.
const REACH: f32 = 1.75;
/// Distance from the mean of the near particles to the surface.
const RADIUS: f32 = 0.5;
/// Farthest that a particle may be from the inside: without it there are specks half way between particles that part.
const FARTHEST: f32 = 1.1;
/// Distances of particles in a cell of the mesh.
pub(super) const FINENESS: f32 = 0.5;
/// The reach in cells.
pub(super) const REACHED: f32 = REACH / FINENESS;
/// Nodes of a row that a particle may reach, and those that are worked on together.
const ROW: usize = 8;
const LANES: usize = 4;
const _: () = assert!(2.0 * REACHED < ROW as f32 && ROW <= NODES as usize);

/// What is known at the nodes of a block: distance over the edge of a cell, negative inside, and the nearest particle. Made once for many
/// blocks.
pub(super) struct Field {
    pub(super) distance: Vec<f32>,
    /// Square of the distance of the nearest particle, and its rank among those of the block.
    near: Vec<f32>,
    rank: Vec<f32>,
    particles: Vec<u32>,
    /// Sums over particles: weights, and weights times the way from the particle.
    weight: Vec<f32>,
    ways: [Vec<f32>; 3],
}

impl Field {
    pub(super) fn new() -> Self {
        let zeros = || vec![0.0; Shape::USIZE];
        let (ways, particles) = (std::array::from_fn(|_| zeros()), Vec::new());
        Self { distance: zeros(), near: zeros(), rank: zeros(), particles, weight: zeros(), ways }
    }

    /// Fills it from particles of which some reach into a block; lengths are in cells. Whether any does.
    pub(super) fn fill(&mut self, block: [i32; 3], own: impl Iterator<Item = (u32, [f32; 3])>) -> bool {
        self.near.fill(f32::INFINITY);
        self.rank.fill(0.0);
        self.weight.fill(0.0);
        self.ways.iter_mut().for_each(|way| way.fill(0.0));
        self.particles.clear();
        for (index, place) in own {
            self.add(index, std::array::from_fn(|axis| place[axis] - (block[axis] * BLOCK) as f32));
        }
        let ends = Shape::USIZE / LANES * LANES;
        (0..ends).step_by(LANES).chain([Shape::USIZE - LANES]).for_each(|from| self.sum_up(from));
        !self.particles.is_empty()
    }

    /// Distances at nodes from one on.
    fn sum_up(&mut self, from: usize) {
        let nodes = from..from + LANES;
        let of = |values: &[f32]| Vec4::from_slice(&values[nodes.clone()]);
        let over = Vec4::ONE / of(&self.weight).max(Vec4::splat(f32::MIN_POSITIVE));
        let [x, y, z] = self.ways.each_ref().map(|way| of(way) * over);
        let root = |square: Vec4| Vec4::from(square.to_array().map(f32::sqrt));
        let farthest = root(of(&self.near).min(Vec4::splat(REACHED * REACHED))) - Vec4::splat(FARTHEST / FINENESS);
        let distance = root(x * x + y * y + z * z) - Vec4::splat(RADIUS / FINENESS);
        distance.max(farthest).write_to_slice(&mut self.distance[nodes]);
    }

    /// Adds a particle to the nodes in its reach, row by row.
    fn add(&mut self, index: u32, place: [f32; 3]) {
        let last = (NODES - 1) as f32;
        if place.iter().any(|x| x + REACHED < 0.0 || x - REACHED > last) {
            return;
        }
        let rank = Vec4::splat(self.particles.len() as f32);
        self.particles.push(index);
        let low = place.map(|x| (x - REACHED).ceil().max(0.0) as usize);
        let high = place.map(|x| (x + REACHED).min(last) as usize);
        let first = low[0].min(NODES as usize - ROW);
        let along: [Vec4; ROW / LANES] = std::array::from_fn(|part| {
            let from = (first + part * LANES) as f32 - place[0];
            Vec4::new(from, from + 1.0, from + 2.0, from + 3.0)
        });
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                let across = [y as f32 - place[1], z as f32 - place[2]];
                if across[0] * across[0] + across[1] * across[1] < REACHED * REACHED {
                    let from = first + NODES as usize * (y + NODES as usize * z);
                    along.iter().enumerate().for_each(|(k, along)| self.add_at(from + k * LANES, rank, *along, across));
                }
            }
        }
    }

    /// Adds a particle to the nodes from one on, which are so far from it along the row and across.
    fn add_at(&mut self, from: usize, rank: Vec4, x: Vec4, [y, z]: [f32; 2]) {
        let nodes = from..from + LANES;
        let square = x * x + Vec4::splat(y * y + z * z);
        let closeness = (Vec4::ONE - square * (1.0 / (REACHED * REACHED))).max(Vec4::ZERO);
        let weight = closeness * closeness * closeness;
        let add = |sums: &mut Vec<f32>, more: Vec4| {
            let sums = &mut sums[nodes.clone()];
            (Vec4::from_slice(sums) + more).write_to_slice(sums);
        };
        let [xs, ys, zs] = &mut self.ways;
        add(&mut self.weight, weight);
        add(xs, weight * x);
        add(ys, weight * y);
        add(zs, weight * z);
        let (near, ranks) = (&mut self.near[nodes.clone()], &mut self.rank[nodes]);
        let known = Vec4::from_slice(near);
        Vec4::select(square.cmplt(known), rank, Vec4::from_slice(ranks)).write_to_slice(ranks);
        known.min(square).write_to_slice(near);
    }

    /// The particle nearest to a cell: to the corner that one is closest to.
    pub(super) fn nearest(&self, cell: [u32; 3]) -> u32 {
        let corner = |k: u32| Shape::linearize([cell[0] + k % 2, cell[1] + k / 2 % 2, cell[2] + k / 4]) as usize;
        let closest = (0..8).map(corner).min_by(|one, two| self.near[*one].total_cmp(&self.near[*two]));
        closest.and_then(|node| self.particles.get(self.rank[node] as usize)).copied().unwrap_or(0)
    }
}
