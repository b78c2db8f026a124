//! Materials in scene files: one key, the kind or a preset, and its numbers.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{self, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::flow::{Flow, FlowGiven};
use super::fracture::{Fracture, FractureGiven, OwnFracture};
use super::{Bound, KINDS, Kind, Material, PRESETS, Parameter, Units, kind_names};

/// An entry of the table of a material.
#[derive(Deserialize, Serialize)]
#[serde(untagged, expecting = "expected a number, or the units of a preset: \"si\" or \"scaled\"")]
enum Given {
    Number(f64),
    Units(Units),
}

impl Serialize for Material {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = self.kind().parameters.iter().zip(&self.values);
        let mut table: BTreeMap<_, _> = numbers.map(|(p, value)| (p.name, Given::Number(*value))).collect();
        let mut name = self.kind().name;
        if let Some((index, units)) = self.preset {
            name = PRESETS[index].name;
            table.insert("units", Given::Units(units));
        }
        let always = self.preset.is_some_and(|(index, _)| PRESETS[index].fracture.is_some_and(|own| own.always));
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry(name, &table)?;
        match &self.fracture {
            Some(fracture) => map.serialize_entry(FRACTURE, fracture)?,
            None if always => map.serialize_entry(FRACTURE, &false)?,
            None => {}
        }
        let flows = self.fracture.is_some_and(|own| own.johnson_cook.is_some());
        match &self.flow {
            Some(flow) => map.serialize_entry(FLOW, flow)?,
            None if flows => map.serialize_entry(FLOW, &false)?,
            None => {}
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Material {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(MaterialVisitor)
    }
}

struct MaterialVisitor;

impl<'de> Visitor<'de> for MaterialVisitor {
    type Value = Material;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "a table with one material: {}", kind_names())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Material, A::Error> {
        let missing = || de::Error::custom(format!("no material, expected one of {}", kind_names()));
        let mut law: Option<(String, BTreeMap<String, Given>)> = None;
        let (mut fracture, mut flow) = (None, None);
        while let Some(key) = map.next_key::<String>()? {
            match &law {
                _ if key == FRACTURE => fracture = Some(map.next_value::<FractureGiven>()?),
                _ if key == FLOW => flow = Some(map.next_value::<FlowGiven>()?),
                None => law = Some((key, map.next_value()?)),
                Some((name, _)) => {
                    let message = format!("two materials, `{name}` and `{key}`; an entry has one, remove the other");
                    return Err(de::Error::custom(message));
                }
            }
        }
        let (name, given) = law.ok_or_else(missing)?;
        from_table(&name, given, fracture, flow).map_err(de::Error::custom)
    }
}

/// The key beside the law of a material that says how it breaks.
const FRACTURE: &str = "fracture";
/// The key beside the law of a metal that says how its flow stress follows strain, rate and temperature.
const FLOW: &str = "flow";

/// A material from its name and table, and what stands beside it.
fn from_table(
    name: &str,
    given: BTreeMap<String, Given>,
    fracture: Option<FractureGiven>,
    flow: Option<FlowGiven>,
) -> Result<Material, String> {
    let preset = PRESETS.iter().position(|preset| preset.name == name);
    let mut units = Units::default();
    let mut numbers = Vec::new();
    for (key, value) in given {
        match value {
            Given::Units(named) if key == "units" && preset.is_some() => units = named,
            Given::Units(_) => return Err(format!("`{key}` of material `{name}` is no number")),
            Given::Number(_) if key == "units" => {
                return Err(format!("`units` of material `{name}` is a number, expected \"si\" or \"scaled\""));
            }
            Given::Number(value) => numbers.push((key, value)),
        }
    }
    let known = preset.map(|index| &PRESETS[index]);
    let fracture = Fracture::resolve(fracture, known.and_then(|own| Some((own.fracture?, units.stress()))))?;
    let tears = fracture.is_some_and(|own| own.johnson_cook.is_some());
    let own = known.and_then(|own| own.flowing(units, flow, tears));
    if let Some((_, [a, b])) = own {
        let left_out = |name: &str| numbers.iter().all(|(key, _)| key != name);
        let more: Vec<_> =
            [("yield_stress", a), ("hardening", b)].into_iter().filter(|(name, _)| left_out(name)).collect();
        numbers.extend(more.into_iter().map(|(name, value)| (name.to_owned(), value)));
    }
    let flow = match flow {
        Some(FlowGiven::Numbers(given)) => Some(given),
        Some(FlowGiven::Switch(true)) if own.is_none() => {
            let help = "`flow = true` needs a preset that knows its flow stress; give";
            return Err(format!(
                "{help} `flow = {{ exponent = ..., melting_temperature = ... [K], heat_capacity = ... }}`"
            ));
        }
        _ => own.map(|(flow, _)| flow),
    };
    let material = match preset {
        Some(index) => Material::of_preset(index, units, &numbers),
        None => Material::new(name, &numbers),
    };
    Ok(Material { fracture, flow, ..material? })
}

