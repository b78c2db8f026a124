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
    /// Low corner of cell (0, 0, 0) \[m\].
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
            origin: domain.origin.map(|v| v as f32),
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

    /// Centre of a cell \[m\].
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
