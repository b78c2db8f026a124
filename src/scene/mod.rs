//! What the user asks for: one TOML file is one experiment. Pure data, no device.
//!
//! A scene is read by [`Scene::load`], which reports every mistake with file, line and key, and is turned into cells and
//! particles by [`Scene::initial_gas`], [`Scene::obstacle_cells`] and [`Scene::seed_particles`].
//!
//! Units are consistent and chosen by the scene: every field names its dimension in brackets, in kg, m, s for example.

mod atmosphere;
mod beyond;
mod body;
mod boundary;
mod build;
mod burn;
mod camera;
mod charge;
mod check;
mod color;
mod coupling;
mod dust;
mod expectation;
mod file;
mod finding;
mod font;
mod fracture;
mod gauge;
mod geometry;
mod going_on;
mod integrator;
mod light;
mod look;
mod noise;
mod numerics;
mod radial_flow;
mod region;
mod render;
mod schema;
mod settings;
mod shape;
mod shock_tube;
mod shot;
mod species;
#[cfg(test)]
mod tests;
mod vector;
mod vortex;
mod warned;
mod wave;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

include!(concat!(env!("OUT_DIR"), "/scenes.rs"));

pub use crate::material::Material;
pub use atmosphere::Atmosphere;
pub use beyond::{MAX_REMEMBERED, Remembered};
pub use body::{Body, Contact, Friction, Motion, MotionAt, Sampling};
pub use boundary::{
    AttenuatedOutlet, Boundaries, Boundary, Inflow, InletRule, Patch, Patched, PressureOutlet, Reservoir, TimedInlet,
    TimedState,
};
pub use build::SceneBuilder;
pub use burn::GridCharge;
pub(crate) use burn::{BURN_WIDTH, NEVER};
pub use camera::{Camera, CameraKey, CameraPath};
pub use charge::{Charge, Placed};
pub use check::blast_estimate::{ChargeEstimate, PlaceEstimate};
pub use check::body::MAX_BODIES;
pub use check::boundary::MAX_OPENINGS;
pub use check::budget::MOST_PARTICLES;
pub use check::estimate::{Estimate, IMPLICIT_COURANT};
#[doc(hidden)]
pub use check::limits::allowed;
pub use color::Color;
pub use coupling::{Coupling, Elasticity, Ghost, InterfacePressure, SolidUpdate};
pub use dust::Dust;
pub use expectation::{Expect, ExpectedBody, ExpectedOrder, ExpectedProbe, Quantity};
pub use file::earlier::FORM;
pub use file::shipped::{STANDARD_INPUT, Shipped, scene_file, shipped, shipped_named, stem};
pub use file::variants::{Changes, GALLERY, SMALL, is_size};
pub use font::Font;
pub use fracture::{Breaking, Tearing};
pub use gauge::{Gauge, GaugePlace, Side};
pub use geometry::camera_file::CameraFile;
pub use geometry::cut::{CutCell, CutGeometry};
#[cfg(feature = "viewer")]
pub(crate) use geometry::mesh::is_mesh_file;
pub use geometry::mesh::{Mesh, Up};
pub use geometry::named::Named;
pub use geometry::polyhedron::Part;
pub(crate) use geometry::sample::random;
pub use geometry::sample::{Overlap, Seed, ThinBody, ThinObstacle};
pub use integrator::{FaceVelocity, Integrator, OddEvenFilter};
pub use light::{Backdrop, DustLook, Emission, Fire, Light, RAMP_KELVIN, Refraction, Soot, brightness, shining};
pub use look::Look;
pub use numerics::{Expert, Numerics, Obstacles, Pair, Paper, Preconditioner, Transfer};
pub use radial_flow::RadialFlow;
pub use region::Region;
pub use render::{
    Colormap, Contours, Field, Overlays, ParticleColor, RenderMode, RenderSettings, Slice, Surface, ToneMap,
};
pub use settings::{Output, Time};
pub use shape::Shape;
pub use shot::{Shot, ShotKeys};
pub(crate) use species::held_energy;
pub use species::{Conserved, EquationOfState, SecondGas, Species};
pub use vortex::Vortex;
pub use warned::Warned;
pub use wave::Wave;

