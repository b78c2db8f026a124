//! Charges: when they go off, and how their near field takes the place of the gas around them. All of it happens between two steps.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Simulation;
use crate::diagnostics::StepRecord;
use crate::error::{Error, Result};
use crate::explosive::Profile;
use crate::gpu::readback;
use crate::scene::{Charge, Conserved, CutGeometry, Scene, random};
use crate::snapshot::kind;
use crate::state::Grid;
use crate::state::cut;

/// Shells of the near field.
const SHELLS: usize = 1024;
/// Steps of a near field at most: some 10,000 bring a front through many radii of a charge.
const MOST_STEPS: usize = 2_000_000;
/// Widest zone of a near field, in cells.
const WIDEST: f64 = 0.125;
/// How far the gas of a near field reaches beyond its front.
const BEYOND: f64 = 1.2;
/// Points per axis of a cell, in 1D, 2D and 3D.
const SAMPLES: [usize; 3] = [64, 8, 4];
/// Distances at the edge between two shells belong to the outer one, on all sides: a part of a shell.
const EDGE: f64 = 1e-9;

/// What charges have given to the gas since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Released {
    /// Charges of the scene that have gone off.
    pub count: usize,
    /// \[kg\]
    pub mass: f64,
    /// \[kg m s^-1\]
    pub momentum: [f64; 3],
}

/// A near field that waits for its time.
#[derive(Clone, Debug)]
pub(super) struct Due {
    /// When it takes the place of the gas \[s\].
    time: f64,
    charge: Charge,
    /// Mass \[kg\] and middle \[m\] of the ball.
    mass: f64,
    center: [f64; 3],
    /// Mass fraction and volume fraction of the second gas in products and around them.
    fractions: [[f64; 2]; 2],
    surface: Unevenness,
    /// Energy of the charge \[J\], without what its products still hold.
    energy: f64,
    /// What they hold: so many energies of detonation \[1\], each of so much \[J kg^-1\].
    held: [f64; 2],
    profile: Profile,
}

/// All of them, by their times.
///
/// # Errors
/// [`Error::Usage`] if there is no room for one; checked scenes have it.
pub(super) fn due(scene: &Scene) -> Result<Vec<Due>> {
    let mut all = scene
        .charges
        .par_iter()
        .filter(|charge| charge.shape.is_none())
        .map(|charge| near_field(scene, charge))
        .collect::<Result<Vec<_>>>()?;
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(all)
}

/// The near field of a charge.
fn near_field(scene: &Scene, charge: &Charge) -> Result<Due> {
    let none = || Error::Usage(format!("charge `{}`: there is no gas around it; choose another place", charge.name));
    let ((mass, center), placed) = charge.ball().zip(scene.placed(charge)).ok_or_else(none)?;
    let mut expansion = placed.ball.start(BEYOND * placed.reach, WIDEST * scene.domain.spacing());
    expansion.run_to(placed.reach, MOST_STEPS);
    let burnt = placed.ball.afterburnt(expansion.time);
    let energy = mass * (placed.ball.explosive.specific_energy() + burnt);
    let profile = expansion.profile(placed.reach, SHELLS);
    let around = scene.still_gas(center, center).mass_fraction;
    let of = |share: f64| [share, scene.gas.equation_of_state().volume_fraction(share)];
    let fractions = [of(if charge.species.is_some() { 1.0 } else { 0.0 }), of(around)];
    Ok(Due {
        held: fuel_left(scene, charge, burnt),
        time: charge.time + expansion.time,
        charge: charge.clone(),
        mass,
        center,
        fractions,
        surface: Unevenness::new(),
        energy,
        profile,
    })
}

/// What products still hold after they have given a heat \[J kg^-1\] in the near field: in energies of detonation, and this energy
/// \[J kg^-1\].
fn fuel_left(scene: &Scene, charge: &Charge, burnt: f64) -> [f64; 2] {
    let own = scene.gas.equation_of_state().species.filter(|_| charge.species.is_some());
    let Some((fuel, unit)) = own.and_then(|own| Some((own.fuel, own.products?.specific_energy()))) else {
        return [0.0; 2];
    };
    [(fuel - burnt / unit).max(0.0), unit]
}

