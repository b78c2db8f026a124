//! The program as a user meets it: exit codes, messages, files.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::state::MemoryPlan;

use crate::common::{folder_or_skip, gpu_or_skip, read_png};

pub(crate) fn brisance(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brisance"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

pub(crate) fn run(arguments: &[&str]) -> Output {
    brisance(arguments).output().unwrap()
}

pub(crate) fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub(crate) fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs, checks the exit code, and returns standard error.
pub(crate) fn fails(code: i32, arguments: &[&str]) -> String {
    let output = run(arguments);
    let text = err(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    assert!(!text.contains("panicked") && !text.contains("a bug in brisance"), "{text}");
    text
}

pub(crate) fn succeeds(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", err(&output));
    out(&output)
}

/// Rows of a CSV file as numbers where they are numbers; every row is as long as the header.
pub(crate) fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(text.ends_with('\n'), "{}: the last row is cut", path.display());
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let rows: Vec<Vec<f64>> = lines
        .map(|row| {
            assert_eq!(row.len(), header.len(), "{}", path.display());
            row.iter().map(|entry| entry.parse().unwrap_or(f64::NAN)).collect()
        })
        .collect();
    (header, rows)
}

pub(crate) fn report(folder: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("report.json")).unwrap()).unwrap()
}

#[test]
fn help_and_usage() {
    let help = succeeds(&["--help"]);
    for verb in [
        "run", "render", "gallery", "check", "bench", "verify", "devices", "selftest", "shaders", "list", "schema",
        "init", "show", "completions",
    ] {
        assert!(help.contains(&format!("\n  {verb} ")), "{help}");
    }
    assert!(succeeds(&["--version"]).starts_with("brisance "));
    assert!(fails(2, &[]).contains("Usage:"));
    fails(2, &["run"]);
    fails(2, &["run", "sod", "--frames", "many"]);
    fails(2, &["bench", "sod", "--steps", "0"]);
    assert!(succeeds(&["completions", "bash"]).contains("_brisance"));
    assert!(succeeds(&["man"]).contains(".TH brisance 1"));
}

#[test]
fn list_names_every_scene_file() {
    let list = succeeds(&["list"]);
    let object: serde_json::Value = serde_json::from_str(&succeeds(&["list", "--json"])).unwrap();
    let scenes = object["scenes"].as_array().unwrap();
    for scene in scenes {
        let name = scene["name"].as_str().unwrap();
        assert!(list.lines().any(|line| line.starts_with(name)), "{name}");
        assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene["path"].as_str().unwrap()).is_file());
    }
    assert!(scenes.iter().any(|scene| scene["name"] == "sod"));
    // Away from the sources the scenes inside the program serve.
    let elsewhere = tempfile::tempdir().unwrap();
    let output = brisance(&["list"]).current_dir(elsewhere.path()).output().unwrap();
    assert_eq!(out(&output), list);
}

#[test]
fn schema_is_json() {
    let schema: serde_json::Value = serde_json::from_str(&succeeds(&["schema"])).unwrap();
    assert!(schema["properties"]["domain"].is_object() && schema["properties"]["gas"].is_object());
}

#[test]
fn check_prints_what_a_run_would_use() {
    let text = succeeds(&["check", "bursting_shell_3d"]);
    assert!(text.contains("# cells      32 x 32 x 32 = 32768"), "{text}");
    assert!(text.contains("bytes per cell") && text.contains("solid_threshold = 0.5"), "{text}");
    // What is printed is a scene again, and the same one.
    let folder = tempfile::tempdir().unwrap();
    let copy = folder.path().join("copy.toml");
    std::fs::write(&copy, &text).unwrap();
    // how fast the device is differs from time to time
    let lasting = |text: &str| text.lines().filter(|line| !line.starts_with("# time ")).collect::<Vec<_>>().join("\n");
    assert_eq!(lasting(&succeeds(&["check", copy.to_str().unwrap()])), lasting(&text));
    assert_eq!(text.contains("# time       very roughly "), gpu_or_skip().is_some(), "{text}");
    let nowhere = brisance(&["check", "sod"]).env("BRISANCE_DEVICE", "abacus").output().unwrap();
    assert!(out(&nowhere).contains("# time       not estimated: no device"), "a check needs none");

    let object = succeeds(&["check", "sod", "--resolution", "100", "--set", "time.until=0.1", "--json"]);
    let object: serde_json::Value = serde_json::from_str(&object).unwrap();
    assert_eq!(object["cells"], 100);
    assert_eq!(object["scene"]["time"]["until"], 0.1);
    assert_eq!(object["scene"]["numerics"]["pair"], "b1b0");
}

