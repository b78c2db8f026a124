//! Limits of numbers. They stand with their keys in the types, as the schema has them: checks and pages take them from there.

use serde_json::Value;

use crate::math::plain;
use crate::scene::Scene;
use crate::scene::finding::Finding;
use crate::scene::schema::{choices, schema};

/// Numbers of a scene that lie outside of their limits, vectors that leave its axes, expected ranges that are empty, and shares of a gas that
/// it has not. Shapes have checks of their own.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let mut walk = Walk { scene, findings: Vec::new() };
    // plain data becomes JSON; numbers that are not finite become null
    walk.value("", &serde_json::to_value(scene).unwrap_or_default(), schema());
    walk.findings
}

struct Walk<'s> {
    scene: &'s Scene,
    findings: Vec<Finding>,
}

impl Walk<'_> {
    fn value(&mut self, path: &str, value: &Value, schema: &Value) {
        let is_shape = |own: &Value| own["$ref"] == "#/$defs/Shape";
        if is_shape(schema) || schema["anyOf"].as_array().is_some_and(|all| all.iter().any(is_shape)) {
            return;
        }
        match value {
            Value::Object(values) => {
                for (key, value) in values {
                    let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                    below(schema, key).into_iter().for_each(|schema| self.value(&path, value, schema));
                }
            }
            Value::Array(entries) => {
                let is_vector = |own: &Value| own["minItems"] == 1 && own["maxItems"] == 3;
                if choices(schema).any(is_vector) && !["domain.cells", "domain.size"].contains(&path) {
                    self.findings.extend(leaves(path, entries, self.scene.domain.axes()));
                }
                if let [low, high] = &entries[..]
                    && path.starts_with("expect.")
                    && low.as_f64() > high.as_f64()
                {
                    let help = "give the lower value first";
                    self.findings.push(Finding::new(path, format!("[{low}, {high}] is empty"), help));
                }
                let each = entries.iter().enumerate();
                each.for_each(|(k, entry)| self.value(&format!("{path}[{k}]"), entry, items(schema)));
            }
            Value::Number(_) | Value::Null => {
                let known = choices(schema).find_map(|choice| Some((choice, allowed(choice)?)));
                let found = known.and_then(|(choice, allowed)| outside(path, value, choice, &allowed));
                let share = path.ends_with(".mass_fraction") && value.as_f64().is_some_and(|share| share > 0.0);
                if found.is_none() && share && self.scene.gas.species.is_empty() {
                    let help = "add a table such as [gas.species.helium] with gamma and gas_constant";
                    self.findings.push(Finding::new(path, "there is no second gas", help));
                }
                self.findings.extend(found);
            }
            Value::Bool(_) | Value::String(_) => {}
        }
    }
}

/// A vector is finite and vanishes along inactive axes.
fn leaves(path: &str, entries: &[Value], axes: usize) -> Option<Finding> {
    let vector: Vec<f64> = entries.iter().map(|entry| entry.as_f64().unwrap_or(f64::NAN)).collect();
    if vector.iter().any(|x| x.is_nan()) {
        return Some(Finding::new(path, format!("{vector:?} is not finite"), "give finite numbers"));
    }
    let help = format!("the scene has {axes} axes: leave the other entries out or give 0");
    let leaves = vector.iter().skip(axes).any(|x| *x != 0.0);
    leaves.then(|| Finding::new(path, format!("{vector:?} leaves the active axes"), help))
}

/// The finding of a number, or of one that is not finite.
fn outside(path: &str, value: &Value, schema: &Value, allowed: &str) -> Option<Finding> {
    let told = match value.as_f64() {
        Some(number) if within(number, schema) => return None,
        Some(number) if number <= 0.0 && schema["exclusiveMinimum"].as_f64() == Some(0.0) => {
            format!("{number} is not positive")
        }
        Some(number) => format!("{number} is out of range"),
        None => "a number that is not finite is out of range".to_owned(),
    };
    let whole = if schema["format"] == "uint32" { "whole " } else { "" };
    let unit = schema["description"].as_str().and_then(|text| text.split_once("`[")?.1.split_once("]`"));
    let unit = unit.map_or(String::new(), |(unit, _)| format!(" [{unit}]"));
    Some(Finding::of_value(path, told, format!("give a {whole}number {allowed}{unit}")))
}

/// The schema of a key of a table.
fn below<'s>(schema: &'s Value, key: &str) -> Option<&'s Value> {
    let known = choices(schema).find_map(|choice| choice["properties"].get(key));
    known.or_else(|| choices(schema).find_map(|choice| choice.get("additionalProperties")))
}

/// The schema of the entries of a list.
fn items(schema: &Value) -> &Value {
    choices(schema).find_map(|choice| choice.get("items")).unwrap_or(&Value::Null)
}

fn within(number: f64, schema: &Value) -> bool {
    let limit =
        |name: &str, holds: fn(&f64, &f64) -> bool| schema[name].as_f64().is_none_or(|own| holds(&number, &own));
    limit("exclusiveMinimum", f64::gt)
        && limit("minimum", f64::ge)
        && limit("exclusiveMaximum", f64::lt)
        && limit("maximum", f64::le)
}

/// What a schema allows a number to be, in words: "above 0 and at most 1".
#[must_use]
pub fn allowed(schema: &Value) -> Option<String> {
    let limit = |name: &str| schema[name].as_f64().map(plain);
    let low = match (limit("exclusiveMinimum"), limit("minimum"), limit("maximum")) {
        (Some(low), ..) => format!("above {low}"),
        (_, Some(low), Some(high)) => return Some(format!("from {low} to {high}")),
        (_, Some(low), _) => format!("of at least {low}"),
        _ => return None,
    };
    let below = limit("exclusiveMaximum").map(|high| format!(" and below {high}"));
    Some(low + &below.or(limit("maximum").map(|high| format!(" and at most {high}"))).unwrap_or_default())
}
