//! The shipped scenes load, and every key is documented.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde_json::Value;

use super::{BASE, parse};
use crate::scene::check::limits::allowed;
use crate::scene::{Boundary, Changes, SMALL, Scene, schema};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn scene_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder exists").map(|entry| entry.expect("readable").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let mut found = files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "toml")).collect::<Vec<_>>();
    found.extend(folders.iter().flat_map(|folder| scene_files(folder)));
    found.sort();
    found
}

#[test]
fn every_scene_loads() {
    let files = scene_files(&root().join("scenes"));
    assert!(files.len() >= 13, "{files:?}");
    files.par_iter().for_each(|path| {
        let full = Scene::load(path, &[]).unwrap_or_else(|error| panic!("{error}"));
        // gas and particles at the small size, where there is one: full sizes take seconds each
        let small = if full.variants.contains_key(SMALL) { Changes::variant(SMALL) } else { Changes::default() };
        let scene = Scene::load(path, small).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.initial_gas().len(), scene.domain.cell_count());
        assert_eq!(scene.seed_particles().is_empty(), scene.bodies.is_empty(), "{}", path.display());
        let text = std::fs::read_to_string(path).expect("it was read before");
        assert!(
            text.starts_with("#:schema ../../docs/scene.schema.json\n# ")
                && text.contains("\n# Reference: ")
                && text.contains("\n[expect]"),
            "{}",
            path.display()
        );
    });
}

#[test]
fn every_variant_loads() {
    scene_files(&root().join("scenes")).par_iter().for_each(|path| {
        let scene = Scene::load(path, &[]).unwrap_or_else(|error| panic!("{error}"));
        for name in scene.variants.keys() {
            Scene::load(path, Changes::variant(name)).unwrap_or_else(|error| panic!("{error}"));
        }
    });
}

#[test]
fn variants_change_keys_in_their_order() {
    let text = format!(
        "{BASE}[boundary]\nx_max = {{ outlet_of = 1 }}\n[variants.fine]\n\"domain.cells\" = [40, 20]\ntime.until = 3.0\n[variants.open]\n\
         boundary.x_max = {{ far_field = {{ density = 2.0, pressure = 1.0 }} }}\n[variants.open.time]\nuntil = 4.0\n"
    );
    let text = text.replace("until = 1.0", "until = 1.0\ncfl = 0.25");
    let state = "far_field = { density = 3.0, velocity = [1.0, 0.0], pressure = 1.0 }";
    let text = text.replace("outlet_of = 1", state);
    let plain = parse(&text, &[]);
    assert_eq!((plain.domain.cells, plain.time.until), ([20, 10, 1], 1.0));
    let changed =
        |changes: Changes| Scene::parse(&text, "test.toml", changes).unwrap_or_else(|error| panic!("{error}"));
    let two = |names: [&str; 2]| changed(Changes { variants: names.map(str::to_owned).into(), ..Changes::default() });
    let fine = changed(Changes::variant("fine").set("time.frames=3"));
    assert_eq!((fine.domain.cells, fine.time.until, fine.time.frames), ([40, 20, 1], 3.0, 3));
    let both = two(["fine", "open"]);
    assert_eq!((both.domain.cells, both.time.until), ([40, 20, 1], 4.0));
    // dotted keys and headers lead inside, an inline table replaces
    assert_eq!((fine.time.cfl, both.time.cfl), (0.25, 0.25));
    assert!(
        matches!(both.boundary.x_max, Boundary::FarField(state) if state.density == 2.0 && state.velocity == [0.0; 3])
    );
    assert_eq!(two(["open", "fine"]).time.until, 3.0);
    assert_eq!(both.variants.keys().collect::<Vec<_>>(), ["fine", "open"]);
}

#[test]
fn a_scene_survives_writing_and_reading() {
    for path in scene_files(&root().join("scenes")) {
        let scene = Scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        let text = toml::to_string(&scene).expect("a scene is plain data");
        assert_eq!(Scene::parse(&text, "written.toml", &[]).unwrap_or_else(|error| panic!("{error}\n{text}")), scene);
        let json = serde_json::to_string(&scene).expect("a scene is plain data");
        assert_eq!(serde_json::from_str::<Scene>(&json).expect("what was written reads"), scene);
    }
}

#[test]
fn resolution_scales_all_axes() {
    let scene = parse(BASE, &[]);
    assert_eq!(scene.with_resolution(64).expect("32 rows").domain.cells, [64, 32, 1]);
    let error = scene.with_resolution(25).expect_err("12.5 rows").to_string();
    assert!(error.contains("multiple of 2"), "{error}");
}