/// One experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Name of the experiment, one line.
    pub title: String,
    /// What it shows and where its numbers come from.
    #[serde(default)]
    pub description: String,
    /// The grid.
    pub domain: Domain,
    /// The gas and its state at the start.
    pub gas: Gas,
    /// What happens at the sides of the domain; all are walls when left out.
    #[serde(default)]
    pub boundary: Boundaries,
    /// Materials of the bodies, by name.
    #[serde(default)]
    pub materials: BTreeMap<String, Material>,
    /// Shapes by name, for `use` in other shapes.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub shapes: BTreeMap<String, Shape>,
    /// Deformable solids, moved by the material point method.
    #[serde(default)]
    pub bodies: Vec<Body>,
    /// Static obstacles; `numerics.paper.obstacles` says how finely the grid sees them.
    #[serde(default)]
    pub obstacles: Vec<Obstacle>,
    /// Explosives that go off during the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub charges: Vec<Charge>,
    /// Acceleration of gravity `[m s^-2]`.
    #[serde(default, with = "vector::Point")]
    pub gravity: [f64; 3],
    /// How long and how finely in time.
    pub time: Time,
    /// Choices of the method; the defaults are what the method recommends.
    #[serde(default)]
    pub numerics: Numerics,
    /// Points whose gas state is written every step.
    #[serde(default)]
    pub probes: Vec<Probe>,
    /// Loads of the gas on walls, obstacles and bodies, and motions of points of bodies, written every step.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gauges: Vec<Gauge>,
    /// Which files a run leaves; one picture of the density per frame when left out.
    #[serde(default)]
    pub output: Output,
    /// How the pictures look.
    #[serde(default)]
    pub render: RenderSettings,
    /// What the result must satisfy; checked by the tests and reported by `run`.
    #[serde(default)]
    pub expect: Expect,
    /// Named sets of changes to the keys above, chosen by `--variant`: what the scene is otherwise.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(with = "BTreeMap<String, BTreeMap<String, serde_json::Value>>")]
    pub variants: BTreeMap<String, toml::Table>,
}

/// The grid: cubes of edge `size / cells`. Axes beyond `dimension` have one cell and unit thickness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Number of active axes: x, then y, then z.
    #[schemars(extend("minimum" = 1, "maximum" = 3))]
    pub dimension: u32,
    /// Cells per axis, at least 3.
    #[serde(with = "vector::Counts")]
    pub cells: [u32; 3],
    /// Low corner `[m]`.
    #[serde(default, with = "vector::Point")]
    pub origin: [f64; 3],
    /// Edge lengths `[m]`, above 0.
    #[serde(with = "vector::Lengths")]
    pub size: [f64; 3],
}

/// An ideal gas, p = (gamma - 1) rho e, or two.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gas {
    /// Ratio of specific heats; air has 1.4.
    #[serde(default = "default_gamma")]
    #[schemars(extend("exclusiveMinimum" = 1))]
    pub gamma: f64,
    /// A second gas, by name: a scene has one at most.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub species: BTreeMap<String, Species>,
    /// State wherever no region says otherwise.
    pub ambient: GasState,
    /// How it starts under gravity.
    #[serde(default)]
    pub atmosphere: Atmosphere,
    /// Parts with a `shape` and their own state; a later one covers an earlier one.
    #[serde(default)]
    pub regions: Vec<Region>,
    /// Sine waves on top of that.
    #[serde(default)]
    pub waves: Vec<Wave>,
    /// Isentropic vortices around z on top of that.
    #[serde(default)]
    pub vortices: Vec<Vortex>,
    /// Flows towards or away from a point on top of that.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub radial_flows: Vec<RadialFlow>,
    /// Noise on every cell on top of that, in every run the same. It is even, between plus and minus this share of density, pressure and
    /// speed of sound.
    #[serde(default)]
    #[schemars(extend("minimum" = 0, "maximum" = 0.5))]
    pub noise: f64,
    /// Dust that the gas takes along from the ground.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dust: Option<Dust>,
}

fn default_gamma() -> f64 {
    1.4
}

/// Density, velocity and pressure of a gas. In a file, `temperature` and `air` may say one or both of them, and `species` which gas it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasState {
    /// Density `[kg m^-3]`, where `temperature` or `air` does not tell it.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
    /// Velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Pressure `[Pa]`, likewise.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub pressure: f64,
    /// Mass fraction of the second gas; both gases have one temperature.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 1, "default" = 0))]
    pub mass_fraction: f64,
}

fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

/// A static obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Name in messages, unique.
    pub name: String,
    /// What the gas cannot enter.
    pub shape: Shape,
}

/// A point whose gas state is recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Its columns in `probes.csv`, unique.
    pub name: String,
    /// Where `[m]`, inside the domain.
    #[serde(with = "vector::Point")]
    pub position: [f64; 3],
}

