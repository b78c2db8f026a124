//! Sections of a scene that say how to compute, which files to write and what to expect.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Coupling, Elasticity, FaceVelocity, Field, Ghost, Integrator, InterfacePressure, Power, SolidUpdate};

/// How long, and how finely in time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run `[s]`.
    pub until: f64,
    /// Fraction of the advective time step, above 0 and at most 1.
    #[serde(default = "Time::default_cfl")]
    pub cfl: f64,
    /// Pictures per run, evenly spaced, besides the one of the start.
    #[serde(default = "Time::default_frames")]
    pub frames: u32,
    /// A step moves sound by at most this many cells.
    #[serde(default = "Time::default_max_courant")]
    pub max_courant: f64,
    /// A step is at most this many times the one before.
    #[serde(default = "Time::default_max_growth")]
    pub max_growth: f64,
    /// Constant step `[s]` instead of the rules above; for measurements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fixed_step: Option<f64>,
}

impl Default for Time {
    fn default() -> Self {
        Time {
            until: 1.0,
            cfl: Time::default_cfl(),
            frames: Time::default_frames(),
            max_courant: Time::default_max_courant(),
            max_growth: Time::default_max_growth(),
            fixed_step: None,
        }
    }
}

impl Time {
    fn default_cfl() -> f64 {
        0.5
    }
    fn default_frames() -> u32 {
        24
    }
    fn default_max_courant() -> f64 {
        2.0
    }
    fn default_max_growth() -> f64 {
        2.0
    }
}

/// Choices of the method. The defaults are the recommended method; the others are the paper's forms and ablations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Numerics {
    /// Finite element pair of velocity and pressure in the coupled solve.
    pub pair: Pair,
    /// Relative residual at which the pressure solve stops, above 0 and below 1.
    pub tolerance: f64,
    /// The pressure solve gives up after this many iterations.
    pub max_iterations: u32,
    /// What speeds the pressure solve up.
    pub preconditioner: Preconditioner,
    /// Time integration of the gas.
    pub integrator: Integrator,
    /// Velocity that carries the gas through its faces.
    pub face_velocity: FaceVelocity,
    /// How the grid sees static obstacles.
    pub obstacles: Obstacles,
    /// Share of the mode alternating from cell to cell that a conservative filter removes per step, 0 to 1. Left out, a fifth in steps in
    /// which sound crosses ten cells or more, else nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub filter: Option<f64>,
    /// Pressure unknowns where gas and solid meet.
    pub interface: InterfacePressure,
    /// A cell is solid when bodies fill more than this fraction of it, above 0 and at most 1.
    pub solid_threshold: f64,
    /// Pressure of the gas film between a body and a wall of the domain.
    pub film: Film,
    /// Velocity in the power that the gas gives to bodies.
    pub power: Power,
    /// What the solved pressure does to the nodes of bodies.
    pub solid_update: SolidUpdate,
    /// Order of the pressure solve and of the elastic step.
    pub coupling: Coupling,
    /// How the ghost pressure and the elastic law of a body share its volume.
    pub ghost: Ghost,
    /// Keep the gas of covered cells in a ledger and give it back when cells are uncovered.
    pub ledger: bool,
    /// Limit fluxes so that density and internal energy stay positive.
    pub limiter: bool,
    /// Blend reflective and passing ghost states by the blocked fraction of partly filled cells.
    pub blending: bool,
    /// Fraction of a cell that elastic waves cross in one sub-step, above 0 and at most 1.
    pub elastic_cfl: f64,
    /// How the elastic part of a step is taken.
    pub elasticity: Elasticity,
    /// Relative tolerance of the implicit elastic step, above 0 and below 1.
    pub elastic_tolerance: f64,
    /// Elastic sub-steps per step at most; a step that would need more is shortened to fit. With `numerics.coupling = "last"` there is one.
    pub max_substeps: u32,
    /// How particles give their momentum to the grid.
    pub transfer: Transfer,
}

impl Default for Numerics {
    fn default() -> Self {
        Numerics {
            pair: Pair::default(),
            tolerance: 1e-5,
            max_iterations: 500,
            preconditioner: Preconditioner::default(),
            integrator: Integrator::default(),
            face_velocity: FaceVelocity::default(),
            obstacles: Obstacles::default(),
            filter: None,
            interface: InterfacePressure::default(),
            solid_threshold: 0.5,
            film: Film::default(),
            power: Power::default(),
            solid_update: SolidUpdate::default(),
            coupling: Coupling::default(),
            ghost: Ghost::default(),
            ledger: true,
            limiter: true,
            blending: true,
            elastic_cfl: 0.4,
            elasticity: Elasticity::default(),
            elastic_tolerance: 1e-4,
            max_substeps: 10_000,
            transfer: Transfer::default(),
        }
    }
}

/// Finite element pair of the coupled solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Pair {
    /// Velocity constant per cell, pressure linear: fastest.
    #[default]
    #[serde(rename = "b1b0")]
    B1b0,
    /// Velocity quadratic, pressure linear: the paper's pair.
    #[serde(rename = "b2b1")]
    B2b1,
}

/// Preconditioner of the pressure solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preconditioner {
    /// In 2D and 3D `multigrid` in the steps whose acoustic Courant number makes it pay, else `jacobi`.
    #[default]
    Auto,
    /// The diagonal.
    Jacobi,
    /// Diagonals on all levels of two coarse spaces in 2D, of four in 3D, in every step.
    Multigrid,
}

/// How the grid sees static obstacles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Obstacles {
    /// Cells are cut by the surface: gas fills a part of them. Gas only, with the pair B1B0.
    Cut,
    /// Whole cells, those whose centre lies inside: slanted surfaces are staircases.
    Cells,
    /// `cut` where that is possible, else `cells`.
    #[default]
    Auto,
}

/// Pressure of the gas film between a body and a wall of the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Film {
    /// That of the nearest gas along the wall.
    #[default]
    Nearest,
    /// The ghost pressure of the body itself.
    Ghost,
}

/// How particles give their momentum to the grid; all ways leave the same bits on every run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Transfer {
    /// Nodes on a GPU, columns on a software device.
    #[default]
    Auto,
    /// Each node sums what the particles around it give.
    Nodes,
    /// Each column of cells hands on what its particles give.
    Columns,
}

/// Which files a run leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// Fields shown in the pictures, one picture each; in 3D the first one is ray marched.
    pub fields: Vec<Field>,
    /// Also write VTK files of all fields and particles.
    pub vtk: bool,
    /// Write pictures with 16 bits per channel.
    pub png16: bool,
    /// Also write the pictures' linear light.
    pub exr: bool,
    /// Keep maps of the largest pressure, the impulse and the largest plastic strain so far, for files; fields that show them turn it on.
    pub maps: bool,
    /// Also write what pictures are drawn from, so that `brisance render` can draw them again.
    pub states: bool,
}

impl Output {
    /// Names of the formats that the scene asks for beside pictures.
    pub fn formats(&self) -> impl Iterator<Item = &'static str> {
        let all = [("vtk", self.vtk), ("png16", self.png16), ("exr", self.exr), ("states", self.states)];
        all.into_iter().filter(|(_, on)| *on).map(|(name, _)| name)
    }
}

impl Default for Output {
    fn default() -> Self {
        Output { fields: vec![Field::Density], vtk: false, png16: false, exr: false, maps: false, states: false }
    }
}
