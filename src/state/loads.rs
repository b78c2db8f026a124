//! Loads of the gas on what is held, driven or fixed: which there are, their sums on the device, and who owns a slot.

use super::{Grid, HISTORY, Openings};
use crate::scene::{Conserved, CutGeometry, GaugePlace, Scene};

/// Numbers of a load: force, power, moment, force of the pressure alone, area. Mirror of `shaders/step/loads.wgsl`.
pub const LOAD_NUMBERS: u32 = 9;
/// vec4 entries of a load in its history ring.
pub const LOAD_WIDTH: usize = 3;
/// Most loads: a slot knows two of them by 16 bits each.
const MOST: usize = 0xfffe;

/// How many loads a scene has: its bodies, if some body is held or driven or has a gauge, for they touch each other; then its obstacles;
/// then the sides whose walls have gauges.
pub fn count(scene: &Scene) -> [usize; 3] {
    let held = scene.bodies.iter().any(crate::scene::Body::is_driven);
    let told = held || scene.gauge_places().iter().any(|place| matches!(place, GaugePlace::Body(_)));
    let bodies = if told { scene.bodies.len() } else { 0 };
    let sides = sides(scene).len();
    [bodies, scene.obstacles.len().min(MOST - bodies - sides), sides]
}

/// The sides whose walls have gauges, in order.
pub fn sides(scene: &Scene) -> Vec<usize> {
    let places = scene.gauge_places();
    (0..6).filter(|side| places.contains(&GaugePlace::Side(*side))).collect()
}

/// The load that a gauge shows; none where it shows a point.
pub fn of_gauge(scene: &Scene, place: GaugePlace) -> Option<usize> {
    let [bodies, obstacles, _] = count(scene);
    match place {
        GaugePlace::Body(body) => Some(body),
        GaugePlace::Obstacle(obstacle) => Some(bodies + obstacle),
        GaugePlace::Side(side) => Some(bodies + obstacles + sides(scene).iter().position(|own| *own == side)?),
        GaugePlace::Point(..) => None,
    }
}

/// vec4 entries of the history ring of so many loads.
pub fn history_length(count: [usize; 3]) -> usize {
    HISTORY as usize * LOAD_WIDTH * count.iter().sum::<usize>()
}

/// Words of the sums and owners.
pub fn length(scene: &Scene, slots: usize) -> usize {
    let loads: usize = count(scene).iter().sum();
    if loads == 0 { 0 } else { 2 * LOAD_NUMBERS as usize * loads + slots }
}

/// What the kernels are told of them.
pub(super) fn overrides(scene: &Scene, start: &[Conserved], openings: &Openings) -> [(&'static str, f64); 2] {
    [("LOADS", count(scene).iter().sum::<usize>() as f64), ("LOAD_UNIT", unit(scene, start, openings))]
}

/// The unit of their sums: the largest pressure of the gas of the start `[density, momentum, energy]` and of the sides \[Pa\].
fn unit(scene: &Scene, start: &[Conserved], openings: &Openings) -> f64 {
    let gases = scene.gas.equation_of_state();
    let inside = start.iter().map(|state| gases.pressure(*state, 0.0));
    let beyond = openings.table.iter().map(|rule| f64::from(rule.pressure));
    let all = inside.chain(beyond).filter(|pressure| pressure.is_finite());
    all.fold(scene.gas.ambient.pressure, f64::max)
}

/// Sums of nothing, and for each slot the load of the obstacle or side that has it, one more, in its upper half.
pub(super) fn start(scene: &Scene, grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    let [bodies, obstacles, _] = count(scene);
    let mut words = vec![0; length(scene, grid.slots())];
    let owners = words.len().saturating_sub(grid.slots());
    for (index, side) in sides(scene).into_iter().enumerate() {
        for slot in slots_beyond(grid, side) {
            words[owners + slot] = ((bodies + obstacles + index + 1) as u32) << 16;
        }
    }
    if obstacles == 0 {
        return words;
    }
    let nearest = |cell: [u32; 3]| {
        let center = scene.domain.cell_center(cell);
        let distance = |k: &usize| scene.distance_to_obstacle(*k, center);
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

/// Slots of the ring that share a face with the cells of a side.
fn slots_beyond(grid: &Grid, side: usize) -> impl Iterator<Item = usize> + '_ {
    let axis = side / 2;
    let beyond = if side.is_multiple_of(2) { -1 } else { grid.cells[axis] as i32 };
    let mut count = grid.cells.map(|n| n as i32);
    count[axis] = 1;
    let cell = move |x: i32, y: i32, z: i32| {
        let mut cell = [x, y, z];
        cell[axis] = beyond;
        grid.slot(cell)
    };
    let [nx, ny, nz] = count;
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| cell(x, y, z))))
}