/// Waves over the directions around a charge, the same ones for all.
#[derive(Clone, Debug)]
struct Unevenness {
    /// Wave vector of each, and its phase \[rad\].
    waves: Vec<([f64; 3], f64)>,
}

/// Waves of an uneven ball, and their lengths: so many radians along a radius.
const WAVES: usize = 48;
const WAVE_NUMBERS: [f64; 2] = [4.0, 12.0];

impl Unevenness {
    fn new() -> Self {
        let wave = |index: usize| {
            let of = |part: usize| random(5 * index + part);
            let vector: [f64; 3] = std::array::from_fn(of);
            let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-9);
            let number = WAVE_NUMBERS[0] + 0.5 * (1.0 + of(3)) * (WAVE_NUMBERS[1] - WAVE_NUMBERS[0]);
            (vector.map(|x| number * x / length), std::f64::consts::PI * of(4))
        };
        Self { waves: (0..WAVES).map(wave).collect() }
    }

    /// Height in a direction, 1 in the quadratic mean and not above 3 in size.
    fn height(&self, arm: [f64; 3], away: f64) -> f64 {
        let part = |(vector, phase): &([f64; 3], f64)| {
            let along = (0..3).map(|d| vector[d] * arm[d]).sum::<f64>() / away.max(f64::MIN_POSITIVE);
            (along + phase).cos()
        };
        let sum: f64 = self.waves.iter().map(part).sum();
        (sum * (2.0 / WAVES as f64).sqrt()).clamp(-3.0, 3.0)
    }
}

/// The near field in a cell.
#[derive(Clone, Copy, Debug)]
struct Mapped {
    slot: usize,
    /// Part of the cell within the near field.
    covered: f64,
    /// What is conserved, mean of that part; in the place of the second gas, products.
    state: Conserved,
}

impl Due {
    /// The cells of kind GAS that the near field touches.
    fn cells(&self, scene: &Scene, simulation: &Simulation, words: &[u32]) -> Vec<Mapped> {
        let domain = &scene.domain;
        let (axes, grid, spacing) = (domain.axes(), &simulation.state.grid, domain.spacing());
        let (center, radius) = (self.center, self.profile.radius * (1.0 + 3.0 * self.charge.roughness));
        let range = |d: usize| {
            let cell = |x: f64| ((x - domain.origin[d]) / spacing).floor().clamp(0.0, f64::from(domain.cells[d] - 1));
            if d < axes { cell(center[d] - radius) as u32..cell(center[d] + radius) as u32 + 1 } else { 0..1 }
        };
        let [x, y, z] = [range(0), range(1), range(2)];
        let rows = z.flat_map(|z| y.clone().map(move |y| [y, z]));
        let cells: Vec<[u32; 3]> = rows.flat_map(|[y, z]| x.clone().map(move |x| [x, y, z])).collect();
        let look = |cell: [u32; 3]| {
            let slot = grid.slot(cell.map(|c| c as i32));
            (words[slot] & u32::from(kind::MASK) == u32::from(kind::GAS)).then(|| self.mapped(scene, cell, slot))?
        };
        cells.into_par_iter().filter_map(look).collect()
    }

