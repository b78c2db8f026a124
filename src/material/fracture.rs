//! Fracture: how a material of any law loses its strength in tension. Scene keys, defaults of presets, constants for the device.
//! The strain of a crack is smeared over a band of cells, and softens so that a band dissipates the fracture energy per area.
//! [Bazant & Oh 1983]

use schemars::JsonSchema;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::drucker_prager::cone_slope;
use super::{JohnsonCook, Material, MaterialParams};

/// Cells that a band of cracking particles is wide, as far as its energy goes.
pub const BAND: f64 = 3.9;
/// Driver at full damage over that at the onset, at least: a smaller ratio would let stress grow with damage.
pub const LEAST_RATIO: f64 = 1.02;

/// Angle of internal friction of rubble \[degrees\].
const RUBBLE_ANGLE: f64 = 35.0;

/// How the stress across a crack falls as it opens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Softening {
    /// On a straight line.
    #[default]
    Linear = 1,
    /// Fast at first, with a long tail: concrete and stone.
    Exponential = 2,
}

/// What is kept where cells are too coarse for both the strength and the fracture energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AtCoarse {
    /// The tensile strength; more energy goes into a crack.
    #[default]
    Strength,
    /// The fracture energy; the material is weaker.
    Energy,
}

/// What becomes of broken particles that no whole one is near.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Debris {
    /// They stay.
    #[default]
    Keep = 0,
    /// They are taken out; the sums keep what they had.
    Drop = 1,
}

/// Scatter of the strength by flaws. [Weibull 1951]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Weibull {
    /// Weibull's modulus: the smaller, the more the strength scatters.
    #[schemars(extend("minimum" = 1, "maximum" = 1000))]
    pub modulus: f64,
    /// Edge of cubes of the material that have strengths of their own, with the given median `[m]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// A number that chooses among arrangements.
    #[serde(default)]
    pub seed: u32,
}

/// The numbers of `fracture` in a scene. Those that are left out are the preset's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct FractureKeys {
    /// Largest principal stress that it bears `[Pa]`, at most a tenth of Young's modulus; that of the preset when left out.
    #[schemars(extend("exclusiveMinimum" = 0))]
    tensile_strength: Option<f64>,
    /// Energy that a crack takes per area `[J m^-2]`; that of the preset when left out.
    #[schemars(extend("exclusiveMinimum" = 0))]
    fracture_energy: Option<f64>,
    /// How the stress across a crack falls as it opens; that of the preset, else `linear`, when left out.
    softening: Option<Softening>,
    /// What is kept where cells are too coarse for both; `check` prints what the other becomes.
    #[serde(default)]
    at_coarse: AtCoarse,
    /// Scatter of the strength.
    weibull: Option<Weibull>,
    /// Whether what has opened by half a cell bears shear by friction alone, as sand does.
    #[serde(default)]
    rubble: bool,
    /// What becomes of broken particles with no whole one within a cell.
    #[serde(default)]
    debris: Debris,
    /// It breaks by voids in place of a tensile strength, for laws that yield; those of the preset when left out.
    johnson_cook: Option<JohnsonCook>,
}

/// `fracture` as it stands in a scene.
#[derive(Clone, Copy, Debug, JsonSchema)]
#[serde(untagged)]
pub(super) enum FractureGiven {
    /// `true` takes all from the preset, `false` leaves a preset whole that breaks by itself.
    Switch(bool),
    /// Numbers.
    Keys(FractureKeys),
}

/// The schema of `fracture` beside a law or a preset that knows no strength.
pub(super) struct OwnFracture;

impl JsonSchema for OwnFracture {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "OwnFracture".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let keys = FractureKeys::json_schema(generator).to_value();
        let needing = |first: &str, kind: serde_json::Value, text: &str| {
            let mut keys = keys.clone();
            keys["properties"][first] = kind;
            keys["properties"]["fracture_energy"]["type"] = "number".into();
            keys["required"] = serde_json::json!([first, "fracture_energy"]);
            keys["description"] = text.into();
            keys
        };
        let mut strength = keys["properties"]["tensile_strength"].clone();
        strength["type"] = "number".into();
        let brittle = needing("tensile_strength", strength, "The numbers of `fracture`, where no preset knows them.");
        let voids = generator.subschema_for::<JohnsonCook>().to_value();
        let metal = needing("johnson_cook", voids, "The numbers of `fracture` of a metal, where no preset knows them.");
        let text = "`fracture = true` needs a preset that knows its strength; \
                    give `fracture = { tensile_strength = ... [Pa], fracture_energy = ... [J m^-2] }`";
        let off = serde_json::json!({ "type": "boolean", "const": false, "description": text });
        schemars::json_schema!({ "description": "How it breaks.", "anyOf": [off, brittle, metal] })
    }
}

