//! How metals break: voids grow with plastic flow, the faster the more tension there is on all sides. [Johnson & Cook 1985]

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Mean stress over that of von Mises in a pulled rod.
const ROD: f64 = 1.0 / 3.0;
/// Plastic strain that voids take at least, whatever the tension. Mirror of `LEAST_STRAIN` in shaders/materials/voids.wgsl.
const LEAST_STRAIN: f64 = 0.01;

/// Plastic strain at which voids join: (d1 + d2 exp(d3 t)) (1 + d4 ln(strain rate over `rate`)) (1 + d5 T), t the mean stress over that of von
/// Mises, T the temperature as `flow` has it; at least 0.01. Below t = -1/3 none grow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JohnsonCook {
    /// Part that no stress changes `[1]`.
    pub d1: f64,
    /// Part that falls with the tension `[1]`.
    pub d2: f64,
    /// How fast it falls, negative `[1]`.
    #[schemars(extend("maximum" = 0))]
    pub d3: f64,
    /// Growth with the logarithm of the strain rate `[1]`.
    #[serde(default)]
    pub d4: f64,
    /// Growth from the temperature at the start to melting; needs `flow` `[1]`.
    #[serde(default)]
    pub d5: f64,
    /// Strain rate from which on it grows `[s^-1]`.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0, "default" = 1.0))]
    pub rate: f64,
}

fn one() -> f64 {
    1.0
}

impl JohnsonCook {
    /// Plastic strain at which voids join, at a mean stress over that of von Mises, a strain rate `[s^-1]` and a share of the way to melting;
    /// infinite where no void grows.
    #[must_use]
    pub fn strain(&self, tension: f64, rate: f64, heated: f64) -> f64 {
        if tension < -ROD {
            return f64::INFINITY;
        }
        let fast = 1.0 + self.d4 * (rate / self.rate).max(1.0).ln();
        ((self.d1 + self.d2 * (self.d3 * tension).exp()) * fast * (1.0 + self.d5 * heated)).max(LEAST_STRAIN)
    }

    /// The same in a rod that is pulled slowly.
    #[must_use]
    pub fn strain_of_a_rod(&self) -> f64 {
        self.strain(ROD, 0.0, 0.0)
    }

    /// What is wrong with it: the strain at failure of a rod is to be positive, and to fall with the tension.
    pub(super) fn mistake(&self) -> Option<String> {
        let rod = self.d1 + self.d2 * (self.d3 * ROD).exp();
        let numbers = [self.d1, self.d2, self.d3, self.d4, self.d5, self.rate];
        if numbers.iter().any(|x| !x.is_finite()) || rod < LEAST_STRAIN {
            return Some(format!(
                "`johnson_cook` breaks a pulled rod at a plastic strain of {rod}: give numbers that make it at least {LEAST_STRAIN}"
            ));
        }
        (self.d3 > 0.0)
            .then(|| format!("`johnson_cook.d3` is {}: give 0 or less, tension makes voids grow faster", self.d3))
    }
}
