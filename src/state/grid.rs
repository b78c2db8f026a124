//! The grid: cells per axis, spacing, origin; and the padded index space every buffer shares.

use rayon::prelude::*;

use crate::scene::Domain;

/// Cells that one thread takes at least.
const LEAST: usize = 1 << 12;

/// A uniform grid of cubic cells with 1, 2 or 3 active axes (x, then y, then z).
///
/// Buffers hold one ring of cells around the active axes. Inactive axes have one cell and no ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Active axes, 1 to 3.
    pub dimension: u32,
    /// Cells per axis without the ring; 1 on inactive axes.
    pub cells: [u32; 3],
    /// Zero of the device's coordinates in those of the scene \[m\], see [`Domain::frame`].
    pub frame: [f64; 3],
    /// Low corner of cell (0, 0, 0) in the device's coordinates \[m\].
    pub origin: [f32; 3],
    /// Edge of a cell \[m\].
    pub spacing: f32,
}

impl Grid {
    /// The grid of a scene's domain.
    pub fn of(domain: &Domain) -> Self {
        Self {
            dimension: domain.dimension,
            cells: domain.cells,
            frame: domain.frame(),
            origin: domain.in_frame(domain.origin),
            spacing: domain.spacing() as f32,
        }
    }

    /// Cells of the ring on each side: 1 on active axes, 0 elsewhere.
    pub fn padding(&self) -> [u32; 3] {
        std::array::from_fn(|axis| u32::from((axis as u32) < self.dimension))
    }

    /// Stored cells per axis, ring included.
    pub fn strides(&self) -> [u32; 3] {
        let padding = self.padding();
        std::array::from_fn(|axis| self.cells[axis] + 2 * padding[axis])
    }

    /// Length of every array over cells, nodes or vertices.
    pub fn slots(&self) -> usize {
        self.strides().iter().map(|&n| n as usize).product()
    }

    /// Position of cell `cell` in such an array; -1 and `cells[d]` name the ring on active axes.
    pub fn slot(&self, cell: [i32; 3]) -> usize {
        let (stride, padding) = (self.strides(), self.padding());
        let at = |axis: usize| (cell[axis] + padding[axis] as i32) as usize;
        at(0) + stride[0] as usize * (at(1) + stride[1] as usize * at(2))
    }

    /// The cell of a slot.
    pub fn cell(&self, slot: u32) -> [i32; 3] {
        let (stride, padding) = (self.strides(), self.padding());
        let at = [slot % stride[0], slot / stride[0] % stride[1], slot / (stride[0] * stride[1])];
        std::array::from_fn(|axis| at[axis] as i32 - padding[axis] as i32)
    }

    /// Cells without the ring.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().map(|&n| n as usize).product()
    }

    /// A point of the device's coordinates in those of the scene \[m\].
    pub fn in_scene(&self, point: [f32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.frame[axis] + f64::from(point[axis]))
    }

    /// Low corner of the domain in the coordinates of the scene \[m\].
    pub fn low(&self) -> [f64; 3] {
        self.in_scene(self.origin)
    }

    /// Whether the device's coordinates are not those of the scene.
    pub fn is_far(&self) -> bool {
        self.frame != [0.0; 3]
    }

    /// Centre of a cell in the device's coordinates \[m\].
    pub fn centre(&self, cell: [i32; 3]) -> [f32; 3] {
        std::array::from_fn(|axis| self.origin[axis] + (cell[axis] as f32 + 0.5) * self.spacing)
    }

    /// Edge lengths of the domain \[m\].
    pub fn extent(&self) -> [f32; 3] {
        std::array::from_fn(|axis| self.cells[axis] as f32 * self.spacing)
    }

    /// The unpadded part of a padded array, x fastest.
    pub fn unpadded<T: Copy + Default + Send + Sync>(&self, padded: &[T]) -> Vec<T> {
        self.unpadded_by(|slot| padded[slot])
    }

    /// What `value` makes of the slot of each cell, x fastest.
    pub(crate) fn unpadded_by<T: Copy + Default + Send>(&self, value: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
        let [wide, high, _] = self.cells.map(|n| n as usize);
        let mut all = vec![T::default(); self.cell_count()];
        let rows = all.par_chunks_mut(wide.max(1)).enumerate().with_min_len(LEAST.div_ceil(wide.max(1)));
        rows.for_each(|(row, cells)| {
            let first = self.slot([0, (row % high) as i32, (row / high) as i32]);
            cells.iter_mut().zip(first..).for_each(|(cell, slot)| *cell = value(slot));
        });
        all
    }
}
