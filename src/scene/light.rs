//! Where the light of pictures in 3D comes from, and what absorbs it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Light of hot gas: a black body whose temperature is that of the gas, p / rho, in units of the ambient one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Emission {
    /// Temperature of the ambient gas \[K\]: hotter gas shines by its ratio to this.
    pub ambient_kelvin: f64,
    /// Factor on the light.
    pub strength: f64,
    /// Optical depth of the whole domain filled with white-hot gas.
    pub optical_depth: f64,
}

impl Default for Emission {
    fn default() -> Self {
        Emission { ambient_kelvin: 300.0, strength: 1.0, optical_depth: 20.0 }
    }
}

/// A second gas that absorbs light and scatters a little of it, as smoke does; with [`Emission`] it shines where it is hot, and nothing else
/// does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Soot {
    /// Extinction per mass of the second gas \[m^2 kg^-1\].
    pub extinction: f64,
}

impl Default for Soot {
    /// Nearly a fifth of the products of TNT is soot, of 8700 m^2 kg^-1. \[Mulholland and Croarkin 2000\]
    fn default() -> Self {
        Soot { extinction: 1600.0 }
    }
}

/// Light from outside, in 3D.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Light {
    /// Direction towards the light.
    pub direction: [f64; 3],
    /// Brightness of the light itself.
    pub strength: f64,
    /// Brightness of the sky around.
    pub ambient: f64,
    /// Gas, bodies, obstacles cast shadows.
    pub shadows: bool,
}

impl Default for Light {
    fn default() -> Self {
        Light { direction: [-0.3, -0.55, 0.9], strength: 1.0, ambient: 0.35, shadows: true }
    }
}