/// How a material breaks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fracture {
    /// Tensile strength `[Pa]`; 0 for what breaks by voids.
    #[serde(skip_serializing_if = "is_zero")]
    pub tensile_strength: f64,
    /// Energy that a crack takes per area `[J m^-2]`.
    pub fracture_energy: f64,
    /// How the stress across a crack falls as it opens.
    pub softening: Softening,
    /// What is kept where cells are too coarse for both.
    pub at_coarse: AtCoarse,
    /// Scatter of the strength.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weibull: Option<Weibull>,
    /// Whether what has opened by half a cell bears shear by friction alone.
    pub rubble: bool,
    /// What becomes of broken particles with no whole one within a cell.
    pub debris: Debris,
    /// How voids grow in what breaks by them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub johnson_cook: Option<JohnsonCook>,
}

fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

/// What a preset knows of its fracture, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PresetFracture {
    /// Tensile strength `[Pa]`; 0 for what breaks by voids.
    pub tensile_strength: f64,
    /// Energy that a crack takes per area `[J m^-2]`.
    pub fracture_energy: f64,
    /// How the stress across a crack falls as it opens.
    pub softening: Softening,
    /// How voids grow in what breaks by them.
    pub johnson_cook: Option<JohnsonCook>,
    /// Whether it breaks without being asked to.
    pub always: bool,
    /// Where the numbers come from.
    pub source: &'static str,
}

impl Weibull {
    /// Strength of a place over the median, in cells of an edge `[m]`. Places within a cube of the spacing share it; of several flaws in a
    /// cell the weakest counts.
    #[must_use]
    pub fn factor(&self, place: [f64; 3], body: u32, dimension: u32, cell: f64) -> f64 {
        let edge = self.spacing.max(cell);
        let cube = place.map(|x| (x / edge).floor() as i64 as u64);
        let key = cube.iter().fold(u64::from(self.seed) << 32 | u64::from(body), |key, axis| scrambled(key ^ *axis));
        let share = (scrambled(key) >> 11) as f64 / (1_u64 << 53) as f64;
        let flaws = (edge / self.spacing).powi(dimension as i32);
        // the chance that none of so many flaws is weaker
        let held = (1.0 - share).max(f64::MIN_POSITIVE).ln() / flaws;
        (-held / std::f64::consts::LN_2).powf(self.modulus.recip()).clamp(WEAKEST, STRONGEST)
    }
}

/// Limits of what flaws do to the strength.
const WEAKEST: f64 = 0.2;
const STRONGEST: f64 = 3.0;