#[test]
fn variants_are_listed_and_chosen() {
    let list = succeeds(&["list"]);
    assert!(
        list.lines().any(|line| line.starts_with("fig04_trucks ") && line.ends_with("[small, strong, weak]")),
        "{list}"
    );
    let check = |options: &[&str]| {
        let arguments = [&["check", "fig04_trucks", "--json"], options].concat();
        serde_json::from_str::<serde_json::Value>(&succeeds(&arguments)).unwrap()
    };
    let small = check(&["--variant", "small", "--variant", "weak", "--set", "time.frames=3"]);
    assert_eq!(small["cells"], 48 * 24 * 24);
    assert_eq!(small["scene"]["materials"]["truck"]["von_mises"]["yield_stress"], 5.2e5);
    assert_eq!(small["scene"]["time"]["frames"], 3);
    let text = fails(3, &["check", "fig04_trucks", "--variant", "medium"]);
    assert!(text.contains("no variant `medium`") && text.contains("`strong`"), "{text}");
}

#[test]
fn check_draws_the_start_and_names_overlaps() {
    let Some(folder) = folder_or_skip() else { return };
    let picture = folder.path().join("start.png");
    let overlap = "bodies[2].shape={ sphere = { center = [1.0, 0.4], radius = 0.1 } }";
    let arguments = ["check", "fig08_supernova_2d", "--set", overlap, "--picture", picture.to_str().unwrap()];
    let output = run(&arguments);
    assert!(
        out(&output).contains("# overlap    `outer` gives ") && out(&output).contains("to `middle`"),
        "{}",
        out(&output)
    );
    let (info, _) = read_png(&picture);
    assert_eq!((info.width, info.height), (1200, 520));
}

#[test]
fn mistakes_in_scenes_are_named() {
    let text = fails(3, &["run", "nowhere.toml"]);
    assert!(text.starts_with("error: no file `nowhere.toml`") && text.contains("brisance list"), "{text}");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wrong.toml");
    let sod = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gas/sod.toml")).unwrap();
    std::fs::write(&path, sod.replace("until = 0.15", "untl = 0.15")).unwrap();
    let line = sod.lines().position(|line| line.contains("until = 0.15")).unwrap() + 1;
    let text = fails(3, &["check", path.to_str().unwrap()]);
    assert!(text.contains("untl") && text.contains(&format!("wrong.toml:{line}:")), "{text}");
    assert_eq!(text.matches("unknown field").count(), 1, "printed once: {text}");

    assert!(fails(3, &["check", "sod", "--set", "gas.ambient.density=-1"]).contains("gas.ambient.density"));
    assert!(fails(3, &["check", "sod", "--set", "gas.ambient"]).contains("--set"));
    assert!(fails(3, &["check", "sod", "--set", "gas.colour=1"]).contains("colour"));
    assert!(fails(3, &["run", "sod", "--until", "-1"]).contains("time.until"));

    let output = run(&["check", "sod", "--set", "gas.gamma=0.5", "--json"]);
    let object: serde_json::Value = serde_json::from_str(&out(&output)).unwrap();
    assert_eq!((&object["error"]["code"], &object["error"]["kind"]), (&3.into(), &"scene".into()));
}

#[test]
fn devices() {
    let Some(_) = gpu_or_skip() else { return };
    assert!(succeeds(&["devices"]).starts_with("0: "));
    let text = fails(4, &["run", "sod", "--device", "abacus"]);
    assert!(text.contains("no device matches `abacus`; there are\n  0: "), "{text}");
}

