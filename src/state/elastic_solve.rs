//! What the implicit elastic step needs on the device.

use std::ops::Range;

use crate::error::Result;
use crate::gpu::{Buffer, Gpu};
use crate::numerics::PcgVectors;
use crate::scene::{Body, Elasticity, Scene};
use crate::state::ParticleStart;

/// Buffers of the stage `elastic_solve`.
#[derive(Debug)]
pub struct ElasticBuffers {
    /// Vectors of its linear systems: a vec4 per slot, w unused.
    pub vectors: PcgVectors,
    /// Change of the stress of each particle times its volume at rest \[J\], as in `stress`; w: Lame constants times that volume.
    pub change: Buffer<[f32; 4]>,
    /// First particle and end of the portions of each body, as many for each; empty for bodies with a held or driven part.
    pub portions: Buffer<[u32; 2]>,
    /// Momentum that is missing and mass of each portion \[kg m/s, kg\], then for each body the velocity that makes up for it \[m/s\].
    pub missing: Buffer<[f32; 4]>,
}

/// Portions of a body whose sums groups of threads form at a time.
pub(crate) const PORTIONS: usize = 32;

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
    pub fn new(gpu: &Gpu, scene: &Scene, slots: usize, start: &ParticleStart) -> Result<Option<Self>> {
        if !wanted(scene, start.len()) {
            return Ok(None);
        }
        let portions: Vec<_> = scene.bodies.iter().zip(start.ranges(scene.bodies.len())).flat_map(portions).collect();
        Ok(Some(Self {
            vectors: PcgVectors::new(gpu, WIDTH * slots)?,
            change: Buffer::new(gpu, "stress change", 2 * start.len())?,
            missing: Buffer::new(gpu, "missing", portions.len() + scene.bodies.len())?,
            portions: Buffer::from_slice(gpu, "portions", &portions)?,
        }))
    }
}

/// Portions of the particles of a body that moves freely.
fn portions((body, range): (&Body, Range<u32>)) -> [[u32; 2]; PORTIONS] {
    let free = body.clamped.is_none() && body.motion.is_none();
    let count = if free { range.len() } else { 0 };
    std::array::from_fn(|k| [k, k + 1].map(|edge| range.start + (edge * count / PORTIONS) as u32))
}
