//! Words of a scene file against the schema: every unknown key and variant, and every value of a wrong type, not only the first one.

use std::sync::OnceLock;

use serde_json::Value;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::Scene;
use super::source::Finding;
use crate::spelling::did_you_mean;

/// Reports words that the schema does not know and takes unknown keys out, so that the rest can be read. The second is whether
/// something stays that cannot be read.
pub(super) fn findings(root: &mut DeTable<'_>) -> (Vec<Finding>, bool) {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    let schema = SCHEMA.get_or_init(|| Scene::schema().to_value());
    let mut words = Words { schema, findings: Vec::new(), unreadable: false };
    words.table("", root, schema);
    words.findings.sort_by_key(|finding| finding.span.as_ref().map(|place| place.start));
    (words.findings, words.unreadable)
}

/// Findings for which it is looked what was meant: many more than are told, in whatever order they come.
const MOST_LOOKED_AT: usize = 1000;

struct Words<'s> {
    schema: &'s Value,
    findings: Vec<Finding>,
    unreadable: bool,
}

impl<'s> Words<'s> {
    /// A schema with its reference followed.
    fn meant(&self, schema: &'s Value) -> &'s Value {
        let name = schema["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/"));
        name.map_or(schema, |name| &self.schema["$defs"][name])
    }

    fn value(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, schema: &'s Value) {
        let schema = self.meant(schema);
        if let Some(choices) = schema["oneOf"].as_array() {
            return self.choice(path, value, choices);
        }
        if let Some(choices) = schema["anyOf"].as_array() {
            // one that may be left out is what it is; of others any may be meant
            let own: Vec<&Value> = choices.iter().filter(|choice| choice["type"] != "null").collect();
            if let [own] = own[..] {
                self.value(path, value, own);
            }
            return;
        }
        if let Some(wanted) = wrong_type(schema, value.get_ref()) {
            self.unreadable = true;
            let message = format!("invalid type: {}, expected {wanted}", value.get_ref().type_str());
            self.add(path, Some(value.span()), message, "see docs/scenes for this key");
            return;
        }
        match value.get_mut() {
            DeValue::Table(table) => self.table(path, table, schema),
            DeValue::Array(array) => {
                for (index, entry) in array.iter_mut().enumerate() {
                    self.value(&format!("{path}[{index}]"), entry, &schema["items"]);
                }
            }
            _ => {}
        }
    }

    fn table(&mut self, path: &str, table: &mut DeTable<'_>, schema: &'s Value) {
        let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        let Some(known) = schema["properties"].as_object() else {
            for (key, value) in table.iter_mut() {
                self.value(&below(key.get_ref()), value, &schema["additionalProperties"]);
            }
            return;
        };
        let mut unknown = Vec::new();
        for (key, value) in table.iter_mut() {
            match known.get(&**key.get_ref()) {
                Some(schema) => self.value(&below(key.get_ref()), value, schema),
                None if schema["additionalProperties"] == false => {
                    unknown.push((key.get_ref().to_string(), key.span()))
                }
                None => {}
            }
        }
        for (key, place) in unknown {
            let names = || known.keys().map(String::as_str);
            let message = format!("unknown field `{key}`{}", self.like(&key, names()));
            self.add(&below(&key), Some(place), message, &there_are(names()));
            table.remove(key.as_str());
        }
    }

    /// One of several words, or a table with one of several keys.
    fn choice(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, choices: &'s [Value]) {
        let words = || choices.iter().flat_map(words_of);
        let place = value.span();
        let unknown = match value.get_mut() {
            DeValue::String(word) if words().any(|known| known == word) => return,
            DeValue::String(word) => word.to_string(),
            DeValue::Table(table) => {
                let key = table.iter().next().map(|(key, _)| (key.get_ref().to_string(), key.span()));
                let Some((key, place)) = key.filter(|_| table.len() == 1) else {
                    // what holds no key, or several, is told by the reader
                    return;
                };
                let inner = choices.iter().find_map(|choice| choice["properties"].get(&key));
                if let (Some(inner), Some((_, value))) = (inner, table.iter_mut().next()) {
                    return self.value(&format!("{path}.{key}"), value, inner);
                }
                self.unreadable = true;
                let message = format!("unknown variant `{key}`{}", self.like(&key, words()));
                return self.add(path, Some(place), message, &there_are(words()));
            }
            _ => return,
        };
        self.unreadable = true;
        let message = format!("unknown variant `{unknown}`{}", self.like(&unknown, words()));
        self.add(path, Some(place), message, &there_are(words()));
    }

    /// What may have been meant by a word.
    fn like<'n>(&self, word: &str, names: impl Iterator<Item = &'n str>) -> String {
        if self.findings.len() < MOST_LOOKED_AT { did_you_mean(word, names) } else { String::new() }
    }

    fn add(&mut self, path: &str, place: Option<std::ops::Range<usize>>, message: String, help: &str) {
        self.findings.push(Finding { span: place, ..Finding::new(path, message, help) });
    }
}

/// The words that one choice stands for.
fn words_of(choice: &Value) -> Vec<&str> {
    let own = choice["const"].as_str().into_iter();
    let listed = choice["enum"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let keys = choice["properties"].as_object().into_iter().flat_map(|keys| keys.keys().map(String::as_str));
    own.chain(listed).chain(keys).collect()
}

fn there_are<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let mut told: Vec<String> = Vec::new();
    for name in names.map(|name| format!("`{name}`")) {
        if !told.contains(&name) {
            told.push(name);
        }
    }
    format!("there are {}", told.join(", "))
}

/// What the schema asks for, if the value is of another type.
fn wrong_type(schema: &Value, value: &DeValue<'_>) -> Option<String> {
    let kinds: Vec<&str> = match &schema["type"] {
        Value::String(kind) => vec![kind],
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).collect(),
        _ => return None,
    };
    let fits = |kind: &&str| match *kind {
        "number" => matches!(value, DeValue::Float(_) | DeValue::Integer(_)),
        "integer" => matches!(value, DeValue::Integer(_)),
        "string" => matches!(value, DeValue::String(_)),
        "boolean" => matches!(value, DeValue::Boolean(_)),
        "array" => matches!(value, DeValue::Array(_)),
        "object" => matches!(value, DeValue::Table(_)),
        _ => false,
    };
    let named = match schema["format"].as_str() {
        Some("double") => "f64",
        Some("uint32") => "u32",
        _ => kinds[0],
    };
    (!kinds.iter().any(fits)).then(|| named.to_owned())
}
