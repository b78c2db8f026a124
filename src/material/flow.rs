//! Flow stress of metals by plastic strain, strain rate and temperature. [Johnson & Cook 1983]

use schemars::JsonSchema;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::{Material, MaterialParams, Preset, Units};

/// How the flow stress of a metal follows strain, rate and temperature: (A + B strain^exponent) (1 + rate ln(strain rate over `reference_rate`))
/// (1 - T^softening), with A `yield_stress` and B `hardening` of the law, and T from 0 at `room_temperature` to 1 at melting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flow {
    /// Exponent of the plastic strain `[1]`.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
    pub exponent: f64,
    /// Growth with the logarithm of the strain rate `[1]`.
    #[serde(default)]
    #[schemars(extend("minimum" = 0))]
    pub rate: f64,
    /// Strain rate from which on it grows `[s^-1]`.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0, "default" = 1.0))]
    pub reference_rate: f64,
    /// Exponent of the temperature `[1]`.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0, "default" = 1.0))]
    pub softening: f64,
    /// Temperature at the start `[K]`.
    #[serde(default = "room")]
    #[schemars(extend("minimum" = 0, "default" = 293.0))]
    pub room_temperature: f64,
    /// Temperature from which on it bears no shear `[K]`, above that at the start.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub melting_temperature: f64,
    /// Specific heat capacity `[J kg^-1 K^-1]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub heat_capacity: f64,
    /// Share of the plastic work that heats it, of Taylor and Quinney `[1]`.
    #[serde(default = "share")]
    #[schemars(extend("minimum" = 0, "maximum" = 1, "default" = 0.9))]
    pub taylor_quinney: f64,
}

fn one() -> f64 {
    1.0
}

fn room() -> f64 {
    293.0
}

fn share() -> f64 {
    0.9
}

/// `flow` as it stands in a scene.
#[derive(Clone, Copy, Debug, JsonSchema)]
#[serde(untagged)]
pub(super) enum FlowGiven {
    /// `true` takes the numbers of the preset; `false` leaves the linear hardening of the law.
    Switch(bool),
    /// Numbers.
    Numbers(Flow),
}

/// What a preset knows of its flow stress, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PresetFlow {
    /// Yield stress A and modulus B of a rod `[Pa]`.
    pub rod: [f64; 2],
    /// The rest.
    pub flow: Flow,
    /// Where the numbers come from.
    pub source: &'static str,
}

/// Length of the deviator of stress over the stress of a rod.
const DEVIATOR: f64 = 0.816_496_580_927_726;

impl Flow {
    /// Flow stress over `A + B strain^exponent`, at a strain rate `[s^-1]` and a share of the way from the start to melting.
    #[must_use]
    pub fn factor(&self, rate: f64, heated: f64) -> f64 {
        let fast = 1.0 + self.rate * (rate / self.reference_rate).max(1.0).ln();
        fast * (1.0 - heated.clamp(0.0, 1.0).powf(self.softening))
    }

    /// Share of the way to melting per plastic work and mass `[kg J^-1]`.
    #[must_use]
    pub fn heating(&self) -> f64 {
        self.taylor_quinney / (self.heat_capacity * (self.melting_temperature - self.room_temperature))
    }

    /// What is wrong with it: key, value, what to give.
    #[must_use]
    pub fn mistake(&self) -> Option<(&'static str, f64, &'static str)> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let sound = [
            (
                "exponent",
                self.exponent,
                positive(self.exponent) && self.exponent <= 1.0,
                "give a number above 0 and of at most 1",
            ),
            ("rate", self.rate, self.rate >= 0.0 && self.rate.is_finite(), "give a number of at least 0"),
            ("reference_rate", self.reference_rate, positive(self.reference_rate), "give a number above 0 [s^-1]"),
            ("softening", self.softening, positive(self.softening), "give a number above 0"),
            ("heat_capacity", self.heat_capacity, positive(self.heat_capacity), "give a number above 0 [J kg^-1 K^-1]"),
            (
                "taylor_quinney",
                self.taylor_quinney,
                (0.0..=1.0).contains(&self.taylor_quinney),
                "give a number from 0 to 1",
            ),
            (
                "room_temperature",
                self.room_temperature,
                self.room_temperature >= 0.0 && self.room_temperature.is_finite(),
                "give a number of at least 0 [K]",
            ),
            (
                "melting_temperature",
                self.melting_temperature,
                positive(self.melting_temperature) && self.melting_temperature > self.room_temperature,
                "give more than `room_temperature` [K]",
            ),
        ];
        sound.into_iter().find(|(_, _, fine, _)| !fine).map(|(key, value, _, help)| (key, value, help))
    }

    /// The numbers of a metal in the units of a scene: rates per unit of time, heat capacity per unit of energy over mass.
    fn scaled(self, units: Units) -> Self {
        let square = units.stress() / units.density();
        Self { reference_rate: self.reference_rate / square.sqrt(), heat_capacity: self.heat_capacity / square, ..self }
    }
}

impl Preset {
    /// Its flow stress for `given` and what the scene says of fracture: the numbers, and yield stress and hardening of the law \[Pa\].
    pub(super) fn flowing(&self, units: Units, given: Option<FlowGiven>, tears: bool) -> Option<(Flow, [f64; 2])> {
        let own = self.flow.filter(|_| matches!(given, Some(FlowGiven::Switch(true))) || (given.is_none() && tears))?;
        Some((own.flow.scaled(units), own.rod.map(|stress| DEVIATOR * stress / units.stress())))
    }
}

impl Material {
    /// How its flow stress follows strain, rate and temperature, if not by linear hardening.
    #[must_use]
    pub fn flow(&self) -> Option<&Flow> {
        self.flow.as_ref()
    }

    /// Length of the deviator of stress at which a metal flows `[Pa]`, at a plastic strain, its rate `[s^-1]` and a share of the way to melting.
    #[must_use]
    pub fn flow_stress(&self, strain: f64, rate: f64, heated: f64) -> f64 {
        let own = self.constants();
        let Some(flow) = self.flow else { return own.yield_stress + own.hardening * strain };
        (own.yield_stress + own.hardening * strain.powf(flow.exponent)) * flow.factor(rate, heated)
    }

    /// The material as the device sees it, with its flow stress.
    pub(super) fn params_with_flow(&self, params: MaterialParams) -> MaterialParams {
        let Some(flow) = self.flow else { return params };
        MaterialParams {
            flow: [flow.exponent, flow.rate, flow.reference_rate, flow.softening].map(|x| x as f32),
            heating: flow.heating() as f32,
            ..params
        }
    }
}

impl<'de> Deserialize<'de> for FlowGiven {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(GivenVisitor)
    }
}

struct GivenVisitor;

impl<'de> Visitor<'de> for GivenVisitor {
    type Value = FlowGiven;

    fn expecting(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str("true, false or a table with `exponent`, `melting_temperature` and `heat_capacity`")
    }

    fn visit_bool<E: de::Error>(self, on: bool) -> Result<FlowGiven, E> {
        Ok(FlowGiven::Switch(on))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FlowGiven, A::Error> {
        Flow::deserialize(de::value::MapAccessDeserializer::new(map)).map(FlowGiven::Numbers)
    }
}
