//! The simulation's buffers, as the renderer reads them.

use crate::Result;
use crate::gpu::{Gpu, readback};
use crate::state::arrays::SPECIES_DENSITY;
use crate::state::{Grid, State};

/// The simulation's buffers, in the padded index space of [`Grid`].
#[derive(Debug, Clone, Copy)]
pub struct SceneBuffers<'a> {
    /// The grid of the cell arrays.
    pub grid: Grid,
    /// Density and momentum per volume, one vec4 per slot.
    pub conserved: &'a wgpu::Buffer,
    /// Total energy per volume, one f32 per slot.
    pub energy: &'a wgpu::Buffer,
    /// A buffer with the density of the second gas, one f32 per slot, then its volume fraction, and the word where they begin; nothing
    /// without one.
    pub species: Option<(&'a wgpu::Buffer, u32, usize)>,
    /// Mass and momentum owed, one vec4 per slot; nothing where only the ring has a ledger.
    pub owed: Option<&'a wgpu::Buffer>,
    /// Largest values so far, one vec4 per slot, see [`State::maps`]; nothing where no maps are kept.
    pub maps: Option<&'a wgpu::Buffer>,
    /// Dust, one f32 per slot; nothing without any.
    pub dust: Option<&'a wgpu::Buffer>,
    /// Cell words, one u32 per slot; bits 0 and 1 are the kind.
    pub cells: &'a wgpu::Buffer,
    /// The particles, if there are any.
    pub particles: Option<ParticleBuffers<'a>>,
}

/// The particles' buffers.
#[derive(Debug, Clone, Copy)]
pub struct ParticleBuffers<'a> {
    /// Number of particles.
    pub count: u32,
    /// Position and mass, one vec4 per particle.
    pub position: &'a wgpu::Buffer,
    /// Velocity and volume at rest, one vec4 per particle.
    pub velocity: &'a wgpu::Buffer,
    /// Affine velocity, three vec4 per particle; the second w is the plastic strain.
    pub affine: &'a wgpu::Buffer,
    /// Deformation gradient, three vec4 per particle; the first w holds the body, the second the active flag.
    pub deformation: &'a wgpu::Buffer,
    /// Kirchhoff stress times volume at rest, two vec4 per particle: xx, yy, zz; then xy, yz, zx.
    pub stress: &'a wgpu::Buffer,
}

impl<'a> SceneBuffers<'a> {
    /// The buffers of a simulation's state.
    #[must_use]
    pub fn of(state: &'a State) -> Self {
        let particles = &state.particles;
        Self {
            grid: state.grid,
            conserved: state.gas.conserved.raw(),
            energy: state.gas.energy.raw(),
            species: match state.gas.species_parts(state.grid.slots()) {
                0 => None,
                parts => Some((state.gas.energy.raw(), (SPECIES_DENSITY * state.grid.slots()) as u32, parts)),
            },
            owed: (state.gas.owed_flow.len() == state.grid.slots()).then(|| state.gas.owed_flow.raw()),
            maps: (!state.maps.is_empty()).then(|| state.maps.raw()),
            dust: (!state.dust.is_empty()).then(|| state.dust.raw()),
            cells: state.interface.cells.raw(),
            particles: state.has_solids().then(|| ParticleBuffers {
                count: particles.count,
                position: particles.position.raw(),
                velocity: particles.velocity.raw(),
                affine: particles.affine.raw(),
                deformation: particles.deformation.raw(),
                stress: particles.stress.raw(),
            }),
        }
    }
}

/// Handles of the same buffers that live as long as the renderer.
#[derive(Debug, Clone)]
pub(super) struct Sources {
    pub(super) grid: Grid,
    pub(super) conserved: wgpu::Buffer,
    pub(super) energy: wgpu::Buffer,
    pub(super) species: Option<(wgpu::Buffer, u32, usize)>,
    pub(super) owed: Option<wgpu::Buffer>,
    pub(super) maps: Option<wgpu::Buffer>,
    pub(super) dust: Option<wgpu::Buffer>,
    pub(super) cells: wgpu::Buffer,
    pub(super) particles: Option<ParticleSources>,
}

/// Handles of the particles' buffers.
#[derive(Debug, Clone)]
pub(super) struct ParticleSources {
    pub(super) count: u32,
    pub(super) position: wgpu::Buffer,
    pub(super) velocity: wgpu::Buffer,
    pub(super) affine: wgpu::Buffer,
    pub(super) deformation: wgpu::Buffer,
    pub(super) stress: wgpu::Buffer,
}

impl From<&SceneBuffers<'_>> for Sources {
    fn from(buffers: &SceneBuffers<'_>) -> Self {
        let particles = buffers.particles.filter(|own| own.count > 0).map(|own| ParticleSources {
            count: own.count,
            position: own.position.clone(),
            velocity: own.velocity.clone(),
            affine: own.affine.clone(),
            deformation: own.deformation.clone(),
            stress: own.stress.clone(),
        });
        Self {
            grid: buffers.grid,
            conserved: buffers.conserved.clone(),
            energy: buffers.energy.clone(),
            species: buffers.species.map(|(buffer, start, parts)| (buffer.clone(), start, parts)),
            owed: buffers.owed.cloned(),
            maps: buffers.maps.cloned(),
            dust: buffers.dust.cloned(),
            cells: buffers.cells.clone(),
            particles,
        }
    }
}

/// What is known of the second gas in so many slots, part by part; empty without one.
pub(super) fn read_species(gpu: &Gpu, species: Option<(&wgpu::Buffer, u32, usize)>, slots: usize) -> Result<Vec<f32>> {
    let Some((buffer, start, parts)) = species else { return Ok(Vec::new()) };
    let bytes = readback::read_bytes(gpu, buffer, 4 * u64::from(start), 4 * (parts * slots) as u64)?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}
