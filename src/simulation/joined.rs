//! A body joins a simulation at work: what there is goes on from where it is, and the gas that the body covers goes.

use std::collections::{BTreeMap, HashMap};

use super::{Saved, SavedArray, Simulation};
use crate::diagnostics::StepRecord;
use crate::error::{Error, Result};
use crate::gpu::{Pass, readback};
use crate::scene::{Scene, Seed};
use crate::snapshot::{ParticleSample, kind};
use crate::state::{Grid, arrays};

/// Buffers that follow from the particles there are, or from the first marks.
const OWN: [&str; 3] = ["extents", "order", "cell_start"];
/// Buffers that a simulation of gas alone has in common with one of bodies.
const OF_GAS: [&str; 7] = ["control", "openings", "supports", "history", "maps", "dust", "pressure"];
/// Buffers of particles: those of a body that has joined stand behind the others.
const OF_PARTICLES: [&str; 5] = ["position", "velocity", "affine", "deformation", "stress"];
/// Parts of `energy` that carry the state.
const PARTS: [usize; 5] = [0, arrays::SPECIES_DENSITY, arrays::SPECIES_VOLUME, arrays::UNBURNED, arrays::BURN_TIME];
/// Words of a particle's row of `affine`, and where among them its material stands, in the low half.
const AFFINE: (usize, usize) = (12, 11);
/// Two particles are in each other's place where they are nearer than this part of their mean edge.
const NEAREST: f64 = 0.7;

impl Simulation {
    /// A simulation of `to`, which has one more body than `now`, the scene of this one as it is: it goes on from this state.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no room for the body; those of [`Simulation::new`]; driver errors.
    pub fn joined(&mut self, now: &Scene, to: &Scene, records: &mut Vec<StepRecord>) -> Result<Simulation> {
        self.settle(records)?;
        let last = to.bodies.len() - 1;
        let seeds: Vec<Seed> = to.seed_particles_of(last).collect();
        self.room_for(now, to, &seeds)?;
        let saved = self.save()?;
        let mut other = Simulation::new(&self.gpu, to)?;
        if other.state.particles.count as usize != self.state.particles.count as usize + seeds.len() {
            return Err(Error::Usage("the bodies of the scene have other particles than at its start".to_owned()));
        }
        other.take_rows(&saved, &materials_of(now, to))?;
        let was = array(&saved, "cells").map_or(&[][..], |array| &array.words);
        let mut covered = other.cover(self.state.particles.count as usize)?;
        covered.retain(|slot, _| was[*slot] & u32::from(kind::MASK) == u32::from(kind::GAS));
        other.take_state(&saved, &covered)?;
        other.take_host(self, to, &saved, &covered);
        other.gpu.check()?;
        Ok(other)
    }

    /// A simulation of `to`, the scene of this one with fewer or more bodies that have joined; it has the state of its start.
    ///
    /// # Errors
    /// Those of [`Simulation::new`].
    pub fn with_bodies_of(&self, to: &Scene) -> Result<Simulation> {
        let mut other = Simulation::new(&self.gpu, to)?;
        let heavier = self.by_hand.densities.iter().filter(|(body, _)| **body < to.bodies.len());
        other.by_hand.densities = heavier.map(|(body, density)| (*body, *density)).collect();
        Ok(other)
    }

    /// Whether the last body of a scene finds room among obstacles and particles.
    fn room_for(&self, now: &Scene, to: &Scene, seeds: &[Seed]) -> Result<()> {
        let name = to.bodies.last().map_or("", |body| body.name.as_str());
        if now.bodies.is_empty() && !now.obstacles.is_empty() {
            let text = "gas alone keeps the cells that obstacles cut in another way than gas with bodies; add one to the scene file";
            return Err(Error::Usage(format!("`{name}` cannot join this scene: {text}")));
        }
        if seeds.is_empty() {
            let text = "no particle of it is inside the domain: it is too small, or lies outside or in an obstacle";
            return Err(Error::Usage(format!("`{name}` finds no place here: {text}")));
        }
        if let Some(overlap) = to.overlaps().into_iter().find(|overlap| overlap.body == name) {
            let text = format!("`{name}` finds no place here: {:.0} % of it lie in", 100.0 * overlap.share);
            return Err(Error::Usage(format!("{text} the obstacle `{}`", overlap.by)));
        }
        let particles = self.snapshot()?.particles;
        let taken = Places::of(self.state.grid, &particles).taken(seeds);
        match taken.and_then(|body| now.bodies.get(body)) {
            Some(body) => Err(Error::Usage(format!("`{name}` finds no place here: `{}` is there", body.name))),
            None => Ok(()),
        }
    }

