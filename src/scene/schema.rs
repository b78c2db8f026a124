//! The schema of scenes, which follows from the types: limits, defaults, words.

use std::sync::OnceLock;

use serde_json::Value;

use super::Scene;

/// The schema of scenes.
pub(crate) fn schema() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| Scene::schema().to_value())
}

/// The word that scenes have for a variant of an enumeration.
pub(crate) fn word(kind: &str, position: usize) -> &'static str {
    schema()["$defs"][kind]["oneOf"][position]["const"].as_str().unwrap_or_default()
}

/// A schema with its reference followed.
pub(crate) fn meant(own: &Value) -> &Value {
    let name = own["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/"));
    name.map_or(own, |name| &schema()["$defs"][name])
}

/// What a schema lets one choose from: itself where there is no choice.
pub(crate) fn choices(schema: &Value) -> impl Iterator<Item = &Value> {
    let schema = meant(schema);
    let several = ["oneOf", "anyOf"].iter().find_map(|key| schema[key].as_array());
    several.map_or(std::slice::from_ref(schema), Vec::as_slice).iter().map(meant)
}
