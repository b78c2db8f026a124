//! From bodies to particles: lattice points inside, with volumes that add up to the body's.

mod thickness;

use std::ops::Range;

use rayon::prelude::*;

use crate::scene::geometry::fill::lattice;
use crate::scene::{Body, Material, Sampling, Scene, Shape};
pub use thickness::{ThinBody, ThinObstacle};

/// Particles that leave their lattice point go this far at most along each axis, in units of the lattice's spacing. In 3D that is
/// less than half a spacing, so that only particles of the outermost layer can leave the body.
const JITTER: f64 = 0.25;
/// Limits of the volume of the particles in the outermost layer over that of a lattice point.
const LAYER: [f64; 2] = [0.5, 1.5];
/// Relative error of volumes that is none.
const EXACT: f64 = 1e-6;

/// A particle at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed {
    /// Position `[m]`.
    pub position: [f64; 3],
    /// Velocity `[m s^-1]`.
    pub velocity: [f64; 3],
    /// Angular velocity `[rad s^-1]`.
    pub spin: [f64; 3],
    /// Rate at which it moves away from the centre of its body, over the distance `[s^-1]`.
    pub expansion: f64,
    /// Volume `[m^3]`, with unit thickness along inactive axes.
    pub volume: f64,
    /// Density `[kg m^-3]`.
    pub density: f64,
    /// Whether it is clamped or moves as prescribed.
    pub driven: bool,
    /// Whether it is broken.
    pub broken: bool,
    /// Its strength over that of the material; 0 where strength does not scatter.
    pub strength: f64,
    /// Index of the body in the scene.
    pub body: u32,
    /// Index of the material among the sorted names.
    pub material: u32,
}

/// A body that wants the place of one before it in the file, or of an obstacle.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Overlap {
    /// Name of the body that gives way.
    pub body: String,
    /// Name of the body or obstacle that has the place.
    pub by: String,
    /// Part of the body's shape that it loses.
    pub share: f64,
}

/// The lattice points of a body, or of a row of its cells.
#[derive(Debug, Default)]
struct Sampled {
    /// Points inside, x fastest within a cell, cell by cell; and whether they are nearer to the surface than half a spacing.
    inside: Vec<([f64; 3], bool)>,
    /// Volume of the layer within half a spacing of the surface, in lattice points: the part of each point's cube that is inside, taken
    /// as linear in the distance. Errors of flat parts cancel.
    layer: f64,
}

/// A body and what has its place before it.
struct Claim<'s> {
    body: &'s Body,
    before: Vec<&'s Shape>,
}

impl Claim<'_> {
    /// Signed distance of what is left of the body.
    fn depth(&self, point: [f64; 3]) -> f64 {
        self.before.iter().fold(self.body.shape.distance(point), |depth, shape| depth.max(-shape.distance(point)))
    }

    /// Whether the surface next to a point is not that of what is left: another body is as near or nearer, on the same side.
    fn hidden(&self, point: [f64; 3]) -> bool {
        let own = self.body.shape.distance(point);
        let nearer = |other: f64| (own < 0.0) == (other < 0.0) && other <= own;
        self.before.iter().any(|shape| nearer(shape.distance(point)))
    }
}

impl Scene {
    /// The particles of all bodies. A point in several bodies belongs to the first; obstacles come before bodies.
    #[must_use]
    pub fn seed_particles(&self) -> Vec<Seed> {
        (0..self.bodies.len()).flat_map(|index| self.seed_particles_of(index)).collect()
    }

    /// Those of one body.
    pub(crate) fn seed_particles_of(&self, index: usize) -> impl Iterator<Item = Seed> + use<> {
        let body = &self.bodies[index];
        let sampled = self.sample(index);
        let count = sampled.inside.iter().filter(|(_, outer)| *outer).count();
        // what is thinner than the lattice has no layer around something
        let resolved = (1..sampled.inside.len()).contains(&count);
        let ratio = if resolved { (sampled.layer / count as f64).clamp(LAYER[0], LAYER[1]) } else { 1.0 };
        let ratio = if (ratio - 1.0).abs() < EXACT { 1.0 } else { ratio };
        let per_cell = f64::from(self.particles_along_axis(body)).powi(self.domain.dimension as i32);
        let volume = self.domain.cell_volume() / per_cell;
        let (material, density) = (self.material_index(&body.material).unwrap_or(0), self.density_of(body));
        let claim = self.claim(index);
        let weibull = self.materials.get(&body.material).and_then(Material::fracture).and_then(|f| f.weibull);
        let seed = |(number, (position, outer)): (usize, ([f64; 3], bool))| Seed {
            position: match body.sampling {
                Sampling::Regular => position,
                Sampling::Jittered => self.jittered(&claim, position, outer, number),
            },
            velocity: body.velocity,
            spin: body.spin,
            expansion: body.expansion,
            volume: volume * if outer { ratio } else { 1.0 },
            density: density.unwrap_or_default(), // a scene without one is refused
            driven: false,
            broken: body.cracks.iter().any(|crack| crack.distance(position) < 0.0),
            strength: weibull.map_or(0.0, |weibull| {
                weibull.factor(position, index as u32, self.domain.dimension, self.domain.spacing())
            }),
            body: index as u32,
            material,
        };
        let mut seeds: Vec<Seed> = sampled.inside.into_par_iter().enumerate().map(seed).collect();
        turn(&mut seeds);
        drive(body, &mut seeds);
        seeds.into_iter()
    }

