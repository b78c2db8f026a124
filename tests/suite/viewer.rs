//! The live window without a window: its session draws what `run` draws, its worker does what it is asked for.

use std::time::{Duration, Instant};

use brisance::export::Origin;
use brisance::gpu::GpuOptions;
use brisance::render::{Renderer, SceneBuffers};
use brisance::scene::{Changes, Field, Scene};
use brisance::simulation::Simulation;
use brisance::viewer::model::{Answer, Command, Look, Outbox, Pace, Phase, Request, Shown, Source, Strike, Weight};
use brisance::viewer::record;
use brisance::viewer::session::Session;
use brisance::viewer::worker::Worker;

use crate::common::{folder_or_skip, gpu_or_skip, read_png};

pub(crate) const SPACE: &str = "title = \"Charge in a box\"\n\
    domain = { dimension = 3, cells = [12, 12, 12], size = [1.0, 1.0, 1.0] }\n\
    gas.ambient = { density = 1.0, pressure = 1.0 }\n\
    gas.regions = [{ shape = { sphere = { center = [0.3, 0.5, 0.5], radius = 0.2 } }, density = 3.0, pressure = 8.0 }]\n\
    time = { until = 0.4, frames = 1 }\n\
    output.fields = [\"pressure\"]\n\
    [materials.jelly]\nneo_hookean = { young_modulus = 20.0, poisson_ratio = 0.3 }\n\
    [[bodies]]\nname = \"lump\"\nshape = { sphere = { center = [0.7, 0.5, 0.5], radius = 0.15 } }\nmaterial = \"jelly\"\ndensity = 10.0\n";

#[test]
fn live_pictures_are_those_of_a_run_byte_by_byte() {
    let Some(gpu) = gpu_or_skip() else { return };
    let plane = "dimension = 2, cells = [24, 16], size = [1.5, 1.0]";
    let plane = SPACE
        .replace("dimension = 3, cells = [12, 12, 12], size = [1.0, 1.0, 1.0]", plane)
        .replace(", 0.5, 0.5]", ", 0.5]");
    for text in [SPACE, &plane] {
        let scene = Scene::parse(text, "charge.toml", &["render.size=[200,150]".to_owned()]).unwrap();
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let mut renderer = Renderer::new(&gpu, &scene, &SceneBuffers::of(&simulation.state)).unwrap();
        let mut session = Session::open(&gpu, scene.clone()).unwrap();
        let look = session.look();
        simulation.set_target(scene.time.until).unwrap();
        let mut records = (Vec::new(), Vec::new());
        for steps in [3, 1, 2] {
            simulation.advance_batch_of(&mut records.0, steps).unwrap();
            session.advance(steps, &mut records.1).unwrap();
            // other looks in between leave no trace
            let other = Look {
                field: Field::Mach,
                settings: brisance::scene::RenderSettings { size: [64, 48], ..look.settings.clone() },
            };
            session.draw(&other).unwrap();
            let (run, live) = (renderer.render(simulation.time()).unwrap(), session.draw(&look).unwrap());
            assert_eq!(session.time().to_bits(), simulation.time().to_bits());
            assert!(run[0] == live, "step {}", session.step_count());
        }
        assert_eq!(records.0, records.1);
    }
}

