//! Words of a scene file against the schema: every unknown key and variant, and every value of a wrong type, not only the first one.

use std::borrow::Cow;
use std::ops::Range;

use serde_json::Value;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene::file::mended::{self, Mended, words_of, wrong_type};
use crate::scene::finding::Finding;
use crate::scene::numerics::GONE;
use crate::scene::schema::{meant, schema};
use crate::spelling::{closest, did_you_mean};

/// Reports words that the schema does not know, values of another type and keys that are missing. Unknown keys are taken out, or take the
/// place of the missing key that was meant; likely words or anything readable stand for the others, so that the rest can be read.
pub(crate) fn findings(root: &mut Spanned<DeTable<'_>>) -> (Vec<Finding>, Mended) {
    let mut words = Words { findings: Vec::new(), mended: Mended::default() };
    let place = root.span();
    words.table("", root.get_mut(), schema(), &place);
    words.findings.sort_by_key(|finding| finding.span.as_ref().map(|place| place.start));
    (words.findings, words.mended)
}

/// What to do about a key that is missing.
const MISSING: &str = "docs/scenes lists every key; `brisance schema` prints the schema";
/// Findings for which it is looked what was meant: many more than are told, in whatever order they come.
const MOST_LOOKED_AT: usize = 1000;

struct Words {
    findings: Vec<Finding>,
    mended: Mended,
}

impl Words {
    fn value(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, schema: &'static Value) {
        let schema = meant(schema);
        if let Some(choices) = schema["oneOf"].as_array() {
            return self.choice(path, value, schema, choices);
        }
        if let Some(choices) = schema["anyOf"].as_array() {
            return self.any(path, value, schema, choices);
        }
        if schema["enum"].is_array() {
            return self.choice(path, value, schema, std::slice::from_ref(schema));
        }
        if let Some(wanted) = wrong_type(schema, value.get_ref()) {
            let message = format!("invalid type: {}, expected {wanted}", value.get_ref().type_str());
            self.add(path, Some(value.span()), message, "see docs/scenes for this key");
            return self.stand_in(path, value, schema);
        }
        let place = value.span();
        match value.get_mut() {
            DeValue::Boolean(given) if schema["const"].as_bool().is_some_and(|only| only != *given) => {
                let message = format!("{given} cannot stand here");
                self.add(path, Some(place), message, schema["description"].as_str().unwrap_or_default());
                self.stand_in(path, value, schema);
            }
            DeValue::Table(table) => self.table(path, table, schema, &place),
            DeValue::Array(array) => {
                for (index, entry) in array.iter_mut().enumerate() {
                    self.value(&format!("{path}[{index}]"), entry, &schema["items"]);
                }
            }
            _ => {}
        }
    }

