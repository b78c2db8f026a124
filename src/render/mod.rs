//! Pictures of the state: line plots in 1D, colour maps in 2D, ray marches in 3D, bodies as lit spheres.
//!
//! Compute kernels write the pixels of the plot; the host frames them with title, time and colour bar. The renderer reads
//! the simulation's buffers and never writes them. A picture follows from state, look, field and time alone: the window and
//! the files show the same bytes.

mod buffers;
mod camera;
mod canvas;
mod colormap;
mod frame;
mod gas;
mod kernels;
mod lines;
mod overlay;
mod plot;
mod quantity;
mod screen;
mod ticks;
mod view;

use glam::Vec3;

pub use buffers::{ParticleBuffers, SceneBuffers};
pub use camera::Ray;
pub use frame::{Frame, Picture};
pub use kernels::constants as shader_constants;
pub use quantity::caption;
pub(crate) use ticks::ticks;
pub use view::View;

use crate::Result;
use crate::gpu::Gpu;
use crate::scene::{Camera, Field, RenderMode, RenderSettings, Scene};
use buffers::Sources;
use camera::Eye;
use canvas::Canvas;
use gas::Gas;
use overlay::Layout;
use screen::Screen;

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

/// Title and time on a picture.
struct Stamp<'a> {
    title: &'a str,
    time: f64,
}

/// What the words and numbers around a picture say.
struct Labels<'a> {
    field: Field,
    range: [f64; 2],
    table: &'a [Vec3],
    time: f64,
}

/// Draws the pictures that a scene asks for, and any other look at it.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    scene: Scene,
    sources: Sources,
    gas: Option<Gas>,
    screen: Option<Screen>,
}

impl Renderer {
    /// For one scene and the buffers that hold its state for as long as the renderer lives.
    ///
    /// # Errors
    /// Those of the shaders and of the device's memory.
    pub fn new(gpu: &Gpu, scene: &Scene, buffers: &SceneBuffers) -> Result<Self> {
        let sources = Sources::from(buffers);
        let gas = if sources.grid.dimension > 1 { Some(Gas::new(gpu, &sources)?) } else { None };
        Ok(Self { gpu: gpu.clone(), scene: scene.clone(), sources, gas, screen: None })
    }

