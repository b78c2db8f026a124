//! The gas: conserved variables and the scratch space of advection and solve.

use super::{Grid, Openings, arrays};
use crate::error::Result;
use crate::gpu::{Buffer, Gpu};
use crate::scene::Scene;

/// Buffers of the gas, in padded slots.
#[derive(Debug)]
pub struct GasState {
    /// Density and momentum. What each array holds, part by part: [`arrays`].
    pub conserved: Buffer<[f32; 4]>,
    /// Total energy per volume, and further parts.
    pub energy: Buffer<f32>,
    /// What stages of a step hand on: parts of a vec4.
    pub work: Buffer<[f32; 4]>,
    /// Gas that GAS cells owe: mass and momentum \[kg\], \[kg m s^-1\]; in GHOST and WALL slots what has crossed the boundary, per cell volume.
    /// Without bodies and obstacles only the slots of the ring have a place, in their order (`shaders/shared/domain.wgsl`).
    pub owed_flow: Buffer<[f32; 4]>,
    /// Energy that GAS cells owe \[J\], or that has crossed, per cell volume.
    pub owed_energy: Buffer<f32>,
}

impl GasState {
    /// Allocates for a scene with so many particles.
    ///
    /// # Errors
    /// If the device has no room.
    pub fn new(gpu: &Gpu, scene: &Scene, grid: &Grid, particles: usize) -> Result<Self> {
        let slots = grid.slots();
        let ledger = if ring_ledger(scene, particles > 0) { slots - grid.cell_count() } else { slots };
        let parts = |array: &str| arrays::parts(array, scene.solves() == 2) * slots;
        Ok(Self {
            conserved: Buffer::new(gpu, "conserved", slots)?,
            energy: Buffer::new(gpu, "energy", parts("energy"))?,
            work: Buffer::new(gpu, "work", parts("work"))?,
            owed_flow: Buffer::new(gpu, "owed_flow", ledger)?,
            owed_energy: Buffer::new(gpu, "owed_energy", ledger)?,
        })
    }
}

/// Whether only the ring has a ledger: without bodies and obstacles nothing else collects gas.
pub(super) fn ring_ledger(scene: &Scene, solids: bool) -> bool {
    !solids && scene.obstacles.is_empty()
}

/// Share of the least entropy of the start and of what flows in that gas must keep: no process lowers p / rho^gamma
/// [minimum entropy principle: Tadmor 1986], but a scheme of high order may, by a little, at jumps.
const ENTROPY_SHARE: f64 = 0.9;
/// The same in gas alone: there thin cells at corners pay for the work of dense ones.
const ENTROPY_SHARE_ALONE: f64 = 0.1;

/// Least p / rho^gamma of the gas of the start `[density, momentum, energy]` and of what may flow in; 0 without gas.
pub(super) fn start_entropy(scene: &Scene, start: &[[f64; 5]], openings: &Openings) -> f64 {
    let gamma = scene.gas.gamma;
    let inside = start
        .iter()
        .map(|[density, x, y, z, total]| (*density, (gamma - 1.0) * (total - 0.5 * (x * x + y * y + z * z) / density)));
    let beyond = openings.table.iter().map(|rule| (rule.flow[0], rule.pressure));
    let later = openings.knots.iter().map(|knot| (knot.density, knot.pressure));
    let states = inside.chain(beyond.chain(later).map(|(density, pressure)| (density.into(), pressure.into())));
    let physical = states.filter(|(density, pressure)| *density > 0.0 && *pressure > 0.0);
    let least =
        physical.map(|(density, pressure): (f64, f64)| pressure / density.powf(gamma)).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// p / rho^gamma that no gas falls below, from the least of the start.
pub(super) fn least_entropy(scene: &Scene, start: f64) -> f32 {
    let share = if scene.bodies.is_empty() { ENTROPY_SHARE_ALONE } else { ENTROPY_SHARE };
    (share * start) as f32
}

/// Maps of the start: the pressure of the gas.
pub(super) fn first_maps(conserved: &[[f32; 4]], energy: &[f32], gamma: f32) -> Vec<[f32; 4]> {
    let pressure = |([density, x, y, z], energy): (&[f32; 4], &f32)| {
        if *density > 0.0 { (gamma - 1.0) * (energy - 0.5 * (x * x + y * y + z * z) / density) } else { 0.0 }
    };
    conserved.iter().zip(energy).map(|state| [pressure(state), 0.0, 0.0, 0.0]).collect()
}
