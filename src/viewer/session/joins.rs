//! Bodies that join the scene while it is at work, and that go where it goes back to a time before.

use std::sync::Arc;

use glam::DVec3;

use super::Session;
use crate::diagnostics::StepRecord;
use crate::expect::Budget;
use crate::render::Renderer;
use crate::scene::{Body, Material, Scene};
use crate::simulation::{Places, Simulation};
use crate::state::MemoryPlan;
use crate::viewer::adding::Addition;
use crate::viewer::model::Look;
use crate::viewer::pick;
use crate::{Error, Result};

/// Part of a cell by which a body is taken back along the line of sight until it finds room.
const BACK: f64 = 0.5;

/// A body that has joined.
#[derive(Debug)]
struct Join {
    body: Body,
    /// The material that it has brought along.
    material: Option<(String, Material)>,
    /// What the budgets of the start change by, because it is there and the gas that it covers is not.
    shift: Budget,
}

/// Those that have joined in the order in which they did, and how many of them are in the scene now.
#[derive(Debug, Default)]
pub(super) struct Joins {
    list: Vec<Join>,
    now: usize,
}

impl Joins {
    /// How many are in the scene now.
    pub(super) fn now(&self) -> usize {
        self.now
    }
}

impl Session {
    /// Adds a body where a place of the picture is, at rest; its name, and its middle \[m\]. In 3D it comes to lie before what is seen there.
    ///
    /// # Errors
    /// [`Error::Usage`] if the place is beside the domain or there is no room for the body; what the device reports.
    pub fn add(
        &mut self,
        at: [f64; 2],
        addition: &Addition,
        look: &Look,
        records: &mut Vec<StepRecord>,
    ) -> Result<(String, [f64; 3])> {
        self.whole()?;
        let before = records.len();
        self.simulation.settle(records)?;
        self.note(&records[before..]);
        let place = self.place_for(at, addition, look)?;
        let to = addition.joined_to(&self.scene, place)?;
        MemoryPlan::fitting(&to, self.simulation.gpu()).map_err(|error| refused(&error))?;
        let other = self.simulation.joined(&self.scene, &to, records)?;
        let stored = self.summary.stored_energy();
        let was = Budget::read(&self.simulation, &self.scene, stored)?;
        let shift = Budget::read(&other, &to, stored)?.over(&was);
        let renderer = Renderer::of(&other, &to)?;

        self.keep_before(records)?;
        let body = to.bodies[to.bodies.len() - 1].clone();
        let name = body.name.clone();
        let brought = (!self.scene.materials.contains_key(&body.material)).then(|| body.material.clone());
        let material = brought.and_then(|name| Some((name.clone(), to.materials.get(&name)?.clone())));
        self.joins.list.push(Join { body, material, shift });
        self.joins.now += 1;
        self.start = self.start.plus(&shift, 1.0);
        self.replace(other, renderer, to);
        self.touched = true;
        Ok((name, place))
    }

    /// Where the middle of a body comes to lie \[m\].
    fn place_for(&self, at: [f64; 2], addition: &Addition, look: &Look) -> Result<[f64; 3]> {
        let (ray, grid) = (self.ray(at, look), self.simulation.state.grid);
        let particles = if grid.dimension == 3 { self.seen()? } else { Vec::new() };
        let beside = || Error::Usage("the click is beside the domain; nothing was added".to_owned());
        let mut place = DVec3::from(pick::point(&ray, &grid, &particles).ok_or_else(beside)?);
        if grid.dimension < 3 {
            return Ok(place.into());
        }
        let places = Places::of(grid, &particles);
        let back = -BACK * f64::from(grid.spacing) * DVec3::from(ray.direction).normalize();
        let tries = (2.0 * addition.reach() / back.length()) as u32;
        let mut seeds = addition.seeds(&self.scene, place.into())?;
        for _ in 0..tries {
            // those that are moved show where room may be; the place's own have the last word
            if places.taken(&seeds).is_none() {
                seeds = addition.seeds(&self.scene, place.into())?;
                if places.taken(&seeds).is_none() {
                    break;
                }
            }
            place += back;
            seeds.iter_mut().for_each(|seed| seed.position = (DVec3::from(seed.position) + back).into());
        }
        Ok(place.into())
    }

    /// Goes on with another simulation.
    fn replace(&mut self, simulation: Simulation, renderer: Renderer, scene: Scene) {
        (self.simulation, self.renderer) = (simulation, renderer);
        self.particles = self.simulation.state.particles.count.into();
        self.hidden.retain(|body| *body < scene.bodies.len());
        self.renderer.repaint(&scene, &self.hidden);
        self.scene = Arc::new(scene);
    }

    /// Has so many of the bodies that have joined, with the numbers that they have now.
    pub(super) fn be_joined_by(&mut self, count: usize) -> Result<()> {
        let now = self.joins.now;
        if count == now {
            return Ok(());
        }
        let mut scene = (*self.scene).clone();
        let own = scene.bodies.len() - now;
        for (join, body) in self.joins.list.iter_mut().zip(scene.bodies.drain(own..)) {
            join.body = body;
            if let Some((name, material)) = &mut join.material {
                *material = scene.materials.remove(name).unwrap_or_else(|| material.clone());
            }
        }
        for join in &self.joins.list[..count] {
            scene.bodies.push(join.body.clone());
            scene.materials.extend(join.material.clone());
        }
        let simulation = self.simulation.with_bodies_of(&scene)?;
        let renderer = Renderer::of(&simulation, &scene)?;
        for join in &self.joins.list[count.min(now)..count.max(now)] {
            self.start = self.start.plus(&join.shift, if count > now { 1.0 } else { -1.0 });
        }
        self.joins.now = count;
        self.replace(simulation, renderer, scene);
        Ok(())
    }

    /// From here the scene goes another way.
    pub(super) fn forget_later(&mut self) {
        self.past.forget_after(self.time());
        self.joins.list.truncate(self.joins.now);
    }
}

/// Why a body is not added; the scene goes on.
fn refused(error: &Error) -> Error {
    Error::Usage(format!("the body is not added, and the scene goes on without it: {error}"))
}
