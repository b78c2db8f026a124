//! Meshes join a scene at work, are saved with it, and are refused where they are wrong.

use std::path::{Path, PathBuf};

use brisance::gpu::GpuOptions;
use brisance::scene::{Scene, Shape};
use brisance::viewer::adding::{Addition, Form, MeshFile};
use brisance::viewer::model::{Command, Outbox, Phase, Request, Weight};
use brisance::viewer::session::Session;
use brisance::viewer::worker::Worker;

use crate::common::{folder_or_skip, gpu_or_skip};
use crate::joins::{place, scene, steps, text};
use crate::viewer::wait;

/// A block of 4 x 2 x 2 m beside the origin.
const BLOCK: &str = "v 1 1 1\nv 5 1 1\nv 5 3 1\nv 1 3 1\nv 1 1 3\nv 5 1 3\nv 5 3 3\nv 1 3 3\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn block(file: &Path, scene: &Scene) -> Addition {
    std::fs::write(file, BLOCK).unwrap();
    let mesh = Some(MeshFile::read(file, scene, false).unwrap());
    Addition { form: Form::Mesh, size: 0.4, mesh, material: "rubber".to_owned() }
}

/// Particles of the last body: the middle of them \[m\], and their volume \[m^dimension\].
fn last_body(session: &Session) -> ([f64; 3], f64) {
    let last = session.scene().bodies.len() as u32 - 1;
    let mut particles = session.simulation().snapshot().unwrap().particles;
    particles.retain(|one| one.body == last);
    let volume: f64 = particles.iter().map(|one| f64::from(one.volume0)).sum();
    let sum = |axis: usize| particles.iter().map(|one| f64::from(one.position[axis] * one.volume0)).sum::<f64>();
    ([0, 1, 2].map(|axis| sum(axis) / volume), volume)
}

#[test]
fn a_mesh_joins_a_scene_at_work_and_is_taken_back() {
    let Some(gpu) = gpu_or_skip() else { return };
    let folder = tempfile::tempdir().unwrap();
    for dimension in [2, 3] {
        let mut session = Session::open(&gpu, scene(dimension, true)).unwrap();
        let look = session.look();
        steps(&mut session, 3);
        let (before, time) = (session.particles(), session.time());
        let addition = block(&folder.path().join("block.obj"), session.scene());
        let at = place(&session, 0.7, 0.5);
        let (name, middle) = session.add(at, &addition, &look, &mut Vec::new()).unwrap();
        assert_eq!((name.as_str(), session.time()), ("block_1", time));
        let (found, volume) = last_body(&session);
        let whole = if dimension == 3 { 0.4 * 0.2 * 0.2 } else { 0.4 * 0.2 };
        assert!((volume / whole - 1.0).abs() < 0.02, "{dimension}D: {volume} of {whole}");
        let away: Vec<f64> = (0..dimension).map(|axis| (found[axis] - middle[axis]).abs()).collect();
        assert!(away.iter().all(|away| *away < 0.02), "{dimension}D: {found:?}, not {middle:?}");
        steps(&mut session, 6);
        let (moved, _) = last_body(&session);
        assert!(moved.iter().all(|x| x.is_finite()) && session.unexpected().is_empty(), "{moved:?}");
        // once more from its start, and back
        let added = Request::default().added.of(session.scene());
        assert_eq!((added.bodies.len(), added.materials.len()), (1, 1));
        session.rewind(time).unwrap();
        assert_eq!((session.particles(), session.scene().bodies.len()), (before, 1));
    }
}

