//! Bodies join a scene at work and are taken back.

use brisance::expect::Budget;
use brisance::gpu::GpuOptions;
use brisance::scene::{Body, Scene, Shape};
use brisance::simulation::Saved;
use brisance::viewer::adding::{Added, Addition, Form};
use brisance::viewer::model::{Command, Outbox, Phase, Request, Weight};
use brisance::viewer::session::Session;
use brisance::viewer::worker::Worker;

use crate::common::{folder_or_skip, gpu_or_skip};
use crate::viewer::wait;

/// A blast beside a body, or gas alone; an obstacle where there are bodies.
pub(crate) fn text(dimension: usize, bodies: bool) -> String {
    let (cells, edges) = (vec![16; dimension], vec![1.0; dimension]);
    let at = |x: f64, y: f64| format!("{:?}", &[x, y, 0.5][..dimension]);
    let solids = format!(
        "[materials.zinc]\nneo_hookean = {{ young_modulus = 1.0e7, poisson_ratio = 0.3 }}\n\
         [[bodies]]\nname = \"lump\"\nshape.sphere = {{ center = {}, radius = 0.15 }}\nmaterial = \"zinc\"\n\
         density = 1000.0\n\
         [[obstacles]]\nname = \"rock\"\nshape.sphere = {{ center = {}, radius = 0.12 }}\n",
        at(0.3, 0.5),
        at(0.85, 0.15),
    );
    format!(
        "title = \"Joins\"\n\
         domain = {{ dimension = {dimension}, cells = {cells:?}, size = {edges:?} }}\n\
         gas.ambient = {{ density = 1.2, pressure = 1.0e5 }}\n\
         gas.regions = [{{ shape.sphere = {{ center = {}, radius = 0.12 }}, density = 1.2, pressure = 3.0e5 }}]\n\
         time = {{ until = 0.004, frames = 1 }}\n\
         render.size = [200, 150]\n{}",
        at(0.55, 0.85),
        if bodies { solids } else { String::new() },
    )
}

pub(crate) fn scene(dimension: usize, bodies: bool) -> Scene {
    Scene::parse(&text(dimension, bodies), "joins.toml", &[]).expect("the scene of the test is valid")
}

/// A ball of a preset whose name comes before that of the scene's own material.
fn ball() -> Addition {
    Addition { form: Form::Ball, size: 0.22, mesh: None, material: "rubber".to_owned() }
}

/// The place of the picture nearest to a point of the plane through the middle.
pub(crate) fn place(session: &Session, x: f64, y: f64) -> [f64; 2] {
    let look = session.look();
    let mut best = ([0.5; 2], f64::INFINITY);
    for k in 0..3600 {
        let at = [(f64::from(k % 60) + 0.5) / 60.0, (f64::from(k / 60) + 0.5) / 60.0];
        let spot = session.spot(at, &look).unwrap();
        let [own_x, own_y] = [0, 1].map(|axis| spot.point.get(axis).copied().unwrap_or(f64::INFINITY));
        let away = (own_x - x).hypot(own_y - y);
        if away < best.1 {
            best = (at, away);
        }
    }
    best.0
}

pub(crate) fn steps(session: &mut Session, count: usize) {
    let mut records = Vec::new();
    while records.len() < count {
        session.advance(count as u32, &mut records).unwrap();
    }
}

fn state(session: &Session) -> Saved {
    session.simulation().save().unwrap()
}

/// Words of an array.
fn words<'a>(saved: &'a Saved, name: &str) -> &'a [u32] {
    &saved.arrays.iter().find(|array| array.name == name).unwrap().words
}

/// Fails unless two states are the same in time and in all that bodies and gas have.
fn assert_same(one: &Saved, two: &Saved, what: &str) {
    assert_eq!((one.time, one.step), (two.time, two.step), "{what}");
    for name in ["position", "velocity", "affine", "deformation", "stress", "conserved", "energy", "cells", "owed_flow"]
    {
        assert_eq!(words(one, name).len(), words(two, name).len(), "{what}: {name}");
        let differ = words(one, name).iter().zip(words(two, name)).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 0, "{what}: words of {name}");
    }
}

/// What a body that joins before the first step gives is what it gives from the start: bit by bit.
#[test]
fn a_body_that_joins_at_the_start_is_as_one_of_the_scene() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (dimension, bodies) in [(2, false), (2, true), (3, true)] {
        // at the start bodies make cut cells whole without a change of the gas, later they do not
        let whole = ["numerics.paper.obstacles=\"cells\"".to_owned()];
        let before = Scene::parse(&text(dimension, bodies), "joins.toml", &whole).unwrap();
        let mut session = Session::open(&gpu, before).unwrap();
        let look = session.look();
        let at = place(&session, 0.7, 0.5);
        let (name, middle) = session.add(at, &ball(), &look, &mut Vec::new()).unwrap();
        assert_eq!(name, "ball_1");
        let mut with = (**session.scene()).clone();
        let last = with.bodies.pop().unwrap();
        assert_eq!(last.shape, Shape::sphere(middle, 0.11));
        with.bodies.push(Body { joined: false, ..last });
        let mut other = Session::open(&gpu, with).unwrap();
        assert_eq!(session.particles(), other.particles());
        steps(&mut session, 6);
        steps(&mut other, 6);
        let (one, two) = (state(&session), state(&other));
        assert_same(&one, &two, &format!("{dimension}D, bodies: {bodies}"));
        let moved = words(&one, "conserved").chunks(4).any(|own| f32::from_bits(own[1]).abs() > 10.0);
        assert!(moved, "{dimension}D: no blast");
    }
}

