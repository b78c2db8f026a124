//! What pictures are drawn from, bit by bit on the host: read from a simulation, kept in files, and brought to a device again.

use bytemuck::cast_slice;
use rayon::prelude::*;

use super::buffers::{ParticleBuffers, SceneBuffers, read_species};
use crate::Result;
use crate::gpu::{Buffer, Gpu, readback};
use crate::snapshot::kind;
use crate::state::Grid;

/// The state at one time as pictures read it. Cell arrays hold the ring around the domain, see [`Grid`].
#[derive(Debug, Clone, PartialEq)]
pub struct Stored {
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// Density and momentum per volume.
    pub conserved: Vec<[f32; 4]>,
    /// Total energy per volume.
    pub energy: Vec<f32>,
    /// Density of the second gas of all slots, then its volume fraction; empty without one.
    pub species: Vec<f32>,
    /// Mass owed \[kg\]; empty where only the ring has a ledger.
    pub owed: Vec<f32>,
    /// Largest values so far, see [`crate::state::State::maps`]; empty where no maps are kept.
    pub maps: Vec<[f32; 4]>,
    /// Dust of all slots; empty without any.
    pub dust: Vec<f32>,
    /// Kind of each cell, see [`kind`].
    pub kind: Vec<u8>,
    /// The particles, if there are any.
    pub particles: Option<StoredParticles>,
}

/// The particles' arrays, as [`ParticleBuffers`] describes them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StoredParticles {
    /// Position and mass.
    pub position: Vec<[f32; 4]>,
    /// Velocity and volume at rest.
    pub velocity: Vec<[f32; 4]>,
    /// Affine velocity, three rows per particle.
    pub affine: Vec<[f32; 4]>,
    /// Deformation gradient less the identity, three columns per particle.
    pub deformation: Vec<[f32; 4]>,
    /// Kirchhoff stress times volume at rest, two rows per particle.
    pub stress: Vec<[f32; 4]>,
}

/// Rows of 16 bytes per particle in each of its arrays.
const ROWS: [usize; 5] = [1, 1, 3, 3, 2];

impl StoredParticles {
    /// The arrays by name.
    #[must_use]
    pub fn arrays(&self) -> [(&'static str, &Vec<[f32; 4]>); 5] {
        [
            ("position", &self.position),
            ("velocity", &self.velocity),
            ("affine", &self.affine),
            ("deformation", &self.deformation),
            ("stress", &self.stress),
        ]
    }

    /// From the arrays in the order of [`StoredParticles::arrays`].
    #[must_use]
    pub fn of([position, velocity, affine, deformation, stress]: [Vec<[f32; 4]>; 5]) -> Self {
        Self { position, velocity, affine, deformation, stress }
    }
}

impl Stored {
    /// Copies what pictures read from the device, at a time \[s\] after so many steps.
    ///
    /// # Errors
    /// Driver errors.
    pub fn read(gpu: &Gpu, buffers: &SceneBuffers, (time, step): (f64, u64)) -> Result<Self> {
        let slots = buffers.grid.slots();
        let words: Vec<u32> = elements(gpu, buffers.cells, slots)?;
        let particles = buffers.particles.filter(|own| own.count > 0).map(|own| {
            let all = [own.position, own.velocity, own.affine, own.deformation, own.stress];
            let mut arrays = [const { Vec::new() }; 5];
            for ((array, buffer), rows) in arrays.iter_mut().zip(all).zip(ROWS) {
                *array = elements(gpu, buffer, rows * own.count as usize)?;
            }
            Ok::<_, crate::Error>(StoredParticles::of(arrays))
        });
        Ok(Self {
            time,
            step,
            conserved: elements(gpu, buffers.conserved, slots)?,
            energy: elements(gpu, buffers.energy, slots)?,
            species: read_species(gpu, buffers.species, slots)?,
            owed: match buffers.owed {
                Some(owed) => elements::<[f32; 4]>(gpu, owed, slots)?.iter().map(|owed| owed[0]).collect(),
                None => Vec::new(),
            },
            maps: buffers.maps.map_or(Ok(Vec::new()), |maps| elements(gpu, maps, slots))?,
            dust: buffers.dust.map_or(Ok(Vec::new()), |dust| elements(gpu, dust, slots))?,
            kind: words.iter().map(|word| *word as u8 & kind::MASK).collect(),
            particles: particles.transpose()?,
        })
    }

