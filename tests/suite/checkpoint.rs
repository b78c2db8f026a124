//! Stop and go on: a state that was saved leads to the same bits, and a run that was stopped to the same files.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use brisance::export::container::{self, Form, Source};
use brisance::gpu::Gpu;
use brisance::scene::{Changes, Scene};
use brisance::simulation::{Saved, SavedArray, Simulation};
use brisance::state::MemoryPlan;

use crate::cli::{SmallRun, brisance, fails, small_run, succeeds};
use crate::common::{contents_below, folder_or_skip, gpu_or_skip};

/// Steps before the state is saved, and behind it.
const STEPS: u64 = 3;

/// Still gas, two solves a step, bodies with fragments, the implicit elastic step. scripts/resume-test does all scenes.
const SCENES: [(&str, Option<&str>, &[&str], u32); 4] = [
    ("gas/sod.toml", None, &[], 64),
    ("gas/sod.toml", None, &["numerics.integrator=ars222"], 64),
    ("paper/fig03_elastic_shell_2d.toml", Some("small"), &[], 32),
    ("paper/fig03_elastic_shell_2d.toml", Some("small"), &["numerics.elasticity=\"implicit\""], 32),
];

/// A run whose end and files are still to be named; the shock comes by its probe.
pub(crate) const SHORT: [&str; 8] = [
    "run",
    "sod",
    "--resolution",
    "64",
    "--no-expect",
    "-q",
    "--set",
    "probes=[{ name = \"right\", position = [0.55] }]",
];

/// Goes on to a number of steps, and settles.
fn advance(simulation: &mut Simulation, steps: u64) {
    let mut records = Vec::new();
    while simulation.step_count() < steps {
        simulation.advance_batch_of(&mut records, (steps - simulation.step_count()) as u32).unwrap();
    }
    simulation.settle(&mut records).unwrap();
}

/// Whether two arrays hold the same. The list of the frontier, a part of `extra`, is in the order in which threads came.
fn same(one: &SavedArray, two: &SavedArray) -> bool {
    let sorted = |array: &SavedArray| {
        let mut words = array.words.clone();
        words.sort_unstable();
        words
    };
    one == two || (one.name == "extra" && two.name == "extra" && sorted(one) == sorted(two))
}

/// Names of the arrays that differ.
fn differing<'a>(one: &'a Saved, two: &Saved) -> Vec<&'a str> {
    assert_eq!((one.time.to_bits(), one.step, &one.host), (two.time.to_bits(), two.step, &two.host));
    assert_eq!(one.arrays.len(), two.arrays.len());
    let pairs = one.arrays.iter().zip(&two.arrays);
    pairs.filter(|(one, two)| !same(one, two)).map(|(one, _)| one.name.as_str()).collect()
}

fn scene(path: &str, variant: Option<&str>, keys: &[&str], cells: u32) -> Scene {
    let changes = variant.map(Changes::variant).unwrap_or_default();
    let changes = keys.iter().fold(changes, |changes, key| changes.set(*key));
    Scene::shipped(path, changes).unwrap().with_resolution(cells).unwrap()
}

/// A state after some steps, and what the same run comes to after as many more.
fn halves(gpu: &Gpu, scene: &Scene) -> (Saved, Saved) {
    let mut simulation = Simulation::new(gpu, scene).unwrap();
    simulation.set_target(scene.time.until).unwrap();
    advance(&mut simulation, STEPS);
    let middle = simulation.save().unwrap();
    advance(&mut simulation, 2 * STEPS);
    (middle, simulation.save().unwrap())
}

#[test]
fn a_saved_state_leads_to_the_same_bits() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (path, variant, keys, cells) in SCENES {
        let scene = scene(path, variant, keys, cells);
        let (middle, end) = halves(&gpu, &scene);
        let plan = MemoryPlan::new(&scene, scene.seed_particles().len());
        let unknown = middle.arrays.iter().map(|array| &array.name).find(|name| !plan.has_array(name));
        assert_eq!(unknown, None, "{path} {keys:?}");
        let mut again = Simulation::new(&gpu, &scene).unwrap();
        again.set_target(scene.time.until).unwrap();
        advance(&mut again, 2); // what is left out of a state must not matter
        again.restore(&middle).unwrap();
        assert_eq!(differing(&middle, &again.save().unwrap()), [""; 0], "{path} {keys:?}");
        advance(&mut again, 2 * STEPS);
        assert_eq!(differing(&end, &again.save().unwrap()), [""; 0], "{path} {keys:?}");
    }
}

/// All files of a run but those that know the clock, in order.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let known = ["report.json", "report.html", "run.json", "written.txt"];
    let all = contents_below(folder).into_iter().filter(|(path, _)| !path.starts_with("checkpoints"));
    all.filter(|(path, _)| !known.iter().any(|name| path.ends_with(name))).collect()
}

