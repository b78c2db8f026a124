//! The velocities that the arrows of a 2D picture show.

use super::buffers::Sources;
use super::gas::Gas;
use super::kernels::bind;
use crate::Result;
use crate::gpu::{Buffer, Extent, Gpu, Pass, readback};

/// Velocity and whether there is gas, at the places that the view uploaded last asks for; rows from below.
pub(super) fn sample(gpu: &Gpu, sources: &Sources, gas: &Gas, count: [u32; 2]) -> Result<Vec<[f32; 4]>> {
    let total = count[0] as usize * count[1] as usize;
    if total == 0 {
        return Ok(Vec::new());
    }
    let arrows: Buffer<[f32; 4]> = Buffer::new(gpu, "arrows", total)?;
    let state = [("conserved", &sources.conserved), ("cells", &sources.cells)];
    let own = [("view", gas.view.raw()), ("arrows", arrows.raw())];
    let kernel = bind(gpu, "picture/arrows.wgsl", "sample_arrows", &[&state[..], &own].concat())?;
    let mut pass = Pass::new(gpu, "arrows");
    pass.dispatch(&kernel, &Extent::Threads(total as u64));
    pass.submit()?;
    readback::read(gpu, &arrows)
}
