//! Where gas and solid meet, and the unknowns of the pressure system.

use super::constants::COLUMN_BLOCK;
use super::params::{MARCH, Params};
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
    /// Places of vertices and lists of slots, part by part ([`super::arrays`]); then `Places`, and behind them the table of cut cells.
    pub extra: Buffer<u32>,
}

/// Parts of [`Interface::extra`] behind the lists, in words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    /// Rows of the blocks of columns of marching kernels.
    pub still: u64,
    /// Behind them.
    pub end: u64,
}

impl Places {
    /// For cells with the ring, on any device: for the shortest marches.
    pub(super) fn new(stride: [u64; 3], dimension: u32) -> Self {
        let slots: u64 = stride.iter().product();
        let rows = stride[dimension as usize - 1];
        let across = (slots / rows).div_ceil(u64::from(COLUMN_BLOCK));
        let still = 2 * slots + 2;
        Self { still, end: still + across * rows.div_ceil(u64::from(MARCH)) }
    }
}

impl Interface {
    /// Allocates; without solids only what the gas needs. `table`: words of the table of cut cells.
    ///
    /// # Errors
    /// If the device has no room.
    pub(super) fn new(gpu: &Gpu, params: &Params, dimension: u32, solids: bool, table: usize) -> Result<Self> {
        let places = Places::new(params.stride.map(u64::from), dimension);
        let slots = params.slots as usize;
        let solid_slots = if solids { slots } else { 1 };
        Ok(Self {
            cells: Buffer::new(gpu, "cells", slots)?,
            fill: Buffer::new(gpu, "fill", slots)?,
            ghost: Buffer::new(gpu, "ghost", solid_slots)?,
            extra: Buffer::new(gpu, "extra", places.end as usize + table)?,
        })
    }
}
