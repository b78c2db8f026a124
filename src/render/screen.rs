//! The kernels that write pixels, and everything that has the size of the picture.

use glam::{Vec3, Vec4};

use super::buffers::{ParticleSources, Sources};
use super::colormap::{TABLE_LENGTH, linear_from_srgb};
use super::gas::Gas;
use super::kernels::{SAMPLES, bind};
use super::view::View;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass, readback};

/// Everything bound for one size of picture.
#[derive(Debug)]
pub(super) struct Screen {
    pub(super) size: [u32; 2],
    colors: Buffer<Vec4>,
    edges: Buffer<[Vec4; 2]>,
    surface: Buffer<[u32; 4]>,
    pixels: Buffer<u32>,
    points: Option<Points>,
    draw: Bound,
}

/// The kernels that draw particles, in order.
#[derive(Debug)]
struct Points {
    count: u64,
    clear_samples: Bound,
    splat_depth: Bound,
    splat_nearest: Bound,
    shade_surface: Bound,
}

impl Screen {
    pub(super) fn new(gpu: &Gpu, sources: &Sources, gas: &Gas, size: [u32; 2]) -> Result<Self> {
        let pixel_count = size[0] as usize * size[1] as usize;
        let colors: Buffer<Vec4> = Buffer::new(gpu, "colour table", TABLE_LENGTH)?;
        let edges: Buffer<[Vec4; 2]> = Buffer::new(gpu, "edges", 12)?;
        let surface: Buffer<[u32; 4]> = Buffer::new(gpu, "surface", pixel_count)?;
        let pixels: Buffer<u32> = Buffer::new(gpu, "pixels", pixel_count)?;
        let points = sources
            .particles
            .as_ref()
            .map(|particles| Points::new(gpu, particles, gas, &surface, pixel_count))
            .transpose()?;
        let shared = [
            ("view", gas.view.raw()),
            ("cells", &sources.cells),
            ("colors", colors.raw()),
            ("surface", surface.raw()),
            ("pixels", pixels.raw()),
        ];
        let draw = if sources.grid.dimension == 3 {
            let own = [("corners", gas.corners.raw()), ("bricks", gas.bricks.raw()), ("edges", edges.raw())];
            bind(gpu, "volume.wgsl", "draw_volume", &[&shared[..], &own].concat())?
        } else {
            bind(gpu, "slice.wgsl", "draw_slice", &[&shared[..], &[("field", gas.field.raw())]].concat())?
        };
        Ok(Self { size, colors, edges, surface, pixels, points, draw })
    }

    /// Draws the field evaluated last; one packed pixel per pixel of the view, rows from the top.
    pub(super) fn draw(&self, gpu: &Gpu, gas: &Gas, view: &View, table: &[Vec3]) -> Result<Vec<u32>> {
        let linear: Vec<Vec4> =
            table.iter().map(|color| Vec3::from(color.to_array().map(linear_from_srgb)).extend(1.0)).collect();
        gas.view.write(gpu, 0, &[*view]);
        self.colors.write(gpu, 0, &linear);
        self.edges.write(gpu, 0, &view.edges());
        let mut pass = Pass::new(gpu, "picture");
        gas.record_packing(&mut pass);
        let pixels = self.pixels.len() as u64;
        match self.points.as_ref().filter(|_| view.particles > 0) {
            Some(points) => {
                pass.dispatch(&points.clear_samples, &Extent::Threads(pixels * u64::from(SAMPLES * SAMPLES)));
                pass.dispatch(&points.splat_depth, &Extent::Threads(points.count));
                pass.dispatch(&points.splat_nearest, &Extent::Threads(points.count));
                pass.dispatch(&points.shade_surface, &Extent::Threads(pixels));
            }
            None => pass.clear(&self.surface),
        }
        pass.dispatch(&self.draw, &Extent::Threads(pixels));
        pass.submit()?;
        readback::read(gpu, &self.pixels)
    }
}

impl Points {
    fn new(
        gpu: &Gpu,
        particles: &ParticleSources,
        gas: &Gas,
        surface: &Buffer<[u32; 4]>,
        pixels: usize,
    ) -> Result<Self> {
        let samples = pixels * (SAMPLES * SAMPLES) as usize;
        let depth_bits = Buffer::<u32>::new(gpu, "sample depths", samples)?;
        let nearest = Buffer::<u32>::new(gpu, "sample particles", samples)?;
        let place = [
            ("view", gas.view.raw()),
            ("position", &particles.position),
            ("velocity", &particles.velocity),
            ("deformation", &particles.deformation),
            ("depth_bits", depth_bits.raw()),
        ];
        let nearest = ("nearest", nearest.raw());
        let own = [nearest, ("affine", &particles.affine), ("surface", surface.raw())];
        let shader = "points.wgsl";
        Ok(Self {
            count: particles.count.into(),
            clear_samples: bind(gpu, shader, "clear_samples", &[place[0], place[4], nearest])?,
            splat_depth: bind(gpu, shader, "splat_depth", &place)?,
            splat_nearest: bind(gpu, shader, "splat_nearest", &[&place[..], &[nearest]].concat())?,
            shade_surface: bind(gpu, shader, "shade_surface", &[&place[..], &own].concat())?,
        })
    }
}