/// What there is goes on from where it is, the budgets count what has come, and the way back leads to the scene before.
#[test]
fn a_body_joins_a_scene_at_work_and_is_taken_back() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut session = Session::open(&gpu, scene(2, true)).unwrap();
    let look = session.look();
    steps(&mut session, 5);
    let (before, time) = (state(&session), session.time());
    let at = place(&session, 0.7, 0.5);
    session.add(at, &ball(), &look, &mut Vec::new()).unwrap();
    let after = state(&session);
    assert_eq!((after.time, after.step, session.scene().bodies.len()), (before.time, before.step, 2));
    for name in ["position", "velocity", "deformation", "stress"] {
        let rows = words(&before, name);
        assert_eq!(&words(&after, name)[..rows.len()], rows, "{name}");
    }
    let density = |saved: &Saved| -> Vec<f32> {
        words(saved, "conserved").iter().step_by(4).map(|word| f32::from_bits(*word)).collect()
    };
    let (was, now) = (density(&before), density(&after));
    let gone: Vec<usize> = (0..was.len()).filter(|slot| was[*slot] != now[*slot]).collect();
    let covered = std::f64::consts::PI * 0.11 * 0.11 * 256.0;
    assert!(gone.iter().all(|slot| now[*slot] == 0.0), "gas is gone or as it was");
    assert!((gone.len() as f64 - covered).abs() < 0.4 * covered, "{} cells for {covered:.1}", gone.len());

    let start = Budget::read(session.simulation(), session.scene(), 0.0).unwrap();
    steps(&mut session, 10);
    assert!(session.unexpected().is_empty(), "{:?}", session.unexpected());
    let end = Budget::read(session.simulation(), session.scene(), 0.0).unwrap();
    assert!(end.drift_since(&start)["gas_mass"].abs() < 1e-5, "{:?}", end.drift_since(&start));
    assert_eq!(end.drift_since(&start)["solid_mass"], 0.0);
    let later = session.time();

    session.rewind(time).unwrap();
    assert_eq!((session.scene().bodies.len(), session.time()), (1, time));
    assert_same(&state(&session), &before, "the state before");
    session.rewind(later).unwrap();
    assert_eq!(session.scene().bodies.len(), if session.time() > time { 2 } else { 1 });
    session.rewind(time).unwrap();
    steps(&mut session, 4);
    let mut plain = Session::open(&gpu, scene(2, true)).unwrap();
    steps(&mut plain, 9);
    assert_same(&state(&session), &state(&plain), "the scene goes on without the body");
}

#[test]
fn what_finds_no_place_is_refused_and_the_scene_goes_on() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut session = Session::open(&gpu, scene(2, true)).unwrap();
    let look = session.look();
    let before = state(&session);
    let places = [(0.3, 0.5), (0.8, 0.15), (0.98, 0.9)].map(|(x, y)| place(&session, x, y));
    let mut refused =
        |at: [f64; 2], addition: &Addition| session.add(at, addition, &look, &mut Vec::new()).unwrap_err().to_string();
    assert!(refused(places[0], &ball()).contains("`lump` is there"));
    assert!(refused(places[1], &ball()).contains("obstacle `rock`"));
    assert!(refused(places[2], &ball()).contains("out of the domain"), "{}", refused(places[2], &ball()));
    assert!(refused([0.0, 0.0], &ball()).contains("beside the domain"));
    let none = Addition { material: "unobtainium".to_owned(), ..ball() };
    assert!(refused(place(&Session::open(&gpu, scene(2, true)).unwrap(), 0.7, 0.5), &none).contains("unobtainium"));
    assert_eq!(session.scene().bodies.len(), 1);
    assert_same(&state(&session), &before, "the scene as it was");
}

/// The worker adds, tells the scene, saves it, and starts it again with what was added.
#[test]
fn added_bodies_are_saved_and_stay_at_a_restart() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("joins.toml");
    std::fs::write(&file, text(2, true)).unwrap();
    let request = Request::of(file.to_str().unwrap());
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    worker.send(Command::Open(request.clone(), None));
    wait(&worker, &mut seen, "picture", |seen| seen.shown.is_some());
    worker.send(Command::Add([0.0, 0.0], Box::new(ball())));
    wait(&worker, &mut seen, "error", |seen| seen.notes.iter().any(|note| note.weight == Weight::Wrong));
    assert_eq!(seen.status.phase, Phase::Ready, "the scene goes on");
    let many = seen.status.particles;
    worker.send(Command::Add([0.5, 0.6], Box::new(ball())));
    wait(&worker, &mut seen, "body", |seen| seen.changed.is_some());
    let scene = seen.changed.clone().unwrap();
    assert!(seen.status.particles > many && scene.bodies.len() == 2, "{} particles", seen.status.particles);

    worker.send(Command::SaveScene);
    wait(&worker, &mut seen, "file", |seen| seen.notes.iter().any(|note| note.text.contains("saved")));
    let saved = Scene::find(folder.path().join("joins_saved_001.toml").to_str().unwrap(), &[]).unwrap();
    assert_eq!(saved.bodies.last().map(|body| (body.name.as_str(), body.joined)), Some(("ball_1", false)));
    assert_eq!(saved.density_of(&saved.bodies[1]), scene.density_of(&scene.bodies[1]));

    let again = Request { added: request.added.of(&scene), ..request };
    assert_eq!(again.load().unwrap().bodies, saved.bodies);
    assert_eq!(again.added.of(&again.load().unwrap()), again.added);
    assert_eq!(Added::default().of(&saved), Added::default());
    let clash = Added { bodies: vec![saved.bodies[0].clone()], ..Added::default() };
    assert!(Request { added: clash, ..again }.load().unwrap_err().to_string().contains("`lump` is taken"));
}
