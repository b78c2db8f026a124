//! What a run may be warned of, by the names that reports and `[expect] warnings` use.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number that is watched in every run; `docs/inside/warnings.md` has its limit and the reason of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Warned {
    /// The budget of the mass of the gas.
    GasMass,
    /// The budget of momentum.
    Momentum,
    /// The budget of energy.
    Energy,
    /// Gas that covered cells owe.
    OwedGas,
    /// Entropy of gas below that of the start and of what flows in.
    Entropy,
    /// Cells whose energy or pressure was raised to a floor.
    FlooredCells,
    /// Cells whose products are denser than the law of their explosive allows.
    DenseProducts,
    /// Particles held back at walls.
    ClampedParticles,
    /// Steps that a limit of their effort cut short.
    CappedSteps,
    /// Bodies that have left the domain.
    LostBodies,
    /// Bodies pressed to nothing.
    CollapsedBodies,
}

impl Warned {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Warned::GasMass => "gas_mass",
            Warned::Momentum => "momentum",
            Warned::Energy => "energy",
            Warned::OwedGas => "owed_gas",
            Warned::Entropy => "entropy",
            Warned::FlooredCells => "floored_cells",
            Warned::DenseProducts => "dense_products",
            Warned::ClampedParticles => "clamped_particles",
            Warned::CappedSteps => "capped_steps",
            Warned::LostBodies => "lost_bodies",
            Warned::CollapsedBodies => "collapsed_bodies",
        }
    }
}
