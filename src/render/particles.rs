//! The particles: what their colours mean, and their colours and radii. Nothing here has the picture's size.

use super::buffers::{ParticleSources, Sources};
use super::gas::{Gas, RANGE_GROUPS, bounds};
use super::kernels::bind;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass, readback};

/// Kernels and buffers of the particles' colours.
#[derive(Debug)]
pub(super) struct Particles {
    pub(super) count: u64,
    /// Place and radius of each, radius 0 for what is not drawn; then its colour.
    pub(super) balls: Buffer<[[f32; 4]; 2]>,
    /// Deformation gradients: three rows per particle.
    pub(super) deformation: wgpu::Buffer,
    ranges: Buffer<[f32; 2]>,
    measure: Bound,
    find_range: Bound,
    mix_paint: Bound,
}

impl Particles {
    pub(super) fn new(gpu: &Gpu, sources: &Sources, gas: &Gas) -> Result<Option<Self>> {
        sources.particles.as_ref().map(|own| Self::of(gpu, own, gas)).transpose()
    }

    fn of(gpu: &Gpu, own: &ParticleSources, gas: &Gas) -> Result<Self> {
        let count = own.count as usize;
        let quantity: Buffer<f32> = Buffer::new(gpu, "particle quantity", count)?;
        let balls: Buffer<[[f32; 4]; 2]> = Buffer::new(gpu, "balls", count)?;
        let ranges: Buffer<[f32; 2]> = Buffer::new(gpu, "particle ranges", RANGE_GROUPS as usize)?;
        let shared = [("view", gas.view.raw()), ("quantity", quantity.raw())];
        let state = [("velocity", &own.velocity), ("affine", &own.affine), ("deformation", &own.deformation)];
        let around = [("position", &own.position), ("stress", &own.stress), ("heat", gas.heat.raw())];
        let mixed = [around[0], ("colors", gas.colors.raw()), ("balls", balls.raw())];
        let bind = |entry: &str, buffers: &[(&str, &wgpu::Buffer)]| bind(gpu, "points.wgsl", entry, buffers);
        Ok(Self {
            measure: bind("measure", &[&shared[..], &state, &around].concat())?,
            find_range: bind("find_particle_range", &[&shared[..], &[("ranges", ranges.raw())]].concat())?,
            mix_paint: bind("mix_paint", &[&shared[..], &state, &mixed].concat())?,
            count: own.count.into(),
            balls,
            deformation: own.deformation.clone(),
            ranges,
        })
    }

    /// Records what the colours mean and its range; the field's heat must be there.
    pub(super) fn record_quantity(&self, pass: &mut Pass) {
        pass.dispatch(&self.measure, &Extent::Threads(self.count));
        pass.dispatch(&self.find_range, &Extent::Groups([RANGE_GROUPS, 1, 1]));
    }

    /// Least and largest value of the quantity recorded last.
    pub(super) fn range(&self, gpu: &Gpu) -> Result<[f64; 2]> {
        Ok(bounds(&readback::read(gpu, &self.ranges)?))
    }

    /// Records the colours.
    pub(super) fn record_paint(&self, pass: &mut Pass) {
        pass.dispatch(&self.mix_paint, &Extent::Threads(self.count));
    }
}
