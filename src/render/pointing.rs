//! What a hand wants of pictures: the line of sight through a place, where a point appears, bodies in other colours or not at all.

use glam::{DVec2, Vec2};

use super::{Ray, Renderer};
use crate::scene::{RenderSettings, Scene};

impl Renderer {
    /// The line of sight at a time \[s\] through a place of the picture, in pixels from the top left corner of the frame. In 2D it
    /// meets the plane of the domain at the point shown there.
    #[must_use]
    pub fn ray(&self, look: &RenderSettings, time: f64, pixel: [f64; 2]) -> Ray {
        let plot = self.layout(look).plot;
        let size = Vec2::new(plot.width as f32, plot.height as f32);
        let place = DVec2::from(pixel) - DVec2::new(plot.x.into(), plot.y.into());
        self.eye(look, time).ray(size, place.as_vec2())
    }

    /// Where a point \[m\] appears, in pixels from the top left corner of the frame; none for what lies behind the eye.
    #[must_use]
    pub fn place(&self, look: &RenderSettings, time: f64, point: [f64; 3]) -> Option<[f64; 2]> {
        let plot = self.layout(look).plot;
        let size = Vec2::new(plot.width as f32, plot.height as f32);
        let place = self.eye(look, time).place(size, point)?.as_dvec2();
        Some((place + DVec2::new(plot.x.into(), plot.y.into())).into())
    }

    /// Draws bodies in the colours that a scene gives them from now on, and leaves some out; gas does not flow into the gap.
    pub fn repaint(&mut self, scene: &Scene, hidden: &[usize]) {
        if let Some(particles) = self.drawing.as_ref().and_then(|drawing| drawing.particles.as_ref()) {
            particles.repaint(&self.gpu, scene, hidden);
        }
    }
}