/// The file that is written stands by itself: the mesh lies beside it.
#[test]
fn a_scene_with_a_mesh_is_saved_and_read_again() {
    for dimension in [2, 3] {
        let Some(folder) = folder_or_skip() else { return };
        let away = tempfile::tempdir().unwrap();
        let (file, mesh) = (folder.path().join(format!("solid_{dimension}.toml")), away.path().join("block.obj"));
        std::fs::write(&file, text(dimension, true)).unwrap();
        std::fs::write(&mesh, BLOCK).unwrap();
        let request = Request::of(file.to_str().unwrap());
        let worker = Worker::start(GpuOptions::default(), || {});
        let mut seen = Outbox::default();
        worker.send(Command::Open(request.clone(), None));
        worker.send(Command::ReadMesh(mesh, false));
        wait(&worker, &mut seen, "mesh", |seen| seen.mesh.is_some() && seen.shown.is_some());
        let addition = Addition { form: Form::Mesh, size: 0.3, mesh: seen.mesh.clone(), material: "zinc".to_owned() };
        let at = [[0.45, 0.6], [0.5, 0.45]][dimension - 2];
        worker.send(Command::Add(at, Box::new(addition)));
        wait(&worker, &mut seen, "body", |seen| {
            let wrong = seen.notes.iter().find(|note| note.weight == Weight::Wrong);
            assert!(wrong.is_none(), "{wrong:?}");
            seen.changed.is_some()
        });
        worker.send(Command::SaveScene);
        wait(&worker, &mut seen, "file", |seen| seen.notes.iter().any(|note| note.text.contains("saved")));
        assert!(seen.notes.iter().any(|note| note.text.contains("with ") && note.text.contains("block.obj")));
        let now = seen.changed.clone().unwrap();
        let again = Request { added: request.added.of(&now), ..request };
        assert_eq!(again.load().unwrap().particle_count() as u64, seen.status.particles, "from its start");
        away.close().unwrap();
        let saved = folder.path().join(format!("solid_{dimension}_saved_001.toml"));
        let saved = Scene::find(saved.to_str().unwrap(), &[]).unwrap();
        let Shape::Mesh(own) = &saved.bodies[1].shape else { panic!("{:?}", saved.bodies[1].shape) };
        assert_eq!((own.path.as_str(), saved.bodies[1].joined), ("block.obj", false));
        assert_eq!(saved.particle_count() as u64, seen.status.particles, "{dimension}D");
        assert_eq!(saved.bodies[1].shape.bounds(), now.bodies[1].shape.bounds());
    }
}

/// In the words that `check` has for a scene that names the file; the scene goes on.
#[test]
fn wrong_meshes_are_told_and_the_scene_goes_on() {
    let Some(folder) = folder_or_skip() else { return };
    let place = |name: &str| folder.path().join(name);
    let open = BLOCK.replace("f 4 1 5 8\n", "");
    let files = [
        ("open.obj", open.as_str(), "edges"),
        ("empty.ply", "", "cannot be read"),
        ("none.obj", "v 0 0 0\n", "no triangles"),
        ("text.stl", "this is no mesh", "cannot be read"),
        ("broken.glb", "glTF", "cannot be read"),
        ("picture.png", "no mesh", "is no mesh file"),
    ];
    files.iter().for_each(|(name, text, _)| std::fs::write(place(name), text).unwrap());
    std::fs::write(place("scene.toml"), text(2, true)).unwrap();
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    let told = |seen: &mut Outbox, file: PathBuf, repair: bool| {
        seen.notes.clear();
        worker.send(Command::ReadMesh(file, repair));
        wait(&worker, seen, "word", |seen| !seen.notes.is_empty());
        (seen.notes[0].weight, seen.notes[0].text.clone())
    };
    let (weight, words) = told(&mut seen, place("open.obj"), false);
    assert!(weight == Weight::Wrong && words.contains("open a scene first"), "{words}");
    worker.send(Command::Open(Request::of(place("scene.toml").to_str().unwrap()), None));
    wait(&worker, &mut seen, "scene", |seen| seen.opened.is_some());
    for (name, _, what) in files.into_iter().chain([("nowhere.stl", "", "nowhere.stl: ")]) {
        let (weight, words) = told(&mut seen, place(name), false);
        assert!(weight == Weight::Wrong && words.contains(what) && words.contains("\n  = "), "{name}: {words}");
        let body =
            format!("[[bodies]]\nname = \"new\"\nmaterial = \"zinc\"\ndensity = 1.0\nshape.mesh.path = \"{name}\"\n");
        std::fs::write(place("named.toml"), text(2, true) + &body).unwrap();
        let check = Scene::find(place("named.toml").to_str().unwrap(), &[]).unwrap_err().to_string();
        assert!(check.contains(words.rsplit_once("= ").unwrap().1), "{name}: {words}\n{check}");
        assert!(seen.mesh.is_none() && seen.status.phase == Phase::Ready, "{name}");
    }
    let (weight, words) = told(&mut seen, place("open.obj"), true);
    assert!(weight == Weight::Fine && words.contains("10 triangles"), "{words}");
    // larger than the domain
    seen.notes.clear();
    let large = Addition { form: Form::Mesh, size: 3.0, mesh: seen.mesh.take(), material: "zinc".to_owned() };
    worker.send(Command::Add([0.5, 0.5], Box::new(large)));
    wait(&worker, &mut seen, "refusal", |seen| !seen.notes.is_empty());
    assert!(seen.notes[0].text.contains("out of the domain"), "{}", seen.notes[0].text);
    let line = Scene::find("gas/sod", &[]).unwrap();
    assert!(MeshFile::read(&place("open.obj"), &line, true).unwrap_err().to_string().contains("along a line"));
}