/// Well-mixed bits of a number. [Steele, Lea & Flood 2014]
fn scrambled(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Fracture {
    /// From the keys of a scene and what a preset knows, if there is one: its numbers in pascals over `unit`.
    ///
    /// # Errors
    /// A sentence that names what is missing.
    pub(super) fn resolve(
        given: Option<FractureGiven>,
        preset: Option<(PresetFracture, f64)>,
    ) -> Result<Option<Self>, String> {
        let always = preset.is_some_and(|(own, _)| own.always);
        let keys = match given {
            None if always => FractureKeys::default(),
            None | Some(FractureGiven::Switch(false)) => return Ok(None),
            Some(FractureGiven::Switch(true)) if preset.is_none() => {
                let help = "`fracture = true` needs a preset that knows its strength; give `fracture = { tensile_strength = ...";
                return Err(format!("{help} [Pa], fracture_energy = ... [J m^-2] }}`"));
            }
            Some(FractureGiven::Switch(true)) => FractureKeys::default(),
            Some(FractureGiven::Keys(keys)) => keys,
        };
        let own = |get: fn(&PresetFracture) -> f64| preset.map(|(own, unit)| get(&own) / unit);
        let needed = |value: Option<f64>, name: &str| value.ok_or_else(|| format!("missing {name} in `fracture`"));
        let voids = keys
            .johnson_cook
            .or(preset.and_then(|(own, _)| own.johnson_cook).filter(|_| keys.tensile_strength.is_none()));
        if keys.johnson_cook.is_some() && keys.tensile_strength.is_some() {
            return Err(
                "`tensile_strength` beside `johnson_cook` in `fracture`: it breaks by one of them, remove the other"
                    .to_owned(),
            );
        }
        if let Some(mistake) = voids.and_then(|voids| voids.mistake()) {
            return Err(mistake);
        }
        if keys.rubble && voids.is_some() {
            return Err(
                "`rubble` beside `johnson_cook` in `fracture`: metals tear and do not crumble, remove `rubble`"
                    .to_owned(),
            );
        }
        let strength = match voids {
            Some(_) => Some(0.0),
            None => keys.tensile_strength.or_else(|| own(|p| p.tensile_strength).filter(|strength| *strength > 0.0)),
        };
        let energy = keys.fracture_energy.or_else(|| own(|p| p.fracture_energy));
        Ok(Some(Self {
            johnson_cook: voids,
            tensile_strength: needed(strength, "`tensile_strength` [Pa], or `johnson_cook` for metals,")?,
            fracture_energy: needed(energy, "`fracture_energy` [J m^-2]")?,
            softening: keys.softening.or(preset.map(|(own, _)| own.softening)).unwrap_or_default(),
            at_coarse: keys.at_coarse,
            weibull: keys.weibull,
            rubble: keys.rubble,
            debris: keys.debris,
        }))
    }

    /// Whether its debris is taken out.
    #[must_use]
    pub fn drops_debris(&self) -> bool {
        self.debris == Debris::Drop
    }

    /// Largest cell at which both strength and energy hold `[m]`; `modulus`: of pressure waves, lambda + 2 mu `[Pa]`.
    #[must_use]
    pub fn coarsest_cell(&self, modulus: f64) -> f64 {
        2.0 * modulus * self.fracture_energy / (LEAST_RATIO * BAND * self.tensile_strength.powi(2))
    }

    /// Strength `[Pa]` and energy `[J m^-2]` that cells of this edge give.
    #[must_use]
    pub fn at_cell(&self, modulus: f64, cell: f64) -> [f64; 2] {
        let coarse = cell / self.coarsest_cell(modulus);
        match self.at_coarse {
            _ if coarse <= 1.0 => [self.tensile_strength, self.fracture_energy],
            AtCoarse::Strength => [self.tensile_strength, self.fracture_energy * coarse],
            AtCoarse::Energy => [self.tensile_strength / coarse.sqrt(), self.fracture_energy],
        }
    }
}

impl Material {
    /// How it breaks, if it does.
    #[must_use]
    pub fn fracture(&self) -> Option<&Fracture> {
        self.fracture.as_ref()
    }

    /// Yield stress of a thin rod `[Pa]`, of laws that yield.
    #[must_use]
    pub fn rod_yield_stress(&self) -> f64 {
        1.5_f64.sqrt() * self.yield_stress()
    }

    /// By how much what breaks by voids is pulled apart from their joining on `[m]`: the stress falls from the yield stress of a rod to zero on
    /// a straight line, and takes the fracture energy.
    #[must_use]
    pub fn tearing(&self, fracture: &Fracture) -> f64 {
        2.0 * fracture.fracture_energy / self.rod_yield_stress()
    }

    /// A tensile strength above a tenth of Young's modulus, and that tenth `[Pa]`.
    #[must_use]
    pub fn beyond_strength(&self) -> Option<[f64; 2]> {
        let most = 0.1 * self.parameter("young_modulus")?;
        self.fracture.map(|fracture| [fracture.tensile_strength, most]).filter(|[strength, most]| strength > most)
    }

    /// The material as the device sees it, on cells of this edge `[m]`, with its fracture.
    #[must_use]
    pub fn params_with_fracture(&self, share: super::VolumeShare, cell: f64) -> MaterialParams {
        let params = self.params(share);
        let Some(fracture) = &self.fracture else { return params };
        let params = MaterialParams {
            rubble: if fracture.rubble { cone_slope(RUBBLE_ANGLE) as f32 } else { 0.0 },
            debris: fracture.debris as u32,
            ..params
        };
        // The modulus that elastic force and ghost pressure have together.
        let modulus = f64::from(params.elastic_lambda) + f64::from(params.ghost_modulus) + 2.0 * f64::from(params.mu);
        let [strength, _] = fracture.at_cell(modulus, cell);
        let poisson = self.parameter("poisson_ratio").unwrap_or(0.25);
        // Speed of Rayleigh's waves over that of shear waves. [Viktorov 1967]
        let surface = (0.862 + 1.14 * poisson) / (1.0 + poisson);
        let band = BAND * cell;
        if let Some(voids) = fracture.johnson_cook {
            let single = |x: f64| x as f32;
            return MaterialParams {
                tensile_strength: single(self.rod_yield_stress()),
                toughness: f32::MAX,
                softening: fracture.softening as u32,
                crack_modulus: (f64::from(params.mu) * (surface / band).powi(2)) as f32,
                voids: [voids.d1, voids.d2, voids.d3, voids.d4].map(single),
                void_rate: single(voids.rate),
                void_heat: single(voids.d5),
                void_softening: single(voids.strain_of_a_rod() * band / self.tearing(fracture)),
                ..params
            };
        }
        MaterialParams {
            tensile_strength: strength as f32,
            toughness: (2.0 * fracture.fracture_energy * modulus / band) as f32,
            softening: fracture.softening as u32,
            crack_modulus: (f64::from(params.mu) * (surface / band).powi(2)) as f32,
            ..params
        }
    }
}

impl<'de> Deserialize<'de> for FractureGiven {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(GivenVisitor)
    }
}

struct GivenVisitor;

impl<'de> Visitor<'de> for GivenVisitor {
    type Value = FractureGiven;

    fn expecting(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str("true, false or a table with `tensile_strength` and `fracture_energy`")
    }

    fn visit_bool<E: de::Error>(self, on: bool) -> Result<FractureGiven, E> {
        Ok(FractureGiven::Switch(on))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FractureGiven, A::Error> {
        FractureKeys::deserialize(de::value::MapAccessDeserializer::new(map)).map(FractureGiven::Keys)
    }
}