fn same_files(one: &Path, two: &Path) {
    let (a, b) = (files(one), files(two));
    let names = |all: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> { all.iter().map(|(path, _)| path.clone()).collect() };
    assert_eq!(names(&a), names(&b));
    for ((path, first), (_, second)) in a.iter().zip(&b) {
        assert!(first == second, "{} differs", path.display());
    }
}

#[test]
fn a_stopped_run_goes_on_to_the_same_files() {
    let Some(place) = folder_or_skip() else { return };
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let given = [&SHORT[..], &["--until", "0.05", "--frames", "4", "--export", "vtk,states"]].concat();
    let every = ["--checkpoint", "3steps", "--keep", "100"];
    succeeds(&[&given[..], &every, &["--out", &text(&whole)]].concat());
    succeeds(&[&given[..], &every, &["--out", &text(&parts)]].concat());
    same_files(&whole, &parts);
    // what a run leaves that was ended at once behind its second checkpoint, with files that are ahead of it
    let mut kept = std::fs::read_dir(parts.join("checkpoints")).unwrap().map(|e| e.unwrap().path()).collect::<Vec<_>>();
    kept.sort();
    assert!(kept.len() >= 4, "{kept:?}");
    kept.iter().skip(2).for_each(|path| std::fs::remove_file(path).unwrap());
    let rows = std::fs::read_to_string(parts.join("diagnostics.csv")).unwrap();
    std::fs::remove_file(parts.join("frames/0004.png")).unwrap();
    succeeds(&["run", "--resume", &text(&parts), "-q"]);
    same_files(&whole, &parts);
    assert_eq!(rows, std::fs::read_to_string(parts.join("diagnostics.csv")).unwrap());

    another_device(&parts);
    same_files(&whole, &parts);
    later_end(&parts, &place.path().join("longer"), &given);
    bad_checkpoints(&parts);
}

/// A checkpoint of another device is gone on from, with a warning.
fn another_device(parts: &Path) {
    let all = checkpoints(parts);
    let (last, before) = (&all[all.len() - 1], &all[all.len() - 2]);
    let kept = std::fs::read(last).unwrap();
    std::fs::remove_file(last).unwrap();
    let state = container::read(before, 1 << 24).unwrap();
    let own = std::fs::read(before).unwrap();
    let scene = state.texts[container::SCENE].clone();
    let source = Source { device: "Abacus (beads, 3000 BC)".to_owned(), scene, ..state.head.source.clone() };
    let texts: Vec<(&str, &str)> = state.texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let texts: Vec<_> = texts.into_iter().filter(|(name, _)| *name != container::SCENE).collect();
    let at = (state.head.time, state.head.step);
    container::write(before, (Form::Full, &source), at, &texts, state.arrays).unwrap();
    let output = brisance(&["run", "--resume", parts.to_str().unwrap(), "-q"]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && told.contains("was made on Abacus (beads, 3000 BC)"), "{told}");
    assert!(told.contains("but not bit for bit"), "{told}");
    // of the same device, in truth
    std::fs::write(before, own).unwrap();
    std::fs::write(last, kept).unwrap();
}

/// A finished run goes on to a later end as if that had been asked for at once.
fn later_end(parts: &Path, longer: &Path, given: &[&str]) {
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    succeeds(&["run", "--resume", &text(parts), "-q", "--until", "0.1"]);
    let end: Vec<&str> = given
        .iter()
        .map(|word| {
            if *word == "0.05" {
                "0.1"
            } else if *word == "4" {
                "8"
            } else {
                word
            }
        })
        .collect();
    succeeds(&[&end[..], &["--out", &text(longer)]].concat());
    for name in ["diagnostics.csv", "frames/0008.png", "fields/0008.vti", "fields.pvd"] {
        assert!(
            std::fs::read(longer.join(name)).unwrap() == std::fs::read(parts.join(name)).unwrap(),
            "{name} differs"
        );
    }
    assert!(fails(2, &["run", "--resume", &text(parts), "--until", "0.107"]).contains("a multiple of it"));
    assert!(fails(2, &["run", "--resume", &text(parts), "--set", "gas.gamma=2"]).contains("--set with --resume"));
}

