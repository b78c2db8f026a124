//! Pictures of the state: line plots in 1D, colour maps in 2D, ray marches in 3D, bodies as lit spheres.
//!
//! Compute kernels write the pixels of the plot; the host frames them with title, time and colour bar. The renderer reads
//! the simulation's buffers and never writes them.

mod canvas;
mod colormap;
mod frame;
mod kernels;
mod overlay;
mod plot;
mod quantity;
mod ticks;
mod view;

use std::collections::HashMap;

use glam::Vec3;

pub use frame::{Frame, Picture};
pub use kernels::constants as shader_constants;
pub(crate) use ticks::ticks;
pub use view::View;

use crate::Result;
use crate::gpu::{Gpu, readback};
use crate::render::canvas::Canvas;
use crate::render::kernels::Kernels;
use crate::render::overlay::Layout;
use crate::render::plot::Line;
use crate::scene::{Field, RenderMode, Scene};
use crate::snapshot::kind;
use crate::state::Grid;

/// Colours of the bodies, sRGB, by index: light enough to stand out from the colour maps.
const BODY_COLORS: [[u8; 3]; 8] = [
    [226, 190, 150],
    [120, 190, 235],
    [240, 150, 90],
    [160, 210, 140],
    [214, 150, 200],
    [235, 215, 110],
    [150, 150, 160],
    [230, 110, 110],
];

/// Optical depth of a layer as thick as a shock (three cells) with the steepest gradient.
const SHOCK_OPTICAL_DEPTH: f32 = 0.9;

/// Optical depth of the whole domain filled with the most unusual value.
const DOMAIN_OPTICAL_DEPTH: f32 = 14.0;

/// The simulation's buffers, in the padded index space of [`Grid`].
#[derive(Debug, Clone, Copy)]
pub struct SceneBuffers<'a> {
    /// The grid of the cell arrays.
    pub grid: Grid,
    /// Density and momentum per volume, one vec4 per slot.
    pub conserved: &'a wgpu::Buffer,
    /// Total energy per volume, one f32 per slot.
    pub energy: &'a wgpu::Buffer,
    /// Cell words, one u32 per slot; bits 0 and 1 are the kind.
    pub cells: &'a wgpu::Buffer,
    /// The particles, if there are any.
    pub particles: Option<ParticleBuffers<'a>>,
}

/// The particles' buffers.
#[derive(Debug, Clone, Copy)]
pub struct ParticleBuffers<'a> {
    /// Number of particles.
    pub count: u32,
    /// Position and mass, one vec4 per particle.
    pub position: &'a wgpu::Buffer,
    /// Velocity and volume at rest, one vec4 per particle.
    pub velocity: &'a wgpu::Buffer,
    /// Affine velocity, three vec4 per particle; the second w is the plastic strain.
    pub affine: &'a wgpu::Buffer,
    /// Deformation gradient, three vec4 per particle; the first w holds the body, the second the active flag.
    pub deformation: &'a wgpu::Buffer,
}

/// Title and time on a picture.
struct Stamp<'a> {
    title: &'a str,
    time: f64,
}

/// Draws the pictures that a scene asks for.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    scene: Scene,
    grid: Grid,
    layout: Layout,
    view: View,
    kernels: Option<Kernels>,
    sources: Sources,
    ranges: HashMap<Field, [f64; 2]>,
}

/// What the line plots of 1D read back.
#[derive(Debug)]
struct Sources {
    conserved: wgpu::Buffer,
    energy: wgpu::Buffer,
    cells: wgpu::Buffer,
    particles: Option<(u32, [wgpu::Buffer; 3])>,
}