    /// One of several types of value; one that may be left out is what it is.
    fn any(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, schema: &'static Value, choices: &'static [Value]) {
        let own = || choices.iter().filter(|choice| choice["type"] != "null");
        let misfit = |choice: &&Value| match meant(choice) {
            plain if plain["oneOf"].is_array() || plain["enum"].is_array() => {
                !matches!(value.get_ref(), DeValue::String(_) | DeValue::Table(_))
            }
            plain => wrong_type(plain, value.get_ref()).is_some(),
        };
        let missing = |choice: &&Value| match value.get_ref() {
            DeValue::Table(table) => {
                let needed = meant(choice)["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
                needed.filter(|key| !table.contains_key(*key)).count()
            }
            _ => 0,
        };
        let fitting = own().filter(|choice| !misfit(choice)).min_by_key(missing);
        if let Some(meant) = fitting.or_else(|| own().next().filter(|_| own().count() == 1)) {
            let before = self.findings.len();
            self.value(path, value, meant);
            let number = own().any(|other| other["type"] == "number");
            for word in self.findings[before..].iter_mut().filter(|found| number && found.path == path) {
                word.help.push_str(", or a number");
            }
            return;
        }
        let kind = |choice| mended::kind_name(meant(choice)["type"].as_str().unwrap_or("word"));
        let wanted: Vec<&str> = own().map(kind).collect();
        let message = format!("invalid type: {}, expected {}", value.get_ref().type_str(), wanted.join(" or "));
        self.add(path, Some(value.span()), message, "see docs/scenes for this key");
        self.stand_in(path, value, schema);
    }

    fn table(&mut self, path: &str, table: &mut DeTable<'_>, schema: &'static Value, place: &Range<usize>) {
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
            if let Some((message, help)) = elsewhere(known, &below(""), &key) {
                self.add(&below(&key), Some(place), message, &help);
                table.remove(key.as_str());
                continue;
            }
            let names = || known.keys().map(String::as_str);
            let message = format!("unknown field `{key}`{}", self.like(&key, names()));
            self.add(&below(&key), Some(place.clone()), message, &there_are(names()));
            let value = table.remove(key.as_str());
            let Some(mut value) = value else { continue };
            let fits = |name: &&str| wrong_type(meant(&known[*name]), value.get_ref()).is_none();
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
    fn choice(
        &mut self,
        path: &str,
        value: &mut Spanned<DeValue<'_>>,
        schema: &'static Value,
        choices: &'static [Value],
    ) {
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
            other if choices.iter().any(|choice| wrong_type(meant(choice), other).is_none()) => {}
            other => {
                let names = || choices.iter().flat_map(|choice| words_of(choice).into_iter().chain(keys_of(choice)));
                let or_table =
                    if choices.iter().any(|choice| keys_of(choice).next().is_some()) { " or a table" } else { "" };
                let message = format!("invalid type: {}, expected a word{or_table}", other.type_str());
                self.add(path, Some(place), message, &there_are(names()));
                self.stand_in(path, value, schema);
            }
        }
    }

    /// A table whose key says which choice it is; whether it can be read.
    fn keyed(&mut self, path: &str, table: &mut DeTable<'_>, choices: &'static [Value], place: &Range<usize>) -> bool {
        let own = |choice: &Value, key: &str| {
            choice["required"].as_array().is_some_and(|required| required.iter().any(|own| own == key))
        };
        let named = table.keys().filter(|key| choices.iter().any(|choice| own(choice, key.get_ref())));
        let mut named: Vec<_> = named.map(|key| (key.span(), key.get_ref().to_string())).collect();
        named.sort_by_key(|(at, _)| at.start);
        if let [(_, first), more @ ..] = &named[..] {
            for (at, key) in more {
                let message = format!("`{first}` and `{key}`, of which one stands here");
                self.add(path, Some(at.clone()), message, &format!("remove `{first}` or `{key}`"));
                table.remove(key.as_str());
            }
            let choice = choices.iter().find(|choice| own(choice, first));
            choice.into_iter().for_each(|choice| self.table(path, table, choice, place));
            return true;
        }
        let known = |key: &str| choices.iter().any(|choice| choice["properties"].get(key).is_some());
        let unknown = table.keys().find(|key| !known(key.get_ref())).map(|key| (key.get_ref().to_string(), key.span()));
        let names = || choices.iter().flat_map(|choice| words_of(choice).into_iter().chain(keys_of(choice)));
        let Some((key, at)) = unknown else {
            let keys = choices.iter().flat_map(|choice| choice["required"].as_array()?.first()?.as_str());
            let message = "no key says what it is".to_owned();
            self.add(path, Some(place.clone()), message, &there_are(keys));
            return false;
        };
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
    fn stand_in(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>, schema: &'static Value) {
        if self.mended.stand_ins_count() < MOST_LOOKED_AT {
            self.mended.stand_in(path, value, schema);
        } else {
            self.mended.unreadable = true;
        }
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

/// What to say of a key that stands in a table beside it, or that there is no more; `path` leads to its own table.
fn elsewhere(known: &serde_json::Map<String, Value>, path: &str, key: &str) -> Option<(String, String)> {
    if let Some((_, help)) = GONE.iter().find(|(own, _)| own.strip_prefix(path) == Some(key)) {
        return Some((format!("unknown field `{key}`"), (*help).to_owned()));
    }
    let (table, _) = known.iter().find(|(_, schema)| meant(schema)["properties"].get(key).is_some())?;
    let message = format!("unknown field `{key}`; it is a key of `{path}{table}`");
    Some((message, format!("write {path}{table}.{key}, or the key below the header [{path}{table}]")))
}

/// The keys that one choice stands for.
fn keys_of(choice: &Value) -> impl Iterator<Item = &str> {
    choice["properties"].as_object().into_iter().flat_map(|keys| keys.keys().map(String::as_str))
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