/// What cannot be gone on from is told.
fn bad_checkpoints(run: &Path) {
    let resume = ["run", "--resume", run.to_str().unwrap(), "-q"];
    let mut all = std::fs::read_dir(run.join("checkpoints")).unwrap().map(|e| e.unwrap().path()).collect::<Vec<_>>();
    all.sort();
    let newest = all.last().unwrap();
    let good = std::fs::read(newest).unwrap();
    std::fs::write(newest, &good[..good.len() / 2]).unwrap();
    let message = fails(6, &resume);
    assert!(message.contains("the file is cut") && message.contains("remove it to go on from"), "{message}");
    let mut damaged = good.clone();
    let at = good.windows(13).position(|window| window == b"conserved.npy").unwrap() + 60;
    damaged[at..at + 8].fill(0xff);
    std::fs::write(newest, &damaged).unwrap();
    let message = fails(6, &resume);
    assert!(message.contains("conserved"), "{message}");
    std::fs::write(newest, &good).unwrap();
    std::fs::write(run.join("diagnostics.csv"), "step,time\n1,2\n").unwrap();
    assert!(fails(6, &resume).contains("not those that the run wrote"));
    let report = std::fs::read_to_string(run.join("report.json")).unwrap();
    let hash = report.split("\"scene_hash\": \"").nth(1).unwrap()[..32].to_owned();
    std::fs::write(run.join("report.json"), report.replace(&hash, &"0".repeat(32))).unwrap();
    assert!(fails(6, &resume).contains("another scene than report.json"));
    std::fs::remove_dir_all(run.join("checkpoints")).unwrap();
    assert!(fails(2, &resume).contains("no checkpoints"));
}

#[test]
fn a_branch_starts_from_a_state_of_another_run() {
    let Some(place) = folder_or_skip() else { return };
    let (run, branch) = (place.path().join("run"), place.path().join("branch"));
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    let given = ["run", "sod", "--resolution", "64", "--until", "0.05", "--frames", "4", "--no-expect", "-q"];
    succeeds(&[&given[..], &["--checkpoint", "t=0.02", "--keep", "9", "--out", &text(&run)]].concat());
    let from = format!("{}@0.03", run.display());
    let changes = ["--set", "render.colormap=inferno", "--set", "time.cfl=0.2", "--until", "0.06", "--frames", "6"];
    succeeds(&[&["run", "--branch", &from, "--no-expect", "-q", "--out", &text(&branch)], &changes[..]].concat());
    let rows = |folder: &Path| std::fs::read_to_string(folder.join("diagnostics.csv")).unwrap();
    let (before, after) = (rows(&run), rows(&branch));
    let shared = before.lines().zip(after.lines()).take_while(|(one, two)| one == two).count();
    assert!(shared > 6 && shared < before.lines().count(), "{shared} rows are shared");
    let time = |row: &str| row.split(',').nth(1).unwrap().parse::<f64>().unwrap();
    assert!(after.lines().skip(1).map(time).is_sorted() && time(after.lines().last().unwrap()) > 0.0599);
    assert!(!branch.join("frames/0001.png").exists() && branch.join("frames/0006.png").exists());
    another_run_stays(&run, &branch);
    let refused = fails(2, &["run", "--branch", &from, "--set", "gas.gamma=1.3"]);
    assert!(refused.contains("gas.gamma") && refused.contains("boundary"), "{refused}");
    for (more, reason) in [
        (&["--resolution", "32"][..], "the state has the cells and bodies of its run"),
        (&["--variant", "small"], "the state has the cells and bodies of its run"),
        (&["--set", "domain.size=[2.0]"], "a state goes on only with the cells, bodies and gas that it has"),
        (&["--set", "numerics.pair=b2b1"], "numerics.tolerance"),
    ] {
        let refused = fails(2, &[&["run", "--branch", &from][..], more].concat());
        assert!(refused.contains(reason), "{more:?}: {refused}");
    }
    assert!(fails(2, &["run", "--branch", &text(&run)]).contains("DIR@TIME"));
    assert!(fails(2, &["run", "--branch", &format!("{}@0.001", run.display())]).contains("it has: "));
}

/// What lies where a branch is to go stays where its checkpoint, or a table, is refused; so does the run that it comes from.
fn another_run_stays(run: &Path, branch: &Path) {
    let [from, out] = [run, branch].map(|path| path.to_str().unwrap().to_owned());
    let before = contents_below(branch);
    let at = format!("{from}@0.03");
    assert!(
        fails(2, &["run", "--branch", &at, "--force", "--out", &from]).contains("the run that this one begins from")
    );
    let table = run.join("diagnostics.csv");
    let rows = std::fs::read(&table).unwrap();
    std::fs::write(&table, "step,time\n1,2\n").unwrap();
    let away = branch.with_file_name("away").join("deep");
    for place in [&out, away.to_str().unwrap()] {
        let refused = fails(6, &["run", "--branch", &at, "--force", "--no-expect", "--out", place]);
        assert!(refused.contains("not those that the run wrote"), "{refused}");
    }
    assert!(!away.parent().unwrap().exists(), "a branch that is refused leaves a folder");
    assert!(contents_below(branch) == before, "a branch that is refused changes what was there");
    std::fs::write(&table, rows).unwrap();
}

