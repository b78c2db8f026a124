//! A CPU copy of the state at one time: what tests, tables and exporters see.

mod cell_rows;
mod device;

use rayon::prelude::*;

use crate::material::Laws;
use crate::scene::{Conserved, EquationOfState, Fire};
use crate::state::Grid;

pub use cell_rows::CellRows;
pub(crate) use device::gone;

/// Kind of a cell, bits 0..1 of a cell word.
pub mod kind {
    /// The bits of a cell word that hold the kind.
    pub const MASK: u8 = 3;
    /// The cell holds gas; its gas values have meaning.
    pub const GAS: u8 = 0;
    /// The cell is covered by a solid body.
    pub const SOLID: u8 = 1;
    /// A static obstacle, or outside of a wall side.
    pub const WALL: u8 = 2;
    /// Outside of an inlet or outlet side.
    pub const GHOST: u8 = 3;
}

/// The state at one time. Cell arrays hold the domain's cells without the ring, x fastest.
///
/// Gas values have meaning in cells of kind [`kind::GAS`] only.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// The grid of the cell arrays.
    pub grid: Grid,
    /// Equation of state of the gas.
    pub gases: EquationOfState,
    /// What pictures make of it; nothing unless it is told.
    pub fire: Fire,
    /// Laws of the materials; none unless they are told.
    pub laws: Laws,
    /// Kind of each cell, see [`kind`].
    pub kind: Vec<u8>,
    /// Gas density \[kg m^-3\].
    pub density: Vec<f32>,
    /// Gas velocity \[m s^-1\].
    pub velocity: Vec<[f32; 3]>,
    /// Gas pressure \[Pa\].
    pub pressure: Vec<f32>,
    /// Total gas energy per volume \[J m^-3\].
    pub energy: Vec<f32>,
    /// Mass fraction of the second gas, its volume fraction, and what it holds, in energies of detonation; empty without one.
    pub species: Vec<[f32; 3]>,
    /// Gas that cells owe, and in covered cells all that they hold \[kg m^-3\].
    pub owed: Vec<f32>,
    /// Of each cell since the start: largest pressure \[Pa\], integral over time of the pressure above ambient \[Pa s\], largest plastic
    /// strain of what has passed; empty where the scene keeps no maps.
    pub maps: Vec<[f32; 3]>,
    /// Dust \[kg m^-3\]; empty without any.
    pub dust: Vec<f32>,
    /// All particles of all bodies, in an order that does not change over time.
    pub particles: Vec<ParticleSample>,
}

/// One particle of a solid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleSample {
    /// Number among the particles of the start, [`crate::scene::Scene::seed_particles`].
    pub index: u32,
    /// Position in the device's coordinates \[m\]; [`Snapshot::place_of`] has it in those of the scene.
    pub position: [f32; 3],
    /// Velocity \[m s^-1\].
    pub velocity: [f32; 3],
    /// Angular velocity times two, from the affine matrix: what the particle adds to the angular momentum per its moment of inertia
    /// m dx^2 / 4 \[s^-1\]. [Jiang et al. 2015]
    pub vorticity: [f32; 3],
    /// Mass \[kg\].
    pub mass: f32,
    /// Kinetic energy, that of the affine motion around it included \[J\].
    pub kinetic_energy: f32,
    /// Volume at rest \[m^3\].
    pub volume0: f32,
    /// Ghost pressure of the solid \[Pa\].
    pub ghost_pressure: f32,
    /// Accumulated plastic strain; 0 of what has broken.
    pub plastic_strain: f32,
    /// Damage, from 0 to 1 for broken.
    pub damage: f32,
    /// Deformation gradient, columns.
    pub deformation: [[f32; 3]; 3],
    /// The same less the identity: of a small strain it has all digits.
    pub displacement_gradient: [[f32; 3]; 3],
    /// Cauchy stress \[Pa\]: xx, yy, zz, xy, yz, zx.
    pub stress: [f32; 6],
    /// Index of the body in the scene.
    pub body: u32,
    /// Index of the material in the scene.
    pub material: u32,
}

impl Default for ParticleSample {
    /// At rest in the origin, of volume and mass 1, undeformed.
    fn default() -> Self {
        Self {
            index: 0,
            position: [0.0; 3],
            velocity: [0.0; 3],
            vorticity: [0.0; 3],
            mass: 1.0,
            kinetic_energy: 0.0,
            volume0: 1.0,
            ghost_pressure: 0.0,
            plastic_strain: 0.0,
            damage: 0.0,
            deformation: glam::Mat3::IDENTITY.to_cols_array_2d(),
            displacement_gradient: [[0.0; 3]; 3],
            stress: [0.0; 6],
            body: 0,
            material: 0,
        }
    }
}

impl ParticleSample {
    /// Determinant of the deformation gradient: current volume over volume at rest.
    #[must_use]
    pub fn volume_ratio(&self) -> f32 {
        glam::Mat3::from_cols_array_2d(&self.deformation).determinant()
    }