impl Renderer {
    /// For one scene and the buffers that hold its state for as long as the renderer lives.
    pub fn new(gpu: &Gpu, scene: &Scene, buffers: &SceneBuffers) -> Result<Self> {
        let grid = buffers.grid;
        let [width, height] = scene.render.size;
        let extent = grid.extent();
        let layout = Layout::new(width, height, (grid.dimension < 3).then(|| extent[0] / extent[1]));
        let particles = buffers.particles.filter(|particles| scene.render.particles && particles.count > 0);
        let size = [layout.plot.width as u32, layout.plot.height as u32];
        let view = View::of_scene(scene, &grid, size, particles.map_or(0, |particles| particles.count));
        let kernels = if grid.dimension > 1 { Some(Kernels::new(gpu, buffers, particles, &view)?) } else { None };
        let sources = Sources {
            conserved: buffers.conserved.clone(),
            energy: buffers.energy.clone(),
            cells: buffers.cells.clone(),
            particles: particles
                .map(|own| (own.count, [own.position, own.velocity, own.deformation].map(wgpu::Buffer::clone))),
        };
        Ok(Self {
            gpu: gpu.clone(),
            scene: scene.clone(),
            grid,
            layout,
            view,
            kernels,
            sources,
            ranges: HashMap::new(),
        })
    }

    /// The pictures of the state as it is now: one per field of the scene's output, or one line plot in 1D.
    pub fn render(&mut self, time: f64) -> Result<Vec<Picture>> {
        if self.grid.dimension == 1 {
            return Ok(vec![self.draw_lines(time)?]);
        }
        self.scene.output.fields.clone().into_iter().map(|field| self.draw_field(field, time)).collect()
    }

    /// The picture of one field; needs two or three dimensions.
    fn draw_field(&mut self, asked: Field, time: f64) -> Result<Picture> {
        let field = self.shown_field(asked);
        let Some(kernels) = &self.kernels else { return self.draw_lines(time) };
        let mut view = self.view;
        view.field = quantity::code(field);
        view.contrast = if self.grid.dimension == 3 && field == Field::Schlieren { 0.5 } else { 1.0 };
        let seen = kernels.evaluate(&self.gpu, &view)?;
        let range = self.range_to_show(field, asked, seen);
        (view.low, view.high) = (range[0] as f32, range[1] as f32);
        (view.neutral, view.opacity) = self.transparency(field, range);

        let table = colormap::table(self.scene.render.colormap, field, self.grid.dimension);
        let kernels = self.kernels.as_ref().expect("checked above");
        let pixels = kernels.draw(&self.gpu, &view, &table)?;
        let frame = self.compose(&pixels, field, range, &table, time);
        Ok(Picture { name: quantity::name(asked).to_owned(), range, frame })
    }

    /// In 3D the scene's render mode says how density is shown; everything else is shown as asked.
    fn shown_field(&self, asked: Field) -> Field {
        let gradient = self.grid.dimension == 3 && self.scene.render.mode == RenderMode::Schlieren;
        if gradient && asked == Field::Density { Field::Schlieren } else { asked }
    }

    /// The scene's range, which is meant for its first field, or one that follows the values.
    fn range_to_show(&mut self, field: Field, asked: Field, seen: [f64; 2]) -> [f64; 2] {
        if let Some(range) = self.scene.render.range.filter(|_| self.scene.output.fields.first() == Some(&asked)) {
            return range;
        }
        let gas = &self.scene.gas;
        let now = quantity::shown_range(field, seen, &gas.ambient, gas.gamma, self.grid.spacing.into());
        let range = quantity::follow(self.ranges.get(&field).copied(), now);
        self.ranges.insert(field, range);
        range
    }

    /// Transparent fraction of the range, and extinction of the most opaque value \[m^-1\].
    fn transparency(&self, field: Field, range: [f64; 2]) -> (f32, f32) {
        let ambient = &self.scene.gas.ambient;
        let neutral = match field {
            Field::Density => ambient.density,
            Field::Pressure => ambient.pressure,
            Field::Temperature => ambient.pressure / ambient.density,
            Field::Velocity | Field::Schlieren | Field::Mach | Field::Vorticity => range[0],
        };
        let fraction = ((neutral - range[0]) / (range[1] - range[0])).clamp(0.0, 1.0) as f32;
        let opacity = match field {
            Field::Schlieren | Field::Vorticity => SHOCK_OPTICAL_DEPTH / (3.0 * self.grid.spacing),
            _ => DOMAIN_OPTICAL_DEPTH / Vec3::from(self.grid.extent()).max_element(),
        };
        (fraction, opacity)
    }

