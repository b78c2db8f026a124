//! The drawing kernels with their buffers.

use std::fmt::Write as _;

use glam::{Vec3, Vec4};

use super::colormap::{TABLE_LENGTH, linear_from_srgb};
use super::view::View;
use super::{BODY_COLORS, ParticleBuffers, SceneBuffers, quantity};
use crate::Result;
use crate::gpu::{Bound, Buffer, Constants, Extent, Gpu, Kernel, Pass, readback};
use crate::snapshot::kind;

/// Samples of a pixel along each axis where particles are drawn.
const SAMPLES: u32 = 2;

/// Workgroups that search the range; each leaves one pair of values.
const RANGE_GROUPS: u32 = 64;

/// Marks cells without gas in the field.
const NO_VALUE: f32 = -3.0e38;

/// Everything bound for one size of picture.
#[derive(Debug)]
pub(super) struct Kernels {
    cell_count: u64,
    cube_count: u64,
    pixel_count: u64,
    view: Buffer<View>,
    colors: Buffer<Vec4>,
    ranges: Buffer<[f32; 2]>,
    pixels: Buffer<u32>,
    evaluate_field: Bound,
    find_range: Bound,
    pack_corners: Option<Bound>,
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

/// WGSL constants that the drawing shaders share with the host.
pub fn constants() -> String {
    let mut text = quantity::constants();
    let _ = writeln!(text, "const KIND_GAS: u32 = {}u;\nconst KIND_WALL: u32 = {}u;", kind::GAS, kind::WALL);
    let _ = writeln!(text, "const SAMPLES: u32 = {SAMPLES}u;\nconst NO_VALUE: f32 = {NO_VALUE:e};");
    let _ = writeln!(text, "const COLOR_COUNT: u32 = {TABLE_LENGTH}u;");
    let count = BODY_COLORS.len();
    let colors = BODY_COLORS.map(|color| {
        let [red, green, blue] = color.map(|channel| linear_from_srgb(f32::from(channel) / 255.0));
        format!("vec3f({red:?}, {green:?}, {blue:?})")
    });
    let _ = writeln!(text, "const BODY_COLOR_COUNT: u32 = {count}u;");
    let _ = writeln!(text, "const BODY_COLORS = array<vec3f, {count}>({});", colors.join(", "));
    text
}

impl Kernels {
    pub(super) fn new(
        gpu: &Gpu,
        state: &SceneBuffers,
        particles: Option<ParticleBuffers>,
        template: &View,
    ) -> Result<Self> {
        let constants = constants();
        let kernel = |shader: &str, entry: &str| {
            Kernel::new(gpu, shader, entry, &Constants { source: &constants, ..Constants::default() })
        };
        let grid = &state.grid;
        let cube_count = if grid.dimension == 3 { grid.cells.map(|n| u64::from(n) + 1).iter().product() } else { 0 };
        let pixel_count = u64::from(template.size[0]) * u64::from(template.size[1]);

        let view = Buffer::uniform(gpu, "view", 1)?;
        let colors = Buffer::new(gpu, "colour table", TABLE_LENGTH)?;
        let field = Buffer::<f32>::new(gpu, "field shown", grid.cell_count())?;
        let ranges = Buffer::new(gpu, "ranges", RANGE_GROUPS as usize)?;
        let corners = Buffer::<[u32; 2]>::new(gpu, "field corners", cube_count as usize)?;
        let surface = Buffer::<[u32; 4]>::new(gpu, "surface", pixel_count as usize)?;
        let pixels = Buffer::new(gpu, "pixels", pixel_count as usize)?;

        let evaluate_field = kernel("field.wgsl", "evaluate_field")?.bind(
            gpu,
            &[
                ("view", view.raw()),
                ("conserved", state.conserved),
                ("energy", state.energy),
                ("cells", state.cells),
                ("field", field.raw()),
            ],
        )?;
        let find_range = kernel("field.wgsl", "find_range")?
            .bind(gpu, &[("view", view.raw()), ("field", field.raw()), ("ranges", ranges.raw())])?;
        let points = particles
            .map(|particles| Points::new(gpu, kernel, &particles, (&view, pixel_count), &surface))
            .transpose()?;
        let shared =
            [("view", view.raw()), ("cells", state.cells), ("colors", colors.raw()), ("surface", surface.raw())];
        let (pack_corners, draw) = if grid.dimension == 3 {
            let edges = Buffer::from_slice(gpu, "edges", &template.edges())?;
            let pack = kernel("field.wgsl", "pack_corners")?
                .bind(gpu, &[("view", view.raw()), ("field", field.raw()), ("corners", corners.raw())])?;
            let own = [("corners", corners.raw()), ("edges", edges.raw()), ("pixels", pixels.raw())];
            (Some(pack), kernel("volume.wgsl", "draw_volume")?.bind(gpu, &[&shared[..], &own].concat())?)
        } else {
            let own = [("field", field.raw()), ("pixels", pixels.raw())];
            (None, kernel("slice.wgsl", "draw_slice")?.bind(gpu, &[&shared[..], &own].concat())?)
        };
        let cell_count = grid.cell_count() as u64;
        Ok(Self {
            cell_count,
            cube_count,
            pixel_count,
            view,
            colors,
            ranges,
            pixels,
            evaluate_field,
            find_range,
            pack_corners,
            points,
            draw,
        })
    }

