//! The table of arrays as shaders and the book show it.

use std::fmt::Write as _;

use super::{Name, Scenes, Slots, USES};

/// Numbers of the words of LENGTHS.
const WORDS: [(&str, u32); 2] = [("LENGTH_LISTED", 0), ("LENGTH_FRONTIER", 1)];

/// The constants of `shaders/shared/state.wgsl`.
pub fn constants() -> String {
    let mut text = String::new();
    let mut known = Vec::new();
    for own in USES {
        let Name::Part(part, name) = own.name else { continue };
        if known.contains(&name) {
            continue;
        }
        known.push(name);
        let arrays: Vec<_> = USES.iter().filter(|other| other.name == own.name).map(|other| other.array).collect();
        let array = if arrays.iter().all(|array| *array == own.array) { own.array } else { "vectors" };
        let unit = if own.unit.is_empty() { String::new() } else { format!(" [{}]", own.unit) };
        let _ = writeln!(text, "const {name} = {part}u; // {array}: {}{unit}", own.holds.replace('`', ""));
    }
    for (name, value) in WORDS {
        let _ = writeln!(text, "const {name} = {value}u;");
    }
    text
}

/// The uses as a table of the book.
pub fn table() -> String {
    let mut text = "| Array | Use | Holds | Unit | From | To |\n|---|---|---|---|---|---|\n".to_owned();
    let mut last = "";
    for own in USES {
        let array = if own.array == last { String::new() } else { format!("`{}`", own.array) };
        last = own.array;
        let name = match own.name {
            Name::Array => String::new(),
            Name::First => "first part".to_owned(),
            Name::Part(part, name) => format!("{part}: `{name}`"),
            Name::Place(member) => format!("`params.{member}`"),
            Name::Lent(binding) => format!("lent as `{binding}`"),
        };
        let scenes = match own.scenes {
            Scenes::All => "",
            Scenes::Gas => " (gas alone)",
            Scenes::Bodies => " (bodies)",
            Scenes::TwoSolves => " (two solves)",
            Scenes::TwoGases => " (two gases)",
            Scenes::Products => " (products of an explosive)",
            Scenes::Dust => " (dust)",
            Scenes::SolveFirst => " (bodies, solve first)",
            Scenes::Explicit => " (sub-steps)",
            Scenes::Implicit => " (implicit elasticity)",
            Scenes::ElasticFirst => " (elastic step first)",
        };
        let slots = match own.slots {
            Slots::All => "",
            Slots::Domain => "cells of the domain: ",
            Slots::Ring => "ring: ",
        };
        let unit = own.unit.split(", ").filter(|unit| !unit.is_empty()).map(|unit| format!("`{unit}`"));
        let unit = unit.collect::<Vec<_>>().join(", ");
        let (from, to) = (own.from.text(), own.to.text());
        let _ = writeln!(text, "| {array} | {name} | {slots}{}{scenes} | {unit} | {from} | {to} |", own.holds);
    }
    text
}
