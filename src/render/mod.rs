//! Pictures of the state: line plots in 1D, colour maps in 2D, ray marches in 3D, bodies as lit surfaces.
//!
//! Compute kernels write the pixels of the plot; the host frames them with title, time and colour bars. The renderer reads
//! the simulation's buffers and never writes them. A picture follows from state, look, field and time alone: the window and
//! the files show the same bytes.

mod arrows;
mod bend;
mod buffers;
mod camera;
mod canvas;
mod colormap;
mod frame;
mod gas;
mod html;
mod kernels;
mod layers;
mod letters;
mod light;
mod lines;
mod overlay;
mod palette;
mod paper;
mod particles;
mod plane;
mod plot;
mod pointing;
mod quantity;
mod screen;
mod sheets;
mod stored;
mod svg;
mod ticks;
mod transfer;
mod value;
mod view;

pub use frame::{Depth, Frame, Picture};
pub(crate) use html::{PAGE_STYLE, escape};
#[cfg(feature = "viewer")]
pub(crate) use palette::of_bodies as body_colors;
pub(crate) use ticks::ticks;
#[doc(hidden)]
pub use {
    buffers::{ParticleBuffers, SceneBuffers},
    camera::Ray,
    colormap::colors,
    kernels::constants as shader_constants,
    layers::{LayerPixel, Layers},
    quantity::{caption, particle_caption, symbol},
    stored::{Loaded, Stored, StoredParticles},
    svg::{Plot, Style},
    view::View,
};

use crate::Result;
use crate::gpu::Gpu;
use crate::scene::{Camera, Contours, Field, RenderMode, RenderSettings, Scene, Shot};
use crate::simulation::Simulation;
use buffers::Sources;
use camera::Eye;
use overlay::Layout;
use plane::{Drawing, Labels, Wanted};

/// Optical depth of a layer as thick as a shock (three cells) with the steepest gradient.
const SHOCK_OPTICAL_DEPTH: f32 = 0.9;

/// Optical depth of the whole domain filled with the most unusual value.
const DOMAIN_OPTICAL_DEPTH: f32 = 14.0;

/// Title and time on a picture.
struct Stamp<'a> {
    title: Option<&'a str>,
    time: Option<f64>,
}

/// Draws the pictures that a scene asks for, and any other look at it.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    scene: Scene,
    shots: Vec<Shot>,
    depth: Depth,
    stop: Option<fn() -> bool>,
    sources: Sources,
    /// In two and three dimensions.
    drawing: Option<Drawing>,
}

impl Renderer {
    /// For one scene and the buffers that hold its state for as long as the renderer lives.
    ///
    /// # Errors
    /// Those of the shaders and of the device's memory.
    pub fn new(gpu: &Gpu, scene: &Scene, buffers: &SceneBuffers) -> Result<Self> {
        let sources = Sources::from(buffers);
        let drawing = if sources.grid.dimension > 1 { Some(Drawing::new(gpu, scene, &sources)?) } else { None };
        let shots = scene.shots()?;
        gpu.finish_kernels()?;
        Ok(Self {
            gpu: gpu.clone(),
            scene: scene.clone(),
            shots,
            depth: Depth::default(),
            stop: None,
            sources,
            drawing,
        })
    }

