//! What pictures show and how: fields, camera, colours.

use super::light::{Backdrop, DustLook, Emission, Light, Refraction, Soot};
use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::camera::{Camera, CameraPath};
use super::font::Font;
use super::look::Look;
use super::schema;
use super::shot::ShotKeys;

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
    /// Pressure over density to the power gamma, which no process lowers `[Pa (m^3/kg)^gamma]`.
    Entropy,
    /// Gas that a cell owes or, below zero, has too much of; of covered cells, what they hold `[kg m^-3]`.
    Owed,
    /// Mass fraction of the second gas.
    MassFraction,
    /// Dust that the gas has taken along `[kg m^-3]`.
    Dust,
    /// Largest pressure since the start `[Pa]`.
    PeakPressure,
    /// Integral over time of the pressure above that of the ambient gas `[Pa s]`.
    Impulse,
    /// Largest plastic strain of what has passed without breaking.
    PeakPlasticStrain,
}

impl Field {
    /// All fields, in the order of menus.
    pub const ALL: [Field; 14] = [
        Field::Density,
        Field::Pressure,
        Field::Velocity,
        Field::Temperature,
        Field::Schlieren,
        Field::Mach,
        Field::Vorticity,
        Field::Entropy,
        Field::Owed,
        Field::MassFraction,
        Field::Dust,
        Field::PeakPressure,
        Field::Impulse,
        Field::PeakPlasticStrain,
    ];

    /// The field's keyword in scene files.
    #[must_use]
    pub fn keyword(self) -> &'static str {
        schema::word("Field", self as usize)
    }

    /// Whether it is a map of what has been so far, which only scenes keep that ask for it.
    #[must_use]
    pub fn is_map(self) -> bool {
        matches!(self, Field::PeakPressure | Field::Impulse | Field::PeakPlasticStrain)
    }
}

/// How the pictures look.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RenderSettings {
    /// One word for many keys, where the scene does not give them; with `--set` also where it or a run does.
    pub look: Look,
    /// Width and height in pixels.
    #[schemars(inner(range(min = 16, max = 8192)))]
    pub size: [u32; 2],
    /// Where the eye is, in 3D; a view from the side and above when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<Camera>,
    /// How the camera moves with the simulated time; it stands still when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<CameraPath>,
    /// How a 3D domain is seen.
    pub mode: RenderMode,
    /// Values at the ends of the colour bar; those of each picture when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Colour map.
    pub colormap: Colormap,
    /// Draw the gas in 3D; without it slices and solids stand alone.
    pub volume: bool,
    /// Opacity of the gas in 3D, linear between points `[fraction of the colour bar, opacity]`, both 0 to 1. When left out, what differs
    /// most from the ambient gas is most opaque.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub opacity: Vec<[f64; 2]>,
    /// Optical depth of the whole domain at opacity 1; by field when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub optical_depth: Option<f64>,
    /// Light of hot gas, in 3D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emission: Option<Emission>,
    /// A second gas that absorbs light, in 3D.
    pub soot: Option<Soot>,
    /// Dust that scatters light, in 3D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dust: Option<DustLook>,
    /// Shock fronts and hot gas bend the view, in 3D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refraction: Option<Refraction>,
    /// Light from outside, in 3D.
    pub light: Light,
    /// From light to pixels, in 3D.
    pub tone: ToneMap,
    /// Factor on all light before `tone`, in 3D.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub exposure: f64,
    /// Rays per pixel along each axis.
    #[schemars(extend("minimum" = 1, "maximum" = 4))]
    pub supersampling: u32,
    /// Draw the particles.
    pub particles: bool,
    /// How particles make up a body, in 3D.
    pub surface: Surface,
    /// What the colours of the particles mean.
    pub particle_color: ParticleColor,
    /// Values at the ends of the particles' colour bar; those of each picture when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub particle_range: Option<[f64; 2]>,
    /// Colour map of the particles.
    pub particle_colormap: Colormap,
    /// A floor on the side of a 3D domain that gravity points to, low z without gravity; it catches shadows.
    pub ground: bool,
    /// What is behind everything, in 3D.
    #[serde(skip_serializing_if = "Backdrop::is_studio")]
    pub backdrop: Backdrop,
    /// Planes through a 3D domain that show the field, at most 4.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub slices: Vec<Slice>,
    /// Lines of equal value in 2D and on slices, at most 32: their number, or their values.
    #[serde(skip_serializing_if = "Contours::is_none")]
    pub contours: Contours,
    /// Velocity arrows across a 2D picture.
    #[schemars(extend("minimum" = 0, "maximum" = 200))]
    pub arrows: u32,
    /// What is written over and around the picture.
    pub overlays: Overlays,
    /// Size of what is written; at 1 a line takes a 36th of the picture's height.
    #[schemars(extend("minimum" = 0.5, "maximum" = 4))]
    pub text_size: f64,
    /// A `.ttf` or `.otf` in the folder of the scene, for letters that the program's fonts lack: they have Latin, Greek and Cyrillic. One font
    /// serves all views.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub font: Option<Font>,
    /// Further pictures of every frame, by name: what each changes of the keys above, and its `fields`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(with = "BTreeMap<String, ShotKeys>")]
    pub views: BTreeMap<String, toml::Table>,
}

