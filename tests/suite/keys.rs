//! The tables of `docs/scenes`: keys, defaults, limits and meanings as the types have them. A page says where which table stands.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

use brisance::material::{KINDS, Kind, PRESETS, Preset};
use brisance::math::plain;
use brisance::scene::{allowed, schema};
use serde_json::Value;

use crate::common::{files_below, is_kind, slashed};

/// Before the name of a table, in the line above it.
const MARK: &str = "Generated from the type ";
/// Words that a row has with their meaning at most.
const FEW_WORDS: usize = 4;
/// Words that a row names at most.
const MANY_WORDS: usize = 7;
/// Types whose keys a page tells in other words: views, regions, sides; laws and presets have tables of their own.
const TOLD: [&str; 8] =
    ["View", "Region", "Boundaries", "Color", "Material", "FractureGiven", "FlowGiven", "OwnFracture"];

/// File, table that it follows from, and the text, for each table of the pages.
pub(crate) fn parts() -> Vec<(String, String, String)> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scenes");
    let tables = Tables::new();
    let mut parts = Vec::new();
    for page in files_below(&docs).into_iter().filter(|path| is_kind(path, "md")) {
        let text = std::fs::read_to_string(docs.join(&page)).unwrap();
        for (at, _) in text.match_indices(MARK) {
            let name = text[at + MARK.len()..].split(' ').next().unwrap();
            parts.push((
                format!("docs/scenes/{}", slashed(&page)),
                format!("the type {name}"),
                format!("\n{}\n", tables.of(name)),
            ));
        }
    }
    let known = tables.root["$defs"].as_object().unwrap().keys();
    let shown = tables.shown.borrow();
    let missing: Vec<_> = known.filter(|name| !shown.contains(*name) && !TOLD.contains(&name.as_str())).collect();
    assert!(missing.is_empty(), "no page of docs/scenes has a table of {missing:?}");
    parts
}

struct Tables {
    root: Value,
    /// Types whose keys or words stand on some page.
    shown: RefCell<BTreeSet<String>>,
}

impl Tables {
    fn new() -> Self {
        Tables { root: serde_json::from_str(&schema()).unwrap(), shown: RefCell::default() }
    }

    /// The table of a type.
    fn of(&self, name: &str) -> String {
        self.shown.borrow_mut().insert(name.to_owned());
        let own = if name == "Scene" { &self.root } else { &self.root["$defs"][name] };
        match (name, own["properties"].as_object(), own["oneOf"].as_array()) {
            ("Law", ..) => laws(),
            ("Parameter", ..) => self.parameters(),
            ("Preset", ..) => presets(),
            ("PresetFracture", ..) => breaking(),
            ("PresetFlow", ..) => flowing(),
            (_, Some(keys), _) => self.keys(own, keys),
            (_, _, Some(choices)) => self.choices(choices),
            _ => panic!("`{name}` is no type with keys or words"),
        }
    }

    fn keys(&self, own: &Value, keys: &serde_json::Map<String, Value>) -> String {
        let required = |key: &str| own["required"].as_array().is_some_and(|all| all.iter().any(|own| own == key));
        let row = |(key, value): (&String, &Value)| {
            let meaning = meaning(value) + &self.meanings(value).unwrap_or_default();
            let default = match default(value) {
                _ if required(key) => "required".to_owned(),
                None if meaning.contains("left out") => String::new(),
                default => default.unwrap_or("none".to_owned()),
            };
            format!("`{key}` | {default} | {} | {meaning}", self.allowed(value))
        };
        table("Key | Default | Allowed | Meaning", keys.iter().map(row))
    }

    /// One of several words, or of several tables of one key.
    fn choices(&self, choices: &[Value]) -> String {
        let plain = choices.iter().all(|choice| choice["const"].is_string());
        let row = |choice: &Value| match choice["const"].as_str() {
            Some(word) if plain => format!("`{word}` | {}", meaning(choice)),
            Some(word) => format!("`{word}` | | {}", meaning(choice)),
            None => {
                let (word, own) = choice["properties"].as_object().unwrap().iter().next().unwrap();
                format!("`{word}` | {} | {}", self.inline(own), meaning(choice))
            }
        };
        table(if plain { "Word | Meaning" } else { "Word | Keys | Meaning" }, choices.iter().map(row))
    }