    /// For a simulation of a scene, whose state it draws as it is at each call.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn of(simulation: &Simulation, scene: &Scene) -> Result<Self> {
        Self::new(simulation.gpu(), scene, &SceneBuffers::of(&simulation.state))
    }

    /// Asks for more than 8 bits per channel of all pictures.
    #[must_use]
    pub fn with_depth(self, depth: Depth) -> Self {
        Self { depth, ..self }
    }

    /// Asks before each part of a picture whether to stop: then [`Renderer::draw`] gives up with [`crate::Error::Interrupted`].
    #[must_use]
    pub fn with_stop(self, stop: fn() -> bool) -> Self {
        Self { stop: Some(stop), ..self }
    }

    /// Draws other views than those of the scene.
    #[must_use]
    pub fn with_shots(self, shots: Vec<Shot>) -> Self {
        Self { shots, ..self }
    }

    /// The pictures of the state as it is now: for the scene and each of its views one per field, or one line plot in 1D.
    /// A range is meant for the first field.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn render(&mut self, time: f64) -> Result<Vec<Picture>> {
        let one = self.sources.grid.dimension == 1;
        let mut pictures = Vec::new();
        for Shot { name, fields, settings: mut look } in self.shots.clone() {
            for field in if one { vec![Field::Density] } else { fields } {
                let picture = self.draw(&look, field, time)?;
                pictures.push(Picture { view: name.clone(), ..picture });
                look.range = None;
            }
        }
        Ok(pictures)
    }

    /// One picture of the state as it is now, with any look; in 1D all fields are in it. What depends on the picture's size is
    /// rebuilt when the size changes and kept otherwise.
    ///
    /// # Errors
    /// [`crate::Error::DoesNotFit`] if the picture is too large for the device, and whatever the device reports.
    pub fn draw(&mut self, look: &RenderSettings, field: Field, time: f64) -> Result<Picture> {
        self.draw_in_haste(look, field, time, 1.0)
    }

    /// The same with a share of the rays along each axis of the plot; what is around it and written stays as sharp. In 1D all are drawn.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw_in_haste(&mut self, look: &RenderSettings, field: Field, time: f64, share: f64) -> Result<Picture> {
        let layout = self.layout(look);
        let mut view = self.view(look, layout.pixels(share), time);
        let Some(drawing) = &self.drawing else { return self.draw_lines(look, time) };
        let shown = self.shown_field(look, field);
        view.field = quantity::code(shown);
        view.contrast = self.contrast(shown);
        let [seen, of_particles] = drawing.evaluate(&self.gpu, &view)?;
        let range = look.range.unwrap_or_else(|| self.range_to_show(shown, seen));
        let particle_range = self.particle_range(look, of_particles);
        self.set_range(&mut view, look, shown, range);
        [view.particle_low, view.particle_high] = particle_range.map(|value| value as f32);

        let colors = colormap::table(look.colormap, shown, self.sources.grid.dimension);
        let particle_colors = colormap::table(look.particle_colormap, Field::Velocity, 3);
        let tables = self.tables(look, shown, range, &colors, &particle_colors);
        let drawing = self.drawing.as_mut().expect("checked above");
        let wanted = Wanted { edges: look.overlays.edges, depth: self.depth, stop: self.stop };
        let (drawn, arrows) = drawing.draw(&self.gpu, &self.sources, &mut view, &tables, wanted)?;
        let stamp = self.stamp(look, time);
        let contrast = view.contrast;
        let bars = [(caption(shown), &colors[..], range, contrast)];
        let own = (particle_caption(look.particle_color), &particle_colors[..], particle_range, 1.0);
        let labels = Labels {
            stamp,
            bars: [bars[0], own],
            arrows: (view.arrows, arrows),
            scale: self.scale(look, &layout, time),
            camera: layers::camera(&self.eye(look, time), layout.plot.width as f32 / layout.plot.height as f32),
        };
        let drawn = drawn.on(layout.pixels(1.0).map(|side| side as usize));
        let picture = plane::compose(look, &layout, &drawn, &labels, self.sources.grid.dimension < 3);
        let [name, shown] = [field, shown].map(|field| field.keyword().to_owned());
        Ok(Picture { name, shown, range, ..picture })
    }

    /// The camera of a look at a time \[s\]: its own, or the one that shows the whole domain, where its path leads it.
    #[must_use]
    pub fn camera(&self, look: &RenderSettings, time: f64) -> Camera {
        let still = look.camera.unwrap_or_else(|| camera::fitting_camera(&self.sources.grid, look.size));
        look.path.as_ref().map_or(still, |path| path.at(time, &still))
    }

    /// The range that a picture without a given one shows: that of the values in the gas now.
    ///
    /// # Errors
    /// What the device reports.
    pub fn automatic_range(&self, look: &RenderSettings, field: Field) -> Result<[f64; 2]> {
        let shown = self.shown_field(look, field);
        let Some(drawing) = &self.drawing else { return Ok(self.read_line(look, 0.0)?.range(0)) };
        let view = View { field: quantity::code(shown), ..self.view(look, self.layout(look).pixels(1.0), 0.0) };
        Ok(self.range_to_show(shown, drawing.evaluate(&self.gpu, &view)?[0]))
    }

    fn layout(&self, look: &RenderSettings) -> Layout {
        let extent = self.sources.grid.extent();
        let overlays = look.overlays;
        let colored = look.particle_color.is_value() && look.particles && self.sources.particles.is_some();
        let bars = [overlays.color_bar && self.optics(look) == 0, overlays.color_bar && colored];
        let aspect = (self.sources.grid.dimension < 3).then(|| extent[0] / extent[1]);
        Layout::new(look, aspect, bars)
    }

    fn eye(&self, look: &RenderSettings, time: f64) -> Eye {
        let grid = &self.sources.grid;
        if grid.dimension == 3 {
            return Eye::of_camera(&self.camera(look, time), self.sources.grid.frame);
        }
        let moved = look.path.as_ref().map(|path| path.at(time, &look.camera.unwrap_or(camera::above(grid))));
        Eye::onto_plane(grid, moved.or(look.camera).as_ref())
    }

    /// Everything about a picture but what depends on the field.
    fn view(&self, look: &RenderSettings, size: [u32; 2], time: f64) -> View {
        let grid = &self.sources.grid;
        let mut view = View::new(&self.scene, grid, &self.eye(look, time), look, size);
        view.species_start = self.sources.species.as_ref().map_or(0, |(_, start, _)| *start);
        view.particles = self.sources.particles.as_ref().filter(|_| look.particles).map_or(0, |own| own.count);
        view.particle_color = quantity::particle_code(look.particle_color);
        view.smooth_skin = u32::from(look.surface == crate::scene::Surface::Smooth && grid.dimension == 3);
        view.tone =
            if grid.dimension == 3 && look.tone == crate::scene::ToneMap::Aces { kernels::TONE_ACES } else { 0 };
        view.exposure = if grid.dimension == 3 { view.exposure } else { 1.0 };
        view.optics = self.optics(look);
        view.fineness = self.drawing.as_ref().map_or(0, |drawing| drawing.distance.fineness);
        if look.arrows > 0 && grid.dimension == 2 {
            let down = (look.arrows as f32 * size[1] as f32 / size[0] as f32).round().clamp(1.0, 1000.0);
            view.arrows = [look.arrows, down as u32];
        }
        if let Some(emission) = look.emission.filter(|_| grid.dimension == 3 && look.volume) {
            let ambient = &self.scene.gas.ambient;
            let [cold, hot] = crate::scene::RAMP_KELVIN;
            let kelvin = emission.ambient_kelvin * ambient.density / ambient.pressure;
            view.heat_scale = (kelvin / (hot - cold)) as f32;
            view.heat_offset = (cold / (hot - cold)) as f32;
            view.heat_opacity = emission.optical_depth as f32 / longest(grid.extent());
        }
        bend::set(&mut view, look, &self.scene.gas.ambient);
        if self.sources.species.is_some() && grid.dimension == 3 && look.volume {
            view.soot = look.soot.map_or(0.0, |soot| soot.extinction as f32);
        }
        if let Some(dust) = look.dust.filter(|_| self.sources.dust.is_some() && grid.dimension == 3 && look.volume) {
            let [red, green, blue] = dust.color.0.map(|value| colormap::linear_from_srgb(f32::from(value) / 255.0));
            (view.dust, view.dust_color) = (dust.extinction as f32, [red, green, blue, 1.0]);
        }
        view
    }

    fn optics(&self, look: &RenderSettings) -> u32 {
        match look.mode {
            RenderMode::LineOfSight if self.sources.grid.dimension == 3 => kernels::OPTICS[0],
            RenderMode::Shadowgraph if self.sources.grid.dimension == 3 => kernels::OPTICS[1],
            _ => 0,
        }
    }

    /// In 3D the mode says how density is shown; everything else is shown as asked.
    fn shown_field(&self, look: &RenderSettings, asked: Field) -> Field {
        let gradient = self.sources.grid.dimension == 3 && look.mode == RenderMode::Schlieren;
        match asked {
            _ if self.optics(look) > 0 => Field::Density,
            Field::Density if gradient => Field::Schlieren,
            other => other,
        }
    }

    /// Power that turns a fraction of the range into a place in the colour table.
    fn contrast(&self, shown: Field) -> f32 {
        if self.sources.grid.dimension == 3 && shown == Field::Schlieren { 0.5 } else { 1.0 }
    }

    fn range_to_show(&self, field: Field, seen: [f64; 2]) -> [f64; 2] {
        let gas = &self.scene.gas;
        quantity::shown_range(field, seen, &gas.ambient, gas.gamma, self.sources.grid.spacing.into())
    }

    fn particle_range(&self, look: &RenderSettings, seen: [f64; 2]) -> [f64; 2] {
        let gas = &self.scene.gas;
        let automatic = || quantity::shown_particle_range(look.particle_color, seen, &gas.ambient, gas.gamma);
        look.particle_range.unwrap_or_else(automatic)
    }

    /// What of a view depends on field and range.
    fn set_range(&self, view: &mut View, look: &RenderSettings, field: Field, range: [f64; 2]) {
        (view.low, view.high) = (range[0] as f32, range[1] as f32);
        if view.optics > 0 {
            view.low = self.scene.gas.ambient.density as f32;
        }
        let grid = &self.sources.grid;
        let depth = match field {
            Field::Schlieren | Field::Vorticity => SHOCK_OPTICAL_DEPTH / (3.0 * grid.spacing),
            _ => DOMAIN_OPTICAL_DEPTH / longest(grid.extent()),
        };
        view.opacity = look.optical_depth.map_or(depth, |given| given as f32 / longest(grid.extent()));
        let values: Vec<f64> = match &look.contours {
            Contours::Count(count) => (1..=*count).map(|k| f64::from(k) / f64::from(count + 1)).collect(),
            Contours::Values(values) => {
                let fraction = |value: &f64| ((value - range[0]) / (range[1] - range[0])).powf(view.contrast.into());
                values.iter().map(fraction).collect()
            }
        };
        let places = view.contours.as_flattened_mut();
        view.contour_count = values.len().min(places.len()) as u32;
        for (place, value) in places.iter_mut().zip(values) {
            *place = value as f32;
        }
    }

    /// Colours and opacities for a range.
    fn tables(
        &self,
        look: &RenderSettings,
        field: Field,
        range: [f64; 2],
        colors: &[glam::Vec3],
        particles: &[glam::Vec3],
    ) -> transfer::Tables {
        let ambient = &self.scene.gas.ambient;
        let neutral = match field {
            Field::Density => ambient.density,
            Field::Pressure | Field::PeakPressure => ambient.pressure,
            Field::Temperature => ambient.pressure / ambient.density,
            Field::Entropy => quantity::entropy(ambient, self.scene.gas.gamma),
            Field::Owed | Field::Impulse | Field::PeakPlasticStrain | Field::MassFraction | Field::Dust => 0.0,
            Field::Velocity | Field::Schlieren | Field::Mach | Field::Vorticity => range[0],
        };
        let neutral = ((neutral - range[0]) / (range[1] - range[0])).clamp(0.0, 1.0) as f32;
        let opacity = |fraction: f32| match &look.opacity[..] {
            [] => transfer::contrast(neutral, fraction),
            points => transfer::curve(points, fraction),
        };
        let strength = look.emission.map_or(0.0, |emission| emission.strength);
        transfer::Tables::new(colors, opacity, strength, particles)
    }

    /// Pixels per metre, where the whole picture has one scale and its bar is wanted.
    fn scale(&self, look: &RenderSettings, layout: &Layout, time: f64) -> Option<f64> {
        let eye = self.eye(look, time);
        (look.overlays.scale_bar && eye.parallel)
            .then(|| f64::from(layout.plot.height) / (2.0 * f64::from(eye.half_height)))
    }

    fn stamp(&self, look: &RenderSettings, time: f64) -> Stamp<'_> {
        let overlays = look.overlays;
        Stamp { title: overlays.title.then_some(&self.scene.title), time: overlays.time.then_some(time) }
    }

    /// The line plot of a one-dimensional state.
    fn draw_lines(&self, look: &RenderSettings, time: f64) -> Result<Picture> {
        let line = self.read_line(look, time)?;
        let frame = plot::draw(&line, look, &self.stamp(look, time));
        Ok(Picture { name: "lines".to_owned(), range: line.range(0), ..plane::flat(frame, self.depth) })
    }

    fn read_line(&self, look: &RenderSettings, time: f64) -> Result<plot::Line> {
        lines::read(&self.gpu, &self.sources, &self.scene, look.size[0], time)
    }
}

fn longest(extent: [f32; 3]) -> f32 {
    glam::Vec3::from(extent).max_element()
}
