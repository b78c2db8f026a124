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

/// Cubes along each edge of a brick, the unit of empty space that the ray march leaps over.
const BRICK: u32 = 4;

/// Contrasts below this are transparent: a little over one step of 8 bits.
const FAINTEST: f32 = 0.01;

/// Marks cells without gas in the field.
const NO_VALUE: f32 = -3.0e38;

/// Everything bound for one size of picture.
#[derive(Debug)]
pub(super) struct Kernels {
    cell_count: u64,
    cube_count: u64,
    pixel_count: u64,
    targets: Targets,
    evaluate_field: Bound,
    find_range: Bound,
    pack: Option<[Bound; 2]>,
    points: Option<Points>,
    draw: Bound,
}

/// The buffers that drawing writes.
#[derive(Debug)]
struct Targets {
    view: Buffer<View>,
    colors: Buffer<Vec4>,
    field: Buffer<f32>,
    ranges: Buffer<[f32; 2]>,
    corners: Buffer<[u32; 2]>,
    bricks: Buffer<u32>,
    edges: Buffer<[Vec4; 2]>,
    surface: Buffer<[u32; 4]>,
    pixels: Buffer<u32>,
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
    let _ = writeln!(text, "const BRICK: u32 = {BRICK}u;\nconst FAINTEST: f32 = {FAINTEST};");
    let count = BODY_COLORS.len();
    let colors = BODY_COLORS.map(|color| {
        let [red, green, blue] = color.map(|channel| linear_from_srgb(f32::from(channel) / 255.0));
        format!("vec3f({red:?}, {green:?}, {blue:?})")
    });
    let _ = writeln!(text, "const BODY_COLOR_COUNT: u32 = {count}u;");
    let _ = writeln!(text, "const BODY_COLORS = array<vec3f, {count}>({});", colors.join(", "));
    text
}

/// Compiles one entry point with the constants of the drawing shaders.
fn kernel(gpu: &Gpu, shader: &str, entry: &str) -> Result<Kernel> {
    Kernel::new(gpu, shader, entry, &Constants { source: &constants(), ..Constants::default() })
}

impl Kernels {
    pub(super) fn new(
        gpu: &Gpu,
        state: &SceneBuffers,
        particles: Option<ParticleBuffers>,
        template: &View,
    ) -> Result<Self> {
        let grid = &state.grid;
        let volume = grid.dimension == 3;
        let cube_count = if volume { grid.cells.map(|n| u64::from(n) + 1).iter().product() } else { 0 };
        let pixel_count = u64::from(template.size[0]) * u64::from(template.size[1]);
        let targets = Targets::new(gpu, template, grid.cell_count(), cube_count as usize)?;

        let view = ("view", targets.view.raw());
        let (field, corners) = (("field", targets.field.raw()), ("corners", targets.corners.raw()));
        let gas = [("conserved", state.conserved), ("energy", state.energy), ("cells", state.cells)];
        let evaluate_field =
            kernel(gpu, "field.wgsl", "evaluate_field")?.bind(gpu, &[&gas[..], &[view, field]].concat())?;
        let find_range =
            kernel(gpu, "field.wgsl", "find_range")?.bind(gpu, &[view, field, ("ranges", targets.ranges.raw())])?;
        let bricks = ("bricks", targets.bricks.raw());
        let pack = if volume {
            Some([
                kernel(gpu, "field.wgsl", "pack_corners")?.bind(gpu, &[view, field, corners])?,
                kernel(gpu, "field.wgsl", "mark_bricks")?.bind(gpu, &[view, corners, bricks])?,
            ])
        } else {
            None
        };
        let points = particles.map(|particles| Points::new(gpu, &particles, &targets, pixel_count)).transpose()?;
        let shared = [
            view,
            ("cells", state.cells),
            ("colors", targets.colors.raw()),
            ("surface", targets.surface.raw()),
            ("pixels", targets.pixels.raw()),
        ];
        let draw = if volume {
            let own = [corners, bricks, ("edges", targets.edges.raw())];
            kernel(gpu, "volume.wgsl", "draw_volume")?.bind(gpu, &[&shared[..], &own].concat())?
        } else {
            kernel(gpu, "slice.wgsl", "draw_slice")?.bind(gpu, &[&shared[..], &[field]].concat())?
        };
        let cell_count = grid.cell_count() as u64;
        Ok(Self { cell_count, cube_count, pixel_count, targets, evaluate_field, find_range, pack, points, draw })
    }