    /// Mean over regular points of a cell; none outside of the near field.
    fn mapped(&self, scene: &Scene, cell: [u32; 3], slot: usize) -> Option<Mapped> {
        let (axes, spacing) = (scene.domain.axes(), scene.domain.spacing());
        let middle = scene.domain.cell_center(cell);
        let (mut sum, mut inside) = ([0.0; 7], 0.0);
        let [[_, products], [_, around]] = self.fractions;
        let samples = SAMPLES[axes - 1];
        let count = samples.pow(axes as u32);
        for point in 0..count {
            let at = |d: usize| (point / samples.pow(d as u32) % samples) as f64;
            let arm: [f64; 3] = std::array::from_fn(|d| {
                let offset = (at(d) + 0.5) / samples as f64 - 0.5;
                if d < axes { middle[d] + offset * spacing - self.center[d] } else { 0.0 }
            });
            let away = arm.iter().map(|x| x * x).sum::<f64>().sqrt();
            let even = away / (1.0 + self.charge.roughness * self.surface.height(arm, away));
            let shell = (even / self.profile.radius * self.profile.shells.len() as f64 + EDGE) as usize;
            let Some(&[density, outward, internal, part, volume]) = self.profile.shells.get(shell) else { continue };
            inside += 1.0;
            sum[0] += density;
            for d in 0..3 {
                sum[d + 1] += outward * arm[d] / away.max(f64::MIN_POSITIVE);
            }
            sum[4] += internal + 0.5 * outward * outward / density;
            sum[5] += part;
            sum[6] += volume * products + (1.0 - volume) * around;
        }
        (inside > 0.0).then(|| Mapped { slot, covered: inside / count as f64, state: sum.map(|part| part / inside) })
    }
}

impl Simulation {
    /// What charges have given to the gas since the start.
    #[must_use]
    pub fn released(&self) -> Released {
        self.released
    }

    /// When the next charge's near field takes the place of the gas, if that is not after a time \[s\].
    pub(super) fn next_charge(&self, until: f64) -> Option<f64> {
        self.due.get(self.released.count).map(|due| due.time).filter(|time| *time <= until)
    }

    /// Sets a charge off where there is gas, as soon as the step that is under way is finished. Its near field takes the place of the gas at
    /// once. Returns its energy \[J\].
    ///
    /// # Errors
    /// [`Error::Usage`] if it does not fit into the domain or there is no gas around it; driver errors.
    pub fn set_off(&mut self, charge: &Charge, records: &mut Vec<StepRecord>) -> Result<f64> {
        if !self.scene.has_room_for(charge) {
            let (mass, center) = charge.ball().unwrap_or_default();
            let text = format!(
                "{mass} kg at {center:?} m do not fit into the gas of this scene; choose less, or another place"
            );
            return Err(Error::Usage(text));
        }
        self.settle(records)?;
        let before = self.blasts;
        self.release(&near_field(&self.scene, charge)?)?;
        Ok(self.blasts - before)
    }

    /// The next charge of the scene goes off.
    pub(super) fn release_next(&mut self) -> Result<()> {
        let due = self.due[self.released.count].clone();
        self.released.count += 1;
        self.release(&due)
    }

