//! Everything that draws in two and three dimensions, in order, and the frame around it.

use glam::Vec3;

use super::arrows;
use super::buffers::Sources;
use super::canvas::Canvas;
use super::colormap::{linear_from_srgb, srgb_from_linear};
use super::frame::{Depth, Drawn, Frame, Picture};
use super::gas::Gas;
use super::layers::{LayerPixel, Layers};
use super::light::{Distance, Light};
use super::overlay::{self, Layout};
use super::particles::Particles;
use super::screen::{Screen, Shared};
use super::transfer::Tables;
use super::{Stamp, View};
use crate::gpu::{Gpu, Pass};
use crate::scene::{RenderSettings, Scene};
use crate::{Error, Result};

/// Sizes of pictures whose kernels and buffers are kept at most.
const MOST_SCREENS: usize = 6;

/// Kernels and buffers of all parts of a picture.
#[derive(Debug)]
pub(super) struct Drawing {
    pub(super) gas: Gas,
    pub(super) particles: Option<Particles>,
    pub(super) distance: Distance,
    light: Light,
    /// Of the pictures drawn last, the newest at the end.
    screens: Vec<Screen>,
    bodies: usize,
    /// As many as there are views, so that none is made anew for every frame.
    kept: usize,
}

/// How a picture is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) edges: bool,
    pub(super) depth: Depth,
    /// Asked before each part whether to stop.
    pub(super) stop: Option<fn() -> bool>,
}

impl Wanted {
    /// The error if the picture is not wanted any more.
    pub(super) fn go_on(self) -> Result<()> {
        if self.stop.is_some_and(|stop| stop()) { Err(Error::Interrupted) } else { Ok(()) }
    }
}

/// A colour bar: caption, colours, values at its ends, and the power that turns a fraction of them into a place in the colours.
pub(super) type Bar<'a> = (&'a str, &'a [Vec3], [f64; 2], f32);

/// What is written over and around a picture.
pub(super) struct Labels<'a> {
    pub(super) stamp: Stamp<'a>,
    /// Of the gas and of the particles; the layout says which are shown.
    pub(super) bars: [Bar<'a>; 2],
    /// Velocity arrows along x and y, and the velocities.
    pub(super) arrows: ([u32; 2], Vec<[f32; 4]>),
    /// Pixels per metre, if a scale bar is drawn.
    pub(super) scale: Option<f64>,
    /// Matrices of the camera.
    pub(super) camera: [[f32; 16]; 2],
}

impl Drawing {
    pub(super) fn new(gpu: &Gpu, scene: &Scene, sources: &Sources) -> Result<Self> {
        let kept = (1 + scene.render.views.len()).min(MOST_SCREENS);
        let gas = Gas::new(gpu, sources)?;
        let particles = Particles::new(gpu, scene, sources, &gas)?;
        let distance = Distance::new(gpu, scene, &sources.grid)?;
        let light = Light::new(gpu, &gas, particles.as_ref(), &distance)?;
        Ok(Self { gas, particles, distance, light, screens: Vec::new(), bodies: scene.bodies.len(), kept })
    }

    /// Computes the view's field and the particles' quantity; returns least and largest value of both.
    pub(super) fn evaluate(&self, gpu: &Gpu, view: &View) -> Result<[[f64; 2]; 2]> {
        self.gas.view.write(gpu, 0, &[*view]);
        let mut pass = Pass::new(gpu, "picture field");
        self.gas.record_field(&mut pass, view);
        let particles = self.particles.as_ref().filter(|_| view.particles > 0 && view.particle_color > 0);
        if let Some(particles) = particles {
            particles.record_quantity(&mut pass);
        }
        pass.submit()?;
        let of_particles = particles.map(|own| own.range(gpu)).transpose()?;
        Ok([self.gas.range(gpu)?, of_particles.unwrap_or([0.0, 1.0])])
    }