    /// The keys of a table within a row.
    fn inline(&self, own: &Value) -> String {
        let target = self.meant(own);
        let one_of = |own: &Value| {
            let choice = own["anyOf"].as_array().map_or(own, |choices| &choices[0]);
            words(self.meant(choice)).map(|_| format!("one of {}", self.allowed(choice)))
        };
        if own["$ref"] == "#/$defs/GasState" || target["type"] == "array" {
            return self.allowed(own);
        }
        // pages say of all tables together which gas they are about
        let keys = target["properties"].as_object().unwrap().iter();
        let keys = keys.filter(|(key, _)| !["mass_fraction", "species"].contains(&key.as_str())).map(|(key, value)| {
            let default = default(value).filter(|default| !default.is_empty() && default != "none");
            let told: Vec<_> = one_of(value).into_iter().chain(default.map(|own| format!("default {own}"))).collect();
            let told = if told.is_empty() { String::new() } else { format!(" ({})", told.join(", ")) };
            format!("`{key}`{told}: {}", lower(&meaning(value)))
        });
        keys.collect::<Vec<_>>().join(" ")
    }

    fn meant<'s>(&'s self, own: &'s Value) -> &'s Value {
        let Some(name) = own["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/")) else { return own };
        self.shown.borrow_mut().insert(name.to_owned());
        &self.root["$defs"][name]
    }

    /// What may stand at a key.
    fn allowed(&self, own: &Value) -> String {
        match own["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
            Some("Shape") => return "a [shape](shapes.md)".to_owned(),
            Some("GasState") => return "a [state](gas.md#gas)".to_owned(),
            Some("Boundary") => return "a [rule](boundary.md#boundary)".to_owned(),
            Some("Color") => return "`\"#rrggbb\"`".to_owned(),
            Some(name) => {
                let target = &self.root["$defs"][name];
                if words(target).is_none_or(|words| words.len() <= MANY_WORDS) && target["properties"].is_null() {
                    self.shown.borrow_mut().insert(name.to_owned());
                }
                return self.allowed(target);
            }
            None => {}
        }
        if let Some(words) = words(own) {
            let known = words.iter().map(|(word, _)| format!("`{word}`")).collect::<Vec<_>>().join(", ");
            return if words.len() <= MANY_WORDS { known } else { "a word".to_owned() };
        }
        if let Some(choices) = own["anyOf"].as_array() {
            let choices = choices.iter().filter(|choice| choice["type"] != "null").map(|choice| self.allowed(choice));
            return choices.collect::<Vec<_>>().join(" or ").replace("or of at", "or a number of at");
        }
        let kind = own["type"].as_str().or_else(|| own["type"][0].as_str()).unwrap_or("object");
        let size = |key: &str| own[key].as_u64();
        match (kind, size("minItems"), size("maxItems")) {
            ("boolean", ..) => "true, false".to_owned(),
            // whole numbers have a least one by their type
            ("integer", ..) if own["maximum"].is_null() => "a whole number".to_owned(),
            ("integer" | "number", ..) => allowed(own).unwrap_or("a number".to_owned()),
            ("string", ..) => "text".to_owned(),
            ("array", Some(1), Some(3)) => "a vector".to_owned(),
            ("array", Some(count), Some(_)) => match allowed(&own["items"]) {
                Some(allowed) => format!("{count} numbers {allowed}"),
                None => format!("{count} numbers"),
            },
            ("array", ..) => match self.allowed(&own["items"]).as_str() {
                "a table" => "a list".to_owned(),
                each => format!("a list, each {each}"),
            },
            _ if own["additionalProperties"].is_object() => "a table by name".to_owned(),
            _ => "a table".to_owned(),
        }
    }

    /// What the few words of a key mean.
    fn meanings(&self, own: &Value) -> Option<String> {
        let own = own["anyOf"].as_array().map_or(own, |choices| &choices[0]);
        let words = words(self.root["$defs"].get(own["$ref"].as_str()?.rsplit('/').next()?)?)?;
        let told = words.len() <= FEW_WORDS && words.iter().all(|(_, meaning)| !meaning.is_empty());
        let each = words.iter().map(|(word, meaning)| format!(" `{word}`: {}", lower(meaning)));
        told.then(|| each.collect())
    }

    /// Parameters of the laws, from the schema of the two laws that have them all.
    fn parameters(&self) -> String {
        let laws = self.root["$defs"]["Material"]["oneOf"].as_array().unwrap();
        let law = |name: &str| laws.iter().find_map(|law| law["properties"].get(name)).unwrap();
        let mut keys = law("von_mises")["properties"].as_object().unwrap().clone();
        keys.extend(law("drucker_prager")["properties"].as_object().unwrap().clone());
        self.keys(law("von_mises"), &keys)
    }
}

fn table(head: &str, rows: impl IntoIterator<Item = String>) -> String {
    let rule = "---|".repeat(head.matches('|').count() + 1);
    let rows: String = rows.into_iter().map(|row| format!("| {row} |\n")).collect();
    format!("| {head} |\n|{rule}\n{rows}")
}

