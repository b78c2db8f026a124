//! Where gas and solid meet, and the unknowns of the pressure system.

use super::constants::STILL_BLOCK;
use super::params::MARCH;
use crate::error::Result;
use crate::gpu::{Buffer, Gpu};

/// Marks of cells and vertices, in padded slots.
#[derive(Debug)]
pub struct Interface {
    /// Word of each slot: kind, previous kind, flags, blocked fraction.
    pub cells: Buffer<u32>,
    /// Solid volume and mean compliance of each cell.
    pub fill: Buffer<[f32; 2]>,
    /// Vertex ghost pressure before the solve; its change after.
    pub ghost: Buffer<f32>,
    /// Place of a vertex in the list of those that carry P, h and Q apart; then the list of slots that are not deep inside the
    /// gas and, from the end, that of the frontier around them; then the lengths of both. Without solids the first part
    /// holds the places of cut cells, and their table stands at the end.
    pub extra: Buffer<u32>,
    /// Blocks of columns of marching kernels in which nothing moves until the solve.
    pub still: Buffer<u32>,
}

/// Blocks of columns of marching kernels, of at least [`MARCH`] slots along the last axis.
pub(super) fn still_blocks(cells: &[u64; 3], dimension: u32) -> u64 {
    let rows = cells[dimension as usize - 1];
    let columns = cells.iter().product::<u64>() / rows * rows.div_ceil(u64::from(MARCH));
    columns.div_ceil(u64::from(STILL_BLOCK))
}

impl Interface {
    /// Allocates for a number of slots; without solids only what the gas needs. `table`: words of the table of
    /// cut cells; `blocks`: of columns of marching kernels.
    ///
    /// # Errors
    /// If the device has no room.
    pub fn new(gpu: &Gpu, slots: usize, solids: bool, table: usize, blocks: usize) -> Result<Self> {
        let solid_slots = if solids { slots } else { 1 };
        Ok(Self {
            cells: Buffer::new(gpu, "cells", slots)?,
            fill: Buffer::new(gpu, "fill", slots)?,
            ghost: Buffer::new(gpu, "ghost", solid_slots)?,
            extra: Buffer::new(gpu, "extra", 2 * slots + 2 + table)?,
            still: Buffer::new(gpu, "still", blocks)?,
        })
    }
}
