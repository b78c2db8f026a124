//! The particles: what their colours mean, and their colours and radii. Nothing here has the picture's size.

use glam::{Vec3, Vec4};

use super::buffers::{ParticleSources, Sources};
use super::colormap::linear_from_srgb;
use super::gas::{Gas, RANGE_GROUPS, bounds};
use super::kernels::{bind, bind_numbers};
use super::palette;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass, readback};
use crate::scene::Scene;

/// Kernels and buffers of the particles' colours.
#[derive(Debug)]
pub(super) struct Particles {
    pub(super) count: u64,
    /// Place and radius of each, radius 0 for what is not drawn; then its colour, and how far it is stretched.
    pub(super) balls: Buffer<[[f32; 4]; 2]>,
    /// Deformation gradients: three rows per particle.
    pub(super) deformation: wgpu::Buffer,
    /// Colours of bodies, then of materials; the fourth number is 0 for bodies that are not drawn.
    names: Buffer<Vec4>,
    ranges: Buffer<[f32; 2]>,
    measure: Bound,
    find_range: Bound,
    mix_paint: Bound,
}

impl Particles {
    pub(super) fn new(gpu: &Gpu, scene: &Scene, sources: &Sources, gas: &Gas) -> Result<Option<Self>> {
        sources.particles.as_ref().map(|own| Self::of(gpu, scene, own, gas)).transpose()
    }

    fn of(gpu: &Gpu, scene: &Scene, own: &ParticleSources, gas: &Gas) -> Result<Self> {
        let bodies = [("BODIES", palette::of_bodies(scene).len() as f64)];
        let of_names = Buffer::from_slice(gpu, "colours of bodies and materials", &colors_of_names(scene, &[]))?;
        let count = own.count as usize;
        let quantity: Buffer<f32> = Buffer::new(gpu, "particle quantity", count)?;
        let balls: Buffer<[[f32; 4]; 2]> = Buffer::new(gpu, "balls", count)?;
        let ranges: Buffer<[f32; 2]> = Buffer::new(gpu, "particle ranges", RANGE_GROUPS as usize)?;
        let shared = [("view", gas.view.raw()), ("quantity", quantity.raw())];
        let state = [("velocity", &own.velocity), ("affine", &own.affine), ("deformation", &own.deformation)];
        let around = [("position", &own.position), ("stress", &own.stress), ("heat", gas.heat.raw())];
        let tables = [("colors", gas.colors.raw()), ("names", of_names.raw())];
        let mixed = [around[0], tables[0], tables[1], ("balls", balls.raw())];
        let bind = |entry: &str, buffers: &[(&str, &wgpu::Buffer)]| bind(gpu, "picture/points.wgsl", entry, buffers);
        Ok(Self {
            measure: bind("measure", &[&shared[..], &state, &around].concat())?,
            find_range: bind("find_particle_range", &[&shared[..], &[("ranges", ranges.raw())]].concat())?,
            mix_paint: bind_numbers(
                gpu,
                "picture/points.wgsl",
                "mix_paint",
                &bodies,
                &[&shared[..], &state, &mixed].concat(),
            )?,
            count: own.count.into(),
            names: of_names,
            balls,
            deformation: own.deformation.clone(),
            ranges,
        })
    }

    /// Colours that bodies have now, and which of them are not drawn.
    pub(super) fn repaint(&self, gpu: &Gpu, scene: &Scene, hidden: &[usize]) {
        self.names.write(gpu, 0, &colors_of_names(scene, hidden));
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

/// Linear colours of bodies, then of materials.
fn colors_of_names(scene: &Scene, hidden: &[usize]) -> Vec<Vec4> {
    let linear = |color: [u8; 3]| Vec3::from(color.map(|channel| linear_from_srgb(f32::from(channel) / 255.0)));
    let shown = |body: usize| if hidden.contains(&body) { 0.0 } else { 1.0 };
    let bodies = palette::of_bodies(scene).into_iter().enumerate();
    let bodies = bodies.map(|(body, color)| linear(color).extend(shown(body)));
    bodies.chain(palette::of_materials(scene).into_iter().map(|color| linear(color).extend(1.0))).collect()
}