    /// Computes the view's field and returns its least and largest value; the first is the larger where there is no gas.
    pub(super) fn evaluate(&self, gpu: &Gpu, view: &View) -> Result<[f64; 2]> {
        self.targets.view.write(gpu, 0, &[*view]);
        let mut pass = Pass::new(gpu, "picture field");
        pass.dispatch(&self.evaluate_field, &Extent::Threads(self.cell_count));
        pass.dispatch(&self.find_range, &Extent::Groups([RANGE_GROUPS, 1, 1]));
        pass.submit()?;
        let ranges = readback::read(gpu, &self.targets.ranges)?;
        let low = ranges.iter().map(|range| f64::from(range[0])).fold(f64::INFINITY, f64::min);
        let high = ranges.iter().map(|range| f64::from(range[1])).fold(f64::NEG_INFINITY, f64::max);
        Ok([low, high])
    }

    /// Draws the field evaluated last; one packed pixel per pixel of the view, rows from the top.
    pub(super) fn draw(&self, gpu: &Gpu, view: &View, table: &[Vec3]) -> Result<Vec<u32>> {
        let linear: Vec<Vec4> =
            table.iter().map(|color| Vec3::from(color.to_array().map(linear_from_srgb)).extend(1.0)).collect();
        self.targets.view.write(gpu, 0, &[*view]);
        self.targets.colors.write(gpu, 0, &linear);
        let mut pass = Pass::new(gpu, "picture");
        if let Some([pack_corners, mark_bricks]) = &self.pack {
            pass.dispatch(pack_corners, &Extent::Threads(self.cube_count));
            pass.dispatch(mark_bricks, &Extent::Threads(self.targets.bricks.len() as u64));
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
        readback::read(gpu, &self.targets.pixels)
    }
}

impl Targets {
    fn new(gpu: &Gpu, template: &View, cells: usize, cubes: usize) -> Result<Self> {
        let bricks = template.cells.iter().map(|n| (n + 1).div_ceil(BRICK) as usize).product();
        let pixels = template.size[0] as usize * template.size[1] as usize;
        Ok(Self {
            view: Buffer::uniform(gpu, "view", 1)?,
            colors: Buffer::new(gpu, "colour table", TABLE_LENGTH)?,
            field: Buffer::new(gpu, "field shown", cells)?,
            ranges: Buffer::new(gpu, "ranges", RANGE_GROUPS as usize)?,
            corners: Buffer::new(gpu, "field corners", cubes)?,
            bricks: Buffer::new(gpu, "bricks", bricks)?,
            edges: Buffer::from_slice(gpu, "edges", &template.edges())?,
            surface: Buffer::new(gpu, "surface", pixels)?,
            pixels: Buffer::new(gpu, "pixels", pixels)?,
        })
    }
}

impl Points {
    fn new(gpu: &Gpu, particles: &ParticleBuffers, targets: &Targets, pixel_count: u64) -> Result<Self> {
        let samples = pixel_count as usize * (SAMPLES * SAMPLES) as usize;
        let depth_bits = Buffer::<u32>::new(gpu, "sample depths", samples)?;
        let nearest = Buffer::<u32>::new(gpu, "sample particles", samples)?;
        let place = [
            ("view", targets.view.raw()),
            ("position", particles.position),
            ("velocity", particles.velocity),
            ("deformation", particles.deformation),
            ("depth_bits", depth_bits.raw()),
        ];
        let nearest = ("nearest", nearest.raw());
        let own = [nearest, ("affine", particles.affine), ("surface", targets.surface.raw())];
        let bind =
            |entry: &str, buffers: &[(&str, &wgpu::Buffer)]| kernel(gpu, "points.wgsl", entry)?.bind(gpu, buffers);
        Ok(Self {
            count: particles.count.into(),
            clear_samples: bind("clear_samples", &[place[0], place[4], nearest])?,
            splat_depth: bind("splat_depth", &place)?,
            splat_nearest: bind("splat_nearest", &[&place[..], &[nearest]].concat())?,
            shade_surface: bind("shade_surface", &[&place[..], &own].concat())?,
        })
    }
}
