//! What a run should have done: the table `expect`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Warned, schema, vector};

/// What the result must satisfy at the end of the run, at the scene's own resolution. Every entry is optional.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[serde(rename_all = "snake_case")]
pub struct Expect {
    /// Largest relative change of the gas mass, ledger included; for closed domains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gas_mass_drift: Option<f64>,
    /// Largest relative change of the energy of gas and solids together; for closed domains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_drift: Option<f64>,
    /// Lowest and highest value allowed for that change with its sign: negative where energy is lost.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_change: Option<[f64; 2]>,
    /// Largest speed of gas and particles over the ambient speed of sound; for scenes at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_speed: Option<f64>,
    /// Lowest and highest value allowed for that speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_speed: Option<[f64; 2]>,
    /// Largest L1 error of the density against the exact Riemann solution `[kg m^-2]`; 1D scenes of ambient gas and one region.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_l1: Option<f64>,
    /// Lowest and highest value allowed for the largest density `[kg m^-3]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_density: Option<[f64; 2]>,
    /// The density stays above this `[kg m^-3]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_density: Option<f64>,
    /// The pressure stays above this `[Pa]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_pressure: Option<f64>,
    /// Most iterations of any pressure solve.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_iterations: Option<u32>,
    /// Most steps of the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_steps: Option<u32>,
    /// Fewest separate pieces that the bodies have broken into.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pieces: Option<u32>,
    /// What must hold of single bodies.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<ExpectedBody>,
    /// Bodies of which each has more of a quantity than the one that follows it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub order: Vec<ExpectedOrder>,
    /// What probes must have seen.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub probes: Vec<ExpectedProbe>,
    /// Warnings that are right, each with the reason: they are told, and `--strict` bears them.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub warnings: BTreeMap<Warned, String>,
}

/// What must hold of a body at the end. Ranges are the lowest and the highest value allowed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedBody {
    /// Name of the body.
    pub body: String,
    /// Where its centre of mass must be `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "vector::optional_point")]
    #[schemars(with = "Option<vector::Point>")]
    pub center: Option<[f64; 3]>,
    /// Distance from `center` allowed `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Distance of the centre of mass from where it was at the start `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved: Option<[f64; 2]>,
    /// The same along x, with its sign `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved_x: Option<[f64; 2]>,
    /// The same along y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved_y: Option<[f64; 2]>,
    /// The same along z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved_z: Option<[f64; 2]>,
    /// Separate pieces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pieces: Option<[f64; 2]>,
    /// Largest equivalent plastic strain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plastic_strain: Option<[f64; 2]>,
    /// Rms distance of its particles from where they would be had it moved as a rigid body, over their rms distance from its centre at the
    /// start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distortion: Option<[f64; 2]>,
    /// Part of the particles that is still inside the domain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<[f64; 2]>,
}

impl ExpectedBody {
    /// The ranges that are given.
    pub fn ranges(&self) -> impl Iterator<Item = (Quantity, [f64; 2])> {
        let ranges = [
            (Quantity::Moved, self.moved),
            (Quantity::MovedX, self.moved_x),
            (Quantity::MovedY, self.moved_y),
            (Quantity::MovedZ, self.moved_z),
            (Quantity::Pieces, self.pieces),
            (Quantity::PlasticStrain, self.plastic_strain),
            (Quantity::Distortion, self.distortion),
            (Quantity::Left, self.left),
        ];
        ranges.into_iter().filter_map(|(quantity, range)| Some((quantity, range?)))
    }
}

/// A number that a body has at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Distance of the centre of mass from where it was at the start `[m]`.
    Moved,
    /// The same along x.
    MovedX,
    /// The same along y.
    MovedY,
    /// The same along z.
    MovedZ,
    /// Separate pieces.
    Pieces,
    /// Largest equivalent plastic strain.
    PlasticStrain,
    /// Rms distance of the particles from where a rigid motion would have brought them, over their rms distance from the centre.
    Distortion,
    /// Part of the particles that is still inside the domain.
    Left,
}

impl Quantity {
    /// Its key.
    #[must_use]
    pub fn name(self) -> &'static str {
        schema::word("Quantity", self as usize)
    }
}

/// Bodies of which each has more of a quantity than the one that follows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedOrder {
    /// Which quantity.
    pub quantity: Quantity,
    /// Names, from the body that has most of it.
    pub bodies: Vec<String>,
}

/// What a probe must have seen in gas. Ranges are the lowest and the highest value allowed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedProbe {
    /// Name of the probe.
    pub probe: String,
    /// Largest pressure `[Pa]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<[f64; 2]>,
    /// Pressure at the end of the run `[Pa]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_at_end: Option<[f64; 2]>,
    /// When the pressure first differs from that of the first step by more than a twentieth `[s]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arrival: Option<[f64; 2]>,
    /// From then until a body covers the probe: short where a body is faster than its shock `[s]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lead: Option<[f64; 2]>,
}

impl ExpectedProbe {
    /// Its keys with their ranges.
    #[must_use]
    pub fn ranges(&self) -> [(&'static str, Option<[f64; 2]>); 4] {
        let at_end = ("pressure_at_end", self.pressure_at_end);
        [("pressure", self.pressure), at_end, ("arrival", self.arrival), ("lead", self.lead)]
    }
}