    /// How many particles [`Scene::seed_particles`] makes.
    #[must_use]
    pub fn particle_count(&self) -> usize {
        let count = |index| {
            let claim = self.claim(index);
            let rows: Vec<_> = self.rows_near(&claim.body.shape).collect();
            rows.into_par_iter().map(|(range, row)| self.sample_row(&claim, range, row).inside.len()).sum::<usize>()
        };
        (0..self.bodies.len()).map(count).sum()
    }

    /// True if a body gets at least one particle.
    pub(crate) fn has_particles(&self, index: usize) -> bool {
        let claim = self.claim(index);
        self.rows_near(&claim.body.shape).any(|(range, row)| !self.sample_row(&claim, range, row).inside.is_empty())
    }

    /// Bodies that lose a part of their shape to others.
    #[must_use]
    pub fn overlaps(&self) -> Vec<Overlap> {
        let mut found = Vec::new();
        for (index, body) in self.bodies.iter().enumerate() {
            let obstacles = self.obstacles.iter().map(|obstacle| (&obstacle.name, &obstacle.shape));
            let of_start = |other: &&Body| !body.joined && !other.joined;
            let others = self.bodies[..index].iter().filter(of_start).map(|other| (&other.name, &other.shape));
            let before = obstacles.chain(others);
            for (by, other) in before.filter(|(_, other)| touch(&body.shape, other)) {
                let share = self.common_share(body, other);
                if share > 0.0 {
                    found.push(Overlap { body: body.name.clone(), by: by.clone(), share });
                }
            }
        }
        found
    }

    /// Part of a body's lattice points that lie in another shape.
    fn common_share(&self, body: &Body, other: &Shape) -> f64 {
        let offsets = lattice(self.domain.axes(), self.particles_along_axis(body));
        let count = |(range, row): (Range<u32>, [u32; 2])| {
            let mut sums = [0u64; 2];
            self.cells_near(&body.shape, range, row, &mut |center| {
                for offset in &offsets {
                    let point = std::array::from_fn(|d| center[d] + offset[d] * self.domain.spacing());
                    if body.shape.distance(point) < 0.0 {
                        sums[0] += 1;
                        sums[1] += u64::from(other.distance(point) < 0.0);
                    }
                }
            });
            sums
        };
        let rows: Vec<_> = self.rows_near(&body.shape).collect();
        let [all, common] = rows.into_par_iter().map(count).reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        common as f64 / all.max(1) as f64
    }