/// From a state that is kept, a scene goes on as it did, to the bit; with other gravity it goes another way.
#[test]
fn a_scene_goes_back_and_on_again() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = Scene::parse(SPACE, "charge.toml", &["render.size=[64,48]".to_owned()]).unwrap();
    let mut session = Session::open(&gpu, scene.clone()).unwrap();
    let mut records = Vec::new();
    while session.kept().len() < 4 {
        session.advance(1, &mut records).unwrap();
    }
    let (kept, last) = (session.kept(), session.time());
    assert_eq!(kept[0], 0.0);
    let back = session.rewind(0.5 * (kept[2] + last)).unwrap();
    assert_eq!((back, session.time(), session.kept().len()), (kept[2], kept[2], 4));
    let from = records.iter().position(|record| record.time > back).unwrap();
    let mut again = Vec::new();
    while again.len() < records.len() - from {
        session.advance(1, &mut again).unwrap();
    }
    assert!(again == records[from..], "the same steps again");
    assert_eq!(session.rewind(0.0).unwrap(), 0.0);
    let mut other = scene;
    other.gravity = [0.0, 0.0, -5.0];
    session.change(other, &mut Vec::new()).unwrap();
    let mut down = Vec::new();
    session.advance(1, &mut down).unwrap();
    session.advance(1, &mut down).unwrap();
    assert!(down[0].step == 1 && down[1].gas.momentum[2] < records[1].gas.momentum[2], "{:?}", down[1].gas);
    assert!(session.kept().iter().all(|time| *time <= session.time()), "what came later is gone");
}

/// A run on the disk opens at its last checkpoint, goes back to an earlier one, and on from there.
#[test]
fn a_run_on_the_disk_is_looked_at_and_goes_on() {
    let Some(gpu) = gpu_or_skip() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (file, run) = (folder.path().join("charge.toml"), folder.path().join("run"));
    std::fs::write(&file, SPACE).unwrap();
    let out = run.to_str().unwrap();
    let every = ["--checkpoint", "3steps", "--keep", "9", "--no-frames", "-q", "--no-expect", "--out", out];
    crate::cli::succeeds(&[&["run", file.to_str().unwrap(), "--until", "0.2"][..], &every].concat());
    let mut session = Session::open_run(&gpu, &run, &Changes::default()).unwrap();
    assert!((session.time() - 0.2).abs() < 1e-7 && session.kept().len() > 2, "{:?}", session.kept());
    let first = session.kept()[0];
    assert_eq!(session.rewind(first).unwrap(), first);
    assert_eq!(session.step_count(), 3);
    let mut records = Vec::new();
    session.advance(1, &mut records).unwrap();
    let (_, rows) = crate::cli::table(&run.join("diagnostics.csv"));
    assert_eq!((f64::from(records[0].step), records[0].time), (rows[3][0], rows[3][1]));
    let mut request = Request::of(out);
    request.resolution = Some(20);
    assert!(request.load().unwrap_err().to_string().contains("the cells and bodies of its run"));
    std::fs::remove_dir_all(run.join("checkpoints")).unwrap();
    assert!(Session::open_run(&gpu, &run, &Changes::default()).unwrap_err().to_string().contains("--checkpoint"));
}

/// With other parameters a run goes on from any of its checkpoints as a branch of it does, to the bit: asked for when it is opened, or in the
/// window behind that.
#[test]
fn a_run_on_the_disk_goes_on_another_way() {
    let Some(gpu) = gpu_or_skip() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [file, run, branch] = ["charge.toml", "run", "branch"].map(|name| folder.path().join(name));
    std::fs::write(&file, SPACE).unwrap();
    let [file, out, other] = [&file, &run, &branch].map(|path| path.to_str().unwrap());
    let quiet = ["--no-frames", "-q", "--no-expect", "--checkpoint", "3steps", "--keep", "9", "--out"];
    crate::cli::succeeds(&[&["run", file, "--until", "0.2"], &quiet[..], &[out]].concat());
    let down = ["--set", "gravity=[0.0, 0.0, -5.0]", "--set", "time.max_courant=0.4"];
    let changes = Changes::default().set(down[1]).set(down[3]);
    let mut asked = Session::open_run(&gpu, &run, &changes).unwrap();
    let mut moved = Session::open_run(&gpu, &run, &Changes::default()).unwrap();
    // what lies behind a state is forgotten where the scene goes on from it
    for place in [1, 0] {
        let from = asked.kept()[place];
        let at = format!("{out}@{from}");
        crate::cli::succeeds(&[&["run", "--branch", &at, "--force"], &down[..], &quiet, &[other]].concat());
        let (_, rows) = crate::cli::table(&branch.join("diagnostics.csv"));
        let rows = &rows[rows.iter().position(|row| row[1] > from).unwrap()..];
        moved.rewind(from).unwrap();
        moved.change((**asked.scene()).clone(), &mut Vec::new()).unwrap();
        asked.rewind(from).unwrap();
        for session in [&mut asked, &mut moved] {
            let mut records = Vec::new();
            session.advance(2, &mut records).unwrap();
            let seen: Vec<_> = records.iter().map(|own| (own.step, own.time, own.gas.momentum[2])).collect();
            let rows = &rows[..seen.len()];
            let expected: Vec<_> = rows.iter().map(|row| (row[0] as u32, row[1], row[6] as f32)).collect();
            assert_eq!(seen, expected, "from {from} s");
            assert!(!session.finished() && seen[0].0 == 3 * (place as u32 + 1) + 1);
        }
    }
    let refused = crate::cli::fails(2, &["view", out, "--set", "gas.gamma=1.3"]);
    assert!(refused.contains("gas.gamma") && refused.contains("what may change is probes"), "{refused}");
}