impl Domain {
    /// Zero of the device's coordinates in those of the scene \[m\]: the low corner of a domain that lies further from zero than twice its
    /// longest edge. Single precision holds a place to 6e-8 of its distance from zero, which in map coordinates is metres.
    #[must_use]
    pub fn frame(&self) -> [f64; 3] {
        let edge = self.size.iter().copied().fold(0.0, f64::max);
        let far = self.origin.iter().any(|low| low.abs() > 2.0 * edge);
        if far { self.origin } else { [0.0; 3] }
    }

    /// A point of the scene in the device's coordinates \[m\].
    #[must_use]
    pub fn in_frame(&self, point: [f64; 3]) -> [f32; 3] {
        let frame = self.frame();
        std::array::from_fn(|axis| (point[axis] - frame[axis]) as f32)
    }

    /// Edge of a cell `[m]`.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.size[0] / f64::from(self.cells[0])
    }

    /// Number of active axes, as an index bound: at most 3, also of a scene whose `dimension` is refused.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.dimension.min(3) as usize
    }

    /// Number of cells, without padding.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.cells.iter().map(|&n| n as usize).product()
    }

    /// Volume of a cell `[m^3]`: spacing^dimension times the unit thickness of the inactive axes.
    #[must_use]
    pub fn cell_volume(&self) -> f64 {
        self.spacing().powi(self.dimension as i32)
    }

    /// Centre of a cell `[m]`; 0 along inactive axes.
    #[must_use]
    pub fn cell_center(&self, cell: [u32; 3]) -> [f64; 3] {
        let center = |d: usize| self.origin[d] + (f64::from(cell[d]) + 0.5) * self.spacing();
        std::array::from_fn(|d| if d < self.axes() { center(d) } else { 0.0 })
    }

    /// Centre of the face of a side next to a cell `[m]`; the entry of `cell` along the side's axis does not matter. Sides are
    /// numbered as in [`Boundaries::sides`].
    #[must_use]
    pub fn face_center(&self, side: usize, cell: [u32; 3]) -> [f64; 3] {
        let mut center = self.cell_center(cell);
        let axis = side / 2;
        center[axis] = self.origin[axis] + if side.is_multiple_of(2) { 0.0 } else { self.size[axis] };
        center
    }

    /// Centres of all faces of a side `[m]`.
    pub fn side_faces(&self, side: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.cells_at(side).map(move |cell| self.face_center(side, cell))
    }
}

impl GasState {
    /// Density, momentum and total energy, each per volume: (rho, rho u, E), E = p / (gamma - 1) + rho u^2 / 2.
    #[must_use]
    pub fn conserved(&self, gamma: f64) -> [f64; 5] {
        let [u, v, w] = self.velocity;
        let kinetic = 0.5 * self.density * (u * u + v * v + w * w);
        let energy = self.pressure / (gamma - 1.0) + kinetic;
        [self.density, self.density * u, self.density * v, self.density * w, energy]
    }

    /// Speed of sound `[m s^-1]`.
    #[must_use]
    pub fn sound_speed(&self, gamma: f64) -> f64 {
        (gamma * self.pressure / self.density).sqrt()
    }
}

impl Scene {
    /// Position of a material among the sorted names: the index that particles carry.
    #[must_use]
    pub fn material_index(&self, name: &str) -> Option<u32> {
        self.materials.keys().position(|key| key == name).map(|index| index as u32)
    }

    /// The parameters of all materials in the order of [`Scene::material_index`], as the device sees them.
    #[must_use]
    pub fn material_parameters(&self) -> Vec<crate::material::MaterialParams> {
        let (share, cell) = (self.volume_share(), self.domain.spacing());
        self.materials.values().map(|material| material.params_with_fracture(share, cell)).collect()
    }

    /// The same for energies on the host.
    #[must_use]
    pub fn laws(&self) -> crate::material::Laws {
        let shared = self.numerics.paper.ghost == Ghost::SharedVolume;
        crate::material::Laws { materials: self.material_parameters(), start: self.gas.ambient.pressure, shared }
    }

    /// The JSON schema of scene files (draft 2020-12).
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(Scene)
    }
}

/// The JSON schema of scene files, indented: what `brisance schema` prints.
#[must_use]
pub fn schema() -> String {
    let mut schema = Scene::schema().to_value();
    file::gas_state::add_keys(&mut schema);
    file::species::add_keys(&mut schema);
    format!("{schema:#}")
}
