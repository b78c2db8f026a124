//! Sections of a scene that say how long to compute and which files to write.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Field;

/// How long, and how finely in time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run `[s]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub until: f64,
    /// Fraction of the advective time step.
    #[serde(default = "Time::default_cfl")]
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
    pub cfl: f64,
    /// Pictures, evenly spaced, besides that of the start.
    #[serde(default = "Time::default_frames")]
    #[schemars(extend("minimum" = 1, "maximum" = 1_000_000))]
    pub frames: u32,
    /// A step moves sound by at most this many cells.
    #[serde(default = "Time::default_max_courant")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max_courant: f64,
    /// A step is at most this many times the one before.
    #[serde(default = "Time::default_max_growth")]
    #[schemars(extend("exclusiveMinimum" = 1))]
    pub max_growth: f64,
    /// Constant step `[s]` instead of the rules above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub fixed_step: Option<f64>,
}

impl Default for Time {
    fn default() -> Self {
        Time {
            until: 1.0,
            cfl: Time::default_cfl(),
            frames: Time::default_frames(),
            max_courant: Time::default_max_courant(),
            max_growth: Time::default_max_growth(),
            fixed_step: None,
        }
    }
}

impl Time {
    fn default_cfl() -> f64 {
        0.5
    }
    fn default_frames() -> u32 {
        24
    }
    fn default_max_courant() -> f64 {
        2.0
    }
    fn default_max_growth() -> f64 {
        2.0
    }
}

/// Which files a run leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// Fields shown, one picture each; in 3D the first one is ray marched.
    pub fields: Vec<Field>,
    /// Also write VTK files of all fields and particles.
    pub vtk: bool,
    /// Write `NNNN.png` with 16 bits per channel instead of 8.
    pub png16: bool,
    /// Also write `NNNN.exr` for compositors: linear light with alpha, depth, objects, velocities.
    pub exr: bool,
    /// Keep maps for files, too; a field that shows one turns it on.
    pub maps: bool,
    /// Also write `states/NNNN.npz`, from which `brisance render` draws again.
    pub states: bool,
    /// What the ambient gas has `[K]`: `temperature` in volumes (`vdb`, `usd`) is in kelvin then, else pressure over density. `convert --kelvin`
    /// gives it later.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ambient_kelvin: Option<f64>,
}

impl Output {
    /// Names of the formats that the scene asks for beside pictures.
    pub fn formats(&self) -> impl Iterator<Item = &'static str> {
        let all = [("vtk", self.vtk), ("png16", self.png16), ("exr", self.exr), ("fields", self.states)];
        all.into_iter().filter(|(_, on)| *on).map(|(name, _)| name)
    }
}

impl Default for Output {
    fn default() -> Self {
        Output {
            fields: vec![Field::Density],
            vtk: false,
            png16: false,
            exr: false,
            maps: false,
            states: false,
            ambient_kelvin: None,
        }
    }
}
