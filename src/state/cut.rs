//! The table of cut cells, as shaders read it, and the gas that they hold at the start.

use super::{Grid, Params, constants};
use crate::gpu::{Buffer, Gpu};
use crate::scene::{Conserved, CutCell, CutGeometry, Scene};

/// Words of one entry; the positions are those of [`FIELDS`].
pub const WIDTH: usize = 36;

/// Of a slot's number: an obstacle lies in the block of three cells each way around it. Set where there are bodies.
pub const NEAR: u32 = 1 << 31;

/// What an entry holds and where. SHARE: gas in the cell; CLUSTER_SHARE: in all cells that share its state; FIRST: slot of the first
/// of these; NEXT: slot of the next one; CENTER: means of x, y, z over the gas, in cells from the centre; MIXED: of yz, zx, xy;
/// APERTURE: open share of the faces x-, x+, y-, ...; MIDDLE: their centroids, and across each face the mean product of the two
/// coordinates along it; SLOT: its own; WHOLE: 1 if it is gas where a body makes it whole.
pub const FIELDS: [(&str, u32); 10] = [
    ("SHARE", 0),
    ("CLUSTER_SHARE", 1),
    ("FIRST", 2),
    ("NEXT", 3),
    ("CENTER", 4),
    ("MIXED", 7),
    ("APERTURE", 10),
    ("MIDDLE", 16),
    ("SLOT", 34),
    ("WHOLE", 35),
];

fn slots(grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    geometry.cells.iter().map(|cut| grid.slot(cut.cell.map(|c| c as i32)) as u32).collect()
}

/// For every slot the number of its entry, counted from 1; 0 for plain cells.
fn entries(grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    let mut entries = vec![0; grid.slots()];
    for (place, slot) in slots(grid, geometry).into_iter().enumerate() {
        entries[slot as usize] = place as u32 + 1;
    }
    entries
}

/// What `extra` holds of cut cells: without bodies the numbers of the slots in the first block and the table behind the lists; with bodies,
/// for which the first block has another use, behind the lists the number of cut cells, those of the slots, and the table.
#[derive(Debug)]
pub struct CutWords {
    first_block: Vec<u32>,
    behind_at: u32,
    behind: Vec<u32>,
    table_at: u32,
}

/// The words of cut cells; `end`: place behind the lists.
pub fn words(grid: &Grid, geometry: &CutGeometry, bodies: bool, end: u32) -> CutWords {
    let none = CutWords { first_block: Vec::new(), behind_at: end, behind: Vec::new(), table_at: end };
    let table = table(grid, geometry);
    match (table.is_empty(), bodies) {
        (true, _) => none,
        (_, false) => CutWords { first_block: entries(grid, geometry), behind: table, ..none },
        (_, true) => {
            let mut behind = vec![geometry.cells.len() as u32];
            behind.extend(marked_entries(grid, geometry));
            let table_at = end + behind.len() as u32;
            behind.extend(table);
            CutWords { behind, table_at, ..none }
        }
    }
}

impl CutWords {
    /// Words behind the lists.
    pub fn length(&self) -> usize {
        self.behind.len()
    }

    /// Parameters that know the place of the table.
    pub fn placed(&self, params: Params) -> Params {
        Params { table_at: self.table_at, ..params }
    }

    /// Writes all of them.
    pub fn write(&self, gpu: &Gpu, extra: &Buffer<u32>) {
        for (at, words) in [(0, &self.first_block), (self.behind_at, &self.behind)] {
            if !words.is_empty() {
                extra.write(gpu, at as usize, words);
            }
        }
    }
}

/// The numbers of all slots, with [`NEAR`] at each that has an obstacle around it; beyond a side, around the cell before it.
fn marked_entries(grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
    let mut entries = entries(grid, geometry);
    let cells = grid.cells.map(|n| n as i32);
    let place = |cell: [i32; 3]| (cell[0] + cells[0] * (cell[1] + cells[1] * cell[2])) as usize;
    let mut obstacle = geometry.walls.clone();
    for cut in &geometry.cells {
        obstacle[place(cut.cell.map(|c| c as i32))] = true;
    }
    let ring = grid.padding().map(|n| n as i32);
    let around = |at: i32, axis: usize| (at - ring[axis]).max(0)..(at + ring[axis] + 1).min(cells[axis]);
    for z in -ring[2]..cells[2] + ring[2] {
        for y in -ring[1]..cells[1] + ring[1] {
            for x in -ring[0]..cells[0] + ring[0] {
                let [nx, ny, nz] = std::array::from_fn(|d| [x, y, z][d].clamp(0, cells[d] - 1));
                let mut near =
                    around(nz, 2).flat_map(|k| around(ny, 1).flat_map(move |j| around(nx, 0).map(move |i| [i, j, k])));
                if near.any(|cell| obstacle[place(cell)]) {
                    entries[grid.slot([x, y, z])] |= NEAR;
                }
            }
        }
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

/// The cut cells that are left by the words of all slots: in a scene with bodies some are whole.
pub fn left(grid: &Grid, geometry: CutGeometry, words: &[u32], bodies: bool) -> CutGeometry {
    if !bodies {
        return geometry;
    }
    let slots = slots(grid, &geometry);
    let mut left = CutGeometry { walls: geometry.walls, ..CutGeometry::default() };
    for cluster in geometry.clusters.iter().filter(|cluster| is_cut(words[slots[cluster[0]] as usize])) {
        let first = left.cells.len();
        for &place in cluster {
            left.cells.push(CutCell { cluster: left.clusters.len(), ..geometry.cells[place] });
        }
        left.clusters.push((first..left.cells.len()).collect());
    }
    left
}

/// Whether a word is that of a cut cell, in a scene with bodies.
fn is_cut(word: u32) -> bool {
    word & constants::CUT_MARK == constants::CUT_MARK && word & 3 == constants::GAS
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
fn table(grid: &Grid, geometry: &CutGeometry) -> Vec<u32> {
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
        table.extend([slots[place], u32::from(geometry.whole_gas(place))]);
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