    /// Puts the state into the buffers of a simulation, to draw it there; false, and nothing done, if sizes differ. The simulation cannot go
    /// on from it.
    #[must_use]
    pub fn write(&self, gpu: &Gpu, buffers: &SceneBuffers) -> bool {
        let count = self.particles.as_ref().map_or(0, |own| own.position.len() as u32);
        let other = buffers.particles.map_or(0, |own| own.count) != count
            || (buffers.maps.is_some() && self.maps.is_empty())
            || (buffers.dust.is_some() && self.dust.is_empty())
            || (buffers.owed.is_some() && self.owed.is_empty())
            || (buffers.species.is_some() && self.species.is_empty());
        if other || !self.fits(&buffers.grid) {
            return false;
        }
        let words: Vec<u32> = self.kind.iter().map(|kind| u32::from(*kind)).collect();
        let put = |buffer: &wgpu::Buffer, bytes: &[u8]| gpu.queue.write_buffer(buffer, 0, bytes);
        put(buffers.conserved, cast_slice(&self.conserved));
        put(buffers.energy, cast_slice(&self.energy));
        put(buffers.cells, cast_slice(&words));
        if let Some((buffer, start, _)) = buffers.species {
            gpu.queue.write_buffer(buffer, 4 * u64::from(start), cast_slice(&self.species));
        }
        buffers.owed.iter().for_each(|buffer| put(buffer, cast_slice(&self.owed_flow())));
        buffers.maps.iter().for_each(|buffer| put(buffer, cast_slice(&self.maps)));
        buffers.dust.iter().for_each(|buffer| put(buffer, cast_slice(&self.dust)));
        if let (Some(own), Some(stored)) = (buffers.particles, &self.particles) {
            let into = [own.position, own.velocity, own.affine, own.deformation, own.stress];
            into.iter().zip(stored.arrays()).for_each(|(buffer, (_, array))| put(buffer, cast_slice(array)));
        }
        true
    }

    /// What is owed as the device has it; pictures read the mass alone.
    fn owed_flow(&self) -> Vec<[f32; 4]> {
        self.owed.iter().map(|mass| [*mass, 0.0, 0.0, 0.0]).collect()
    }

    /// Whether all arrays have the lengths that belong to a grid.
    #[must_use]
    pub fn fits(&self, grid: &Grid) -> bool {
        self.wrong_length(grid).is_none()
    }

    /// The array whose length does not belong to a grid.
    #[must_use]
    pub fn wrong_length(&self, grid: &Grid) -> Option<&'static str> {
        self.wrong_cells(grid).or_else(|| self.wrong_particles())
    }

