//! Shipped scenes against their own `[expect]`.

use std::path::Path;

use brisance::expect;
use brisance::scene::Scene;

use crate::common::gpu_or_skip;

/// Runs a shipped scene and demands that it has expectations and meets them.
fn meets_its_expectations(path: &str, overrides: &[&str]) {
    let Some(gpu) = gpu_or_skip() else { return };
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let scene = Scene::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(path), &overrides).unwrap();
    let checks = expect::run(&gpu, &scene).unwrap_or_else(|error| panic!("{path}: {error}"));
    let lines: Vec<String> = checks.iter().map(ToString::to_string).collect();
    eprintln!("{path}\n{}", lines.join("\n"));
    assert!(!checks.is_empty(), "{path}: an empty [expect] tests nothing");
    assert!(checks.iter().all(|check| check.passed), "{path}\n{}", lines.join("\n"));
}

macro_rules! scenes {
    ($($(#[$attribute:meta])* $name:ident: $path:literal $(, $set:literal)*;)*) => {
        $(#[test] $(#[$attribute])* fn $name() { meets_its_expectations($path, &[$($set),*]); })*

        /// Files that a test above runs.
        const TESTED: &[&str] = &[$($path),*];
    };
}

scenes! {
    sod: "gas/sod.toml";
    lax: "gas/lax.toml";
    mach3: "gas/mach3.toml";
    high_mach: "gas/high_mach.toml";
    strong_shock_tube: "gas/strong_shock_tube.toml";
    rarefactions: "gas/rarefactions.toml";
    blast: "gas/blast.toml";
    circular_shock: "gas/circular_shock.toml";
    modified_sod: "validation/modified_sod.toml";
    stationary_contact: "validation/stationary_contact.toml";
    shu_osher: "validation/shu_osher.toml";
    shock_reflection: "validation/shock_reflection.toml";
    noh_planar: "validation/noh_planar.toml";
    sedov_planar: "validation/sedov_planar.toml";
    acoustic_wave: "validation/acoustic_wave.toml";
    density_wave: "validation/density_wave.toml";
    sedov_cylindrical: "validation/sedov_cylindrical.toml";
    piston: "coupled/piston.toml";
    slab_at_rest: "coupled/slab_at_rest.toml";
    shell_at_rest: "coupled/shell_at_rest.toml";
    #[ignore = "minutes on a software device"]
    bursting_shell_2d: "coupled/bursting_shell_2d.toml";
    #[ignore = "minutes on a software device"]
    bursting_shell_3d: "demos/bursting_shell_3d.toml";
    ball_in_blast_3d: "demos/ball_in_blast_3d.toml", "domain.cells=[12, 12, 12]", "time.until=0.1";
}

fn scene_files(folder: &Path, below: &str, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = format!("{below}{}", path.file_name().unwrap().to_string_lossy());
        if path.is_dir() {
            scene_files(&path, &format!("{name}/"), found);
        } else if name.ends_with(".toml") {
            found.push(name);
        }
    }
}

#[test]
fn every_scene_is_tested() {
    let mut found = Vec::new();
    scene_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"), "", &mut found);
    found.sort();
    let mut tested = TESTED.to_vec();
    tested.sort_unstable();
    assert_eq!(found, tested, "tests/suite/scenes.rs lists every scene");
}
