//! Limits of numbers. They stand with their keys in the types, as the schema has them: checks and pages take them from there.

use std::sync::OnceLock;

use serde::Serialize;
use serde_json::Value;

use crate::scene::Scene;
use crate::scene::finding::Finding;

/// The schema of scenes.
pub(crate) fn schema() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| Scene::schema().to_value())
}

/// A schema with its reference followed.
pub(crate) fn meant(own: &Value) -> &Value {
    let name = own["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/"));
    name.map_or(own, |name| &schema()["$defs"][name])
}

/// Numbers of a section that lie outside of their limits.
pub(crate) fn findings(section: &str, values: &impl Serialize) -> Vec<Finding> {
    let mut findings = Vec::new();
    // plain data becomes JSON; numbers that are not finite become null
    let values = serde_json::to_value(values).unwrap_or_default();
    compare(section, &values, &schema()["properties"][section], &mut findings);
    findings
}

fn compare(path: &str, value: &Value, schema: &Value, findings: &mut Vec<Finding>) {
    if let Some(values) = value.as_object() {
        let keys = &meant(schema)["properties"];
        values.iter().for_each(|(key, value)| compare(&format!("{path}.{key}"), value, &keys[key], findings));
    }
    let Some(allowed) = allowed(schema).filter(|_| value.is_number() || value.is_null()) else { return };
    let told = match value.as_f64() {
        Some(number) if within(number, schema) => return,
        Some(number) => number.to_string(),
        None => "a number that is not finite".to_owned(),
    };
    findings.push(Finding::out_of_range(path, told, format!("give a number {allowed}")));
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
pub(crate) fn allowed(schema: &Value) -> Option<String> {
    let limit = |name: &str| schema[name].as_f64();
    let low = match (limit("exclusiveMinimum"), limit("minimum"), limit("maximum")) {
        (Some(low), ..) => format!("above {low}"),
        (_, Some(low), Some(high)) => return Some(format!("from {low} to {high}")),
        _ => return None,
    };
    let below = limit("exclusiveMaximum").map(|high| format!(" and below {high}"));
    Some(low + &below.or(limit("maximum").map(|high| format!(" and at most {high}"))).unwrap_or_default())
}
