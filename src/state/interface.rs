//! Where gas and solid meet, and the unknowns of the pressure system.

use super::constants::{PARTIALS, STILL_BLOCK};
use super::params::{MARCH, Params, STILL_ASLEEP};
use crate::error::Result;
use crate::gpu::{Buffer, Gpu, OCTET, WORKGROUP};

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
    /// Rows of blocks of columns of marching kernels in which something moves, now and in the step before; then scratch of as many words.
    /// Where nothing sleeps another buffer serves.
    pub busy: Buffer<u32>,
    /// Runs of the whole grid, awake or not.
    pub runs: usize,
}

/// Parts of [`Interface::extra`] behind the lists, in words (`shaders/shared/runs.wgsl` and `still.wgsl`).
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    /// Runs of slots that are awake.
    pub runs: u64,
    /// Runs of the list of slots that are not deep inside the gas.
    pub list_runs: u64,
    /// Rows of the blocks of columns of marching kernels.
    pub still: u64,
    /// Behind both.
    pub end: u64,
    /// Runs of the whole grid.
    pub all: u64,
    /// Words of [`Interface::busy`].
    pub busy: u64,
}

impl Places {
    /// For cells with the ring, on any device: for as many groups that leave partial results as there may be, and the shortest marches.
    /// Where nothing sleeps there are no lists of runs.
    pub(super) fn new(stride: [u64; 3], dimension: u32, sleeps: bool) -> Self {
        let (block, lanes) = (u64::from(STILL_BLOCK), u64::from(OCTET));
        let slots: u64 = stride.iter().product();
        let groups = slots.div_ceil(u64::from(WORKGROUP)).clamp(1, u64::from(PARTIALS));
        let rows = stride[dimension as usize - 1];
        let across = (slots / rows).div_ceil(block);
        let all = if dimension == 1 { slots.div_ceil(lanes) } else { rows * across };
        let (octets, kept) = (lanes * groups + 1, u64::from(sleeps));
        let runs = 2 * slots + 2;
        let list_runs = runs + kept * (octets + 2 * all);
        let still = list_runs + kept * (octets + slots.div_ceil(lanes));
        let busy = if sleeps { 2 * across * rows.div_ceil(u64::from(MARCH)) } else { 0 };
        Self { runs, list_runs, still, end: still + across * rows.div_ceil(u64::from(MARCH)), all, busy }
    }
}

impl Interface {
    /// Allocates; without solids only what the gas needs. `table`: words of the table of cut cells.
    ///
    /// # Errors
    /// If the device has no room.
    pub(super) fn new(gpu: &Gpu, params: &Params, dimension: u32, solids: bool, table: usize) -> Result<Self> {
        let places = Places::new(params.stride.map(u64::from), dimension, params.still == STILL_ASLEEP);
        let slots = params.slots as usize;
        let solid_slots = if solids { slots } else { 1 };
        let busy = Buffer::new(gpu, "busy", places.busy as usize)?;
        busy.write(gpu, 0, &vec![u32::MAX; places.busy as usize]); // all, before the first step
        Ok(Self {
            cells: Buffer::new(gpu, "cells", slots)?,
            fill: Buffer::new(gpu, "fill", slots)?,
            ghost: Buffer::new(gpu, "ghost", solid_slots)?,
            extra: Buffer::new(gpu, "extra", places.end as usize + table)?,
            busy,
            runs: places.all as usize,
        })
    }
}
