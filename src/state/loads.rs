//! Loads of the gas on what is held, driven or fixed: which there are, their sums on the device, and who owns a slot.

use super::{Grid, Openings};
use crate::scene::{CutGeometry, Scene};

/// Numbers of a load: force, power, moment, force of the pressure alone, area. Mirror of `shaders/loads.wgsl`.
pub const LOAD_NUMBERS: u32 = 9;
/// vec4 entries of a load in its history ring.
pub const LOAD_WIDTH: usize = 3;
/// Most loads: a slot knows two of them by 16 bits each.
const MOST: usize = 0xfffe;

/// How many loads a scene has: its bodies, if some body is held or driven, for they touch each other; then its obstacles.
#[must_use]
pub fn count(scene: &Scene) -> [usize; 2] {
    let held = scene.bodies.iter().any(crate::scene::Body::is_driven);
    let bodies = if held { scene.bodies.len() } else { 0 };
    [bodies, scene.obstacles.len().min(MOST - bodies)]
}

/// Words of the sums and owners.
#[must_use]
pub fn length(scene: &Scene, slots: usize) -> usize {
    let loads: usize = count(scene).iter().sum();
    if loads == 0 { 0 } else { 2 * LOAD_NUMBERS as usize * loads + slots }
}

/// What the kernels are told of them.
#[must_use]
pub(super) fn overrides(scene: &Scene, start: &[[f64; 5]], openings: &Openings) -> [(&'static str, f64); 2] {
    [("LOADS", count(scene).iter().sum::<usize>() as f64), ("LOAD_UNIT", unit(scene, start, openings))]
}

/// The unit of their sums: the largest pressure of the gas of the start `[density, momentum, energy]` and of the sides \[Pa\].
fn unit(scene: &Scene, start: &[[f64; 5]], openings: &Openings) -> f64 {
    let gamma = scene.gas.gamma;
    let inside =
        start.iter().map(|[density, x, y, z, total]| (gamma - 1.0) * (total - 0.5 * (x * x + y * y + z * z) / density));
    let beyond = openings.table.iter().map(|rule| f64::from(rule.pressure));
    let all = inside.chain(beyond).filter(|pressure| pressure.is_finite());
    all.fold(scene.gas.ambient.pressure, f64::max)
}

/// Sums of nothing, and for each slot the load of the obstacle that has it, one more, in its upper half.
#[must_use]
pub(super) fn start(scene: &Scene, grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    let [bodies, obstacles] = count(scene);
    let mut words = vec![0; length(scene, grid.slots())];
    if obstacles == 0 {
        return words;
    }
    let owners = words.len() - grid.slots();
    let nearest = |cell: [u32; 3]| {
        let center = scene.domain.cell_center(cell);
        let distance = |k: &usize| scene.obstacles[*k].shape.distance(center);
        let nearest = (0..obstacles).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        ((bodies + nearest.unwrap_or(0) + 1) as u32) << 16
    };
    let [nx, ny, _] = grid.cells;
    let walls = geometry.walls.iter().enumerate().filter(|(_, wall)| **wall);
    let cell = |index: usize| [index as u32 % nx, index as u32 / nx % ny, index as u32 / (nx * ny)];
    for cell in walls.map(|(index, _)| cell(index)).chain(geometry.cells.iter().map(|cut| cut.cell)) {
        words[owners + grid.slot(cell.map(|k| k as i32))] = nearest(cell);
    }
    words
}