#[test]
fn defaults_depend_on_the_dimension() {
    let body = "[[bodies]]\nname = \"b\"\nmaterial = \"rubber\"\ndensity = 1.0\nshape = { box = { center = [0.5], size = [0.5] } }\n";
    let line =
        BASE.replace("dimension = 2", "dimension = 1").replace("[20, 10]", "[20]").replace("[2.0, 1.0]", "[2.0]");
    assert_eq!(parse(&format!("{line}{body}"), &[]).bodies[0].particles_per_cell, Some(4));
    let plane = body.replace("[0.5]", "[0.5, 0.5]");
    assert_eq!(parse(&format!("{BASE}{plane}"), &[]).bodies[0].particles_per_cell, Some(2));
}

/// Collects the names of properties and the values of enumerations.
fn keys(schema: &Value, found: &mut Vec<String>) {
    match schema {
        Value::Object(entries) => {
            for (name, value) in entries {
                match (name.as_str(), value) {
                    ("properties", Value::Object(properties)) => found.extend(properties.keys().cloned()),
                    ("const", Value::String(text)) => found.push(text.clone()),
                    ("enum", Value::Array(texts)) => {
                        found.extend(texts.iter().filter_map(|text| text.as_str().map(str::to_owned)));
                    }
                    _ => {}
                }
                keys(value, found);
            }
        }
        Value::Array(entries) => entries.iter().for_each(|entry| keys(entry, found)),
        _ => {}
    }
}

#[test]
fn every_key_is_documented() {
    let pages = std::fs::read_dir(root().join("docs/scenes")).expect("docs/scenes exists");
    let text: String =
        pages.map(|page| std::fs::read_to_string(page.expect("listed").path()).expect("a page")).collect();
    let schema = serde_json::from_str(&schema()).expect("the schema is JSON");
    let mut found = Vec::new();
    keys(&schema, &mut found);
    assert!(found.len() > 120, "{}", found.len());
    for key in ["smooth_union", "von_mises", "yield_stress", "b2b1", "outlet", "tolerance"] {
        assert!(found.iter().any(|other| other == key), "the schema lost {key}");
    }
    let written =
        std::fs::read_to_string(root().join("docs/scene.schema.json")).expect("docs/scene.schema.json exists");
    assert_eq!(
        written.trim_end(),
        crate::scene::schema().trim_end(),
        "write it again: brisance schema > docs/scene.schema.json"
    );
    let missing = found.iter().filter(|key| !text.contains(&format!("`{key}`"))).collect::<Vec<_>>();
    assert!(missing.is_empty(), "docs/scenes does not mention {missing:?}");
}

/// Defaults and limits stand in the types; rows of the page about time and numerics say the same.
#[test]
fn the_page_of_numerics_has_the_defaults_and_limits_of_the_types() {
    let page = std::fs::read_to_string(root().join("docs/scenes/numerics.md")).expect("a page");
    let schema = crate::scene::check::limits::schema();
    for (heading, table) in
        [("time", "Time"), ("numerics", "Numerics"), ("numerics.paper", "Paper"), ("numerics.expert", "Expert")]
    {
        let (_, part) = page.split_once(&format!("\n## `{heading}`\n")).unwrap_or_else(|| panic!("no {heading}"));
        let part = part.split("\n## ").next().unwrap_or_default();
        for (key, own) in schema["$defs"][table]["properties"].as_object().expect("a table") {
            let row = part.lines().find_map(|line| line.strip_prefix(&format!("| `{key}` | ")));
            let cells: Vec<&str> = row.unwrap_or_else(|| panic!("no row of {heading}.{key}")).split(" | ").collect();
            if let Some(limits) = allowed(own) {
                assert_eq!(cells[1], limits, "{heading}.{key}");
            }
            match &own["default"] {
                Value::String(word) => assert_eq!(cells[0], format!("`{word}`"), "{heading}.{key}"),
                Value::Number(number) => assert_eq!(cells[0].parse().ok(), number.as_f64(), "{heading}.{key}"),
                _ => assert!(["none", "required", "|"].contains(&cells[0]), "{heading}.{key}: {}", cells[0]),
            }
        }
    }
}

#[test]
fn the_shock_tube_knows_its_exact_solution() {
    let scene = Scene::load(root().join("scenes/gas/sod.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    let (exact, jump) = scene.riemann().expect("one jump");
    assert!((jump - 0.5).abs() < 1e-12 && (exact.star_pressure - 0.30313018).abs() < 1e-8);
}