    /// Norm of the elastic strain of Green and Lagrange, E = (F^T F - 1) / 2: sqrt(E:E).
    #[must_use]
    pub fn elastic_strain(&self) -> f32 {
        let f = glam::Mat3::from_cols_array_2d(&self.deformation);
        let strain = (f.transpose() * f - glam::Mat3::IDENTITY) * 0.5;
        [strain.x_axis, strain.y_axis, strain.z_axis].iter().map(|column| column.length_squared()).sum::<f32>().sqrt()
    }

    /// Deviatoric stress of von Mises, sqrt(3/2 s:s) of the Cauchy stress \[Pa\].
    #[must_use]
    pub fn deviatoric_stress(&self) -> f32 {
        let [x, y, z, xy, yz, zx] = self.stress;
        let normal = (x - y) * (x - y) + (y - z) * (y - z) + (z - x) * (z - x);
        (0.5 * normal + 3.0 * (xy * xy + yz * yz + zx * zx)).sqrt()
    }
}

/// The gas in one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GasSample {
    /// Density \[kg m^-3\].
    pub density: f32,
    /// Velocity \[m s^-1\].
    pub velocity: [f32; 3],
    /// Pressure \[Pa\].
    pub pressure: f32,
}

impl Snapshot {
    /// Position of a particle in the coordinates of the scene \[m\].
    #[must_use]
    pub fn place_of(&self, particle: &ParticleSample) -> [f64; 3] {
        self.grid.in_scene(particle.position)
    }

    /// The cell that holds a point \[m\]: its place in the cell arrays, or nothing outside of the domain. Axes that are left out are 0.
    #[must_use]
    pub fn cell_at<const N: usize>(&self, position: [f64; N]) -> Option<usize> {
        let grid = &self.grid;
        let (mut place, low) = (0, grid.low());
        for axis in (0..grid.dimension as usize).rev() {
            let offset = position.get(axis).copied().unwrap_or(0.0) - low[axis];
            let cell = (offset / f64::from(grid.spacing)).floor();
            if !(cell >= 0.0 && cell < f64::from(grid.cells[axis])) {
                return None;
            }
            place = place * grid.cells[axis] as usize + cell as usize;
        }
        Some(place)
    }

    /// Ratio of specific heats in a cell.
    #[must_use]
    pub fn gamma_at(&self, cell: usize) -> f64 {
        self.gases.gamma_at(self.species.get(cell).map_or(0.0, |own| own[1].into()))
    }

    /// Speed of sound in a cell \[m s^-1\].
    #[must_use]
    pub fn sound_speed_at(&self, cell: usize) -> f64 {
        if self.gases.products().is_none() {
            return (self.gamma_at(cell) * f64::from(self.pressure[cell]) / f64::from(self.density[cell])).sqrt();
        }
        let (state, held) = self.conserved_at(cell);
        self.gases.sound_speed(state, held)
    }

    /// Temperature times the gas constant of the first gas in a cell \[J kg^-1\]: p / rho of it.
    #[must_use]
    pub fn thermal_energy_at(&self, cell: usize) -> f32 {
        let plain = || {
            let constant = self.gases.constant_ratio(self.mass_fraction_at(cell).into()) as f32;
            self.pressure[cell] / self.density[cell] / constant
        };
        if self.gases.products().is_none() {
            return plain();
        }
        let (state, held) = self.conserved_at(cell);
        plain() * (1.0 - self.gases.cold_pressure(state, held) as f32 / self.pressure[cell])
    }

    /// What is conserved in a cell, and what the second gas holds, in energies of detonation.
    fn conserved_at(&self, cell: usize) -> (Conserved, f64) {
        let [share, phi, held] = self.species.get(cell).map_or([0.0; 3], |own| own.map(f64::from));
        let density = f64::from(self.density[cell]);
        let [u, v, w] = self.velocity[cell].map(|speed| density * f64::from(speed));
        ([density, u, v, w, self.energy[cell].into(), share * density, phi], held)
    }

    /// Mass fraction of the second gas in a cell.
    #[must_use]
    pub fn mass_fraction_at(&self, cell: usize) -> f32 {
        self.species.get(cell).map_or(0.0, |own| own[0])
    }

    /// The gas at a point \[m\]; nothing outside of the domain and inside of bodies and obstacles.
    #[must_use]
    pub fn gas_at<const N: usize>(&self, position: [f64; N]) -> Option<GasSample> {
        let i = self.cell_at(position).filter(|i| self.kind[*i] == kind::GAS)?;
        Some(GasSample { density: self.density[i], velocity: self.velocity[i], pressure: self.pressure[i] })
    }
}

impl Snapshot {
    /// Particles alone, without a cell of gas.
    pub(crate) fn of_particles((time, step): (f64, u64), grid: Grid, particles: Vec<ParticleSample>) -> Snapshot {
        Snapshot {
            time,
            step,
            grid,
            gases: EquationOfState { gamma: 1.4, species: None },
            fire: Fire::default(),
            laws: Laws::default(),
            kind: Vec::new(),
            density: Vec::new(),
            velocity: Vec::new(),
            pressure: Vec::new(),
            energy: Vec::new(),
            species: Vec::new(),
            owed: Vec::new(),
            maps: Vec::new(),
            dust: Vec::new(),
            particles,
        }
    }

