//! The shipped scenes load.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::{BASE, parse};
use crate::scene::{Boundary, Changes, SMALL, Scene};

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

#[test]
fn the_shock_tube_knows_its_exact_solution() {
    let scene = Scene::load(root().join("scenes/gas/sod.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    let (exact, jump) = scene.riemann().expect("one jump");
    assert!((jump - 0.5).abs() < 1e-12 && (exact.star_pressure - 0.30313018).abs() < 1e-8);
}
