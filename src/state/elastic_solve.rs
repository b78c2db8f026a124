//! What the implicit elastic step needs on the device.

use crate::error::Result;
use crate::gpu::{Buffer, Gpu};
use crate::numerics::PcgVectors;
use crate::scene::{Elasticity, Scene};

/// Buffers of the stage `elastic_solve`.
#[derive(Debug)]
pub struct ElasticBuffers {
    /// Vectors of its linear systems: a vec4 per slot, w unused.
    pub vectors: PcgVectors,
    /// Change of the stress of each particle times its volume at rest \[J\], as in `stress`; w: Lame constants times that volume.
    pub change: Buffer<[f32; 4]>,
}

/// Entries of a vector per slot.
pub(crate) const WIDTH: usize = 4;

/// Whether a scene with so many particles has the stage.
pub(crate) fn wanted(scene: &Scene, particles: usize) -> bool {
    scene.numerics.elasticity == Elasticity::Implicit && particles > 0
}

impl ElasticBuffers {
    /// Allocates, if the scene wants it.
    ///
    /// # Errors
    /// If the device has no room.
    pub fn new(gpu: &Gpu, scene: &Scene, slots: usize, particles: usize) -> Result<Option<Self>> {
        if !wanted(scene, particles) {
            return Ok(None);
        }
        let vectors = PcgVectors::new(gpu, WIDTH * slots)?;
        Ok(Some(Self { vectors, change: Buffer::new(gpu, "stress change", 2 * particles)? }))
    }
}
