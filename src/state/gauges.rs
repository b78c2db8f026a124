//! Points of bodies that gauges are fixed to: the particles there, and their latest states.

use glam::DVec3;

use super::{HISTORY, ParticleStart};
use crate::error::Result;
use crate::gpu::{Buffer, Gpu};
use crate::scene::{GaugePlace, Scene};

/// vec4 entries of a point in its history ring: position, velocity, affine matrix, deformation, stress. Mirror of `shaders/step/gauges.wgsl`.
pub const GAUGE_WIDTH: u32 = 10;

/// Buffers of the points.
#[derive(Debug)]
pub struct GaugeBuffers {
    /// Particle of each point.
    pub particles: Buffer<u32>,
    /// States of the latest steps.
    pub history: Buffer<[f32; 4]>,
    /// Where the particles were at the start, in the device's coordinates \[m\].
    pub start: Vec<[f32; 3]>,
}

/// Points that have gauges: body and place \[m\].
fn points(scene: &Scene) -> Vec<(usize, [f64; 3])> {
    let point = |place| if let GaugePlace::Point(body, point) = place { Some((body, point)) } else { None };
    scene.gauge_places().into_iter().filter_map(point).collect()
}

/// How many points have gauges.
pub fn count(scene: &Scene) -> usize {
    points(scene).len()
}

impl GaugeBuffers {
    /// Finds the particles that are nearest to the points at the start.
    ///
    /// # Errors
    /// If the device has no room.
    pub fn new(gpu: &Gpu, scene: &Scene, start: &ParticleStart) -> Result<Self> {
        let ranges = start.ranges(scene.bodies.len());
        let nearest = |(body, point): (usize, [f32; 3])| {
            let distance = |particle: &u32| -> f64 {
                let arm =
                    DVec3::from(start.place(*particle as usize).map(f64::from)) - DVec3::from(point.map(f64::from));
                arm.length_squared()
            };
            ranges[body].clone().min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        // a body without particles has no point
        let particles: Vec<u32> = points(scene)
            .into_iter()
            .map(|(body, point)| nearest((body, scene.domain.in_frame(point))).unwrap_or(u32::MAX))
            .collect();
        let place = |particle: &u32| if *particle == u32::MAX { [0.0; 3] } else { start.place(*particle as usize) };
        Ok(Self {
            start: particles.iter().map(place).collect(),
            history: Buffer::new(gpu, "gauge_history", (GAUGE_WIDTH * HISTORY) as usize * particles.len())?,
            particles: Buffer::from_slice(gpu, "gauge_particles", &particles)?,
        })
    }
}