    /// Writes the rows of the particles that there were.
    fn take_rows(&self, saved: &Saved, materials: &[u32]) -> Result<()> {
        for (name, buffer) in self.carried() {
            let Some(array) = array(saved, &name).filter(|_| OF_PARTICLES.contains(&name.as_str())) else { continue };
            let mut words = array.words.clone();
            if name == "affine" {
                for own in words.iter_mut().skip(AFFINE.1).step_by(AFFINE.0) {
                    let material = materials.get((*own & 0xffff) as usize).copied().unwrap_or_default();
                    *own = (*own & 0xffff_0000) | material;
                }
            }
            if !words.is_empty() {
                self.gpu.queue.write_buffer(&buffer.raw, 0, bytemuck::cast_slice(&words));
            }
        }
        self.gpu.check()
    }

    /// Marks what the particles cover from a number on; the words of the slots that were gas.
    fn cover(&self, first: usize) -> Result<BTreeMap<usize, u32>> {
        let (gpu, state) = (&self.gpu, &self.state);
        let mut pass = Pass::new(gpu, "start");
        if let Some(particle_sort) = &self.particle_sort {
            particle_sort.record(&mut pass, state);
        }
        self.interface.record_start(&mut pass, state);
        pass.submit()?;
        let words: Vec<u32> = readback::read(gpu, &state.interface.cells)?;
        let places = readback::read(gpu, &state.particles.position)?;
        let (grid, solid) = (&state.grid, u32::from(kind::SOLID));
        let slots = places[first..].iter().map(|place| grid.slot(cell_of(grid, *place)));
        let covered = slots.filter(|slot| words[*slot] & u32::from(kind::MASK) == solid);
        // covered before, too: the ledger has nothing to do
        Ok(covered.map(|slot| (slot, (words[slot] & !(3 << 2)) | (solid << 2))).collect())
    }

    /// Writes the state that there was, but for what the new particles cover.
    fn take_state(&self, saved: &Saved, covered: &BTreeMap<usize, u32>) -> Result<()> {
        let slots = self.state.grid.slots();
        let alone = array(saved, "position").is_none_or(|array| array.words.is_empty());
        for (name, buffer) in self.carried() {
            let name = name.as_str();
            let Some(array) = array(saved, name).filter(|_| !OWN.contains(&name) && !OF_PARTICLES.contains(&name))
            else {
                continue;
            };
            let mut words = array.words.clone();
            let length = buffer.bytes as usize / 4;
            match name {
                // of gas alone the marks of the ring are others
                "cells" if alone => continue,
                "cells" => covered.iter().for_each(|(slot, word)| words[*slot] = *word),
                "conserved" | "energy" | "owed_flow" | "owed_energy" => {
                    let width = if name.ends_with("flow") || name == "conserved" { 4 } else { 1 };
                    let own: Vec<u32> =
                        bytemuck::pod_collect_to_vec(&readback::read_bytes(&self.gpu, &buffer.raw, 0, buffer.bytes)?);
                    words = of_gas(name, words, own, (slots, width), &self.state.grid);
                    for part in words.chunks_exact_mut(width * slots) {
                        covered.keys().for_each(|slot| part[width * slot..width * (slot + 1)].fill(0));
                    }
                }
                "pressure" if words.len() != length => words.truncate(slots),
                _ if words.len() != length || (alone && !OF_GAS.contains(&name)) => continue,
                _ => {}
            }
            if !words.is_empty() {
                self.gpu.queue.write_buffer(&buffer.raw, 0, bytemuck::cast_slice(&words));
            }
        }
        self.gpu.check()
    }

    /// Takes what the host keeps.
    fn take_host(&mut self, from: &Simulation, to: &Scene, saved: &Saved, covered: &BTreeMap<usize, u32>) {
        let [bodies, ..] = from.state.load_count;
        let (own, added) = (&from.borne, self.borne.len() - from.borne.len());
        self.borne = [&own[..bodies], &vec![[0.0; 4]; added], &own[bodies..]].concat();
        (self.given, self.pulled, self.blasts) = (from.given, from.pulled, from.blasts);
        (self.released, self.target) = (from.released, from.target);
        (self.time, self.step, self.recorded) = (from.time, from.step, from.recorded);
        self.by_hand.densities.clone_from(&from.by_hand.densities);
        self.gas_before = from.gas_before;
        let volume = to.domain.cell_volume();
        let flow: &[u32] = array(saved, "conserved").map_or(&[], |array| &array.words);
        for slot in covered.keys() {
            for (axis, sum) in self.gas_before.iter_mut().enumerate() {
                *sum -= volume * f64::from(f32::from_bits(flow[4 * slot + 1 + axis]));
            }
        }
        self.state.keep_entropy(to, from.state.start_entropy);
        self.state.params_buffer.write(&self.gpu, 0, &[self.state.params]);
    }
}

