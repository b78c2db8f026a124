//! What the mouse does to a scene: it asks what lies somewhere, sets energy free, holds a body and lets it go.

use glam::DVec3;

use super::Session;
use crate::diagnostics::StepRecord;
use crate::gpu::readback;
use crate::render::Ray;
use crate::simulation::Blast;
use crate::snapshot::ParticleSample;
use crate::viewer::hold::Spring;
use crate::viewer::model::{Look, Source, Spot, Strike};
use crate::viewer::pick;
use crate::{Error, Result};

/// A body that the mouse holds.
#[derive(Debug)]
pub(super) struct Held {
    body: usize,
    /// The particle that it is held at, and where that was last \[m\].
    particle: usize,
    place: DVec3,
    /// Where it is to go \[m\], on the plane through its first place across the line of sight.
    target: DVec3,
    across: DVec3,
    spring: Spring,
    /// Up to when the spring has acted \[s\], and whether it has.
    since: f64,
    acted: bool,
}

impl Session {
    /// Sets energy free where a click on a picture of this look points; the place \[m\], and the energy \[J\] as it was.
    ///
    /// # Errors
    /// [`Error::Usage`] if the click misses the domain or its gas, or there is no room for the charge.
    pub fn strike(&mut self, strike: &Strike, look: &Look, records: &mut Vec<StepRecord>) -> Result<([f64; 3], f64)> {
        self.whole()?;
        let ray = self.ray(strike.at, look);
        let grid = self.simulation.state.grid;
        let particles = if grid.dimension == 3 { self.seen()? } else { Vec::new() };
        let center = pick::point(&ray, &grid, &particles)
            .ok_or_else(|| Error::Usage("the click is beside the domain; nothing was detonated".to_owned()))?;
        self.keep_before(records)?;
        let before = records.len();
        let energy = match strike.source {
            Source::Energy(energy, radius) => self.simulation.detonate(&Blast { center, radius, energy }, records)?,
            Source::Tnt(mass) => self.simulation.set_off(&self.scene.clicked(mass, center), records)?,
        };
        self.summary.add(&records[before..]);
        self.touched = true;
        Ok((center, energy))
    }

    /// Keeps the state before it is changed by hand, so that there is a way back to it.
    pub(super) fn keep_before(&mut self, records: &mut Vec<StepRecord>) -> Result<()> {
        let before = records.len();
        self.simulation.settle(records)?;
        self.note(&records[before..]);
        self.forget_later();
        if self.past.has(self.time(), self.step_count()) { Ok(()) } else { self.keep_this() }
    }

    /// Whether the state was changed by hand since the last step.
    pub fn is_touched(&self) -> bool {
        self.touched
    }

    /// The line of sight through a place of a picture, in shares of its width and height.
    pub(super) fn ray(&self, at: [f64; 2], look: &Look) -> Ray {
        let [width, height] = look.settings.size.map(f64::from);
        self.renderer.ray(&look.settings, self.time(), [at[0] * width, at[1] * height])
    }

    /// What lies at a place of the picture drawn last.
    ///
    /// # Errors
    /// What the device reports.
    pub fn spot(&self, at: [f64; 2], look: &Look) -> Result<Spot> {
        let (grid, particles) = (self.simulation.state.grid, self.seen()?);
        let Some(point) = pick::point(&self.ray(at, look), &grid, &particles) else {
            return Ok(Spot { at, point: Vec::new(), value: None, body: None });
        };
        let body =
            pick::particle(point, &grid, &particles).map(|one| self.scene.bodies[one.body as usize].name.clone());
        let value = if grid.dimension == 2 && body.is_none() { self.renderer.value_at(point)? } else { None };
        Ok(Spot { at, point: point[..grid.dimension as usize].to_vec(), value, body })
    }

