//! Materials in scene files: one key, the kind or a preset, and its numbers.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{self, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

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
        let mut fracture = None;
        while let Some(key) = map.next_key::<String>()? {
            match &law {
                _ if key == FRACTURE => fracture = Some(map.next_value::<FractureGiven>()?),
                None => law = Some((key, map.next_value()?)),
                Some((name, _)) => {
                    let message = format!("two materials, `{name}` and `{key}`; an entry has one, remove the other");
                    return Err(de::Error::custom(message));
                }
            }
        }
        let (name, given) = law.ok_or_else(missing)?;
        let material = from_table(&name, given).map_err(de::Error::custom)?;
        let own = material.preset.and_then(|(index, units)| Some((PRESETS[index].fracture?, units.stress())));
        let fracture = Fracture::resolve(fracture, own).map_err(de::Error::custom)?;
        Ok(Material { fracture, ..material })
    }
}

/// The key beside the law of a material that says how it breaks.
const FRACTURE: &str = "fracture";

/// A material from its name and table.
fn from_table(name: &str, given: BTreeMap<String, Given>) -> Result<Material, String> {
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
    match preset {
        Some(index) => Material::of_preset(index, units, &numbers),
        None => Material::new(name, &numbers),
    }
}

impl schemars::JsonSchema for Material {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Material".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let known = serde_json::Value::from(generator.subschema_for::<FractureGiven>());
        let own = serde_json::Value::from(generator.subschema_for::<OwnFracture>());
        let kinds = KINDS.iter().map(|kind| entry(kind.name, kind.summary, kind_table(kind), &own)).collect::<Vec<_>>();
        let presets = PRESETS.iter().filter_map(|preset| {
            let law = KINDS.iter().find(|kind| kind.name == preset.law)?;
            let mut table = kind_table(law);
            table["required"] = serde_json::json!([]);
            let text = "Units of the numbers: SI, or atmospheres and the density of air.";
            table["properties"]["units"] =
                serde_json::json!({ "type": "string", "enum": ["si", "scaled"], "description": text });
            let fracture = if preset.fracture.is_some() { &known } else { &own };
            Some(entry(preset.name, preset.summary, table, fracture))
        });
        let all = kinds.into_iter().chain(presets).collect::<Vec<_>>();
        schemars::json_schema!({ "description": "A material: one kind or preset with its parameters.", "oneOf": all })
    }
}

/// Schema of one material.
fn entry(name: &str, summary: &str, table: serde_json::Value, fracture: &serde_json::Value) -> serde_json::Value {
    serde_json::json!({
        "type": "object", "description": summary, "properties": { name: table, FRACTURE: fracture },
        "required": [name], "additionalProperties": false,
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