    /// Draws what was evaluated last: pixels of the plot, rows from the top, and the velocities of the arrows.
    pub(super) fn draw(
        &mut self,
        gpu: &Gpu,
        sources: &Sources,
        view: &mut View,
        tables: &Tables,
        wanted: Wanted,
    ) -> Result<(Drawn, Vec<[f32; 4]>)> {
        let Self { gas, particles, distance, light, screens, bodies, kept } = self;
        wanted.go_on()?;
        gas.view.write(gpu, 0, &[*view]);
        gas.set_tables(gpu, tables);
        let mut pass = Pass::new(gpu, "picture light");
        gas.record_packing(&mut pass, view);
        if let Some(particles) = particles.as_ref().filter(|_| view.particles > 0) {
            particles.record_paint(&mut pass);
        }
        light.record(&mut pass, view);
        pass.submit()?;
        let shared = Shared { gpu, sources, gas, particles: particles.as_ref(), light, distance, bodies: *bodies };
        match screens.iter().position(|screen| screen.fits(view, wanted.depth)) {
            Some(place) => screens[place..].rotate_left(1),
            None => {
                // Old ones first: one more than are kept may not fit.
                screens.drain(..(screens.len() + 1).saturating_sub(*kept));
                screens.push(Screen::new(&shared, view, wanted.depth)?);
            }
        }
        let screen = screens.last().expect("made or moved to the end above");
        let velocities = arrows::sample(gpu, sources, gas, view.arrows)?;
        Ok((screen.draw(&shared, view, wanted)?, velocities))
    }
}

/// Puts the plot's pixels on a frame and writes over and around them.
pub(super) fn compose(
    look: &RenderSettings,
    layout: &Layout,
    drawn: &Drawn,
    labels: &Labels,
    outlined: bool,
) -> Picture {
    let mut frame = Frame::blank(look);
    let plot = layout.plot;
    for (row, line) in drawn.pixels.chunks_exact(plot.width as usize).enumerate() {
        let first = 4 * ((plot.y as usize + row) * frame.width as usize + plot.x as usize);
        frame.rgba[first..first + 4 * line.len()].copy_from_slice(bytemuck::cast_slice(line));
    }
    let mut canvas = Canvas::new(&mut frame, look);
    if outlined {
        canvas.outline(plot, canvas.paper.faint);
    }
    let (count, velocities) = &labels.arrows;
    overlay::arrows(&mut canvas, plot, *count, velocities);
    if let Some(pixels_per_metre) = labels.scale {
        overlay::scale_bar(&mut canvas, plot, pixels_per_metre);
    }
    for (place, (caption, table, range, contrast)) in layout.bars.iter().zip(labels.bars) {
        if let Some(bar) = place {
            overlay::color_bar(&mut canvas, *bar, table, range, contrast, caption);
        }
    }
    overlay::header(&mut canvas, labels.stamp.title, labels.stamp.time);
    let depth = Depth { layers: false, fine: !drawn.toned.is_empty() };
    let mut picture = flat(frame, depth);
    if !drawn.layers.is_empty() {
        let (width, height) = (plot.width as u32, plot.height as u32);
        picture.layers = Layers { width, height, pixels: drawn.layers.clone(), camera: Some(labels.camera) };
    }
    let corner = [plot.x as usize, plot.y as usize];
    deepen(&mut picture, drawn, corner, plot.width as usize);
    picture
}

/// A picture that is known in 8 bits only.
pub(super) fn flat(frame: Frame, depth: Depth) -> Picture {
    let pixels = || frame.rgba.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]);
    let light = |value: u8| linear_from_srgb(f32::from(value) / 255.0);
    let mut layers = Layers::default();
    if depth.layers {
        layers.pixels = pixels().map(|pixel| LayerPixel::flat(pixel.map(light))).collect();
        (layers.width, layers.height) = (frame.width, frame.height);
    }
    let fine =
        if depth.fine { pixels().map(|pixel| pixel.map(|value| 257 * u16::from(value))).collect() } else { Vec::new() };
    Picture { frame, layers, fine, ..Picture::default() }
}

/// Puts the full depth of the plot where nothing was written over it.
fn deepen(picture: &mut Picture, drawn: &Drawn, corner: [usize; 2], width: usize) {
    let Picture { frame, fine, .. } = picture;
    for (i, pixel) in drawn.pixels.iter().enumerate() {
        let place = (corner[1] + i / width) * frame.width as usize + corner[0] + i % width;
        if frame.rgba[4 * place..4 * place + 4] != pixel.to_le_bytes() {
            continue;
        }
        if let Some([red, green, blue, _]) = drawn.toned.get(i) {
            fine[place] = [*red, *green, *blue].map(|light| (65535.0 * srgb_from_linear(light)).round() as u16);
        }
    }
}
