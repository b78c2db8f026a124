//! Everything that draws in two and three dimensions, in order, and the frame around it.

use glam::Vec3;

use super::arrows;
use super::buffers::Sources;
use super::canvas::Canvas;
use super::frame::Frame;
use super::gas::Gas;
use super::light::{Distance, Light};
use super::overlay::{self, Layout};
use super::particles::Particles;
use super::screen::{Screen, Shared};
use super::transfer::Tables;
use super::{Stamp, View};
use crate::Result;
use crate::gpu::{Gpu, Pass};
use crate::scene::Scene;

/// Kernels and buffers of all parts of a picture.
#[derive(Debug)]
pub(super) struct Drawing {
    gas: Gas,
    particles: Option<Particles>,
    pub(super) distance: Distance,
    light: Light,
    screen: Option<Screen>,
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
}

impl Drawing {
    pub(super) fn new(gpu: &Gpu, scene: &Scene, sources: &Sources) -> Result<Self> {
        let gas = Gas::new(gpu, sources)?;
        let particles = Particles::new(gpu, sources, &gas)?;
        let distance = Distance::new(gpu, scene, &sources.grid)?;
        let light = Light::new(gpu, &gas, particles.as_ref(), &distance)?;
        Ok(Self { gas, particles, distance, light, screen: None })
    }

    /// Computes the view's field and the particles' quantity; returns least and largest value of both.
    pub(super) fn evaluate(&self, gpu: &Gpu, view: &View) -> Result<[[f64; 2]; 2]> {
        self.gas.view.write(gpu, 0, &[*view]);
        let mut pass = Pass::new(gpu, "picture field");
        self.gas.record_field(&mut pass);
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
        edges: bool,
    ) -> Result<(Vec<u32>, Vec<[f32; 4]>)> {
        let Self { gas, particles, distance, light, screen } = self;
        gas.view.write(gpu, 0, &[*view]);
        gas.set_tables(gpu, tables);
        let mut pass = Pass::new(gpu, "picture light");
        gas.record_packing(&mut pass, view);
        if let Some(particles) = particles.as_ref().filter(|_| view.particles > 0) {
            particles.record_paint(&mut pass);
        }
        light.record(&mut pass, view);
        pass.submit()?;
        let shared = Shared { gpu, sources, gas, particles: particles.as_ref(), light, distance };
        if screen.as_ref().is_none_or(|screen| !screen.fits(view)) {
            // The old one first: two at once may not fit.
            *screen = None;
            *screen = Some(Screen::new(&shared, view)?);
        }
        let screen = screen.as_ref().expect("made above");
        let velocities = arrows::sample(gpu, sources, gas, view.arrows)?;
        Ok((screen.draw(&shared, view, edges)?, velocities))
    }
}

/// Puts the plot's pixels on a frame and writes over and around them.
pub(super) fn compose(size: [u32; 2], layout: &Layout, pixels: &[u32], labels: &Labels, outlined: bool) -> Frame {
    let [width, height] = size;
    let mut frame = Frame::filled(width, height, overlay::BACKGROUND);
    let plot = layout.plot;
    for (row, line) in pixels.chunks_exact(plot.width as usize).enumerate() {
        let first = 4 * ((plot.y as usize + row) * width as usize + plot.x as usize);
        frame.rgba[first..first + 4 * line.len()].copy_from_slice(bytemuck::cast_slice(line));
    }
    let mut canvas = Canvas::new(&mut frame);
    if outlined {
        canvas.outline(plot, overlay::FAINT);
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
    frame
}
