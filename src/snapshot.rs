//! A CPU copy of the state at one time: what tests, tables and exporters see.

use crate::state::Grid;

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
    /// Ratio of specific heats of the gas.
    pub gamma: f64,
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
    /// All particles of all bodies, in an order that does not change over time.
    pub particles: Vec<ParticleSample>,
}

/// One particle of a solid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleSample {
    /// Position \[m\].
    pub position: [f32; 3],
    /// Velocity \[m s^-1\].
    pub velocity: [f32; 3],
    /// Angular velocity times two, from the affine matrix: what the particle adds to the angular momentum per its moment of inertia
    /// m dx^2 / 4 \[s^-1\]. [Jiang et al. 2015]
    pub vorticity: [f32; 3],
    /// Mass \[kg\].
    pub mass: f32,
    /// Volume at rest \[m^3\].
    pub volume0: f32,
    /// Ghost pressure of the solid \[Pa\].
    pub ghost_pressure: f32,
    /// Accumulated plastic strain.
    pub plastic_strain: f32,
    /// Deformation gradient, columns.
    pub deformation: [[f32; 3]; 3],
    /// Index of the body in the scene.
    pub body: u32,
    /// Index of the material in the scene.
    pub material: u32,
}

impl ParticleSample {
    /// Determinant of the deformation gradient: current volume over volume at rest.
    #[must_use]
    pub fn volume_ratio(&self) -> f32 {
        glam::Mat3::from_cols_array_2d(&self.deformation).determinant()
    }
}
