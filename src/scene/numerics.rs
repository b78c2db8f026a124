//! The section `numerics` of a scene: what a user may want, the forms of the paper, and what only tunes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Coupling, Elasticity, FaceVelocity, Ghost, Integrator, InterfacePressure, SolidUpdate};

/// Choices of the method; the defaults are the recommended method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Numerics {
    /// Finite element pair of the coupled solve.
    pub pair: Pair,
    /// Time integration of the gas.
    pub integrator: Integrator,
    /// How the elastic part of a step is taken.
    pub elasticity: Elasticity,
    /// Share of the mode alternating from cell to cell that a conservative filter removes per step. When left out, scenes without bodies
    /// take 0.2 in steps in which sound crosses ten cells or more.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = 0, "maximum" = 1))]
    pub filter: Option<f64>,
    /// Relative residual at which the pressure solve stops; single precision reaches about 1e-6.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub tolerance: f64,
    /// Elastic sub-steps per step at most; a step that would need more is shortened to fit. With `paper.coupling = "last"` there is one.
    #[schemars(extend("minimum" = 1, "maximum" = 10_000))]
    pub max_substeps: u32,
    /// Forms of the paper, to compare with.
    pub paper: Paper,
    /// What changes the cost of a run, hardly its result.
    pub expert: Expert,
}

impl Default for Numerics {
    fn default() -> Self {
        Numerics {
            pair: Pair::default(),
            integrator: Integrator::default(),
            elasticity: Elasticity::default(),
            filter: None,
            tolerance: 1e-5,
            max_substeps: 10_000,
            paper: Paper::default(),
            expert: Expert::default(),
        }
    }
}

/// Forms of the paper; the defaults are the recommended method, the others its variants. [Cao et al. 2022]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Paper {
    /// Velocity that carries the gas through its faces.
    pub face_velocity: FaceVelocity,
    /// How the grid sees static obstacles.
    pub obstacles: Obstacles,
    /// Pressure unknowns where gas and solid meet.
    pub interface: InterfacePressure,
    /// How the ghost pressure and the elastic law of a body share its volume.
    pub ghost: Ghost,
    /// Order of the pressure solve and of the elastic step.
    pub coupling: Coupling,
    /// What the solved pressure does to the nodes of bodies.
    pub solid_update: SolidUpdate,
    /// A cell is solid when bodies fill more than this fraction of it; thin walls are found all the same.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
    pub solid_threshold: f64,
}

impl Default for Paper {
    fn default() -> Self {
        Paper {
            face_velocity: FaceVelocity::default(),
            obstacles: Obstacles::default(),
            interface: InterfacePressure::default(),
            ghost: Ghost::default(),
            coupling: Coupling::default(),
            solid_update: SolidUpdate::default(),
            solid_threshold: 0.5,
        }
    }
}

/// What changes the cost of a run, hardly its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Expert {
    /// What speeds the pressure solve up.
    pub preconditioner: Preconditioner,
    /// The pressure solve fails after this many iterations.
    #[schemars(extend("minimum" = 1, "maximum" = 100_000))]
    pub max_iterations: u32,
    /// Part of a cell that elastic waves cross in one sub-step, and the strain in it.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
    pub elastic_cfl: f64,
    /// Relative tolerance of the implicit elastic step.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 0.5))]
    pub elastic_tolerance: f64,
    /// How particles give their momentum to the grid: by ordered sums.
    pub transfer: Transfer,
}

impl Default for Expert {
    fn default() -> Self {
        Expert {
            preconditioner: Preconditioner::default(),
            max_iterations: 500,
            elastic_cfl: 0.4,
            elastic_tolerance: 1e-4,
            transfer: Transfer::default(),
        }
    }
}

/// Keys that scenes of earlier versions may have, and what to do about them.
pub(super) const GONE: [(&str, &str); 5] = [
    ("numerics.ledger", "remove it: the gas of covered cells is always kept and given back"),
    ("numerics.limiter", "remove it: fluxes are always limited so that density and internal energy stay positive"),
    ("numerics.blending", "remove it: faces of partly filled cells are always blocked by their share"),
    ("numerics.film", "remove it: the film between a body and a wall has the pressure of the nearest gas"),
    (
        "numerics.power",
        "remove it: the velocity in the power that gas gives to bodies follows from numerics.paper.ghost",
    ),
];

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

/// How the grid sees static obstacles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Obstacles {
    /// The surface cuts cells, and gas fills a part of them, but for cells near bodies: with `b1b0`.
    Cut,
    /// Whole cells, those whose centre lies inside: slanted walls are staircases.
    Cells,
    /// `cut` where that is possible, else `cells`.
    #[default]
    Auto,
}

/// Preconditioner of the pressure solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preconditioner {
    /// In 2D and 3D `multigrid` in the steps where it pays; `max_courant` or `fixed_step` must allow it at the start.
    #[default]
    Auto,
    /// The diagonal.
    Jacobi,
    /// Diagonals on all levels of two coarse spaces in 2D, of four in 3D, in every step.
    Multigrid,
}

/// How particles give their momentum to the grid; all ways leave the same bits on every run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Transfer {
    /// `nodes` on a GPU, `columns` in software.
    #[default]
    Auto,
    /// Each node sums what the particles around it give.
    Nodes,
    /// Each column of cells hands on what its particles give.
    Columns,
}