/// A branch keeps `[expect]` in force unless it, or the run that it comes from, was changed by hand.
#[test]
fn a_branch_is_held_to_what_is_expected() {
    let Some(SmallRun { scene, out, folder }) = small_run() else { return };
    let (run, branch) = (out.to_str().unwrap().to_owned(), folder.path().join("branch").display().to_string());
    let from = format!("{run}@0.01");
    let again = ["run", "--branch", &from, "-q", "--no-frames", "--force", "--out", &branch];
    let unmet = ["--set", "expect.min_pressure=9.0", "--set", "render.colormap=inferno"];
    let start =
        ["run", &scene, "-q", "--no-frames", "--checkpoint", "1steps", "--keep", "99", "--force", "--out", &run];
    succeeds(&start);
    let told = fails(8, &[&again[..], &unmet].concat());
    assert!(told.contains("does not meet the scene's [expect]: min_pressure"), "{told}");
    let passes = |changes: &[&str]| {
        let output = brisance(&[&again[..], changes].concat()).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{text}");
        text
    };
    assert!(!passes(&[]).contains("not enforced"));
    let moved = passes(&[&unmet[..], &["--set", "gravity=[0.0, -1.0]"]].concat());
    assert!(moved.contains("not enforced, since gravity was changed by hand"), "{moved}");
    succeeds(&[&start[..], &["--resolution", "48"]].concat());
    let coarse = passes(&unmet);
    assert!(coarse.contains("not enforced, since the resolution was changed by hand"), "{coarse}");
}

#[test]
fn an_interrupted_run_leaves_a_checkpoint() {
    if gpu_or_skip().is_none() || cfg!(not(unix)) {
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("run");
    let given = [&SHORT[..], &["--until", "50", "--frames", "2000", "--no-frames", "--out"]].concat();
    let mut child = brisance(&given).arg(&out).spawn().unwrap();
    while !out.join("diagnostics.csv").exists() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let rows = std::fs::read_to_string(out.join("diagnostics.csv")).unwrap().lines().count() - 1;
    assert!(out.join(format!("checkpoints/{rows:08}.npz")).exists(), "of the last step, {rows}");
}

/// Checkpoints of a run, the latest at the end.
fn checkpoints(run: &Path) -> Vec<PathBuf> {
    let all = std::fs::read_dir(run.join("checkpoints")).into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut all: Vec<_> = all.filter(|path| path.extension().is_some_and(|own| own == "npz")).collect();
    all.sort();
    all
}

/// SIGKILL costs an interval at most and never a file; scripts/resume-test --kill does it at any number of random times.
#[test]
fn a_killed_run_loses_an_interval_at_most() {
    let Some(place) = folder_or_skip() else { return };
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let given =
        [&SHORT[..], &["--until", "0.1", "--frames", "8", "--export", "vtk", "--checkpoint", "3steps"]].concat();
    succeeds(&[&given[..], &["--out", whole.to_str().unwrap()]].concat());
    let step = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().parse::<usize>().unwrap();
    let mut before: Vec<PathBuf> = Vec::new();
    for (kill, pause) in [0, 9, 40].into_iter().enumerate() {
        let out = parts.to_str().unwrap();
        let resumed = ["run", "--resume", out, "-q"];
        let words = if kill == 0 { [&given[..], &["--out", out]].concat() } else { resumed.to_vec() };
        let last = checkpoints(&parts).last().map_or(0, step);
        let mut child = brisance(&words).spawn().unwrap();
        while checkpoints(&parts).last().map_or(0, step) == last && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(2));
        }
        std::thread::sleep(Duration::from_millis(pause));
        child.kill().unwrap();
        child.wait().unwrap();
        let left: Vec<PathBuf> = files(&parts).into_iter().map(|(path, _)| path).collect();
        assert!(before.iter().all(|path| left.contains(path)), "kill {kill}: of {before:?} there is {left:?}");
        let kept = checkpoints(&parts);
        kept.iter().for_each(|path| drop(container::read(path, 1 << 20).unwrap()));
        let table = std::fs::read_to_string(parts.join("diagnostics.csv")).unwrap_or_default();
        let (rows, last) = (table.lines().count().saturating_sub(1), kept.last().map_or(0, step));
        assert!(last > 0 && rows <= last + 3, "kill {kill}: {rows} steps in the table, checkpoint {last}");
        // what is written aside at that moment has another name
        before = left.into_iter().filter(|path| !path.to_string_lossy().contains(".tmp")).collect();
    }
    // what a process leaves that is killed while it writes a picture
    std::fs::write(parts.join("frames/.brisance-killed.tmp"), "half").unwrap();
    succeeds(&["run", "--resume", parts.to_str().unwrap(), "-q"]);
    same_files(&whole, &parts);
}