    /// Holds the body that lies at a place of the picture; its name, none where there is no body.
    ///
    /// # Errors
    /// [`Error::Usage`] for a body that moves as the scene says; what the device reports.
    pub fn hold(&mut self, at: [f64; 2], look: &Look, records: &mut Vec<StepRecord>) -> Result<Option<String>> {
        self.held = None;
        let (grid, ray) = (self.simulation.state.grid, self.ray(at, look));
        let particles = self.seen()?;
        let point = pick::point(&ray, &grid, &particles);
        let Some(found) = point.and_then(|point| pick::particle(point, &grid, &particles)) else { return Ok(None) };
        let (body, particle) = (found.body as usize, found.index as usize);
        let place = DVec3::from(grid.in_scene(found.position));
        self.whole()?;
        self.keep_before(records)?;
        let name = self.scene.bodies[body].name.clone();
        if self.simulation.moving(body, records)?[3] <= 0.0 {
            return Err(Error::Usage(format!("`{name}` is held or moved as its scene says; it cannot be pushed")));
        }
        self.held = Some(Held {
            body,
            particle,
            place,
            target: place,
            across: ray.direction.into(),
            spring: Spring::of(&self.scene),
            since: self.time(),
            acted: false,
        });
        Ok(Some(name))
    }

    /// Where the body that is held is to go: below a place of the picture.
    pub fn lead(&mut self, at: [f64; 2], look: &Look) {
        let ray = self.ray(at, look);
        let Some(held) = &mut self.held else { return };
        let (origin, direction) = (DVec3::from(ray.origin), DVec3::from(ray.direction));
        let depth = (held.place - origin).dot(held.across) / direction.dot(held.across);
        if depth.is_finite() && depth > 0.0 {
            held.target = origin + depth * direction;
        }
    }

    /// Lets go of a body, which goes on as it moves. One that no step has moved is thrown: it gets the velocity with which it would follow.
    /// Returns the momentum \[kg m s^-1\] of that throw, if there is one.
    ///
    /// # Errors
    /// What the device reports.
    pub fn let_go(&mut self, records: &mut Vec<StepRecord>) -> Result<Option<[f64; 3]>> {
        let Some(held) = self.held.take() else { return Ok(None) };
        let change = held.spring.towards(held.target - held.place);
        if held.acted || change == DVec3::ZERO {
            return Ok(None);
        }
        let [x, y, z, _] = self.simulation.push(held.body, change.into(), records)?;
        self.touched = true;
        Ok(Some([x, y, z]))
    }

    /// The spring acts on the body that is held, for the time since it acted last.
    pub(super) fn pull(&mut self, records: &mut Vec<StepRecord>) -> Result<()> {
        let Some(mut held) = self.held.take() else { return Ok(()) };
        let [x, y, z, mass] = self.simulation.moving(held.body, records)?;
        let state = &self.simulation.state;
        let [px, py, pz, _] = readback::read_range(&state.gpu, &state.particles.position, held.particle, 1)?[0];
        held.place = DVec3::from(state.grid.in_scene([px, py, pz]));
        let time = self.simulation.time() - held.since;
        // what has left the domain is held no more
        if mass <= 0.0 || !held.place.is_finite() {
            return Ok(());
        }
        let velocity = DVec3::new(x, y, z) / mass;
        let mut change = held.spring.after(velocity, held.target - held.place, time) - velocity;
        for axis in state.grid.dimension as usize..3 {
            change[axis] = 0.0;
        }
        if time > 0.0 {
            self.simulation.push(held.body, change.into(), records)?;
            held.acted = true;
        }
        held.since = self.simulation.time();
        self.held = Some(held);
        Ok(())
    }

    /// The particles of bodies that are not hidden.
    pub(super) fn seen(&self) -> Result<Vec<ParticleSample>> {
        let mut particles = self.simulation.snapshot()?.particles;
        particles.retain(|particle| !self.hidden.contains(&(particle.body as usize)));
        Ok(particles)
    }

    /// Leaves bodies out of pictures.
    pub fn hide(&mut self, hidden: Vec<usize>) {
        self.renderer.repaint(&self.scene, &hidden);
        self.hidden = hidden;
    }

    /// Where the probes are, in shares of the picture's width and height.
    pub fn probes_at(&self, look: &Look) -> Vec<Option<[f64; 2]>> {
        self.scene.probes.iter().map(|probe| self.place_of(probe.position, look)).collect()
    }

    fn place_of(&self, point: [f64; 3], look: &Look) -> Option<[f64; 2]> {
        let [x, y] = self.renderer.place(&look.settings, self.time(), point)?;
        let [width, height] = look.settings.size.map(f64::from);
        Some([x / width, y / height])
    }

    /// Where the body that is held is held, in shares of the picture's width and height.
    pub fn held_at(&self, look: &Look) -> Option<[f64; 2]> {
        self.place_of(self.held.as_ref()?.place.into(), look)
    }
}