impl schemars::JsonSchema for Material {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Material".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let known = serde_json::Value::from(generator.subschema_for::<FractureGiven>());
        let own = serde_json::Value::from(generator.subschema_for::<OwnFracture>());
        let given = serde_json::Value::from(generator.subschema_for::<FlowGiven>());
        let numbers = serde_json::Value::from(generator.subschema_for::<Flow>());
        let kinds = KINDS.iter().map(|kind| entry(kind.name, kind.summary, kind_table(kind), [&own, &numbers]));
        let kinds = kinds.collect::<Vec<_>>();
        let presets = PRESETS.iter().filter_map(|preset| {
            let law = KINDS.iter().find(|kind| kind.name == preset.law)?;
            let mut table = kind_table(law);
            table["required"] = serde_json::json!([]);
            let text = "Units of the numbers: SI, or atmospheres and the density of air.";
            table["properties"]["units"] =
                serde_json::json!({ "type": "string", "enum": ["si", "scaled"], "description": text });
            let fracture = if preset.fracture.is_some() { &known } else { &own };
            let flow = if preset.flow.is_some() { &given } else { &numbers };
            Some(entry(preset.name, preset.summary, table, [fracture, flow]))
        });
        let all = kinds.into_iter().chain(presets).collect::<Vec<_>>();
        schemars::json_schema!({ "description": "A material: one kind or preset with its parameters.", "oneOf": all })
    }
}

/// Schema of one material.
fn entry(
    name: &str,
    summary: &str,
    table: serde_json::Value,
    [fracture, flow]: [&serde_json::Value; 2],
) -> serde_json::Value {
    let hardens = !table["properties"]["hardening"].is_null();
    let mut properties = serde_json::json!({ name: table, FRACTURE: fracture });
    if hardens {
        properties[FLOW] = flow.clone();
    }
    serde_json::json!({
        "type": "object", "description": summary, "properties": properties, "required": [name],
        "additionalProperties": false,
    })
}

/// Schema of the parameters of a kind.
fn kind_table(kind: &Kind) -> serde_json::Value {
    let properties = kind.parameters.iter().map(parameter).collect::<serde_json::Map<_, _>>();
    let required = kind.parameters.iter().filter(|p| p.default.is_none()).map(|p| p.name).collect::<Vec<_>>();
    serde_json::json!({
        "type": "object", "properties": properties, "required": required, "additionalProperties": false,
    })
}

/// Name and schema of a parameter.
fn parameter(p: &Parameter) -> (String, serde_json::Value) {
    let text = format!("{} `[{}]`.", p.summary, p.unit);
    let mut schema = serde_json::json!({ "type": "number", "description": text });
    if let Some(value) = p.default {
        schema["default"] = value.into();
    }
    for (bound, inside, outside) in [(p.low, "minimum", "exclusiveMinimum"), (p.high, "maximum", "exclusiveMaximum")] {
        match bound {
            Bound::Included(value) => schema[inside] = value.into(),
            Bound::Excluded(value) => schema[outside] = value.into(),
            Bound::Unbounded => {}
        }
    }
    (p.name.to_owned(), schema)
}
