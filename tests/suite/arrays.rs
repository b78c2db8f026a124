//! The table of what arrays hold (`src/state/arrays.rs`) against itself and against the shaders.

use std::collections::{BTreeMap, BTreeSet};

use brisance::gpu::{Detail, Folder, Shader};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::state::arrays::{Name, USES, Use, When};
use brisance::state::stages::Stage;

use crate::common::gpu_or_skip;
use crate::shaders::{constants, files, stages};

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
    assert!(found.is_empty(), "two uses of one part at once: {found:?}");
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
        .filter(|(file, _, line)| file != "shared/state.wgsl" && by_hand(line))
        .map(|(file, line, text)| format!("shaders/{file}:{line}: {}", text.trim()))
        .collect();
    assert!(failures.is_empty(), "write array[part(NAME, slot)]:\n{}", failures.join("\n"));
}

#[test]
fn every_part_and_lent_vector_is_used() {
    let code = code();
    for used in USES {
        let name = name_of(used);
        let named = code.iter().any(|(_, _, line)| !line.starts_with("const ") && words(line).contains(name));
        assert!(named, "no shader names {name}");
    }
}

fn words(text: &str) -> BTreeSet<&str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty()).collect()
}

/// Words of a text, and `name[` for what is indexed.
fn words_and_arrays(text: &str) -> BTreeSet<String> {
    let arrays = words(text).into_iter().map(|word| format!("{word}[")).filter(|word| text.contains(word.as_str()));
    arrays.chain(words(text).into_iter().map(str::to_owned)).collect()
}

/// For each entry point of the step: the words and arrays of all functions that it may call.
fn words_of_kernels() -> BTreeMap<String, BTreeSet<String>> {
    let mut kernels = BTreeMap::new();
    for name in stages() {
        let folder = Folder::Disk(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders").into());
        let shader = Shader::load(&name, &constants(&name), &folder).unwrap();
        let code: Vec<_> = shader.text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
        let code = code.join("\n");
        let mut functions = BTreeMap::new();
        for part in code.split("\nfn ").skip(1) {
            let body = part.find("\n}").map_or(part.lines().next().unwrap_or_default(), |end| &part[..end]);
            functions.insert(part.split('(').next().unwrap_or_default().to_owned(), words_and_arrays(body));
        }
        for entry in code.split("@compute").skip(1).filter_map(|part| part.split("fn ").nth(1)?.split('(').next()) {
            let (mut found, mut left) = (BTreeSet::new(), vec![entry.to_owned()]);
            while let Some(function) = left.pop() {
                let new = functions[&function].iter().filter(|word| found.insert((*word).clone()));
                left.extend(new.filter(|word| functions.contains_key(*word)).cloned());
            }
            kernels.insert(entry.to_owned(), found);
        }
    }
    kernels
}

/// Stage and kernel of all dispatches in the first steps of small scenes with every form of a step.
fn recorded() -> Option<BTreeSet<(Stage, String)>> {
    let gpu = gpu_or_skip()?;
    let gas = ["domain.cells=[16]"];
    let open = ["domain.cells=[16]", "boundary.x_max=outlet"];
    let slab = ["domain.cells=[16]", "materials.stiff.neo_hookean.young_modulus=100.0"];
    let dust = "gas.dust={ sides = [\"x_min\"], amount = 1.0, threshold = 0.0, rate = 1.0 }";
    let scenes: [(&str, &[&str], &str); 9] = [
        ("gas/sod.toml", &gas, "numerics.integrator=auto"),
        ("gas/sod.toml", &gas, "numerics.integrator=predictor"),
        ("gas/sod.toml", &gas, "numerics.pair=b2b1"),
        ("gas/sod.toml", &gas, "numerics.filter=0.2"),
        ("gas/sod.toml", &gas, dust),
        ("gas/sod.toml", &open, "expect={ min_pressure = 0.0 }"),
        ("coupled/slab_at_rest.toml", &slab, "numerics.filter=0.2"),
        ("coupled/slab_at_rest.toml", &slab, "numerics.elasticity=implicit"),
        ("coupled/slab_at_rest.toml", &slab, "numerics.paper.coupling=last"),
    ];
    let mut found = BTreeSet::new();
    for (scene, overrides, method) in scenes {
        let overrides: Vec<_> = overrides.iter().chain([&method]).map(|&text| text.to_owned()).collect();
        let scene = Scene::shipped(scene, &overrides).unwrap();
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        simulation.set_target(1e30).unwrap();
        let (_, times) = simulation.advance_timed(&mut Vec::new(), Detail::Kernels).unwrap();
        for (stage, kernel) in times.iter().filter_map(|(name, _)| name.split_once(": ")) {
            let known = Stage::ALL.iter().find(|known| known.name() == stage);
            let kernel = kernel.split(' ').next().unwrap_or_default().to_owned();
            found.extend(known.map(|stage| (*stage, kernel)));
        }
    }
    Some(found)
}

/// Whether a stage has a moment within a use. The carrier belongs to several moments between its first and the update of the gas.
fn within(used: &Use, stage: Stage) -> bool {
    let moments = [When::At(stage), When::Second(stage), When::Substep(stage), When::Next(stage)].map(When::order);
    let (from, to) = (used.from.order(), used.to.order());
    moments.iter().any(|at| (from..=to).contains(at))
        || stage == Stage::Carrier && from <= When::At(Stage::FluidUpdate).order()
}

#[test]
fn kernels_name_parts_in_the_stages_of_the_table_only() {
    let Some(recorded) = recorded() else { return };
    let kernels = words_of_kernels();
    let mut failures = Vec::new();
    let named = |used: &Use| matches!(used.name, Name::Part(..) | Name::Lent(_)) && name_of(used) != "APART";
    for name in USES.iter().filter(|used| named(used)).map(name_of).collect::<BTreeSet<_>>() {
        let of_name = || USES.iter().filter(|used| name_of(used) == name);
        let lent = of_name().any(|used| matches!(used.name, Name::Lent(_)));
        let word = if lent { format!("{name}[") } else { name.to_owned() };
        let naming: BTreeSet<_> = recorded
            .iter()
            .filter(|(_, kernel)| kernels.get(kernel).is_some_and(|words| words.contains(&word)))
            .collect();
        let outside = naming.iter().filter(|(stage, _)| !of_name().any(|used| within(used, *stage)));
        failures.extend(outside.map(|(stage, kernel)| format!("{name}: {kernel} of {}", stage.name())));
        for used in of_name() {
            for When::At(end) | When::Second(end) | When::Substep(end) | When::Next(end) in [used.from, used.to] {
                if !naming.iter().any(|(stage, _)| *stage == end) {
                    failures.push(format!("{name}: no kernel of {} names it", end.name()));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} failures\n{}", failures.len(), failures.join("\n"));
}