    /// Computes the view's field and returns its least and largest value; the first is the larger where there is no gas.
    pub(super) fn evaluate(&self, gpu: &Gpu, view: &View) -> Result<[f64; 2]> {
        self.view.write(gpu, 0, &[*view]);
        let mut pass = Pass::new(gpu, "picture field");
        pass.dispatch(&self.evaluate_field, &Extent::Threads(self.cell_count));
        pass.dispatch(&self.find_range, &Extent::Groups([RANGE_GROUPS, 1, 1]));
        pass.submit()?;
        let ranges = readback::read(gpu, &self.ranges)?;
        let low = ranges.iter().map(|range| f64::from(range[0])).fold(f64::INFINITY, f64::min);
        let high = ranges.iter().map(|range| f64::from(range[1])).fold(f64::NEG_INFINITY, f64::max);
        Ok([low, high])
    }

    /// Draws the field evaluated last; one packed pixel per pixel of the view, rows from the top.
    pub(super) fn draw(&self, gpu: &Gpu, view: &View, table: &[Vec3]) -> Result<Vec<u32>> {
        let linear: Vec<Vec4> =
            table.iter().map(|color| Vec3::from(color.to_array().map(linear_from_srgb)).extend(1.0)).collect();
        self.view.write(gpu, 0, &[*view]);
        self.colors.write(gpu, 0, &linear);
        let mut pass = Pass::new(gpu, "picture");
        if let Some(pack) = &self.pack_corners {
            pass.dispatch(pack, &Extent::Threads(self.cube_count));
        }
        if let Some(points) = &self.points {
            let samples = self.pixel_count * u64::from(SAMPLES * SAMPLES);
            pass.dispatch(&points.clear_samples, &Extent::Threads(samples));
            pass.dispatch(&points.splat_depth, &Extent::Threads(points.count));
            pass.dispatch(&points.splat_nearest, &Extent::Threads(points.count));
            pass.dispatch(&points.shade_surface, &Extent::Threads(self.pixel_count));
        }
        pass.dispatch(&self.draw, &Extent::Threads(self.pixel_count));
        pass.submit()?;
        readback::read(gpu, &self.pixels)
    }
}

impl Points {
    fn new(
        gpu: &Gpu,
        kernel: impl Fn(&str, &str) -> Result<Kernel>,
        particles: &ParticleBuffers,
        (view, pixel_count): (&Buffer<View>, u64),
        surface: &Buffer<[u32; 4]>,
    ) -> Result<Self> {
        let samples = pixel_count as usize * (SAMPLES * SAMPLES) as usize;
        let depth_bits = Buffer::<u32>::new(gpu, "sample depths", samples)?;
        let nearest = Buffer::<u32>::new(gpu, "sample particles", samples)?;
        let view = ("view", view.raw());
        let depth_bits = ("depth_bits", depth_bits.raw());
        let nearest = ("nearest", nearest.raw());
        let place = [
            ("position", particles.position),
            ("velocity", particles.velocity),
            ("deformation", particles.deformation),
        ];
        let bind = |entry: &str, own: &[(&str, &wgpu::Buffer)]| kernel("points.wgsl", entry)?.bind(gpu, own);
        Ok(Self {
            count: particles.count.into(),
            clear_samples: bind("clear_samples", &[view, depth_bits, nearest])?,
            splat_depth: bind("splat_depth", &[&place[..], &[view, depth_bits]].concat())?,
            splat_nearest: bind("splat_nearest", &[&place[..], &[view, depth_bits, nearest]].concat())?,
            shade_surface: bind(
                "shade_surface",
                &[&place[..], &[view, depth_bits, nearest, ("affine", particles.affine), ("surface", surface.raw())]]
                    .concat(),
            )?,
        })
    }
}
