//! Regions of gas: a shape and the state inside, whose keys stand side by side in a file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GasState, Shape, vector};

/// A part of the domain with its own gas state at the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "RegionKeys", into = "RegionKeys")]
pub struct Region {
    /// Where.
    pub shape: Shape,
    /// The state inside; its keys stand next to `shape` in the file.
    pub state: GasState,
}

/// The keys of a [`Region`] as they stand in the file.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Region")]
struct RegionKeys {
    /// Where.
    shape: Shape,
    /// Density `[kg m^-3]`, where `temperature` or `air` does not tell it.
    #[schemars(extend("exclusiveMinimum" = 0))]
    density: f64,
    /// Velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    velocity: [f64; 3],
    /// Pressure `[Pa]`, likewise.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pressure: f64,
    /// Mass fraction of the second gas; both gases have one temperature.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 1, "default" = 0))]
    mass_fraction: f64,
}

impl From<RegionKeys> for Region {
    fn from(keys: RegionKeys) -> Self {
        let RegionKeys { shape, density, velocity, pressure, mass_fraction } = keys;
        Region { shape, state: GasState { density, velocity, pressure, mass_fraction } }
    }
}

impl From<Region> for RegionKeys {
    fn from(region: Region) -> Self {
        let GasState { density, velocity, pressure, mass_fraction } = region.state;
        RegionKeys { shape: region.shape, density, velocity, pressure, mass_fraction }
    }
}
