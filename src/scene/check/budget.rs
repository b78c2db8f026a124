//! How much work a scene is, by counting, before anything loops over it: signed distances of single shapes to evaluate, particles, rows
//! of cells. What is too much is refused with the number and the limit.

use toml::de::{DeTable, DeValue};

use crate::scene::finding::Finding;
use crate::scene::{Boundary, Domain, Scene, Shape};

/// Single shapes that one shape may be made of, copies and uses counted as often as they are there.
const MOST_PARTS: u64 = 1_000_000;
/// Keys and entries of lists that a scene may have that somebody wrote, its variants among them.
pub(crate) const MOST_VALUES: u64 = 100_000;
/// Particles of a scene at most: the device's largest buffer holds no more.
pub const MOST_PARTICLES: u64 = 1 << 27;
/// Rows of cells that bodies touch at most, each body counted by itself.
const MOST_ROWS: u64 = 1 << 26;
/// Distances of single shapes that the check of a scene may need.
const MOST_DISTANCES: u64 = 4_000_000_000;
/// Distances that the openings of the sides may need.
const MOST_FACES: u64 = 100_000_000;
/// Points per axis in the box around a body at which its share of the box is looked up.
const LOOKS: u32 = 24;
/// Distances that these looks may need for one body.
const MOST_LOOKS: u64 = 200_000;
/// How often every lattice point of a body is looked at: particles counted, placed, looked for in other bodies.
const PASSES: u64 = 4;

/// The work of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Particles, about.
    particles: u64,
    /// Rows of cells that bodies touch.
    rows: u64,
    /// Distances to single shapes.
    distances: u64,
}

impl Shape {
    /// Single shapes whose distance the distance of this one takes, about; faces and corners count, too.
    pub(crate) fn parts_count(&self) -> u64 {
        let below = || self.parts().iter().fold(1u64, |sum, (_, part)| sum.saturating_add(part.parts_count()));
        match self {
            Shape::Polygon { points, .. } | Shape::Revolve { points, .. } => points.len() as u64,
            Shape::Chain { points, .. } => points.len() as u64,
            Shape::Mesh(mesh) => 16 + u64::from((mesh.triangle_count() as u64).max(1).ilog2()),
            Shape::Use(named) => named.parts_count().saturating_add(1),
            Shape::Mirror { .. } => below().saturating_mul(2),
            Shape::Repeat { count, .. } | Shape::Around { count, .. } => below().saturating_mul(u64::from(*count)),
            _ => below(),
        }
    }

    /// Shapes in each other, the innermost counted as 1.
    pub(crate) fn depth(&self) -> u32 {
        match self {
            Shape::Use(named) => named.depth() + 1,
            _ => 1 + self.parts().iter().map(|(_, part)| part.depth()).max().unwrap_or(0),
        }
    }
}

/// A text of too many keys and entries; nothing may look at each of them.
pub(crate) fn values(root: &DeTable<'_>, most: u64) -> Option<Finding> {
    let count = root.iter().fold(0, |sum: u64, (_, value)| sum + values_count(value.get_ref()));
    let help = format!("at most {most} are read; a large outline is better a mesh file");
    (count > most).then(|| Finding::new("", format!("{count} keys and entries of lists"), help))
}

fn values_count(value: &DeValue<'_>) -> u64 {
    match value {
        DeValue::Table(table) => table.iter().fold(1, |sum, (_, value)| sum + values_count(value.get_ref())),
        DeValue::Array(array) => array.iter().fold(1, |sum, value| sum + values_count(value.get_ref())),
        _ => 1,
    }
}

/// Shapes of too many parts; nothing may ask one of them for a distance.
pub(crate) fn shapes(scene: &Scene) -> Vec<Finding> {
    let own = scene.shapes.iter().map(|(name, shape)| (format!("shapes.{name}"), shape));
    let placed = scene.placed_shapes().into_iter().chain(scene.patch_shapes()).chain(own);
    let finding = |(path, shape): (String, &Shape)| {
        let parts = shape.parts_count();
        let help =
            format!("give at most {MOST_PARTS}; copies of copies multiply, and so do uses of shapes that use others");
        (parts > MOST_PARTS).then(|| Finding::new(path, format!("a shape of {parts} single shapes"), help))
    };
    placed.filter_map(finding).collect()
}

/// What a sound domain and sound shapes cost.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut limit = |path: &str, number: u64, what: &str, most: u64, help: &str| {
        if number > most {
            found.push(Finding::new(path, format!("{number} {what}"), format!("at most {most} are taken; {help}")));
        }
    };
    let faces = face_distances(scene);
    let help = "use fewer or simpler patches, fewer regions beside outlets, or fewer cells";
    limit("boundary", faces, "distances to find patches and remembered gas of all faces", MOST_FACES, help);
    let work = work(scene);
    let help = "use fewer cells or fewer particles_per_cell";
    limit("bodies", work.particles, "particles, about", MOST_PARTICLES, help);
    limit("bodies", work.rows, "rows of cells that bodies touch", MOST_ROWS, help);
    let help = "use fewer cells, simpler shapes, or bodies that overlap less";
    limit("domain.cells", work.distances, "distances to single shapes, about", MOST_DISTANCES, help);
    found
}

