//! The table of cut cells, as shaders read it, and the gas that they hold at the start.

use super::Grid;
use crate::scene::{Conserved, CutGeometry, Scene};

/// Words of one entry; the positions are those of [`FIELDS`].
pub const WIDTH: usize = 34;

/// What an entry holds and where. SHARE: gas in the cell; CLUSTER_SHARE: in all cells that share its state; FIRST: slot of the first
/// of these; NEXT: slot of the next one; CENTER: means of x, y, z over the gas, in cells from the centre; MIXED: of yz, zx, xy;
/// APERTURE: open share of the faces x-, x+, y-, ...; MIDDLE: their centroids, and across each face the mean product of the two
/// coordinates along it.
pub const FIELDS: [(&str, u32); 8] = [
    ("SHARE", 0),
    ("CLUSTER_SHARE", 1),
    ("FIRST", 2),
    ("NEXT", 3),
    ("CENTER", 4),
    ("MIXED", 7),
    ("APERTURE", 10),
    ("MIDDLE", 16),
];

fn slots(grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    geometry.cells.iter().map(|cut| grid.slot(cut.cell.map(|c| c as i32)) as u32).collect()
}

/// For every slot the number of its entry, counted from 1; 0 for plain cells.
pub fn entries(grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    let mut entries = vec![0; grid.slots()];
    for (place, slot) in slots(grid, geometry).into_iter().enumerate() {
        entries[slot as usize] = place as u32 + 1;
    }
    entries
}

/// The gas that fits into each slot, in cells: less than one where an obstacle cuts it.
pub fn gas_shares(grid: &Grid, geometry: &CutGeometry) -> Vec<f64> {
    let mut shares = vec![1.0; grid.slots()];
    for (cut, slot) in geometry.cells.iter().zip(slots(grid, geometry)) {
        shares[slot as usize] = cut.part.volume;
    }
    shares
}

/// Momentum of the gas of the start `[density, momentum, energy]` \[kg m s^-1\].
pub fn momentum(scene: &Scene, geometry: &CutGeometry, gas: &[Conserved]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let cells = gas.iter().zip(&geometry.walls).filter(|(_, wall)| !**wall);
    for (gas, _) in cells {
        for (sum, part) in sum.iter_mut().zip(&gas[1..4]) {
            *sum += part;
        }
    }
    let [nx, ny, _] = scene.domain.cells.map(|n| n as usize);
    for cut in &geometry.cells {
        let [x, y, z] = cut.cell.map(|k| k as usize);
        for (sum, part) in sum.iter_mut().zip(&gas[x + nx * (y + ny * z)][1..4]) {
            *sum -= (1.0 - cut.part.volume) * part;
        }
    }
    sum.map(|sum| sum * scene.domain.cell_volume())
}

/// The entries, one after the other.
pub fn table(grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    let slots = slots(grid, geometry);
    let mut table = Vec::with_capacity(WIDTH * slots.len());
    for (place, cut) in geometry.cells.iter().enumerate() {
        let cluster = &geometry.clusters[cut.cluster];
        let together: f64 = cluster.iter().map(|&member| geometry.cells[member].part.volume).sum();
        let next = cluster.iter().position(|&member| member == place).and_then(|at| cluster.get(at + 1));
        let word = |value: f64| (value as f32).to_bits();
        table.extend([word(cut.part.volume), word(together)]);
        table.extend([slots[cluster[0]], next.map_or(u32::MAX, |&member| slots[member])]);
        table.extend(cut.part.center.map(word));
        table.extend(cut.part.mixed.map(word));
        table.extend(cut.part.apertures.map(word));
        table.extend(cut.part.middles.iter().flatten().map(|&value| word(value)));
    }
    table
}

/// The gas at the start; what shares one state gets the mean.
pub fn initial_gas(scene: &Scene, geometry: &CutGeometry) -> Vec<Conserved> {
    let mut gas = scene.initial_gas();
    let [nx, ny, _] = scene.domain.cells.map(|n| n as usize);
    let index = |cell: [u32; 3]| cell[0] as usize + nx * (cell[1] as usize + ny * cell[2] as usize);
    for cluster in &geometry.clusters {
        let (mut sum, mut volume) = ([0.0; 7], 0.0);
        for &member in cluster {
            let cut = &geometry.cells[member];
            let state = scene.initial_gas_beside_obstacles(cut.cell);
            sum = std::array::from_fn(|k| sum[k] + cut.part.volume * state[k]);
            volume += cut.part.volume;
        }
        for &member in cluster {
            gas[index(geometry.cells[member].cell)] = sum.map(|total| total / volume);
        }
    }
    gas
}
