//! Choices of the method, by the names of the scene's `[numerics]`.

/// Velocity/pressure pair of the gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pair {
    /// Quadratic / linear.
    B2b1,
    /// Linear / constant on the dual cell.
    B1b0,
}

/// Which interface vertices share one pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shared {
    /// Those of resolved bodies.
    Resolved,
    /// None.
    H,
    /// All.
    Single,
}

/// Squares of relative differences that the reconstruction takes as smooth: where gas is compressed, and in the fifth-order form
/// elsewhere; None: the first everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Weno {
    /// Where gas is compressed.
    pub steep: f64,
    /// In the fifth-order form elsewhere.
    pub even: Option<f64>,
}

/// Choices of the method.
#[derive(Clone, Debug)]
pub struct Numerics {
    /// Element pair of the solve.
    pub pair: Pair,
    /// Relative residual at which the solve ends.
    pub tolerance: f64,
    /// Most iterations of the solve.
    pub max_iterations: usize,
    /// The pressure before the solve follows what advection compressed.
    pub predictor: bool,
    /// ARS(2,2,2): two solves per step; gas only.
    pub two_solves: bool,
    /// Sound of fourth order in space.
    pub fourth: bool,
    /// Gas is carried by what the solve sees of its velocity; gas only.
    pub consistent: bool,
    /// Which interface vertices share one pressure.
    pub shared: Shared,
    /// Part of a cell above which bodies make it solid.
    pub solid_threshold: f64,
    /// Half of what bodies gain in the solve carries gas.
    pub late_flux: bool,
    /// Solid nodes follow the local pressure gradient.
    pub gradients: bool,
    /// The elastic step comes before the solve.
    pub coupling_last: bool,
    /// The ghost pressure follows the volumetric part of the law.
    pub shared_volume: bool,
    /// Reconstruction of the advection.
    pub weno: Weno,
    /// Courant number of an elastic sub-step.
    pub elastic_cfl: f64,
    /// Most elastic sub-steps in a step.
    pub max_substeps: usize,
    /// Courant number of the flow.
    pub cfl: f64,
    /// Courant number of sound.
    pub max_courant: f64,
    /// Most growth of the time step from one step to the next.
    pub max_growth: f64,
    /// Solid node masses are floored in the solve at this part of a full node.
    pub mass_floor: f64,
    /// The same as a share of the heaviest node next to it, in 1D, 2D and 3D.
    pub mass_beside: [f64; 3],
    /// Elasticity by backward Euler.
    pub implicit: bool,
}

impl Default for Numerics {
    fn default() -> Self {
        Self {
            pair: Pair::B1b0,
            tolerance: 1e-5,
            max_iterations: 500,
            predictor: true,
            two_solves: false,
            fourth: false,
            consistent: false,
            shared: Shared::Resolved,
            solid_threshold: 0.5,
            late_flux: true,
            gradients: false,
            coupling_last: false,
            shared_volume: false,
            weno: Weno { steep: 7e-4, even: Some(1e-6) },
            elastic_cfl: 0.4,
            max_substeps: 10_000,
            cfl: 0.5,
            max_courant: 2.0,
            max_growth: 2.0,
            mass_floor: 0.01,
            mass_beside: [0.5, 0.2, 0.03],
            implicit: false,
        }
    }
}
