//! The gas: conserved variables and the scratch space of advection and solve.

use super::{Grid, Openings, arrays};
use crate::error::Result;
use crate::gpu::{Buffer, Gpu, readback};
use crate::scene::{Conserved, NEVER, Scene};

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
    /// Energy that GAS cells owe \[J\], or that has crossed, per cell volume; further parts of a second gas.
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
        let parts = |array: &str| arrays::parts(array, scene);
        let (energy, work) = (parts("energy") * slots, parts("work") * slots);
        Ok(Self {
            conserved: Buffer::new(gpu, "conserved", slots)?,
            energy: Buffer::new(gpu, "energy", energy)?,
            work: Buffer::new(gpu, "work", work)?,
            owed_flow: Buffer::new(gpu, "owed_flow", ledger)?,
            owed_energy: Buffer::new(gpu, "owed_energy", parts("owed_energy") * ledger)?,
        })
    }
}

impl GasState {
    /// What is known of the second gas in each slot: density and volume fraction, of products also the density of explosive that has not burned.
    pub fn species_parts(&self, slots: usize) -> usize {
        match self.energy.len() {
            len if len > arrays::BURN_TIME * slots => 3,
            len if len > arrays::SPECIES_VOLUME * slots => 2,
            _ => 0,
        }
    }

    /// These parts, one after the other; empty without a second gas.
    ///
    /// # Errors
    /// Driver errors.
    pub fn read_species(&self, gpu: &Gpu, slots: usize) -> Result<Vec<f32>> {
        match self.species_parts(slots) {
            0 => Ok(Vec::new()),
            parts => readback::read_range(gpu, &self.energy, arrays::SPECIES_DENSITY * slots, parts * slots),
        }
    }

    /// Writes when each cell begins to burn, from [`Scene::burn_starts`], and that its explosive, of a density \[kg m^-3\], holds `full`
    /// energies of detonation; nothing without an explosive.
    pub(super) fn write_burn(&self, gpu: &Gpu, grid: &Grid, starts: &[Option<f32>], density: &[f32], full: f64) {
        if starts.is_empty() {
            return;
        }
        let (mut unburned, mut begin) = (vec![0.0; grid.slots()], vec![-NEVER; grid.slots()]);
        for (index, slot) in grid.unpadded_by(|slot| slot).into_iter().enumerate() {
            if let Some(start) = starts[index] {
                (unburned[slot], begin[slot]) = (full as f32 * density[slot], start);
            }
        }
        self.energy.write(gpu, arrays::UNBURNED * grid.slots(), &unburned);
        self.energy.write(gpu, arrays::BURN_TIME * grid.slots(), &begin);
    }

    /// Puts back what [`GasState::read_species`] has read.
    pub fn write_species(&self, gpu: &Gpu, slots: usize, species: &[f32]) {
        if !species.is_empty() {
            self.energy.write(gpu, arrays::SPECIES_DENSITY * slots, species);
        }
    }
}

/// What the second gas of a cell holds at the start, in energies of detonation: `full` of a charge, nothing elsewhere.
pub(super) fn held_at_start(starts: &[Option<f32>], index: usize, full: f64) -> f64 {
    if starts.get(index).is_some_and(Option::is_some) { full } else { 0.0 }
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

/// Where one gas has less than this share of the volume, the other counts as pure. Mirror of `shaders/shared/state.wgsl`.
const PURE: f64 = 1e-3;

/// Least p / rho^gamma of the gas of the start and of what may flow in, of the first gas and of the second; 0 without.
pub(super) fn start_entropy(scene: &Scene, start: &[Conserved], openings: &Openings) -> [f64; 2] {
    let gases = scene.gas.equation_of_state();
    let inside = start.iter().map(|state| (state[0], gases.pressure(*state, 0.0), state[6]));
    let beyond = openings.table.iter().map(|rule| (rule.flow[0], rule.pressure, rule.species_volume));
    let later = openings.table.iter().flat_map(|rule| {
        let knots = openings.knots.iter().skip(rule.first as usize).take(rule.knots as usize);
        knots.map(|knot| (knot.density, knot.pressure, rule.species_volume))
    });
    let wide = |(density, pressure, phi): (f32, f32, f32)| (density.into(), pressure.into(), phi.into());
    let mut least = [f64::INFINITY; 2];
    for (density, pressure, phi) in inside.chain(beyond.chain(later).map(wide)) {
        let gas = usize::from(phi > 0.5);
        if gas == 1 && gases.products().is_some() {
            continue; // the floor knows ideal gases
        }
        if density > 0.0 && pressure > 0.0 && f64::min(phi, 1.0 - phi) < PURE {
            let gamma = gases.gamma_at(gas as f64);
            least[gas] = least[gas].min(pressure / f64::powf(density, gamma));
        }
    }
    least.map(|least| if least.is_finite() { least } else { 0.0 })
}

/// p / rho^gamma that no gas falls below, of both gases, from the least of the start.
pub(super) fn least_entropies(scene: &Scene, start: [f64; 2]) -> [f32; 2] {
    let share = if scene.bodies.is_empty() { ENTROPY_SHARE_ALONE } else { ENTROPY_SHARE };
    start.map(|start| (share * start) as f32)
}

/// Maps of the start: the pressure of the gas.
pub(super) fn first_maps(conserved: &[[f32; 4]], pressure: &[f32]) -> Vec<[f32; 4]> {
    let own = |([density, ..], pressure): (&[f32; 4], &f32)| if *density > 0.0 { *pressure } else { 0.0 };
    conserved.iter().zip(pressure).map(|state| [own(state), 0.0, 0.0, 0.0]).collect()
}