    /// The same from arrays in the layout of the device.
    pub(crate) fn of_rows(grid: Grid, gases: EquationOfState, moment: (f64, u64), rows: &ParticleRows) -> Snapshot {
        Snapshot { gases, ..Self::of_particles(moment, grid, rows.samples(&grid)) }
    }
}

impl Snapshot {
    /// From arrays in the layout of the device, of a grid and gas, at a time \[s\] after so many steps.
    #[must_use]
    pub fn of(
        grid: Grid,
        gases: EquationOfState,
        (time, step): (f64, u64),
        cells: &CellRows,
        rows: &ParticleRows,
    ) -> Snapshot {
        let flow = &cells.conserved;
        let pressure = |slot: usize| cells.pressure(&grid, &gases, slot);
        let velocity = |slot: usize| [1, 2, 3].map(|axis| flow[slot][axis] / flow[slot][0]);
        Snapshot {
            time,
            step,
            grid,
            gases,
            fire: Fire::default(),
            laws: Laws::default(),
            kind: grid.unpadded(&cells.kind),
            density: grid.unpadded_by(|slot| flow[slot][0]),
            velocity: grid.unpadded_by(velocity),
            pressure: grid.unpadded_by(pressure),
            energy: grid.unpadded(&cells.energy),
            species: cells.species_fractions(&grid),
            owed: cells.owed_density(&grid),
            maps: cells.kept_maps(&grid),
            dust: if cells.dust.is_empty() { Vec::new() } else { grid.unpadded(&cells.dust) },
            particles: rows.samples(&grid),
        }
    }
}

/// The particles in the layout of the device, see [`crate::state::Particles`].
#[derive(Debug, Clone, Default)]
pub struct ParticleRows {
    /// Position and mass.
    pub position: Vec<[f32; 4]>,
    /// Velocity and volume at rest.
    pub velocity: Vec<[f32; 4]>,
    /// Three rows per particle.
    pub affine: Vec<[f32; 4]>,
    /// Three rows per particle.
    pub deformation: Vec<[f32; 4]>,
    /// Two rows per particle.
    pub stress: Vec<[f32; 4]>,
}

impl ParticleRows {
    /// The particles that are inside the domain.
    fn samples(&self, grid: &Grid) -> Vec<ParticleSample> {
        let inside = |p: &usize| self.deformation[3 * p + 1][3] > 0.0;
        (0..self.position.len()).into_par_iter().filter(inside).map(|p| self.sample(grid, p)).collect()
    }

    /// One particle.
    pub(crate) fn sample(&self, grid: &Grid, p: usize) -> ParticleSample {
        let Self { position, velocity, affine, deformation, stress } = self;
        let axes = grid.dimension as usize;
        let xyz = |v: [f32; 4]| [v[0], v[1], v[2]];
        ParticleSample {
            index: p as u32,
            position: xyz(position[p]),
            velocity: xyz(velocity[p]),
            vorticity: {
                let [a, b, c] = [0, 1, 2].map(|column| affine[3 * p + column]);
                [b[2] - c[1], c[0] - a[2], a[1] - b[0]]
            },
            mass: position[p][3],
            kinetic_energy: {
                let square = |v: [f32; 4]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
                let turning = turning(&affine[3 * p..3 * p + axes]);
                0.5 * position[p][3] * (square(velocity[p]) + 0.25 * grid.spacing * grid.spacing * turning)
            },
            volume0: velocity[p][3],
            ghost_pressure: affine[3 * p][3],
            plastic_strain: if deformation[3 * p + 2][3] < 1.0 { affine[3 * p + 1][3] } else { 0.0 },
            damage: deformation[3 * p + 2][3],
            deformation: std::array::from_fn(|column| {
                let unit = |row: usize| if row == column { 1.0 } else { 0.0 };
                std::array::from_fn(|row| unit(row) + deformation[3 * p + column][row])
            }),
            displacement_gradient: [0, 1, 2].map(|column| xyz(deformation[3 * p + column])),
            stress: {
                let (diagonal, aside) = (stress[2 * p], stress[2 * p + 1]);
                let all = [diagonal[0], diagonal[1], diagonal[2], aside[0], aside[1], aside[2]];
                let column = |k: usize| glam::Vec3::from(xyz(deformation[3 * p + k])) + glam::Vec3::AXES[k];
                let volume = velocity[p][3] * glam::Mat3::from_cols(column(0), column(1), column(2)).determinant();
                all.map(|product| product / volume)
            },
            body: deformation[3 * p][3].to_bits(),
            material: affine[3 * p + 2][3].to_bits() & 0xffff,
        }
    }
}

fn turning(affine: &[[f32; 4]]) -> f32 {
    affine.iter().map(|v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sum()
}