    /// The array of cells whose length does not belong to a grid.
    fn wrong_cells(&self, grid: &Grid) -> Option<&'static str> {
        let slots = grid.slots();
        let cells = [("conserved", self.conserved.len()), ("energy", self.energy.len()), ("kind", self.kind.len())];
        let optional = [("owed", self.owed.len()), ("maps", self.maps.len()), ("dust", self.dust.len())];
        let species = [0, 2 * slots, 3 * slots].contains(&self.species.len());
        let cells = cells.iter().find(|(_, len)| *len != slots);
        let optional = optional.iter().find(|(_, len)| ![0, slots].contains(len));
        cells.or(optional).map(|(name, _)| *name).or((!species).then_some("species"))
    }

    /// The array of particles that has not a row, or its rows, for each of them.
    #[must_use]
    pub fn wrong_particles(&self) -> Option<&'static str> {
        let own = self.particles.as_ref()?;
        let mut arrays = own.arrays().into_iter().zip(ROWS);
        arrays.find(|((_, array), rows)| array.len() != rows * own.position.len()).map(|((name, _), _)| name)
    }

    /// The array that holds something else than finite numbers where it has meaning: in gas, at particles, those inside the domain for what
    /// lies in several rows.
    #[must_use]
    pub fn not_finite(&self) -> Option<&'static str> {
        let finite = |row: &[f32; 4]| row.iter().all(|value| value.is_finite());
        let gas = |is: &(dyn Fn(usize) -> bool + Sync)| {
            self.kind.par_iter().enumerate().all(|(slot, cell)| *cell != kind::GAS || is(slot))
        };
        let particles = self.particles.as_ref();
        let rows =
            |rows: fn(&StoredParticles) -> &Vec<[f32; 4]>| particles.is_none_or(|own| rows(own).par_iter().all(finite));
        // the fourth numbers are bits of indices, too
        let inside = |rows: fn(&StoredParticles) -> &Vec<[f32; 4]>, each: usize| {
            let finite = |row: &[f32; 4]| row[..3].iter().all(|value| value.is_finite());
            particles.is_none_or(|own| {
                let all = rows(own).par_chunks(each).zip(own.deformation.par_chunks(3));
                all.all(|(own, about)| about.get(1).is_none_or(|row| row[3] <= 0.0) || own.iter().all(finite))
            })
        };
        let checks = [
            ("conserved", gas(&|slot| finite(&self.conserved[slot]))),
            ("energy", gas(&|slot| self.energy[slot].is_finite())),
            ("position", rows(|own| &own.position)),
            ("velocity", rows(|own| &own.velocity)),
            ("affine", inside(|own| &own.affine, 3)),
            ("deformation", inside(|own| &own.deformation, 3)),
            ("stress", inside(|own| &own.stress, 2)),
        ];
        checks.iter().find(|(_, finite)| !finite).map(|(name, _)| *name)
    }
}

/// A stored state on a device.
#[derive(Debug)]
pub struct Loaded {
    grid: Grid,
    conserved: Buffer<[f32; 4]>,
    energy: Buffer<f32>,
    species: Option<Buffer<f32>>,
    owed: Option<Buffer<[f32; 4]>>,
    maps: Option<Buffer<[f32; 4]>>,
    dust: Option<Buffer<f32>>,
    cells: Buffer<u32>,
    count: u32,
    particles: Option<[Buffer<[f32; 4]>; 5]>,
}

impl Loaded {
    /// Brings a state to the device; it must fit the grid, see [`Stored::fits`].
    ///
    /// # Errors
    /// If the device has no room.
    pub fn new(gpu: &Gpu, grid: Grid, stored: &Stored) -> Result<Self> {
        let words: Vec<u32> = stored.kind.iter().map(|kind| u32::from(*kind)).collect();
        let particles = stored.particles.as_ref().map(|own| {
            let [a, b, c, d, e] = own.arrays().map(|(name, array)| Buffer::from_slice(gpu, name, array));
            Ok::<_, crate::Error>([a?, b?, c?, d?, e?])
        });
        Ok(Self {
            grid,
            conserved: Buffer::from_slice(gpu, "conserved", &stored.conserved)?,
            energy: Buffer::from_slice(gpu, "energy", &stored.energy)?,
            species: match stored.species.is_empty() {
                true => None,
                false => Some(Buffer::from_slice(gpu, "species", &stored.species)?),
            },
            owed: match stored.owed.is_empty() {
                true => None,
                false => Some(Buffer::from_slice(gpu, "owed_flow", &stored.owed_flow())?),
            },
            maps: match stored.maps.is_empty() {
                true => None,
                false => Some(Buffer::from_slice(gpu, "maps", &stored.maps)?),
            },
            dust: match stored.dust.is_empty() {
                true => None,
                false => Some(Buffer::from_slice(gpu, "dust", &stored.dust)?),
            },
            cells: Buffer::from_slice(gpu, "cells", &words)?,
            count: stored.particles.as_ref().map_or(0, |own| own.position.len() as u32),
            particles: particles.transpose()?,
        })
    }