fn array<'a>(saved: &'a Saved, name: &str) -> Option<&'a SavedArray> {
    saved.arrays.iter().find(|array| array.name == name)
}

/// Where the materials of a scene stand in another one that has them all.
fn materials_of(now: &Scene, to: &Scene) -> Vec<u32> {
    now.materials.keys().map(|name| to.material_index(name).unwrap_or_default()).collect()
}

/// The cell of a point of the device's coordinates.
fn cell_of(grid: &Grid, [x, y, z, _]: [f32; 4]) -> [i32; 3] {
    let place = [x, y, z];
    std::array::from_fn(|axis| {
        let at = ((place[axis] - grid.origin[axis]) / grid.spacing).floor() as i32;
        if axis < grid.dimension as usize { at.clamp(0, grid.cells[axis] as i32 - 1) } else { 0 }
    })
}

/// Words of an array of the gas in the form that a simulation with bodies has: of gas alone, whose ledger has the ring alone and whose
/// energies have fewer parts, the others stay its `own`.
fn of_gas(name: &str, words: Vec<u32>, own: Vec<u32>, (slots, width): (usize, usize), grid: &Grid) -> Vec<u32> {
    if words.len() == own.len() {
        return words;
    }
    let mut all = own;
    if name == "energy" {
        let common = words.len().min(all.len());
        for part in PARTS.map(|part| part * slots).into_iter().filter(|at| at + slots <= common) {
            all[part..part + slots].copy_from_slice(&words[part..part + slots]);
        }
        return all;
    }
    let ring = width * (slots - grid.cell_count());
    for (part, of_ring) in all.chunks_exact_mut(width * slots).zip(words.chunks_exact(ring)) {
        let outside = (0..slots).filter(|slot| {
            let cell = grid.cell(*slot as u32);
            (0..3).any(|axis| !(0..grid.cells[axis] as i32).contains(&cell[axis]))
        });
        for (slot, own) in outside.zip(of_ring.chunks_exact(width)) {
            part[width * slot..width * (slot + 1)].copy_from_slice(own);
        }
    }
    all
}

/// Where the particles of a scene are, cell by cell.
#[derive(Debug)]
pub struct Places<'p> {
    grid: Grid,
    near: HashMap<[i64; 3], Vec<(&'p ParticleSample, [f64; 3])>>,
}

impl<'p> Places<'p> {
    /// Those of some particles.
    #[must_use]
    pub fn of(grid: Grid, particles: &'p [ParticleSample]) -> Self {
        let mut places = Self { grid, near: HashMap::new() };
        for particle in particles {
            let place = grid.in_scene(particle.position);
            places.near.entry(places.key(place)).or_default().push((particle, place));
        }
        places
    }

    fn key(&self, point: [f64; 3]) -> [i64; 3] {
        point.map(|x| (x / f64::from(self.grid.spacing)).floor() as i64)
    }

    /// The body whose particles are where others are to be.
    #[must_use]
    pub fn taken(&self, seeds: &[Seed]) -> Option<usize> {
        let edge = |volume: f64| volume.powf(1.0 / f64::from(self.grid.dimension));
        let reach = |axis: u32| if axis < self.grid.dimension { -1..=1 } else { 0..=0 };
        let beside: Vec<[i64; 2]> = reach(2).flat_map(|z| reach(1).map(move |y| [y, z])).collect();
        seeds.iter().find_map(|seed| {
            let [x, y, z] = self.key(seed.position);
            let all = beside.iter().flat_map(|by| reach(0).map(move |dx| [x + dx, y + by[0], z + by[1]]));
            let mut close = all.filter_map(|at| self.near.get(&at)).flatten();
            close.find_map(|(particle, place)| {
                let away = (0..3).map(|d| (place[d] - seed.position[d]).powi(2)).sum::<f64>().sqrt();
                let mean = 0.5 * (edge(seed.volume) + edge(particle.volume0.into()));
                (away < NEAREST * mean).then_some(particle.body as usize)
            })
        })
    }
}