/// States of frames are looked at, and played; from there the scene goes on from the last checkpoint, or from its start.
#[test]
fn states_of_frames_are_shown_and_the_scene_goes_on_before_them() {
    let Some(gpu) = gpu_or_skip() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("charge.toml");
    std::fs::write(&file, SPACE).unwrap();
    let run = folder.path().join("run");
    let out = run.to_str().unwrap();
    let kept = ["--export", "fields", "--frames", "4", "--checkpoint", "off", "-q", "--no-expect", "--out", out];
    crate::cli::succeeds(&[&["run", file.to_str().unwrap(), "--until", "0.2"][..], &kept].concat());
    let mut session = Session::open_run(&gpu, &run, &Changes::default()).unwrap();
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    assert!(near(session.time(), 0.2) && session.kept().len() == 6, "{:?}", session.kept());
    let look = session.look();
    assert!(near(session.rewind(0.1).unwrap(), 0.1) && session.step_count() > 0);
    // the picture of the run to the byte
    let drawn = session.draw(&look).unwrap();
    let (info, bytes) = read_png(&run.join("frames/0002.png"));
    let channels = info.color_type.samples();
    let same = drawn.frame.rgba.chunks_exact(4).zip(bytes.chunks_exact(channels)).all(|(a, b)| a[..3] == b[..3]);
    assert!(same, "the picture of the run");
    let mut records = Vec::new();
    session.advance(1, &mut records).unwrap();
    let (_, rows) = crate::cli::table(&run.join("diagnostics.csv"));
    assert_eq!((f64::from(records[0].step), records[0].time), (rows[0][0], rows[0][1]), "from the start");
    // the window plays what is there, each state once, and simulates nothing
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    worker.send(Command::Pace(Pace::Fastest));
    worker.send(Command::Open(Request::of(out), None));
    wait(&worker, &mut seen, "run", |seen| seen.opened.is_some() && seen.shown.is_some());
    assert!(near(seen.status.time, 0.2) && seen.status.replay, "{:?}", seen.status);
    let begun = Instant::now();
    worker.send(Command::Play(true));
    wait(&worker, &mut seen, "first state", |seen| seen.status.playing && seen.status.time < 0.1);
    wait(&worker, &mut seen, "last state", |seen| !seen.status.playing && near(seen.status.time, 0.2));
    assert!(begun.elapsed() > Duration::from_secs_f64(4.0 / 25.0), "as fast as a film: {:?}", begun.elapsed());
    assert!(seen.records.is_empty() && seen.notes.is_empty(), "{:?}", seen.notes);
    worker.send(Command::Rewind(0.1));
    worker.send(Command::Play(true));
    worker.send(Command::Play(false));
    wait(&worker, &mut seen, "way back", |seen| seen.rewound.is_some() && !seen.status.playing);
    assert!(seen.records.is_empty() && seen.status.replay);
    // whoever asks for it has it simulated from there
    worker.send(Command::Rewind(0.1));
    worker.send(Command::GoOn);
    wait(&worker, &mut seen, "end", |seen| seen.status.finished && seen.records.len() > 2);
    assert!(seen.notes.is_empty() && !seen.status.replay, "{:?}", seen.notes);
    // what is left of a branch has no start to go back to
    std::fs::remove_file(run.join("states/0000.npz")).unwrap();
    let mut session = Session::open_run(&gpu, &run, &Changes::default()).unwrap();
    let told = session.advance(1, &mut records).unwrap_err().to_string();
    assert!(told.contains("left no checkpoint up to it"), "{told}");
}

