//! The particles of the solids and the nodes they write to.

use crate::error::Result;
use crate::gpu::{Buffer, Gpu, readback};
use crate::material::{Laws, MaterialParams};
use crate::scene::Scene;

use super::State;

impl State {
    /// The laws of the materials, as the device has them now.
    ///
    /// # Errors
    /// Driver errors.
    pub(crate) fn laws(&self) -> Result<Laws> {
        let numbers: Vec<f32> = readback::read(&self.gpu, &self.materials)?;
        let width = size_of::<MaterialParams>() / size_of::<f32>();
        let materials = numbers.chunks_exact(width).map(|own| *bytemuck::from_bytes(bytemuck::cast_slice(own)));
        let shared = self.overrides.iter().any(|(name, value)| *name == "SHARED_VOLUME" && *value != 0.0);
        Ok(Laws { materials: materials.collect(), start: self.params.ambient_pressure.into(), shared })
    }
}

/// Buffers of the particles, structure of arrays.
#[derive(Debug)]
pub struct Particles {
    /// Number of particles.
    pub count: u32,
    /// Position \[m\] and mass \[kg\]: 0 once it has left the domain, negative once it was dropped as debris.
    pub position: Buffer<[f32; 4]>,
    /// Velocity \[m s^-1\] and volume at rest \[m^3\].
    pub velocity: Buffer<[f32; 4]>,
    /// Columns of the affine matrix \[s^-1\]; w: ghost pressure \[Pa\]; plastic strain, or what a broken one has opened by, as logarithm of a
    /// volume; material index in the low half, what scatters its strength above it, and in the highest bit whether it has crumbled.
    pub affine: Buffer<[f32; 4]>,
    /// Columns of the deformation gradient less the identity; w: body index, 1 while inside the domain or 2 if driven, damage.
    pub deformation: Buffer<[f32; 4]>,
    /// Kirchhoff stress times volume at rest \[J\]: xx, yy, zz; then xy, yz, zx. w: heat of plastic flow and
    /// cracks \[J\], driver of fracture \[Pa\].
    pub stress: Buffer<[f32; 4]>,
    /// Particle indices, cell by cell.
    pub order: Buffer<u32>,
    /// First entry of each slot in `order`, and the end.
    pub cell_start: Buffer<u32>,
    /// Velocity and mass of the grid nodes, padded slots.
    pub node: Buffer<[f32; 4]>,
    /// Mass that the pressure solve gives to the nodes \[kg\].
    pub inertia: Buffer<f32>,
    /// What the pressure solve is told of elasticity, see `shaders/solid/elastic_reaction.wgsl`.
    pub elastic: Buffer<[f32; 4]>,
}

/// Host arrays of the particles at the start.
#[derive(Debug, Default)]
pub struct ParticleStart {
    position: Vec<[f32; 4]>,
    velocity: Vec<[f32; 4]>,
    affine: Vec<[f32; 4]>,
    deformation: Vec<[f32; 4]>,
    /// Largest density \[kg m^-3\].
    pub max_density: f64,
}

impl ParticleStart {
    /// Seeds the bodies of a scene; the ghost pressure starts at the ambient pressure.
    pub fn new(scene: &Scene) -> Self {
        let mut start = Self::default();
        let bits = f32::from_bits;
        for seed in scene.seed_particles() {
            let [x, y, z] = scene.domain.in_frame(seed.position);
            let [u, v, w] = seed.velocity.map(|v| v as f32);
            start.position.push([x, y, z, (seed.density * seed.volume) as f32]);
            start.velocity.push([u, v, w, seed.volume as f32]);
            let broken = if seed.broken { 1.0 } else { 0.0 };
            let word = if seed.driven { 2.0 } else { 1.0 };
            let ghost = scene.gas.equation_of_state().pressure_in_single(&scene.gas.ambient);
            let [x, y, z] = seed.spin.map(|rate| rate as f32);
            let grows = [0, 1, 2].map(|d| if d < scene.domain.axes() { seed.expansion as f32 } else { 0.0 });
            start.affine.extend([
                [grows[0], z, -y, ghost],
                [-z, grows[1], x, 0.0],
                [y, -x, grows[2], bits(seed.material | strength_bits(seed.strength))],
            ]);
            start.deformation.extend([
                [0.0, 0.0, 0.0, bits(seed.body)],
                [0.0, 0.0, 0.0, word],
                [0.0, 0.0, 0.0, broken],
            ]);
            start.max_density = start.max_density.max(seed.density);
        }
        start
    }

    /// Where a particle is at the start, in the device's coordinates \[m\].
    pub(super) fn place(&self, particle: usize) -> [f32; 3] {
        let [x, y, z, _] = self.position[particle];
        [x, y, z]
    }

    /// Particles of each body: they stay together.
    pub(super) fn ranges(&self, bodies: usize) -> Vec<std::ops::Range<u32>> {
        let of = |column: &[f32; 4]| column[3].to_bits() as usize;
        let mut count = vec![0; bodies];
        self.deformation.iter().step_by(3).for_each(|column| count[of(column)] += 1);
        let start = |k: usize| count[..k].iter().sum::<u32>();
        (0..bodies).map(|k| start(k)..start(k + 1)).collect()
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether the scene has no bodies.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}

/// A factor of strength for the high half of a word: as a float no such word is a NaN, an infinity or below the normal numbers.
fn strength_bits(factor: f64) -> u32 {
    ((f64::from(STRENGTH_UNIT) * factor).round() as u32) << 16
}

/// Units of that factor in one, as in `shaders/materials/stress.wgsl`.
pub(super) const STRENGTH_UNIT: u32 = 8192;

impl Particles {
    /// Allocates and uploads. `carrier`: gas without bodies also wants room per slot in `node`; `elastic`: vectors per slot
    /// that the order of the elastic step wants.
    ///
    /// # Errors
    /// If the device has no room.
    pub fn new(gpu: &Gpu, slots: usize, start: &ParticleStart, carrier: bool, elastic: usize) -> Result<Self> {
        let count = start.len();
        let solid_slots = if start.is_empty() { 1 } else { slots };
        let particles = Self {
            count: count as u32,
            position: Buffer::from_slice(gpu, "position", &start.position)?,
            velocity: Buffer::from_slice(gpu, "velocity", &start.velocity)?,
            affine: Buffer::from_slice(gpu, "affine", &start.affine)?,
            deformation: Buffer::from_slice(gpu, "deformation", &start.deformation)?,
            stress: Buffer::new(gpu, "stress", 2 * count)?,
            order: Buffer::new(gpu, "order", count)?,
            cell_start: Buffer::new(gpu, "cell_start", solid_slots + 1)?,
            node: Buffer::new(gpu, "node", if carrier { slots } else { solid_slots })?,
            inertia: Buffer::new(gpu, "inertia", solid_slots)?,
            elastic: Buffer::new(gpu, "elastic", if count == 0 { 0 } else { elastic * slots })?,
        };
        Ok(particles)
    }
}
