//! What stands for values of a scene that cannot be read, so that everything else of it can.

use std::borrow::Cow;
use std::ops::Range;

use serde_json::Value;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::scene::finding::{About, Finding};
use crate::scene::schema::{choices, meant, schema};

/// Values inside each other that stand for one that is missing.
const DEEPEST: u32 = 16;

/// What stands in a scene that had to be mended before it could be read.
#[derive(Debug, Default)]
pub(crate) struct Mended {
    /// Paths whose values stand for something that is missing or cannot be read: findings about them mean nothing.
    stand_ins: Vec<String>,
    /// Whether something stays that cannot be read.
    pub unreadable: bool,
}

impl Mended {
    /// Whether a finding is about what the user wrote. Where a shape is not known, nor is what it leaves to others, or to those that use
    /// it; where the domain or all of the gas is not, only what is said of one value holds.
    pub(crate) fn concerns(&self, finding: &Finding) -> bool {
        let of_shapes = finding.path.ends_with(".shape") || finding.path.ends_with(".clamped");
        // an entry of a list of numbers is told by the name of the list
        let entry = |rest: &str| rest.starts_with('[') && rest.ends_with(']') && rest.rfind('[') == Some(0);
        !self.stand_ins.iter().any(|own| {
            below(&finding.path, own).is_some()
                || below(own, &finding.path).is_some_and(|rest| of_shapes || entry(rest))
                || (finding.about != About::Value && (below(own, "domain").is_some() || own == "gas"))
                || (finding.about == About::Remainder && own.contains("shape"))
                || (of_shapes && below(own, "shapes").is_some())
        })
    }

    /// How many values stand for others.
    pub(crate) fn stand_ins_count(&self) -> usize {
        self.stand_ins.len()
    }

    /// What is at a path is not known: findings about it mean nothing.
    pub(crate) fn unknown(&mut self, path: &str) {
        self.stand_ins.push(path.to_owned());
    }

    /// Puts something readable in the place of a value.
    pub(crate) fn stand_in(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, schema: &Value) {
        match readable(schema, &value.span(), 0) {
            Some(readable) => {
                *value = readable;
                self.unknown(path);
            }
            None => self.unreadable = true,
        }
    }

    /// Puts something readable in the place of what no reader takes: the value of the path, or what it lies in where it has been
    /// replaced before. Whether there is such a value.
    pub(crate) fn replace(&mut self, root: &mut DeTable<'_>, path: &str) -> bool {
        let mut path = path;
        while self.stand_ins.iter().any(|own| own == path) {
            path = path.rfind(['.', '[']).map_or("", |end| &path[..end]);
        }
        let root_schema = schema();
        let found = root.iter_mut().find_map(|(key, value)| {
            let rest = below(path, key.get_ref())?;
            descend(value, property(root_schema, key.get_ref()), rest)
        });
        let before = self.stand_ins.len();
        found.into_iter().for_each(|(value, schema)| self.stand_in(path, value, schema));
        self.stand_ins.len() > before
    }
}

/// What is left of a path below another one.
fn below<'p>(path: &'p str, above: &str) -> Option<&'p str> {
    path.strip_prefix(above).filter(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// The value at a path below another one, with its schema.
fn descend<'v, 'a>(
    value: &'v mut Spanned<DeValue<'a>>,
    schema: &'static Value,
    path: &str,
) -> Option<(&'v mut Spanned<DeValue<'a>>, &'static Value)> {
    if path.is_empty() {
        return Some((value, schema));
    }
    match value.get_mut() {
        DeValue::Table(table) => table.iter_mut().find_map(|(key, value)| {
            let rest = below(path.strip_prefix('.')?, key.get_ref())?;
            descend(value, property(schema, key.get_ref()), rest)
        }),
        DeValue::Array(array) => array.iter_mut().enumerate().find_map(|(index, value)| {
            let rest = below(path, &format!("[{index}]"))?;
            let list = choices(schema).find(|choice| choice["items"].is_object())?;
            descend(value, &list["items"], rest)
        }),
        _ => None,
    }
}

/// The schema of a key of a table.
fn property<'s>(schema: &'s Value, key: &str) -> &'s Value {
    let known = choices(schema).find_map(|choice| choice["properties"].get(key));
    known.unwrap_or_else(|| &meant(schema)["additionalProperties"])
}

/// Any value that a schema allows.
fn readable(schema: &Value, place: &Range<usize>, depth: u32) -> Option<Spanned<DeValue<'static>>> {
    let schema = meant(schema);
    if depth > DEEPEST {
        return None;
    }
    if schema["oneOf"].is_array() || schema["anyOf"].is_array() {
        return choices(schema).find_map(|choice| readable(choice, place, depth + 1));
    }
    let kinds = std::slice::from_ref(&schema["type"]);
    let kinds = schema["type"].as_array().map_or(kinds, Vec::as_slice).iter();
    let kind = kinds.filter_map(Value::as_str).find(|kind| *kind != "null")?;
    let value = match (words_of(schema).first(), kind) {
        (Some(word), _) => DeValue::String(Cow::Owned((*word).to_owned())),
        (_, "string") => DeValue::String(Cow::Borrowed("unknown")),
        (_, "boolean") => DeValue::Boolean(false),
        (_, "number") => number("v = 1.0")?,
        (_, "integer") => number("v = 1")?,
        (_, "array") => {
            let mut array = DeArray::new();
            for _ in 0..schema["minItems"].as_u64().unwrap_or(1) {
                array.push(readable(&schema["items"], place, depth + 1)?);
            }
            DeValue::Array(array)
        }
        (_, "object") => {
            let mut table = DeTable::new();
            for key in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
                let value = readable(&schema["properties"][key], place, depth + 1)?;
                table.insert(Spanned::new(place.clone(), Cow::Owned(key.to_owned())), value);
            }
            DeValue::Table(table)
        }
        _ => return None,
    };
    Some(Spanned::new(place.clone(), value))
}

/// A number, from the text of a document with the key `v`.
pub(crate) fn number(text: &'static str) -> Option<DeValue<'static>> {
    DeTable::parse(text).ok()?.into_inner().remove("v").map(Spanned::into_inner)
}

/// The words that one choice stands for.
pub(crate) fn words_of(choice: &Value) -> Vec<&str> {
    let own = choice["const"].as_str().into_iter();
    own.chain(choice["enum"].as_array().into_iter().flatten().filter_map(Value::as_str)).collect()
}

/// What the schema asks for, if the value is of another type.
pub(crate) fn wrong_type(schema: &Value, value: &DeValue<'_>) -> Option<String> {
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
        _ => kind_name(kinds[0]),
    };
    (!kinds.iter().any(fits)).then(|| named.to_owned())
}

/// A type of value as TOML names it.
pub(crate) fn kind_name(kind: &str) -> &str {
    if kind == "object" { "table" } else { kind }
}