    /// The buffers as a renderer takes them.
    #[must_use]
    pub fn buffers(&self) -> SceneBuffers<'_> {
        let particles =
            self.particles.as_ref().map(|[position, velocity, affine, deformation, stress]| ParticleBuffers {
                count: self.count,
                position: position.raw(),
                velocity: velocity.raw(),
                affine: affine.raw(),
                deformation: deformation.raw(),
                stress: stress.raw(),
            });
        let (conserved, energy, cells) = (self.conserved.raw(), self.energy.raw(), self.cells.raw());
        let [owed, maps] = [&self.owed, &self.maps].map(|buffer| buffer.as_ref().map(Buffer::raw));
        let slots = self.grid.slots();
        let species = self.species.as_ref().map(|buffer| (buffer.raw(), 0, buffer.len() / slots));
        let dust = self.dust.as_ref().map(Buffer::raw);
        SceneBuffers { grid: self.grid, conserved, energy, species, owed, maps, dust, cells, particles }
    }

    /// Puts another state of the same scene into the same buffers; false, and nothing done, if its sizes differ.
    #[must_use]
    pub fn fill(&self, gpu: &Gpu, stored: &Stored) -> bool {
        let count = stored.particles.as_ref().map_or(0, |own| own.position.len() as u32);
        let other = stored.owed.is_empty() != self.owed.is_none()
            || stored.maps.is_empty() != self.maps.is_none()
            || stored.dust.is_empty() != self.dust.is_none()
            || stored.species.is_empty() != self.species.is_none();
        if !stored.fits(&self.grid) || count != self.count || other {
            return false;
        }
        let words: Vec<u32> = stored.kind.iter().map(|kind| u32::from(*kind)).collect();
        self.conserved.write(gpu, 0, &stored.conserved);
        self.energy.write(gpu, 0, &stored.energy);
        self.cells.write(gpu, 0, &words);
        if let Some(species) = &self.species {
            species.write(gpu, 0, &stored.species);
        }
        if let Some(owed) = &self.owed {
            owed.write(gpu, 0, &stored.owed_flow());
        }
        if let Some(maps) = &self.maps {
            maps.write(gpu, 0, &stored.maps);
        }
        if let Some(dust) = &self.dust {
            dust.write(gpu, 0, &stored.dust);
        }
        if let (Some(buffers), Some(own)) = (&self.particles, &stored.particles) {
            for (buffer, (_, array)) in buffers.iter().zip(own.arrays()) {
                buffer.write(gpu, 0, array);
            }
        }
        true
    }
}

/// The first elements of a buffer.
pub(super) fn elements<T: bytemuck::Pod>(gpu: &Gpu, buffer: &wgpu::Buffer, len: usize) -> Result<Vec<T>> {
    let bytes = readback::read_bytes(gpu, buffer, 0, (len * size_of::<T>()) as u64)?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one slot of gas and two particles, of which the second has left the domain.
    fn state() -> Stored {
        let mut particles = StoredParticles::of(ROWS.map(|rows| vec![[0.5; 4]; 2 * rows]));
        particles.deformation[4][3] = 0.0;
        Stored {
            time: 0.0,
            step: 0,
            conserved: vec![[1.0; 4]],
            energy: vec![1.0],
            species: Vec::new(),
            owed: Vec::new(),
            maps: Vec::new(),
            dust: Vec::new(),
            kind: vec![kind::GAS],
            particles: Some(particles),
        }
    }

    #[test]
    fn arrays_with_numbers_that_are_not_finite_are_named() {
        assert_eq!(state().not_finite(), None);
        let spoilt = |name: &str, row: usize| {
            let mut own = state().particles.unwrap();
            let arrays = [&mut own.position, &mut own.affine, &mut own.deformation, &mut own.stress];
            let at = ["position", "affine", "deformation", "stress"].iter().position(|own| *own == name).unwrap();
            arrays.into_iter().nth(at).unwrap()[row][2] = f32::NAN;
            Stored { particles: Some(own), ..state() }.not_finite()
        };
        for (name, row) in [("position", 0), ("affine", 2), ("deformation", 1), ("stress", 1)] {
            assert_eq!(spoilt(name, row), Some(name));
        }
        assert_eq!(spoilt("deformation", 5), None, "what has left is nowhere");
        assert_eq!(Stored { energy: vec![f32::NAN], ..state() }.not_finite(), Some("energy"));
    }
}