    /// The pictures of the state as it is now: one per field of the scene's output, or one line plot in 1D.
    /// The scene's range is meant for its first field.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn render(&mut self, time: f64) -> Result<Vec<Picture>> {
        let mut look = self.scene.render.clone();
        let fields =
            if self.sources.grid.dimension == 1 { vec![Field::Density] } else { self.scene.output.fields.clone() };
        let mut pictures = Vec::with_capacity(fields.len());
        for field in fields {
            pictures.push(self.draw(&look, field, time)?);
            look.range = None;
        }
        Ok(pictures)
    }

    /// One picture of the state as it is now, with any look; in 1D all fields are in it. What depends on the picture's size is
    /// rebuilt when the size changes and kept otherwise.
    ///
    /// # Errors
    /// [`crate::Error::DoesNotFit`] if the picture is too large for the device, and whatever the device reports.
    pub fn draw(&mut self, look: &RenderSettings, field: Field, time: f64) -> Result<Picture> {
        let layout = self.layout(look);
        let Some(gas) = &self.gas else { return self.draw_lines(look, time) };
        let shown = self.shown_field(look, field);
        let mut view = self.view(look, &layout);
        view.field = quantity::code(shown);
        view.contrast = self.contrast(shown);
        let seen = gas.evaluate(&self.gpu, &view)?;
        let range = look.range.unwrap_or_else(|| self.range_to_show(shown, seen));
        (view.low, view.high) = (range[0] as f32, range[1] as f32);
        (view.neutral, view.opacity) = self.transparency(shown, range);

        let table = colormap::table(look.colormap, shown, self.sources.grid.dimension);
        if self.screen.as_ref().is_none_or(|screen| screen.size != view.size) {
            // The old one first: two at once may not fit.
            self.screen = None;
            self.screen = Some(Screen::new(&self.gpu, &self.sources, gas, view.size)?);
        }
        let screen = self.screen.as_ref().expect("made above");
        let pixels = screen.draw(&self.gpu, gas, &view, &table)?;
        let labels = Labels { field: shown, range, table: &table, time };
        let frame = self.compose(look, &layout, &pixels, &labels);
        Ok(Picture { name: field.keyword().to_owned(), range, frame })
    }

    /// The camera of a look: its own, or the one that shows the whole domain.
    #[must_use]
    pub fn camera(&self, look: &RenderSettings) -> Camera {
        look.camera.unwrap_or_else(|| camera::fitting_camera(&self.sources.grid, look.size))
    }

    /// The line of sight through a place of the picture, in pixels from the top left corner of the frame. In 2D it meets the
    /// plane of the domain at the point shown there.
    #[must_use]
    pub fn ray(&self, look: &RenderSettings, pixel: [f64; 2]) -> Ray {
        let plot = self.layout(look).plot;
        let size = glam::Vec2::new(plot.width as f32, plot.height as f32);
        let place = glam::DVec2::from(pixel) - glam::DVec2::new(plot.x.into(), plot.y.into());
        self.eye(look).ray(size, place.as_vec2())
    }

    /// The range that a picture without a given one shows: that of the values in the gas now.
    ///
    /// # Errors
    /// What the device reports.
    pub fn automatic_range(&self, look: &RenderSettings, field: Field) -> Result<[f64; 2]> {
        let shown = self.shown_field(look, field);
        let Some(gas) = &self.gas else { return Ok(self.read_line(look, 0.0)?.range(0)) };
        let view = View { field: quantity::code(shown), ..self.view(look, &self.layout(look)) };
        Ok(self.range_to_show(shown, gas.evaluate(&self.gpu, &view)?))
    }

    fn layout(&self, look: &RenderSettings) -> Layout {
        let extent = self.sources.grid.extent();
        let [width, height] = look.size;
        Layout::new(width, height, (self.sources.grid.dimension < 3).then(|| extent[0] / extent[1]))
    }

    fn eye(&self, look: &RenderSettings) -> Eye {
        let grid = &self.sources.grid;
        if grid.dimension == 3 { Eye::of_camera(&self.camera(look)) } else { Eye::onto_plane(grid) }
    }

    fn view(&self, look: &RenderSettings, layout: &Layout) -> View {
        let size = [layout.plot.width as u32, layout.plot.height as u32];
        let particles = self.sources.particles.as_ref().filter(|_| look.particles).map_or(0, |own| own.count);
        View::new(&self.scene, &self.sources.grid, &self.eye(look), size, particles)
    }

    /// In 3D the mode says how density is shown; everything else is shown as asked.
    fn shown_field(&self, look: &RenderSettings, asked: Field) -> Field {
        let gradient = self.sources.grid.dimension == 3 && look.mode == RenderMode::Schlieren;
        if gradient && asked == Field::Density { Field::Schlieren } else { asked }
    }

    /// Power that turns a fraction of the range into a place in the colour table.
    fn contrast(&self, shown: Field) -> f32 {
        if self.sources.grid.dimension == 3 && shown == Field::Schlieren { 0.5 } else { 1.0 }
    }

    fn range_to_show(&self, field: Field, seen: [f64; 2]) -> [f64; 2] {
        let gas = &self.scene.gas;
        quantity::shown_range(field, seen, &gas.ambient, gas.gamma, self.sources.grid.spacing.into())
    }

    /// Transparent fraction of the range, and extinction of the most opaque value \[m^-1\].
    fn transparency(&self, field: Field, range: [f64; 2]) -> (f32, f32) {
        let (ambient, grid) = (&self.scene.gas.ambient, &self.sources.grid);
        let neutral = match field {
            Field::Density => ambient.density,
            Field::Pressure => ambient.pressure,
            Field::Temperature => ambient.pressure / ambient.density,
            Field::Velocity | Field::Schlieren | Field::Mach | Field::Vorticity => range[0],
        };
        let fraction = ((neutral - range[0]) / (range[1] - range[0])).clamp(0.0, 1.0) as f32;
        let opacity = match field {
            Field::Schlieren | Field::Vorticity => SHOCK_OPTICAL_DEPTH / (3.0 * grid.spacing),
            _ => DOMAIN_OPTICAL_DEPTH / Vec3::from(grid.extent()).max_element(),
        };
        (fraction, opacity)
    }

    /// Puts the plot's pixels on a frame and writes around them.
    fn compose(&self, look: &RenderSettings, layout: &Layout, pixels: &[u32], labels: &Labels) -> Frame {
        let [width, height] = look.size;
        let mut frame = Frame::filled(width, height, overlay::BACKGROUND);
        let plot = layout.plot;
        for (row, line) in pixels.chunks_exact(plot.width as usize).enumerate() {
            let first = 4 * ((plot.y as usize + row) * width as usize + plot.x as usize);
            frame.rgba[first..first + 4 * line.len()].copy_from_slice(bytemuck::cast_slice(line));
        }
        let mut canvas = Canvas::new(&mut frame);
        if self.sources.grid.dimension < 3 {
            canvas.outline(plot, overlay::FAINT);
        }
        let contrast = self.contrast(labels.field);
        overlay::color_bar(&mut canvas, layout.bar, labels.table, labels.range, contrast, caption(labels.field));
        overlay::header(&mut canvas, &self.scene.title, labels.time);
        frame
    }

    /// The line plot of a one-dimensional state.
    fn draw_lines(&self, look: &RenderSettings, time: f64) -> Result<Picture> {
        let line = self.read_line(look, time)?;
        let frame = plot::draw(&line, look.size, &Stamp { title: &self.scene.title, time });
        Ok(Picture { name: "lines".to_owned(), range: line.range(0), frame })
    }

    fn read_line(&self, look: &RenderSettings, time: f64) -> Result<plot::Line> {
        lines::read(&self.gpu, &self.sources, &self.scene, look.size[0], time)
    }
}
