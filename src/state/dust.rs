//! Dust on the ground at the start.

use super::{Grid, arrays};
use crate::error::Result;
use crate::gpu::{Buffer, Gpu};
use crate::scene::{CutGeometry, Scene};

/// Part of `dust` that holds what still lies on the ground.
const LOOSE_DUST: usize = 1;

/// The array, with all dust on the ground; empty in scenes without any.
pub(super) fn new(gpu: &Gpu, scene: &Scene, grid: &Grid, geometry: &CutGeometry) -> Result<Buffer<f32>> {
    let slots = grid.slots();
    let dust = Buffer::new(gpu, "dust", arrays::parts("dust", scene) * slots)?;
    if !dust.is_empty() {
        let mut loose = vec![0.0; slots];
        let lies = scene.loose_dust(geometry);
        for (index, slot) in grid.unpadded_by(|slot| slot).into_iter().enumerate() {
            loose[slot] = lies[index] as f32;
        }
        dust.write(gpu, LOOSE_DUST * slots, &loose);
    }
    Ok(dust)
}
