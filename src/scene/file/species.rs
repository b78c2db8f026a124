//! Which gas a state is: a name in a file becomes a mass fraction.

use std::borrow::Cow;

use serde_json::{Value, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene::file::mended;
use crate::scene::finding::Finding;

/// The key of a state.
const KEY: &str = "species";

/// Replaces the names of gases in all states of a document.
pub(crate) fn take(root: &mut DeTable<'_>, findings: &mut Vec<Finding>) {
    let names: Vec<String> = match root.get("gas").map(Spanned::get_ref) {
        Some(DeValue::Table(gas)) => match gas.get(KEY).map(Spanned::get_ref) {
            Some(DeValue::Table(species)) => species.keys().map(|name| name.get_ref().to_string()).collect(),
            _ => Vec::new(),
        },
        _ => Vec::new(),
    };
    let mut walk = Walk { names, findings };
    if let Some(DeValue::Table(gas)) = root.get_mut("gas").map(Spanned::get_mut) {
        for key in ["ambient", "regions"] {
            gas.get_mut(key).into_iter().for_each(|value| walk.value(&format!("gas.{key}"), value));
        }
    }
    root.get_mut("boundary").into_iter().for_each(|value| walk.value("boundary", value));
}

struct Walk<'a> {
    names: Vec<String>,
    findings: &'a mut Vec<Finding>,
}

impl Walk<'_> {
    fn value(&mut self, path: &str, value: &mut Spanned<DeValue<'_>>) {
        match value.get_mut() {
            DeValue::Table(table) => {
                self.state(path, table);
                table.iter_mut().for_each(|(key, own)| self.value(&format!("{path}.{}", key.get_ref()), own));
            }
            DeValue::Array(entries) => {
                let each = entries.iter_mut().enumerate();
                each.for_each(|(index, own)| self.value(&format!("{path}[{index}]"), own));
            }
            _ => {}
        }
    }

    fn state(&mut self, path: &str, state: &mut DeTable<'_>) {
        let Some(named) = state.get(KEY) else { return };
        let place = named.span();
        let name = if let DeValue::String(name) = named.get_ref() { Some(name.to_string()) } else { None };
        let known = name.as_ref().is_some_and(|name| self.names.contains(name));
        if !known || state.contains_key("mass_fraction") {
            let what = name.map_or("no name of a gas".to_owned(), |name| format!("no gas `{name}`"));
            let (message, help) = match (known, self.names.first()) {
                (true, _) => (
                    "it is a mass fraction of 1, and the state gives one".to_owned(),
                    "leave one of them out".to_owned(),
                ),
                (false, Some(own)) => (what, format!("give \"{own}\", or leave it out for the first gas")),
                (false, None) => {
                    (what, "add a table such as [gas.species.helium] with gamma and gas_constant".to_owned())
                }
            };
            self.findings
                .push(Finding { span: Some(place.clone()), ..Finding::new(format!("{path}.{KEY}"), message, help) });
        }
        state.remove(KEY);
        if let Some(one) = mended::number("v = 1.0").filter(|_| known) {
            state.insert(Spanned::new(place.clone(), Cow::Borrowed("mass_fraction")), Spanned::new(place, one));
        }
    }
}

/// Adds the key to the schema that editors use.
pub(crate) fn add_keys(schema: &mut Value) {
    for name in ["GasState", "Region", "Inflow", "Reservoir", "TimedInlet", "AttenuatedOutlet"] {
        schema["$defs"][name]["properties"][KEY] = json!({ "type": "string", "description": "Name of the second gas, in place of `mass_fraction = 1`; the first gas when left out." });
    }
}