    /// Puts the plot's pixels on a frame and writes around them.
    fn compose(&self, pixels: &[u32], field: Field, range: [f64; 2], table: &[Vec3], time: f64) -> Frame {
        let [width, height] = self.scene.render.size;
        let mut frame = Frame::filled(width, height, overlay::BACKGROUND);
        let plot = self.layout.plot;
        for (row, line) in pixels.chunks_exact(plot.width as usize).enumerate() {
            let first = 4 * ((plot.y as usize + row) * width as usize + plot.x as usize);
            frame.rgba[first..first + 4 * line.len()].copy_from_slice(bytemuck::cast_slice(line));
        }
        let mut canvas = Canvas::new(&mut frame);
        if self.grid.dimension < 3 {
            canvas.outline(plot, overlay::FAINT);
        }
        let contrast = if self.grid.dimension == 3 && field == Field::Schlieren { 0.5 } else { 1.0 };
        overlay::color_bar(&mut canvas, self.layout.bar, table, range, contrast, quantity::caption(field));
        overlay::header(&mut canvas, &self.scene.title, time);
        frame
    }

    /// The line plot of a one-dimensional state.
    fn draw_lines(&self, time: f64) -> Result<Picture> {
        let line = self.read_line(time)?;
        let frame = plot::draw(&line, self.scene.render.size, &Stamp { title: &self.scene.title, time });
        Ok(Picture { name: "lines".to_owned(), range: line.range(0), frame })
    }

    fn read_line(&self, time: f64) -> Result<Line> {
        let conserved: Vec<[f32; 4]> = self.grid.unpadded(&self.read(&self.sources.conserved, self.grid.slots())?);
        let energy: Vec<f32> = self.grid.unpadded(&self.read(&self.sources.energy, self.grid.slots())?);
        let cells: Vec<u32> = self.grid.unpadded(&self.read(&self.sources.cells, self.grid.slots())?);
        let velocity: Vec<f32> = conserved.iter().map(|state| state[1] / state[0]).collect();
        let thermal = |(state, energy): (&[f32; 4], &f32)| {
            let kinetic = 0.5 * state[1..].iter().map(|momentum| momentum * momentum).sum::<f32>() / state[0];
            (self.view.gamma - 1.0) * (energy - kinetic)
        };
        let pressure = conserved.iter().zip(&energy).map(thermal).collect();
        let density = conserved.iter().map(|state| state[0]).collect();
        let mut particles = Vec::new();
        if let Some((count, [position, velocity, deformation])) = &self.sources.particles {
            let count = *count as usize;
            let (position, velocity): (Vec<[f32; 4]>, Vec<[f32; 4]>) =
                (self.read(position, count)?, self.read(velocity, count)?);
            let deformation: Vec<[[f32; 4]; 3]> = self.read(deformation, count)?;
            let active = |index: &usize| deformation[*index][1][3] != 0.0;
            particles = (0..count)
                .filter(active)
                .map(|index| (position[index][0], velocity[index][0], deformation[index][0][3].to_bits()))
                .collect();
        }
        let kind = cells.iter().map(|word| (word & u32::from(kind::MASK)) as u8).collect();
        let exact = self.exact_lines(time);
        Ok(Line { grid: self.grid, kind, gas: [density, velocity, pressure], particles, exact })
    }

    /// Density, velocity and pressure of the exact solution over x, if the scene has one; a few points per pixel.
    fn exact_lines(&self, time: f64) -> Option<[Vec<[f64; 2]>; 3]> {
        let (exact, jump) = self.scene.riemann_until_waves_leave(time).filter(|_| time > 0.0)?;
        let (low, points) = (self.scene.domain.origin[0], 2 * self.scene.render.size[0]);
        let places = (0..=points).map(|k| low + self.scene.domain.size[0] * f64::from(k) / f64::from(points));
        let mut lines = [const { Vec::new() }; 3];
        for x in places {
            let (density, velocity, pressure) = exact.sample((x - jump) / time);
            for (line, value) in lines.iter_mut().zip([density, velocity, pressure]) {
                line.push([x, value]);
            }
        }
        Some(lines)
    }

    fn read<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer, len: usize) -> Result<Vec<T>> {
        let bytes = readback::read_bytes(&self.gpu, buffer, 0, (len * size_of::<T>()) as u64)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}