/// Waits until the outbox has what a test waits for; everything that came before is added to `seen`.
pub(crate) fn wait(worker: &Worker, seen: &mut Outbox, what: &str, done: impl Fn(&Outbox) -> bool) {
    let start = Instant::now();
    while !done(seen) {
        assert!(start.elapsed() < Duration::from_secs(120), "no {what}: {:?} {:?}", seen.status, seen.notes);
        std::thread::sleep(Duration::from_millis(10));
        let Outbox {
            status,
            opened,
            shown,
            records,
            stages,
            changed,
            notes,
            rewound,
            spot,
            holds,
            picked,
            answers,
            mesh,
        } = worker.take();
        seen.answers.extend(answers);
        seen.mesh = mesh.or(seen.mesh.take());
        seen.holds = holds.or(seen.holds);
        seen.picked = picked.or(seen.picked.take());
        seen.status = status;
        seen.opened = opened.or(seen.opened.take());
        seen.shown = shown.or(seen.shown.take());
        seen.stages = stages.or(seen.stages.take());
        seen.changed = changed.or(seen.changed.take());
        seen.rewound = rewound.or(seen.rewound.take());
        seen.spot = spot.or(seen.spot.take());
        seen.records.extend(records);
        seen.notes.extend(notes);
    }
}

#[test]
fn the_worker_opens_steps_detonates_changes_and_saves() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("charge.toml");
    std::fs::write(&file, SPACE).unwrap();
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    worker.send(Command::Pace(Pace::Fastest));
    worker.send(Command::Open(Request::of(file.to_str().unwrap()), None));
    wait(&worker, &mut seen, "scene", |seen| seen.opened.is_some() && seen.shown.is_some());
    let opened = seen.opened.clone().unwrap();
    assert_eq!((opened.scene.title.as_str(), opened.particles > 0), ("Charge in a box", true));
    assert_eq!(seen.status.phase, Phase::Ready);
    let mut look = opened.look.clone();
    look.settings.size = [160, 120];
    worker.send(Command::Look { look: Box::new(look.clone()), moving: false });
    let drawn = |shown: &Option<Shown>, look: &Look| shown.as_ref().is_some_and(|shown| shown.look == *look);
    wait(&worker, &mut seen, "picture of that size", |seen| drawn(&seen.shown, &look));
    worker.send(Command::Steps(3));
    wait(&worker, &mut seen, "three steps", |seen| seen.records.len() == 3);
    let before = seen.records.last().unwrap().given.energy;
    worker.send(Command::Detonate(Strike { at: [0.5, 0.5], source: Source::Energy(0.75, 0.2) }));
    worker.send(Command::Steps(1));
    wait(&worker, &mut seen, "blast", |seen| seen.records.len() == 4);
    let given = seen.records[3].given.energy - before;
    assert!((given - 0.75).abs() < 0.05, "the budgets have {given} J");
    assert!(seen.notes.iter().any(|note| note.weight == Weight::Fine), "{:?}", seen.notes);
    worker.send(Command::Detonate(Strike { at: [0.001, 0.001], source: Source::Energy(0.75, 0.2) }));
    wait(&worker, &mut seen, "word about a miss", |seen| {
        seen.notes.iter().any(|note| note.text.contains("beside the domain"))
    });
    // its walls are nearer than a kilogram is wide
    worker.send(Command::Detonate(Strike { at: [0.5, 0.5], source: Source::Tnt(1e9) }));
    wait(&worker, &mut seen, "word about a charge", |seen| {
        seen.notes.iter().any(|note| note.text.contains("do not fit into the gas"))
    });
    let mut scene = (*opened.scene).clone();
    scene.gravity = [0.0, 0.0, -5.0];
    worker.send(Command::Change(Box::new(scene.clone())));
    wait(&worker, &mut seen, "change", |seen| seen.changed.as_ref().is_some_and(|now| **now == scene));
    worker.send(Command::Play(true));
    wait(&worker, &mut seen, "end of the run", |seen| seen.status.finished);
    assert!((seen.status.time - 0.4).abs() < 1e-6 && !seen.status.playing, "{:?}", seen.status);
    worker.send(Command::Steps(1));
    wait(&worker, &mut seen, "step beyond the end", |seen| seen.status.time > 0.4);
    worker.send(Command::Rewind(0.0));
    wait(&worker, &mut seen, "way back", |seen| seen.rewound == Some(0.0) && seen.shown.as_ref().unwrap().time == 0.0);
    assert!(seen.status.step == 0 && seen.status.kept.len() > 1 && !seen.status.finished, "{:?}", seen.status);
}

