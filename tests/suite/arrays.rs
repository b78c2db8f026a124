//! The table of what arrays hold (`src/state/arrays.rs`) against itself and against the shaders.

use brisance::state::arrays::{Name, USES, Use};

use crate::shaders::files;

/// Uses that meet all the same.
const KNOWN: [[&str; 2]; 1] = [
    // After a step with the filter the carrier of the next one takes the velocity before open faces for that in them, as at the start.
    ["OPEN_PRESSURE", "FILTER_ENERGY"],
];

fn name_of(used: &Use) -> &'static str {
    match used.name {
        Name::Array | Name::First => used.array,
        Name::Part(_, name) | Name::Place(name) | Name::Lent(name) => name,
    }
}

/// File, number and text of all lines of the shaders, without comments.
fn code() -> Vec<(String, usize, String)> {
    let code = |line: &str| line.split("//").next().unwrap_or_default().to_owned();
    let lines = |(file, text): (String, String)| {
        text.lines().enumerate().map(|(at, line)| (file.clone(), at + 1, code(line))).collect::<Vec<_>>()
    };
    files().into_iter().flat_map(lines).collect()
}

#[test]
fn no_two_uses_of_a_part_meet() {
    let mut found = Vec::new();
    for (first, used) in USES.iter().enumerate() {
        for (second, later) in USES.iter().enumerate() {
            if first != second && used.meets(later) {
                found.push([name_of(used), name_of(later)]);
            }
        }
    }
    assert_eq!(found, KNOWN, "two uses of one part at once");
}

#[test]
fn every_use_ends_after_it_begins() {
    for used in USES {
        assert!(used.from.order() <= used.to.order(), "{used:?}");
    }
}

/// `k * params.slots + slot`, in any order of its terms.
#[test]
fn no_shader_counts_places_by_hand() {
    let by_hand = |line: &str| {
        let parts: Vec<_> = line.split("params.slots").collect();
        let before = parts[..parts.len() - 1].iter().any(|text| text.trim_end().ends_with(['+', '*']));
        before || parts[1..].iter().any(|text| text.trim_start().starts_with(['+', '*']))
    };
    let failures: Vec<_> = code()
        .into_iter()
        .filter(|(file, _, line)| file != "shared/arrays.wgsl" && by_hand(line))
        .map(|(file, line, text)| format!("shaders/{file}:{line}: {}", text.trim()))
        .collect();
    assert!(failures.is_empty(), "write array[part(NAME, slot)]:\n{}", failures.join("\n"));
}

#[test]
fn every_part_and_lent_vector_is_used() {
    let code = code();
    for used in USES {
        let name = name_of(used);
        let word = |line: &str| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
        let named = code.iter().any(|(_, _, line)| !line.starts_with("const ") && word(line));
        assert!(named, "no shader names {name}");
    }
}