/// Distances that the rules of all faces take, and the gas that outlets remember there.
fn face_distances(scene: &Scene) -> u64 {
    let domain = &scene.domain;
    let regions = scene.gas.regions.iter().fold(1u64, |sum, region| sum.saturating_add(region.shape.parts_count()));
    let regions = regions.saturating_add(scene.gas.radial_flows.len() as u64);
    let sides = scene.boundary.sides().into_iter().enumerate().filter(|(index, _)| index / 2 < domain.axes());
    let cost = |(index, side): (usize, &Boundary)| {
        let patches = match side {
            Boundary::Patched(patched) => &patched.patches[..],
            _ => &[],
        };
        let parts = patches.iter().fold(0u64, |sum, patch| sum.saturating_add(patch.shape.parts_count()));
        let remembers = side.rules().contains(&&Boundary::Outlet) && !scene.is_even_at_sides();
        let parts = if remembers { parts.saturating_add(regions) } else { parts };
        let across = (0..domain.axes()).filter(|d| *d != index / 2);
        across.fold(parts, |product, d| product.saturating_mul(u64::from(domain.cells[d])))
    };
    sides.map(cost).fold(0, u64::saturating_add)
}

/// The work of finding particles, obstacles and regions.
fn work(scene: &Scene) -> Work {
    let domain = &scene.domain;
    let mut work = Work::default();
    let cells = (0..domain.axes()).fold(1u64, |product, d| product.saturating_mul(u64::from(domain.cells[d])));
    let everywhere = scene.gas.regions.iter().map(|region| &region.shape);
    let everywhere = everywhere.chain(scene.obstacles.iter().map(|obstacle| &obstacle.shape));
    // obstacles are looked at on a coarse grid where there are many cells; regions when the scene runs
    let sampled = cells.min(1 << 24);
    for shape in everywhere {
        work.distances = work.distances.saturating_add(sampled.saturating_mul(shape.parts_count()));
    }
    // twice at each charge: what is gas around it
    let looks = 2 * u64::from(crate::scene::charge::SAMPLES).pow(domain.axes() as u32) * scene.charges.len() as u64;
    let solids = scene.bodies.iter().map(|body| &body.shape).chain(scene.obstacles.iter().map(|own| &own.shape));
    let parts = solids.fold(0u64, |sum, shape| sum.saturating_add(shape.parts_count()));
    work.distances = work.distances.saturating_add(looks.saturating_mul(parts));
    let mut before: Vec<(u64, [[f64; 3]; 2])> = Vec::new();
    let boxed = |shape: &Shape| {
        let (low, high) = shape.bounds();
        (shape.parts_count(), [low, high])
    };
    before.extend(scene.obstacles.iter().map(|obstacle| boxed(&obstacle.shape)));
    for body in &scene.bodies {
        let (parts, bounds) = boxed(&body.shape);
        let beside = before.iter().filter(|(_, other)| touch(&bounds, other));
        let all = beside.fold(parts, |sum, (parts, _)| sum.saturating_add(*parts));
        let counts = range_counts(domain, &bounds);
        let rows = counts[1].saturating_mul(counts[2]);
        let lattice = u64::from(scene.particles_along_axis(body).max(1)).saturating_pow(domain.dimension);
        let most = counts.iter().fold(lattice, |product, count| product.saturating_mul(*count));
        let particles = (most as f64 * share(domain, &body.shape, &bounds, parts)) as u64;
        work.rows = work.rows.saturating_add(rows);
        work.particles = work.particles.saturating_add(particles);
        let looks = rows.saturating_add(particles).saturating_mul(all).saturating_mul(PASSES);
        work.distances = work.distances.saturating_add(looks);
        before.push((parts, bounds));
    }
    work
}

fn touch(a: &[[f64; 3]; 2], b: &[[f64; 3]; 2]) -> bool {
    (0..3).all(|d| a[0][d] <= b[1][d] && b[0][d] <= a[1][d])
}

/// Cells along each axis that a box touches.
fn range_counts(domain: &Domain, [low, high]: &[[f64; 3]; 2]) -> [u64; 3] {
    std::array::from_fn(|d| {
        if d >= domain.axes() {
            return 1;
        }
        let cell =
            |x: f64| ((x - domain.origin[d]) / domain.spacing()).floor().clamp(0.0, f64::from(domain.cells[d] - 1));
        (cell(high[d]) - cell(low[d])).max(0.0) as u64 + 1
    })
}

/// Share of the box around a shape, within the domain, that is inside; from a few points.
fn share(domain: &Domain, shape: &Shape, [low, high]: &[[f64; 3]; 2], parts: u64) -> f64 {
    let axes = domain.axes();
    let affordable = (MOST_LOOKS as f64 / parts as f64).powf(1.0 / axes as f64) as u32;
    let count = affordable.clamp(2, LOOKS);
    let corner = |d: usize, x: f64| x.clamp(domain.origin[d], domain.origin[d] + domain.size[d]);
    let at = |d: usize, k: u32| {
        let (low, high) = (corner(d, low[d]), corner(d, high[d]));
        if d < axes { low + (high - low) * (f64::from(k) + 0.5) / f64::from(count) } else { 0.0 }
    };
    let total = count.pow(axes as u32);
    let inside =
        |k: u32| shape.distance([at(0, k % count), at(1, k / count % count), at(2, k / (count * count))]) < 0.0;
    (0..total).filter(|k| inside(*k)).count() as f64 / f64::from(total)
}
