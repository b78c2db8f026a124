//! What pictures show and how: fields, camera, colours.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A quantity of the gas that can be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Field {
    /// Density `[kg m^-3]`.
    Density,
    /// Pressure `[Pa]`.
    Pressure,
    /// Speed `[m s^-1]`.
    Velocity,
    /// Pressure over density, the temperature times the gas constant `[m^2 s^-2]`.
    Temperature,
    /// Shades of the density gradient, like the optical method.
    Schlieren,
    /// Speed over the speed of sound.
    Mach,
    /// Magnitude of the curl of the velocity `[s^-1]`.
    Vorticity,
}

impl Field {
    /// All fields, in the order of menus.
    pub const ALL: [Field; 7] = [
        Field::Density,
        Field::Pressure,
        Field::Velocity,
        Field::Temperature,
        Field::Schlieren,
        Field::Mach,
        Field::Vorticity,
    ];

    /// The field's keyword in scene files.
    #[must_use]
    pub fn keyword(self) -> &'static str {
        match self {
            Field::Density => "density",
            Field::Pressure => "pressure",
            Field::Velocity => "velocity",
            Field::Temperature => "temperature",
            Field::Schlieren => "schlieren",
            Field::Mach => "mach",
            Field::Vorticity => "vorticity",
        }
    }
}

/// How the pictures look.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RenderSettings {
    /// Width and height in pixels, 16 to 8192 each.
    pub size: [u32; 2],
    /// Where the eye is, in 3D; a view from the side and above when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<Camera>,
    /// What the ray march through a 3D domain shows.
    pub mode: RenderMode,
    /// Values at the ends of the colour bar; those of each picture when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Colour map.
    pub colormap: Colormap,
    /// Draw the particles.
    pub particles: bool,
}

impl Default for RenderSettings {
    fn default() -> Self {
        RenderSettings {
            size: [1280, 720],
            camera: None,
            mode: RenderMode::default(),
            range: None,
            colormap: Colormap::default(),
            particles: true,
        }
    }
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Position of the eye `[m]`.
    pub eye: [f64; 3],
    /// The point in the middle of the picture `[m]`.
    pub target: [f64; 3],
    /// Direction that is up in the picture.
    #[serde(default = "Camera::default_up")]
    pub up: [f64; 3],
    /// Vertical opening angle `[degrees]`, 1 to 170.
    #[serde(default = "Camera::default_fov")]
    pub fov_degrees: f64,
}

impl Camera {
    fn default_up() -> [f64; 3] {
        [0.0, 0.0, 1.0]
    }
    fn default_fov() -> f64 {
        40.0
    }
}

/// What the ray march shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RenderMode {
    /// Shades of the density gradient.
    #[default]
    Schlieren,
    /// Density through the colour map.
    Density,
}

/// Colour map; all but gray are perceptually uniform in hue and lightness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Colormap {
    /// Blue, green, yellow.
    #[default]
    Viridis,
    /// Black, red, pale yellow.
    Inferno,
    /// Black, purple, pale yellow.
    Magma,
    /// Blue, pink, yellow.
    Plasma,
    /// Blue, gray, yellow; for colour-blind readers.
    Cividis,
    /// Black to white.
    Gray,
}
