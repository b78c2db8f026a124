//! Where the light of pictures in 3D comes from, and what absorbs it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Color, Scene};

/// Light of hot gas: a black body whose temperature is that of the gas, p / rho, in units of the ambient one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Emission {
    /// Temperature of the ambient gas `[K]`: that of the gas is in proportion to p / rho. Below 850 K nothing shines.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ambient_kelvin: f64,
    /// Factor on the light.
    #[schemars(extend("minimum" = 0))]
    pub strength: f64,
    /// Optical depth of the whole domain filled with gas of 2600 K or more.
    #[schemars(extend("exclusiveMinimum" = 0))]
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
    /// Extinction per mass of the second gas `[m^2 kg^-1]`; the default is that of products of TNT, a fifth of which is soot.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub extinction: f64,
}

impl Default for Soot {
    /// Nearly a fifth of the products of TNT is soot, of 8700 m^2 kg^-1. \[Mulholland and Croarkin 2000\]
    fn default() -> Self {
        Soot { extinction: 1600.0 }
    }
}

/// Dust that absorbs light, scatters the rest in its colour, and casts shadows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DustLook {
    /// Extinction per mass `[m^2 kg^-1]`: 3 over the width and the density of the grains. The default is that of quartz 50 um wide.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub extinction: f64,
    /// Share of the light that it scatters, as a colour.
    pub color: Color,
}

impl Default for DustLook {
    /// Grains wide beside the wave of light stop twice what meets them. \[van de Hulst 1957\]
    fn default() -> Self {
        DustLook { extinction: 22.6, color: Color([0xb4, 0x9b, 0x78]) }
    }
}

/// Differences of density bend light, in 3D: n - 1 is in proportion to the density.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Refraction {
    /// The constant of Gladstone and Dale, n - 1 over density `[m^3 kg^-1]`; the default is that of air in visible light.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gladstone_dale: f64,
    /// Factor on the bending; 0 turns it off.
    #[schemars(extend("minimum" = 0))]
    pub exaggeration: f64,
}

impl Default for Refraction {
    /// Air at 589 nm. \[Merzkirch 1987\]
    fn default() -> Self {
        Refraction { gladstone_dale: 2.26e-4, exaggeration: 1.0 }
    }
}

/// What is behind everything, in 3D.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Backdrop {
    /// A dark wall; `ground` is plain and fades into it.
    #[default]
    Studio,
    /// A bright sky; `ground` is bare earth up to the horizon.
    Daylight,
}

impl Backdrop {
    /// Whether it is the usual one.
    #[must_use]
    pub fn is_studio(&self) -> bool {
        *self == Backdrop::Studio
    }
}

/// Temperatures at the ends of the black-body ramp \[K\]: the Draper point is 798 K, light of the eye begins a little above.
pub const RAMP_KELVIN: [f64; 2] = [850.0, 6000.0];
/// Temperature from which hot gas is fully opaque in its own light \[K\].
const OPAQUE_KELVIN: f64 = 2600.0;
/// Temperature at which the light of an opaque body is as bright as white paper in full light \[K\].
const WHITE_KELVIN: f64 = 1900.0;

/// How much of a gas or of soot shines at a temperature \[K\], 0 to 1.
#[must_use]
pub fn shining(kelvin: f64) -> f64 {
    ((kelvin - RAMP_KELVIN[0]) / (OPAQUE_KELVIN - RAMP_KELVIN[0])).clamp(0.0, 1.0)
}

/// Luminance of an opaque body at a temperature \[K\], over that of white paper in full light.
#[must_use]
pub fn brightness(kelvin: f64) -> f64 {
    (kelvin / WHITE_KELVIN).powi(4)
}

/// What pictures of a scene in 3D make of hot gas and of soot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fire {
    /// Extinction per mass of the second gas \[m^2 kg^-1\], where it is soot.
    pub extinction: Option<f64>,
    /// Kelvin for a pressure over density of 1 m^2 s^-2, factor on the light, and extinction of the hottest gas without soot \[m^-1\]; where
    /// it shines.
    pub emission: Option<[f64; 3]>,
}

impl Fire {
    /// That of a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        if scene.domain.dimension < 3 {
            return Self::default();
        }
        let ambient = &scene.gas.ambient;
        let longest = scene.domain.size.iter().copied().fold(0.0, f64::max);
        let emission = |own: Emission| {
            [own.ambient_kelvin * ambient.density / ambient.pressure, own.strength, own.optical_depth / longest]
        };
        let soot = scene.render.soot.filter(|_| !scene.gas.species.is_empty());
        Self { extinction: soot.map(|soot| soot.extinction), emission: scene.render.emission.map(emission) }
    }

    /// Extinction by soot of a density of the second gas \[kg m^-3\]; 0 where that is none \[m^-1\].
    #[must_use]
    pub fn soot(&self, density: f64) -> f64 {
        self.extinction.unwrap_or(0.0) * density.max(0.0)
    }

    /// Luminance that a metre of gas sends out, over that of white paper in full light \[m^-1\]: of a density of the second gas
    /// \[kg m^-3\], and a pressure over density \[m^2 s^-2\].
    #[must_use]
    pub fn light(&self, density: f64, heat: f64) -> f64 {
        let Some([kelvin, strength, clear]) = self.emission else { return 0.0 };
        let kelvin = (heat * kelvin).min(RAMP_KELVIN[1]);
        let extinction = if self.extinction.is_some() { self.soot(density) } else { clear };
        strength * brightness(kelvin) * shining(kelvin) * extinction
    }
}

/// Light from outside, in 3D.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Light {
    /// Direction towards the light.
    pub direction: [f64; 3],
    /// Brightness of the light itself.
    #[schemars(extend("minimum" = 0))]
    pub strength: f64,
    /// Brightness of the sky around.
    #[schemars(extend("minimum" = 0))]
    pub ambient: f64,
    /// Bodies, obstacles and opaque gas cast shadows on everything.
    pub shadows: bool,
}

impl Default for Light {
    fn default() -> Self {
        Light { direction: [-0.3, -0.55, 0.9], strength: 1.0, ambient: 0.35, shadows: true }
    }
}