/// The words of an enumeration with their meanings.
fn words(own: &Value) -> Option<Vec<(String, String)>> {
    if let Some(words) = own["enum"].as_array() {
        return Some(words.iter().map(|word| (word.as_str().unwrap().to_owned(), String::new())).collect());
    }
    own["oneOf"]
        .as_array()?
        .iter()
        .map(|choice| Some((choice["const"].as_str()?.to_owned(), meaning(choice))))
        .collect()
}

/// The description as it stands in a cell.
fn meaning(own: &Value) -> String {
    let text = own["description"].as_str().unwrap_or_default();
    let text = text.replace("`[", "[").replace("]`", "]").replace("\\[", "[").replace("\\]", "]");
    text.replace('\n', " ").replace('|', "\\|")
}

/// A sentence after a colon.
fn lower(text: &str) -> String {
    let mut letters = text.chars();
    match (letters.next(), letters.clone().next()) {
        (Some(first), Some(second)) if second.is_lowercase() || second == ' ' => {
            first.to_lowercase().chain(letters).collect()
        }
        _ => text.to_owned(),
    }
}

/// The default in words, if there is one.
fn default(own: &Value) -> Option<String> {
    let short = |value: &Value| value.to_string().replace(".0,", ",").replace(".0]", "]").replace(',', ", ");
    Some(match own.get("default")? {
        Value::Null => return None,
        Value::String(word) if word.is_empty() => "empty".to_owned(),
        Value::String(word) => format!("`{word}`"),
        Value::Array(all) if all.is_empty() => "none".to_owned(),
        Value::Array(all) if all.iter().all(|x| x.as_f64() == Some(0.0)) => "zero".to_owned(),
        list @ Value::Array(_) if short(list) == "[0, 0, 1]" => "z".to_owned(),
        list @ Value::Array(_) => format!("`{}`", short(list)),
        Value::Object(keys) => if keys.is_empty() { "none" } else { "" }.to_owned(),
        small if small.as_f64().is_some_and(|x| x > 0.0 && x < 1e-3) => format!("{:e}", small.as_f64().unwrap()),
        other => other.to_string().trim_end_matches(".0").to_owned(),
    })
}

fn laws() -> String {
    let row = |kind: &&Kind| {
        let own = kind.parameters.iter().map(|own| match own.default {
            Some(value) => format!("`{}` ({value})", own.name),
            None => format!("`{}`", own.name),
        });
        format!("`{}` | {} | {}", kind.name, own.collect::<Vec<_>>().join(", "), kind.summary)
    };
    table("Kind | Parameters | Law", KINDS.iter().map(row))
}

fn presets() -> String {
    let row = |own: &Preset| {
        let values = own.values.iter().map(|(name, value)| format!("`{name}` {}", plain(*value)));
        let values = values.collect::<Vec<_>>().join(", ");
        let breaks = if own.fracture.is_some_and(|own| own.always) { " Breaks." } else { "" };
        format!("`{}` | {}{breaks} | `{}` | {values} | {}", own.name, own.summary, own.law, own.density)
    };
    table("Preset | What it is | Law | Parameters | Density [kg m^-3]", PRESETS.iter().map(row))
}

fn breaking() -> String {
    let rows = PRESETS.iter().filter_map(|preset| {
        let own = preset.fracture?;
        let (always, softening) =
            (if own.always { ", always" } else { "" }, format!("{:?}", own.softening).to_lowercase());
        let strength = match own.johnson_cook {
            Some(voids) => format!("voids: {}, {}, {}, {}, {}", voids.d1, voids.d2, voids.d3, voids.d4, voids.d5),
            None => plain(own.tensile_strength),
        };
        let energy = own.fracture_energy;
        Some(format!("`{}`{always} | {strength} | {energy} | `{softening}` | {}", preset.name, own.source))
    });
    table("Preset | Tensile strength [Pa], or `d1` to `d5` | Fracture energy [J m^-2] | Softening | Source", rows)
}

fn flowing() -> String {
    let rows = PRESETS.iter().filter_map(|preset| {
        let own = preset.flow?;
        let [a, b] = own.rod.map(plain);
        let brisance::material::Flow { exponent, rate, softening, melting_temperature, heat_capacity, .. } = own.flow;
        let numbers = format!("{a}, {b} | {exponent}, {rate}, {softening} | {melting_temperature} | {heat_capacity}");
        Some(format!("`{}` | {numbers} | {}", preset.name, own.source))
    });
    let head = "Preset | A and B of a rod [Pa] | `exponent`, `rate`, `softening`";
    table(&format!("{head} | Melts at [K] | Heat capacity [J kg^-1 K^-1] | Source"), rows)
}