#[test]
fn too_large_scenes_are_refused_before_allocation() {
    let Some(folder) = folder_or_skip() else { return };
    let out = folder.path().to_str().unwrap();
    let text = fails(5, &["run", "bursting_shell_3d", "--resolution", "900", "--out", out]);
    let advice = text.split("--resolution ").nth(1).unwrap_or_else(|| panic!("{text}"));
    let fitting = advice.split(' ').next().unwrap();
    assert!(fitting.parse::<u32>().unwrap() < 900, "{text}");
    assert!(fails(5, &["check", "bursting_shell_3d", "--resolution", "1200"]).contains("particles, about"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
    fails(2, &["run", "sod", "--export", "gif", "--out", out]);
}

#[test]
fn the_memory_plan_is_what_is_allocated() {
    for (name, cells, per_cell) in
        [("sod", 400, 152.0), ("fig16_convergence", 96, 162.0), ("bursting_shell_3d", 36, 233.0)]
    {
        let Some(gpu) = gpu_or_skip() else { return };
        let shipped = succeeds(&["list", "--json"]);
        let shipped: serde_json::Value = serde_json::from_str(&shipped).unwrap();
        let entry = shipped["scenes"].as_array().unwrap().iter().find(|scene| scene["name"] == name).unwrap();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(entry["path"].as_str().unwrap());
        let scene = Scene::load(path, &[]).unwrap().with_resolution(cells).unwrap();
        let plan = MemoryPlan::new(&scene, scene.seed_particles().len());
        let simulation = Simulation::new(&gpu, &scene).unwrap();
        assert_eq!(plan.bytes(None), gpu.allocated_bytes(), "{name}");
        assert!(plan.per_cell() < per_cell, "{name}: {}", plan.per_cell());
        assert!(plan.per_particle() <= 200.0, "{name}: {}", plan.per_particle());
        drop(simulation);
    }
    let large = Scene::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/demos/bursting_shell_3d.toml"), &[]);
    let large = large.unwrap().with_resolution(128).unwrap();
    let plan = MemoryPlan::new(&large, large.seed_particles().len());
    assert!(plan.per_cell() <= 207.0, "{}", plan.per_cell());
    let gas = Scene::shipped("paper/fig16_convergence.toml", &[]).unwrap().with_resolution(512).unwrap();
    let plan = MemoryPlan::new(&gas, 0);
    assert!(plan.per_cell() <= 134.0, "{}", plan.per_cell());
}

#[test]
#[cfg(unix)]
fn a_closed_pipe_is_no_bug() {
    let mut child = brisance(&["schema"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(err(&output), "");
}

#[test]
fn a_folder_that_cannot_be_written_is_a_disk_error() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("file");
    std::fs::write(&file, "not a folder").unwrap();
    let text = fails(9, &["run", "sod", "--out", file.join("out").to_str().unwrap()]);
    assert!(text.contains("file/out"), "{text}");
}

/// A small scene with a body and a probe.
pub(crate) fn write_small_scene(path: &Path) {
    let text = r#"
title = "Small"
domain = { dimension = 2, cells = [24, 12], size = [2.0, 1.0] }
time = { until = 0.02, frames = 2 }
materials.rubber.neo_hookean = { young_modulus = 100.0, poisson_ratio = 0.3 }
output = { fields = ["density", "pressure"], vtk = true }
render = { size = [64, 48] }
probes = [{ name = "left", position = [0.3, 0.5] }]
[gas]
ambient = { density = 1.0, pressure = 1.0 }
regions = [{ shape = { box = { center = [0.25, 0.5], size = [0.5, 1.0] } }, density = 2.0, pressure = 2.0 }]
[[bodies]]
name = "block"
shape = { box = { center = [1.25, 0.5], size = [0.5, 0.5] } }
material = "rubber"
density = 5.0
[expect]
min_pressure = 0.0
pieces = 1
"#;
    std::fs::write(path, text).unwrap();
}

/// The small scene in a folder of its own, and where a run of it goes.
pub(crate) struct SmallRun {
    /// The scene's file.
    pub(crate) scene: String,
    /// A folder that is not there yet.
    pub(crate) out: PathBuf,
    /// Holds both for as long as it lives.
    pub(crate) folder: tempfile::TempDir,
}

/// Writes the small scene; nothing where a machine without a device skips what needs one.
pub(crate) fn small_run() -> Option<SmallRun> {
    gpu_or_skip()?;
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("small.toml");
    write_small_scene(&scene);
    Some(SmallRun { scene: scene.display().to_string(), out: folder.path().join("result"), folder })
}

#[test]
fn a_run_leaves_its_files() {
    let Some(SmallRun { scene, out: target, folder: _folder }) = small_run() else { return };
    let printed = succeeds(&["run", &scene, "--out", target.to_str().unwrap()]);
    assert!(printed.contains("ok   pieces"), "{printed}");
    for name in ["frames/0000.png", "frames/0002.png", "frames/pressure/0001.png", "fields/0002.vti", "particles.pvd"] {
        assert!(target.join(name).is_file(), "{name}");
    }
    let (header, steps) = table(&target.join("diagnostics.csv"));
    let column = |name: &str| header.iter().position(|own| own == name).unwrap_or_else(|| panic!("{name}"));
    assert!(steps.iter().enumerate().all(|(index, row)| row[0] == (index + 1) as f64), "every step once");
    let time: f64 = steps.iter().map(|row| row[column("dt")]).sum();
    assert!((time - 0.02).abs() < 1e-6, "{time}");
    assert!(steps.iter().all(|row| row[column("pcg_residual")] <= 1e-5 && row[column("min_density")] > 0.0));

    let text = std::fs::read_to_string(target.join("bodies.csv")).unwrap();
    assert_eq!(text.lines().filter(|line| line.contains(",block,")).count(), 3, "{text}");
    let (probes, rows) = table(&target.join("probes.csv"));
    assert_eq!(probes[..3], ["step", "time", "left_density"]);
    assert_eq!(rows.len(), steps.len());

    let report = report(&target);
    // the wave so far, which at the end is that of the report
    let (last, gauge) = (rows.last().unwrap(), &report["gauges"]["left"]);
    let of = |name: &str| last[probes.iter().position(|own| *own == format!("left_{name}")).unwrap()];
    let pressure = of("pressure") - gauge["first"].as_f64().unwrap();
    assert!(of("overpressure") == pressure && of("impulse") == gauge["impulse"].as_f64().unwrap(), "{gauge}");
    assert!(printed.contains("overpressure [Pa]") && printed.contains("  left  "), "{printed}");
    assert_eq!(report["outcome"], "finished");
    assert_eq!((&report["frames"], &report["steps"]), (&3.into(), &(steps.len() as u64).into()));
    assert_eq!(report["scene"]["numerics"]["expert"]["max_iterations"], 500);
    assert!(report["drift"]["gas_mass"].as_f64().unwrap().abs() < 1e-5, "{}", report["drift"]);
    assert!(
        !std::fs::read_dir(&target).unwrap().any(|entry| entry.unwrap().path().extension().is_some_and(|e| e == "tmp"))
    );
}

/// The software driver takes workgroups in turn, as the suite does elsewhere, or on threads of its own; two that write one place show.
#[test]
fn threads_of_the_driver_change_no_bit() {
    let Some(folder) = folder_or_skip() else { return };
    for scene in [
        &["bursting_diaphragm_2d", "--until", "0.01"][..],
        &["fig16_convergence", "--resolution", "160", "--until", "0.04"],
    ] {
        let [alone, threads] = ["0", "2"].map(|threads| {
            let target = folder.path().join(scene[0]).join(threads);
            let mut run =
                brisance(&["run", "--no-frames", "--no-expect", "--quiet", "--out", target.to_str().unwrap()]);
            assert!(run.args(scene).env("LP_NUM_THREADS", threads).status().unwrap().success(), "{scene:?}");
            std::fs::read_to_string(target.join("diagnostics.csv")).unwrap()
        });
        assert!(alone.lines().count() > 20, "{scene:?}: {alone}");
        assert_eq!(alone, threads, "{scene:?}");
    }
}

#[test]
fn failed_expectations_have_their_own_exit_code() {
    let Some(SmallRun { scene, out: target, folder: _folder }) = small_run() else { return };
    let short = [
        "--set",
        "expect.min_pressure=1.5",
        "--until",
        "0.005",
        "--no-frames",
        "--force",
        "--out",
        target.to_str().unwrap(),
    ];
    let arguments = [&["run", &scene], &short[..]].concat();
    // what was changed by hand is another experiment
    assert!(err(&run(&arguments)).contains("not enforced, since the end was changed"));
    let text = fails(8, &[&arguments[..], &["--expect"]].concat());
    assert!(text.contains("[expect]: min_pressure"), "{text}");
    assert!(!target.join("frames").exists());
    assert_eq!(report(&target)["expect"][0]["passed"], false);
    let object = succeeds(&[&arguments[..], &["--no-expect", "--json"]].concat());
    assert_eq!(serde_json::from_str::<serde_json::Value>(&object).unwrap()["outcome"], "finished");
}