#[test]
fn a_scene_that_is_wrong_says_so_and_the_next_one_opens() {
    let Some(_) = gpu_or_skip() else { return };
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    worker.send(Command::Open(
        Request { changes: Changes::default().set("gas.gamma=0.5"), ..Request::of("gas/sod") },
        None,
    ));
    wait(&worker, &mut seen, "finding", |seen| seen.status.phase == Phase::Failed);
    assert!(seen.notes[0].text.contains("gamma") && seen.notes[0].weight == Weight::Wrong, "{:?}", seen.notes);
    worker.send(Command::Open(Request { resolution: Some(50), ..Request::of("gas/sod") }, None));
    wait(&worker, &mut seen, "scene", |seen| seen.status.phase == Phase::Ready && seen.shown.is_some());
}

/// Whatever is wrong about another one: the scene that is open runs on, as it was, and is recorded on.
#[test]
fn a_scene_that_is_wrong_leaves_the_one_before_running() {
    let Some(folder) = folder_or_skip() else { return };
    let [file, wrong, empty] = ["kept.toml", "wrong.toml", "empty"].map(|name| folder.path().join(name));
    std::fs::write(&file, SPACE.replace("until = 0.4", "until = 4e3")).unwrap();
    std::fs::write(&wrong, SPACE.replace("density = 1.0", "density = -1.0")).unwrap();
    std::fs::create_dir(&empty).unwrap();
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    worker.send(Command::Pace(Pace::Fastest));
    worker.send(Command::Open(Request::of(file.to_str().unwrap()), None));
    worker.send(Command::Play(true));
    wait(&worker, &mut seen, "scene at work", |seen| seen.status.step > 2 && seen.shown.is_some());
    let large = Request { resolution: Some(12_000), ..Request::of(file.to_str().unwrap()) };
    let [wrong, empty] = [&wrong, &empty].map(|path| Request::of(path.to_str().unwrap()));
    let told = ["gas.ambient.density", "empty", "nowhere", "fewer cells"];
    for (request, told) in [wrong, empty, Request::of("nowhere"), large].into_iter().zip(told) {
        seen.notes.clear();
        seen.answers.clear();
        worker.send(Command::Open(request, None));
        wait(&worker, &mut seen, "answer", |seen| !seen.answers.is_empty());
        assert_eq!(seen.answers, [Answer::Refused], "{:?}", seen.notes);
        let note = seen.notes[0].clone();
        assert!(note.weight == Weight::Wrong && note.text.contains(told), "{told}: {}", note.text);
        let step = seen.status.step;
        wait(&worker, &mut seen, "more steps", |seen| seen.status.step > step + 2);
        assert!(seen.status.playing && seen.status.phase == Phase::Ready, "{:?}", seen.status);
        if told == "gas.ambient.density" {
            let parts = ["wrong.toml:3:", "density = -1.0", "above 0"];
            assert!(parts.iter().all(|part| note.text.contains(part)), "file, line and help: {}", note.text);
        }
    }
    let opened = seen.opened.clone().unwrap();
    assert_eq!(opened.request.name, file.to_str().unwrap());
    worker.send(Command::Open(Request { resolution: Some(50), ..Request::of("gas/sod") }, None));
    wait(&worker, &mut seen, "another scene", |seen| seen.answers.last() == Some(&Answer::Opened));
    assert_eq!(seen.opened.unwrap().request.name, "gas/sod");
}