    fn claim(&self, index: usize) -> Claim<'_> {
        let body = &self.bodies[index];
        let obstacles = self.obstacles.iter().map(|obstacle| &obstacle.shape);
        let of_start = |other: &&Body| !body.joined && !other.joined;
        let before = obstacles.chain(self.bodies[..index].iter().filter(of_start).map(|body| &body.shape));
        Claim { body, before: before.filter(|shape| touch(&body.shape, shape)).collect() }
    }

    fn sample(&self, index: usize) -> Sampled {
        let claim = self.claim(index);
        let rows: Vec<_> = self.rows_near(&claim.body.shape).collect();
        let parts: Vec<Sampled> =
            rows.into_par_iter().map(|(range, row)| self.sample_row(&claim, range, row)).collect();
        let mut all = Sampled::default();
        for part in parts {
            all.inside.extend(part.inside);
            all.layer += part.layer;
        }
        all
    }

    fn sample_row(&self, claim: &Claim<'_>, range: Range<u32>, row: [u32; 2]) -> Sampled {
        let (spacing, radius) = (self.domain.spacing(), self.cell_radius());
        let fine = spacing / f64::from(self.particles_along_axis(claim.body));
        let offsets = lattice(self.domain.axes(), self.particles_along_axis(claim.body));
        let mut sampled = Sampled::default();
        self.cells_near(&claim.body.shape, range, row, &mut |center| {
            // distances are nowhere steeper than 1
            let whole = claim.depth(center) < -radius - 0.5 * fine;
            for offset in &offsets {
                let point = std::array::from_fn(|d| center[d] + offset[d] * spacing);
                let depth = if whole { f64::NEG_INFINITY } else { claim.depth(point) };
                let outer = depth.abs() < 0.5 * fine * (1.0 - EXACT);
                if outer && (depth < 0.0 || !claim.hidden(point)) {
                    sampled.layer += 0.5 - depth / fine;
                }
                // a point on the surface stands for half of its volume, else a wall between two rows of points would lose both
                if depth < EXACT * fine && (depth < -EXACT * fine || !claim.hidden(point)) {
                    sampled.inside.push((point, outer));
                }
            }
        });
        sampled
    }

    /// Moves a particle off its lattice point, if that does not leave the body.
    fn jittered(&self, claim: &Claim<'_>, position: [f64; 3], outer: bool, number: usize) -> [f64; 3] {
        let fine = self.domain.spacing() / f64::from(self.particles_along_axis(claim.body));
        let axes = self.domain.axes();
        let shift = |d: usize| if d < axes { JITTER * fine * random(3 * number + d) } else { 0.0 };
        let moved = std::array::from_fn(|d| position[d] + shift(d));
        if outer && claim.depth(moved) >= 0.0 { position } else { moved }
    }

    /// The rows of cells along x that the box around a shape touches: range of x; y and z.
    fn rows_near(&self, shape: &Shape) -> impl Iterator<Item = (Range<u32>, [u32; 2])> + use<> {
        let (low, high) = shape.bounds();
        let range = |d: usize| {
            if d >= self.domain.axes() {
                return 0..1;
            }
            let cell = |x: f64| {
                let at = ((x - self.domain.origin[d]) / self.domain.spacing()).floor();
                at.clamp(0.0, f64::from(self.domain.cells[d] - 1)) as u32
            };
            cell(low[d])..cell(high[d]) + 1
        };
        let [x, y, z] = [range(0), range(1), range(2)];
        z.flat_map(move |z| y.clone().map(move |y| [y, z])).map(move |row| (x.clone(), row))
    }

    /// Visits the centres of the cells of a row that a shape may touch: the row is halved until it is one cell, and dropped where
    /// the shape is too far away.
    fn cells_near(&self, shape: &Shape, range: Range<u32>, row: [u32; 2], visit: &mut dyn FnMut([f64; 3])) {
        let first = self.domain.cell_center([range.start, row[0], row[1]]);
        let half = 0.5 * f64::from(range.end - range.start - 1) * self.domain.spacing();
        // lattice points lie half a spacing or more inside the corners, so those of the outermost layer are in cells that pass
        let reach = half + self.cell_radius();
        if shape.distance([first[0] + half, first[1], first[2]]) > reach {
            return;
        }
        if range.len() == 1 {
            visit(first);
            return;
        }
        let middle = range.start.midpoint(range.end);
        self.cells_near(shape, range.start..middle, row, visit);
        self.cells_near(shape, middle..range.end, row, visit);
    }
}

/// Whether the boxes around two shapes have points in common.
fn touch(a: &Shape, b: &Shape) -> bool {
    let (a, b) = (a.bounds(), b.bounds());
    (0..3).all(|d| a.0[d] <= b.1[d] && b.0[d] <= a.1[d])
}

/// A number from -1 to 1 that depends on `number` alone. [Steele, Lea, Flood 2014: splitmix64]
pub(crate) fn random(number: usize) -> f64 {
    let mut x = (number as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x ^ (x >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}

/// Adds what a body's spin and expansion give to the velocities of its particles: spin x arm + expansion arm, arm = position - centre.
fn turn(seeds: &mut [Seed]) {
    let count = seeds.len() as f64;
    let center: [f64; 3] = std::array::from_fn(|d| seeds.iter().map(|seed| seed.position[d]).sum::<f64>() / count);
    for seed in seeds {
        let arm: [f64; 3] = std::array::from_fn(|d| seed.position[d] - center[d]);
        for (d, (a, b)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
            seed.velocity[d] += seed.spin[a] * arm[b] - seed.spin[b] * arm[a] + seed.expansion * arm[d];
        }
    }
}

/// Gives the driven part of a body its prescribed motion.
fn drive(body: &Body, seeds: &mut [Seed]) {
    let start = body.driven_motion()[0];
    let about = body.motion.as_ref().map_or([0.0; 3], |motion| motion.about);
    for seed in seeds.iter_mut().filter(|seed| body.drives(seed.position)) {
        let arm = glam::DVec3::from(seed.position) - glam::DVec3::from(about);
        seed.driven = true;
        seed.velocity = (glam::DVec3::from(start.velocity) + glam::DVec3::from(start.spin).cross(arm)).into();
        seed.spin = start.spin;
        seed.expansion = 0.0;
    }
}
