//! The gases of a scene: the one that every scene has, and a second one that some have.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Gas, GasState};

/// Gas constant of dry air \[J kg^-1 K^-1\]. [U.S. Standard Atmosphere, 1976]
pub(super) const AIR_CONSTANT: f64 = 287.053;

/// A second ideal gas, that does not mix with the first below the size of a cell: both have one velocity and one pressure there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Species {
    /// Ratio of specific heats, above 1.
    pub gamma: f64,
    /// Gas constant `[J kg^-1 K^-1]`; where both gases are in one state, it tells their volumes at one temperature, that of the first being
    /// the one of air.
    #[serde(default = "air_constant")]
    pub gas_constant: f64,
}

fn air_constant() -> f64 {
    AIR_CONSTANT
}

/// What is conserved in a cell: density \[kg m^-3\], momentum \[kg m^-2 s^-1\], energy \[J m^-3\], density of the second gas \[kg m^-3\], each
/// per volume; then its volume fraction, which is carried along.
pub type Conserved = [f64; 7];

/// The equation of state of one or two ideal gases: rho e = p G, G = phi / (gamma_1 - 1) + (1 - phi) / (gamma - 1). [Allaire, Clerc and Kokh 2002]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquationOfState {
    /// Ratio of specific heats of the first gas.
    pub gamma: f64,
    /// The second gas.
    pub species: Option<Species>,
}

impl EquationOfState {
    /// gamma - 1 at a volume fraction of the second gas.
    #[must_use]
    pub fn grueneisen(&self, phi: f64) -> f64 {
        let Some(species) = self.species else { return self.gamma - 1.0 };
        1.0 / (phi / (species.gamma - 1.0) + (1.0 - phi) / (self.gamma - 1.0))
    }

    /// Ratio of specific heats at a volume fraction.
    #[must_use]
    pub fn gamma_at(&self, phi: f64) -> f64 {
        if self.species.is_none() { self.gamma } else { 1.0 + self.grueneisen(phi) }
    }

    /// Gas constant of the mixture over that of the first gas.
    #[must_use]
    pub fn constant_ratio(&self, mass_fraction: f64) -> f64 {
        let own = self.species.map_or(1.0, |species| species.gas_constant / AIR_CONSTANT);
        1.0 + mass_fraction * (own - 1.0)
    }

    /// Pressure \[Pa\].
    #[must_use]
    pub fn pressure(&self, [density, x, y, z, energy, _, phi]: Conserved) -> f64 {
        self.grueneisen(phi) * (energy - 0.5 * (x * x + y * y + z * z) / density)
    }

    /// Volume fraction of the second gas at a mass fraction, where both have one temperature.
    #[must_use]
    pub fn volume_fraction(&self, mass_fraction: f64) -> f64 {
        let own = mass_fraction * self.species.map_or(AIR_CONSTANT, |species| species.gas_constant);
        own / (own + (1.0 - mass_fraction) * AIR_CONSTANT)
    }

    /// A state per volume.
    #[must_use]
    pub fn conserved(&self, state: &GasState) -> Conserved {
        let phi = self.volume_fraction(state.mass_fraction);
        let [density, x, y, z, energy] = state.conserved(self.gamma_at(phi));
        [density, x, y, z, energy, density * state.mass_fraction, phi]
    }
}

impl Gas {
    /// The equation of state.
    #[must_use]
    pub fn equation_of_state(&self) -> EquationOfState {
        EquationOfState { gamma: self.gamma, species: self.species.values().next().copied() }
    }
}