/// A recording begins with the picture in the window and counts every picture of steps.
#[test]
fn a_recording_counts_its_pictures() {
    let Some(folder) = folder_or_skip() else { return };
    // Recordings go to a folder of this name below the user's for pictures, or `out`.
    let name = format!("recorded_{}", std::process::id());
    let file = folder.path().join(format!("{name}.toml"));
    std::fs::write(&file, format!("{SPACE}[render]\nsize = [64, 48]")).unwrap();
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    worker.send(Command::Open(Request::of(file.to_str().unwrap()), None));
    worker.send(Command::Record(true));
    wait(&worker, &mut seen, "first picture", |seen| seen.status.recorded == Some(1));
    worker.send(Command::Steps(1));
    wait(&worker, &mut seen, "picture of a step", |seen| seen.status.recorded == Some(2));
    worker.send(Command::Record(false));
    wait(&worker, &mut seen, "end", |seen| seen.status.recorded.is_none() && !seen.notes.is_empty());
    let told = seen.notes[0].text.strip_prefix("2 pictures in ").expect("it says where they are");
    let frames = std::path::Path::new(told.split([',', ';']).next().unwrap());
    let own = frames.ancestors().find(|above| above.ends_with(&name)).expect("in a folder of the scene");
    assert_eq!(std::fs::read_dir(frames).unwrap().count(), 2, "{told}");
    std::fs::remove_dir_all(own).unwrap();
}

fn origin() -> Origin {
    Origin { title: "charge".to_owned(), hash: "cafe".to_owned(), ..Origin::default() }
}

#[test]
fn saved_pictures_hold_the_bytes_that_are_shown() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = Scene::parse(SPACE, "charge.toml", &["render.size=[96,64]".to_owned()]).unwrap();
    let mut session = Session::open(&gpu, scene).unwrap();
    let look = session.look();
    let picture = std::sync::Arc::new(session.draw(&look).unwrap());
    let shown = Shown { picture, look, time: 0.0, step: 0 };
    let folder = tempfile::tempdir().unwrap();
    let mut recording = record::Recording::start(folder.path(), origin()).unwrap();
    assert!(recording.add(&shown) && recording.add(&shown) && recording.count() == 2);
    recording.finish().unwrap();
    let first = record::save(folder.path(), &shown, &origin()).unwrap();
    let second = record::save(folder.path(), &shown, &origin()).unwrap();
    assert_ne!(first, second);
    for path in [first, second, folder.path().join("recording_001/frames/0001.png")] {
        let (_, pixels) = read_png(&path);
        let rgb: Vec<u8> = shown.picture.frame.rgba.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect();
        assert_eq!(pixels, rgb, "{}", path.display());
    }
}