    /// Puts a near field in the place of the gas: mass and energy grow by those of the charge.
    fn release(&mut self, due: &Due) -> Result<()> {
        let (gpu, scene) = (&self.gpu, &self.scene);
        let mut flow = readback::read(gpu, &self.state.gas.conserved)?;
        let mut energy = readback::read_range(gpu, &self.state.gas.energy, 0, self.state.grid.slots())?;
        let words = readback::read(gpu, &self.state.interface.cells)?;
        let slots = self.state.grid.slots();
        let mut species = self.state.gas.read_species(gpu, slots)?;
        let geometry = cut::left(&self.state.grid, scene.cut_geometry(), &words, self.state.has_solids());
        let shares = cut::gas_shares(&self.state.grid, &geometry);
        let volume = scene.domain.cell_volume();
        let mut cells = due.cells(scene, self, &words);
        join_clusters(&mut cells, &cut_clusters(&self.state.grid, &geometry), &shares);
        let sum = |value: &dyn Fn(&Mapped) -> f64| {
            cells.iter().map(|cell| volume * shares[cell.slot] * cell.covered * value(cell)).sum::<f64>()
        };
        let old = [sum(&|cell| f64::from(flow[cell.slot][0])), sum(&|cell| f64::from(energy[cell.slot]))];
        let new = [sum(&|cell| cell.state[5]), sum(&|cell| cell.state[0] - cell.state[5]), sum(&|cell| cell.state[4])];
        if new[0] <= 0.0 || new[1] <= 0.0 {
            let text =
                format!("charge `{}` goes off where there is no gas; move it, or set it off earlier", due.charge.name);
            return Err(Error::Usage(text));
        }
        // of the products is there what the charge had, of the gas around what was there
        let [products, around, hotter] = [due.mass / new[0], old[0] / new[1], (due.energy + old[1]) / new[2]];
        let mut gained = [0.0; 5];
        for cell in &cells {
            let before = flow[cell.slot].map(f64::from);
            let left = 1.0 - cell.covered;
            let own = [products * cell.state[5], around * (cell.state[0] - cell.state[5])];
            let denser = (own[0] + own[1]) / cell.state[0];
            let after: [f64; 4] = std::array::from_fn(|k| left * before[k] + cell.covered * denser * cell.state[k]);
            let chemical = due.held[0] * due.held[1] * own[0];
            let heat = left * f64::from(energy[cell.slot]) + cell.covered * (hotter * cell.state[4] + chemical);
            let room = volume * shares[cell.slot];
            for (k, value) in after.into_iter().enumerate() {
                flow[cell.slot][k] = value as f32;
                gained[k] += room * (f64::from(flow[cell.slot][k]) - before[k]);
            }
            gained[4] += room * (f64::from(heat as f32) - f64::from(energy[cell.slot]));
            energy[cell.slot] = heat as f32;
            if !species.is_empty() {
                let part = own[0] * due.fractions[0][0] + own[1] * due.fractions[1][0];
                let parts = [part, cell.state[6], due.held[0] * own[0]];
                for (place, part) in (cell.slot..species.len()).step_by(slots).zip(parts) {
                    species[place] = (left * f64::from(species[place]) + cell.covered * part) as f32;
                }
            }
        }
        self.state.gas.conserved.write(gpu, 0, &flow);
        self.state.gas.energy.write(gpu, 0, &energy);
        self.state.gas.write_species(gpu, slots, &species);
        self.book(gained);
        self.gpu.check()
    }

    /// Counts what a charge has given: mass, momentum, energy.
    fn book(&mut self, gained: [f64; 5]) {
        self.released.mass += gained[0];
        for d in 0..3 {
            self.released.momentum[d] += gained[d + 1];
            self.given[d] += gained[d + 1];
            self.gas_before[d] += gained[d + 1];
        }
        self.given[3] += gained[4];
        self.blasts += gained[4];
    }
}

/// Slots of the cells that share one state.
fn cut_clusters(grid: &Grid, geometry: &CutGeometry) -> Vec<Vec<usize>> {
    let slot = |&at: &usize| grid.slot(geometry.cells[at].cell.map(|c| c as i32));
    geometry.clusters.iter().map(|cluster| cluster.iter().map(slot).collect()).collect()
}

/// Cells that share one state get the same.
fn join_clusters(cells: &mut Vec<Mapped>, clusters: &[Vec<usize>], shares: &[f64]) {
    for cluster in clusters.iter().filter(|cluster| cluster.len() > 1) {
        let members: Vec<Mapped> = cells.iter().filter(|cell| cluster.contains(&cell.slot)).copied().collect();
        if members.is_empty() {
            continue;
        }
        let room: f64 = cluster.iter().map(|&slot| shares[slot]).sum();
        let filled: f64 = members.iter().map(|cell| shares[cell.slot] * cell.covered).sum();
        let mean = |k: usize| {
            members.iter().map(|cell| shares[cell.slot] * cell.covered * cell.state[k]).sum::<f64>() / filled
        };
        let (covered, state) = (filled / room, std::array::from_fn(mean));
        cells.retain(|cell| !cluster.contains(&cell.slot));
        cells.extend(cluster.iter().map(|&slot| Mapped { slot, covered, state }));
    }
}