impl Default for RenderSettings {
    fn default() -> Self {
        RenderSettings {
            look: Look::default(),
            size: [1280, 720],
            camera: None,
            path: None,
            mode: RenderMode::default(),
            range: None,
            colormap: Colormap::default(),
            volume: true,
            opacity: Vec::new(),
            optical_depth: None,
            emission: None,
            soot: None,
            dust: None,
            refraction: None,
            light: Light::default(),
            tone: ToneMap::default(),
            exposure: 1.0,
            supersampling: 1,
            particles: true,
            surface: Surface::default(),
            particle_color: ParticleColor::default(),
            particle_range: None,
            particle_colormap: Colormap::Plasma,
            ground: false,
            backdrop: Backdrop::default(),
            slices: Vec::new(),
            contours: Contours::default(),
            arrows: 0,
            overlays: Overlays::default(),
            text_size: 1.0,
            font: None,
            views: BTreeMap::new(),
        }
    }
}

/// How a 3D domain is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RenderMode {
    /// Ray march; density is shown by shades of its gradient.
    #[default]
    Schlieren,
    /// Ray march; density is shown through the colour map.
    Density,
    /// How far light is bent across a slanted knife edge, in grey, as a schlieren camera shows it.
    LineOfSight,
    /// How light is focused along each line of sight, in grey, as a shadow on a screen.
    Shadowgraph,
}

/// Colour map; all but gray and the diverging one are perceptually uniform in hue and lightness.
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
    /// Blue, white, red; for ranges with a middle.
    RedBlue,
}

/// From light to pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ToneMap {
    /// Cut off at white; colours stay those of the colour bar.
    #[default]
    None,
    /// The shoulder of film, for pictures with `emission`: bright light keeps its shape and turns white.
    Aces,
}

/// How particles make up a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Surface {
    /// Every particle is a ball.
    Spheres,
    /// Rays meet the smooth surface of what the particles make up (3D), closed also where a body is stretched. A particle that touches no
    /// other one is a shard, and broken ones are rough.
    #[default]
    Smooth,
}

/// What the colours of the particles mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ParticleColor {
    /// One colour per body, darker where it has flowed.
    #[default]
    Body,
    /// One colour per material, darker where it has flowed.
    Material,
    /// Speed `[m s^-1]`.
    Speed,
    /// Norm of the deviatoric stress `[Pa]`.
    DeviatoricStress,
    /// Equivalent plastic strain.
    PlasticStrain,
    /// Damage: 0 whole, 1 broken.
    Damage,
    /// Pressure over density of the gas around `[m^2 s^-2]`.
    Temperature,
}

impl ParticleColor {
    /// All of them, in the order of menus.
    pub const ALL: [ParticleColor; 7] = [
        ParticleColor::Body,
        ParticleColor::Material,
        ParticleColor::Speed,
        ParticleColor::DeviatoricStress,
        ParticleColor::PlasticStrain,
        ParticleColor::Damage,
        ParticleColor::Temperature,
    ];

    /// Whether colours are values on a colour bar.
    #[must_use]
    pub fn is_value(self) -> bool {
        !matches!(self, ParticleColor::Body | ParticleColor::Material)
    }
}

/// A plane through a 3D domain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slice {
    /// A point of the plane `[m]`.
    pub point: [f64; 3],
    /// Direction across the plane.
    pub normal: [f64; 3],
}

/// Lines of equal value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a number of lines, or a list of values")]
pub enum Contours {
    /// This many, evenly spaced over the range.
    Count(u32),
    /// At these values.
    Values(Vec<f64>),
}

impl Default for Contours {
    fn default() -> Self {
        Contours::Count(0)
    }
}

impl Contours {
    /// Whether there are no lines.
    #[must_use]
    pub fn is_none(&self) -> bool {
        match self {
            Contours::Count(count) => *count == 0,
            Contours::Values(values) => values.is_empty(),
        }
    }
}

/// What is written over and around a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Overlays {
    /// The scene's title.
    pub title: bool,
    /// The time.
    pub time: bool,
    /// Colours with their values and units.
    pub color_bar: bool,
    /// A length, where the picture has one scale: in 2D, and in 3D with parallel rays.
    pub scale_bar: bool,
    /// The edges of a 3D domain.
    pub edges: bool,
}

impl Overlays {
    /// Nothing is written.
    pub const NONE: Overlays = Overlays { title: false, time: false, color_bar: false, scale_bar: false, edges: false };
}

impl Default for Overlays {
    fn default() -> Self {
        Overlays { title: true, time: true, color_bar: true, scale_bar: true, edges: true }
    }
}
