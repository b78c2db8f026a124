//! Words of a scene file against the schema: every unknown key and variant, and every value of a wrong type, not only the first one.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::OnceLock;

use serde_json::Value;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::Scene;
use super::source::Finding;
use crate::spelling::{closest, did_you_mean};

/// What stands in a scene that had to be mended before it could be read.
#[derive(Debug, Default)]
pub(super) struct Mended {
    /// Paths whose values stand for something that is missing or cannot be read: findings about them mean nothing.
    stand_ins: Vec<String>,
    /// Whether something stays that cannot be read.
    pub unreadable: bool,
}

impl Mended {
    /// Whether a finding is about what the user wrote. Where a shape is not known, nor is what it leaves to others; where the domain is
    /// not, nothing is.
    pub(super) fn concerns(&self, finding: &Finding) -> bool {
        let below = |path: &str, above: &str| {
            path.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        let of_shapes = finding.path.ends_with(".shape") || finding.path.ends_with(".clamped");
        !self.stand_ins.iter().any(|own| {
            below(&finding.path, own) || below(own, "domain") || (of_shapes && own.contains("shape")) || own == "gas"
        })
    }
}

/// Reports words that the schema does not know, values of another type and keys that are missing. Unknown keys are taken out, or take the
/// place of the missing key that was meant; likely words or anything readable stand for the others, so that the rest can be read.
pub(super) fn findings(root: &mut Spanned<DeTable<'_>>) -> (Vec<Finding>, Mended) {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    let schema = SCHEMA.get_or_init(|| Scene::schema().to_value());
    let mut words = Words { schema, findings: Vec::new(), mended: Mended::default() };
    let place = root.span();
    words.table("", root.get_mut(), schema, &place);
    words.findings.sort_by_key(|finding| finding.span.as_ref().map(|place| place.start));
    (words.findings, words.mended)
}

/// What to do about a key that is missing.
const MISSING: &str = "docs/scenes lists every key; `brisance schema` prints the schema";
/// Values inside each other that stand for one that is missing.
const DEEPEST: u32 = 16;
/// Findings for which it is looked what was meant: many more than are told, in whatever order they come.
const MOST_LOOKED_AT: usize = 1000;

struct Words<'s> {
    schema: &'s Value,
    findings: Vec<Finding>,
    mended: Mended,
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
            return self.choice(path, value, schema, choices);
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
            let message = format!("invalid type: {}, expected {wanted}", value.get_ref().type_str());
            self.add(path, Some(value.span()), message, "see docs/scenes for this key");
            return self.stand_in(path, value, schema);
        }
        let place = value.span();
        match value.get_mut() {
            DeValue::Table(table) => self.table(path, table, schema, &place),
            DeValue::Array(array) => {
                for (index, entry) in array.iter_mut().enumerate() {
                    self.value(&format!("{path}[{index}]"), entry, &schema["items"]);
                }
            }
            _ => {}
        }
    }

    fn table(&mut self, path: &str, table: &mut DeTable<'_>, schema: &'s Value, place: &Range<usize>) {
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
        let required = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let mut missing: Vec<&str> = required.filter(|key| !table.contains_key(*key)).collect();
        for (key, place) in unknown {
            let names = || known.keys().map(String::as_str);
            let message = format!("unknown field `{key}`{}", self.like(&key, names()));
            self.add(&below(&key), Some(place.clone()), message, &there_are(names()));
            let value = table.remove(key.as_str());
            let Some(mut value) = value else { continue };
            let fits = |name: &&str| wrong_type(self.meant(&known[*name]), value.get_ref()).is_none();
            let meant = self.closest(&key, names().filter(|name| !table.contains_key(*name))).into_iter().find(fits);
            if let Some(meant) = meant {
                missing.retain(|own| *own != meant);
                self.value(&below(meant), &mut value, &known[meant]);
                table.insert(Spanned::new(place, Cow::Owned(meant.to_owned())), value);
            }
        }
        for key in missing {
            self.add(path, Some(place.clone()), format!("missing field `{key}`"), MISSING);
            let mut value = Spanned::new(place.clone(), DeValue::Boolean(false));
            self.stand_in(&below(key), &mut value, &known[key]);
            table.insert(Spanned::new(place.clone(), Cow::Owned(key.to_owned())), value);
        }
    }

    /// One of several words, or a table with one of several keys.
    fn choice(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, schema: &'s Value, choices: &'s [Value]) {
        let place = value.span();
        match value.get_mut() {
            DeValue::String(word) => {
                let words = || choices.iter().flat_map(words_of);
                if words().any(|known| known == word) {
                    return;
                }
                let names = || choices.iter().flat_map(|choice| words_of(choice).into_iter().chain(keys_of(choice)));
                let message = format!("unknown variant `{word}`{}", self.like(word, names()));
                self.add(path, Some(place), message, &there_are(names()));
                match self.closest(word, words()).first() {
                    Some(meant) => *word = Cow::Owned((*meant).to_owned()),
                    None => self.stand_in(path, value, schema),
                }
            }
            DeValue::Table(table) => {
                if !self.keyed(path, table, choices, &place) {
                    self.stand_in(path, value, schema);
                }
            }
            other if choices.iter().any(|choice| wrong_type(self.meant(choice), other).is_none()) => {}
            other => {
                let names = || choices.iter().flat_map(|choice| words_of(choice).into_iter().chain(keys_of(choice)));
                let message = format!("invalid type: {}, expected a word or a table", other.type_str());
                self.add(path, Some(place), message, &there_are(names()));
                self.stand_in(path, value, schema);
            }
        }
    }

    /// A table whose key says which choice it is; whether it can be read.
    fn keyed(&mut self, path: &str, table: &mut DeTable<'_>, choices: &'s [Value], place: &Range<usize>) -> bool {
        let own = |choice: &Value, key: &str| {
            choice["required"].as_array().is_some_and(|required| required.iter().any(|own| own == key))
        };
        let mut named = choices.iter().filter(|choice| table.keys().any(|key| own(choice, key.get_ref())));
        if let Some(choice) = named.next() {
            // several are told by the reader
            if named.next().is_none() {
                self.table(path, table, choice, place);
            }
            return true;
        }
        let known = |key: &str| choices.iter().any(|choice| choice["properties"].get(key).is_some());
        let unknown = table.keys().find(|key| !known(key.get_ref())).map(|key| (key.get_ref().to_string(), key.span()));
        // so is a table without a key
        let Some((key, at)) = unknown else { return true };
        let names = || choices.iter().flat_map(|choice| words_of(choice).into_iter().chain(keys_of(choice)));
        let message = format!("unknown variant `{key}`{}", self.like(&key, names()));
        self.add(path, Some(at.clone()), message, &there_are(names()));
        let meant = |name: &str| choices.iter().find(|choice| own(choice, name));
        let meant = self.closest(&key, names()).into_iter().find_map(|name| Some((name, meant(name)?)));
        let (Some((name, choice)), Some(value)) = (meant, table.remove(key.as_str())) else { return false };
        table.insert(Spanned::new(at, Cow::Owned(name.to_owned())), value);
        self.table(path, table, choice, place);
        true
    }

    /// Puts something readable in the place of a value.
    fn stand_in(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, schema: &'s Value) {
        match self.readable(schema, &value.span(), 0) {
            Some(readable) if self.mended.stand_ins.len() < MOST_LOOKED_AT => {
                *value = readable;
                self.mended.stand_ins.push(path.to_owned());
            }
            _ => self.mended.unreadable = true,
        }
    }

    /// Any value that the schema allows.
    fn readable(&self, schema: &'s Value, place: &Range<usize>, depth: u32) -> Option<Spanned<DeValue<'static>>> {
        let schema = self.meant(schema);
        if depth > DEEPEST {
            return None;
        }
        let choices = ["oneOf", "anyOf"].iter().find_map(|key| schema[key].as_array());
        if let Some(choices) = choices {
            return choices.iter().find_map(|choice| self.readable(choice, place, depth + 1));
        }
        let value = match (words_of(schema).first(), schema["type"].as_str()?) {
            (Some(word), _) => DeValue::String(Cow::Owned((*word).to_owned())),
            (_, "string") => DeValue::String(Cow::Borrowed("unknown")),
            (_, "boolean") => DeValue::Boolean(false),
            (_, "number") => number("v = 1.0")?,
            (_, "integer") => number("v = 1")?,
            (_, "array") => {
                let mut array = DeArray::new();
                for _ in 0..schema["minItems"].as_u64().unwrap_or(1) {
                    array.push(self.readable(&schema["items"], place, depth + 1)?);
                }
                DeValue::Array(array)
            }
            (_, "object") => {
                let mut table = DeTable::new();
                for key in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
                    let value = self.readable(&schema["properties"][key], place, depth + 1)?;
                    table.insert(Spanned::new(place.clone(), Cow::Owned(key.to_owned())), value);
                }
                DeValue::Table(table)
            }
            _ => return None,
        };
        Some(Spanned::new(place.clone(), value))
    }

    /// What may have been meant by a word.
    fn like<'n>(&self, word: &str, names: impl Iterator<Item = &'n str>) -> String {
        if self.findings.len() < MOST_LOOKED_AT { did_you_mean(word, names) } else { String::new() }
    }

    /// The same as names.
    fn closest<'n>(&self, word: &str, names: impl Iterator<Item = &'n str>) -> Vec<&'n str> {
        if self.findings.len() < MOST_LOOKED_AT { closest(word, names) } else { Vec::new() }
    }

    fn add(&mut self, path: &str, place: Option<Range<usize>>, message: String, help: &str) {
        self.findings.push(Finding { span: place, ..Finding::new(path, message, help) });
    }
}

/// The words that one choice stands for.
fn words_of(choice: &Value) -> Vec<&str> {
    let own = choice["const"].as_str().into_iter();
    own.chain(choice["enum"].as_array().into_iter().flatten().filter_map(Value::as_str)).collect()
}

/// The keys that one choice stands for.
fn keys_of(choice: &Value) -> impl Iterator<Item = &str> {
    choice["properties"].as_object().into_iter().flat_map(|keys| keys.keys().map(String::as_str))
}

fn number(text: &'static str) -> Option<DeValue<'static>> {
    DeTable::parse(text).ok()?.into_inner().remove("v").map(Spanned::into_inner)
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
