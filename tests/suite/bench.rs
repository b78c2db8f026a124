//! The bench: its yardstick, comparison with an earlier measurement, sizes, and what it refuses.

use std::collections::BTreeSet;

use brisance::gpu::{Detail, Gpu};
use brisance::numerics::{Rounds, copy_bandwidth};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::state::stages::Stage;
use serde_json::Value;

use crate::cli::{fails, succeeds};
use crate::common::{folder_or_skip, gpu_or_skip};

const SHORT: &[&str] = &["bench", "sod", "--steps", "3", "--warmup", "1"];

fn bench(more: &[&str]) -> String {
    succeeds(&[SHORT, more].concat())
}

#[test]
fn a_copy_is_faster_than_a_disk_and_slower_than_light() {
    let Some(gpu) = gpu_or_skip() else { return };
    let speed = copy_bandwidth(&gpu, Rounds::FEW).unwrap();
    assert!(speed > 0.2 && speed < 5e4, "{speed} GB/s");
}

#[test]
fn an_earlier_measurement_stands_beside_a_new_one() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("before.json");
    let name = file.to_str().unwrap();
    let json = bench(&["--json"]);
    let measured: Value = serde_json::from_str(&json).unwrap();
    let copy = measured["copy_gigabytes_per_second"].as_f64().unwrap();
    for row in measured["stages"].as_array().unwrap() {
        let share = row["gigabytes_per_second"].as_f64().unwrap() / copy;
        assert!((share - row["share_of_copy"].as_f64().unwrap()).abs() < 1e-6, "{row}");
    }
    assert!(measured["mass_drift"].as_f64().unwrap() < 1e-6);
    // a thousand times slower then
    let slow = measured["milliseconds_per_step"].as_f64().unwrap() * 1e3;
    let mut before = measured.clone();
    before["milliseconds_per_step"] = slow.into();
    std::fs::write(&file, before.to_string()).unwrap();
    let text = bench(&["--compare", name]);
    let line = text.lines().find(|line| line.starts_with("milliseconds per step")).unwrap();
    let ratio: f64 = line.split_whitespace().last().unwrap().parse().unwrap();
    assert!(ratio < 0.1, "{line}");
    assert!(text.contains("now/before") && !text.contains("another measurement"), "{text}");
    before["cells"] = 7.into();
    std::fs::write(&file, before.to_string()).unwrap();
    assert!(bench(&["--compare", name]).contains("another measurement"));
    std::fs::write(&file, "{}").unwrap();
    let error = fails(2, &[SHORT, &["--compare", name]].concat());
    assert!(error.contains("before.json") && error.contains("--json"), "{error}");
    fails(9, &[SHORT, &["--compare", "/nowhere/before.json"]].concat());
}

#[test]
fn sizes_stand_one_below_the_other() {
    let Some(_) = gpu_or_skip() else { return };
    let json = bench(&["--sweep", "50,100", "--json"]);
    let sizes: Value = serde_json::from_str(&json).unwrap();
    let cells: Vec<u64> = sizes.as_array().unwrap().iter().map(|m| m["cells"].as_u64().unwrap()).collect();
    assert_eq!(cells, [50, 100]);
    assert_eq!(bench(&["--sweep", "50,100"]).lines().count(), 5);
}

/// Stages or kernels of the first step of a scene that is shipped.
fn names(gpu: &Gpu, scene: &str, overrides: &[&str], detail: Detail) -> BTreeSet<String> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let scene = Scene::shipped(scene, &overrides).unwrap();
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    simulation.set_target(1e30).unwrap();
    let (mut records, mut names) = (Vec::new(), BTreeSet::new());
    while records.is_empty() {
        let (_, times) = simulation.advance_timed(&mut records, detail).unwrap();
        assert!(times.iter().all(|(_, time)| time.is_finite() && (*time > 0.0 || gpu.timestamps)), "{times:?}");
        names.extend(times.into_iter().map(|(name, _)| name));
    }
    names
}

/// A piston in few cells, with few sub-steps.
const PISTON: (&str, &[&str]) =
    ("coupled/piston.toml", &["domain.cells=[100]", "materials.stiff.neo_hookean.young_modulus=100.0"]);

/// In gas alone an iteration sweeps over all vertices twice: operator with its dots, and all vectors at once.
#[test]
fn an_iteration_in_gas_alone_has_two_kernels() {
    let Some(gpu) = gpu_or_skip() else { return };
    let of = |(scene, overrides): (&str, &[&str])| names(&gpu, scene, overrides, Detail::Kernels);
    let (gas, bodies) = (of(("gas/sod.toml", &["domain.cells=[100]"])), of(PISTON));
    let has = |names: &BTreeSet<String>, kernel: &str| names.iter().any(|name| name.contains(kernel));
    assert!(has(&gas, "pcg_step") && !has(&gas, "pcg_update") && !has(&gas, "pcg_direction"), "{gas:?}");
    assert!(has(&bodies, "pcg_update") && has(&bodies, "pcg_direction") && !has(&bodies, "pcg_step"), "{bodies:?}");
}

/// Without timestamps every stage is submitted alone and waited for; stages and kernels are those of the timestamps.
#[test]
fn a_device_without_timestamps_waits_for_each_stage() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut blind = gpu.clone();
    blind.timestamps = false;
    for detail in [Detail::Stages, Detail::Kernels] {
        let [stamped, waited] = [&gpu, &blind].map(|gpu| names(gpu, PISTON.0, PISTON.1, detail));
        for name in &stamped {
            let stage = name.split(':').next().unwrap_or_default();
            let listed =
                Stage::ALL.iter().map(|stage| stage.name()).chain(["steps", "rest"]).any(|known| known == stage);
            assert!(listed, "{name} is of no stage in src/state/stages.rs");
        }
        let missing: Vec<&String> = stamped.difference(&waited).collect();
        assert!(stamped.len() > 5 && missing.is_empty(), "{missing:?} in {waited:?}");
    }
}
