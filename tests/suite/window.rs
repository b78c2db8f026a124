//! What the window asks of its worker beside pictures and steps, and pictures in haste.

use brisance::gpu::GpuOptions;
use brisance::scene::{Changes, Field, Scene};
use brisance::viewer::model::{Command, Outbox, Request, Spot};
use brisance::viewer::session::Session;
use brisance::viewer::worker::Worker;

use crate::common::{folder_or_skip, gpu_or_skip};
use crate::viewer::{SPACE, wait};

/// The scene in a plane.
fn plane() -> String {
    let cells = "dimension = 2, cells = [24, 24], size = [1, 1]";
    SPACE.replace("dimension = 3, cells = [12, 12, 12], size = [1.0, 1.0, 1.0]", cells).replace(", 0.5, 0.5]", ", 0.5]")
}

/// With a share of the rays the field alone is coarser: frame, letters and scales stay where and as they are.
#[test]
fn a_picture_in_haste_has_the_frame_and_the_letters_of_the_whole_one() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = Scene::parse(&plane(), "charge.toml", &["render.size=[420,301]".to_owned()]).unwrap();
    let mut session = Session::open(&gpu, scene).unwrap();
    let look = session.look();
    let whole = session.draw(&look).unwrap().frame;
    for share in [0.75, 0.5, 0.25] {
        let hasty = session.draw_in_haste(&look, share).unwrap().frame;
        assert_eq!((hasty.width, hasty.height), (whole.width, whole.height));
        let differs: Vec<[usize; 2]> = whole
            .rgba
            .chunks_exact(4)
            .zip(hasty.rgba.chunks_exact(4))
            .enumerate()
            .filter(|(_, (one, other))| one != other)
            .map(|(place, _)| [place % 420, place / 420])
            .collect();
        // title and time are above the plot, the colour bar and its numbers right of it
        let beside: Vec<_> = differs.iter().filter(|[x, y]| *y < 20 || *x >= 312).collect();
        assert!(beside.is_empty() && differs.len() > 500, "{share}: {} pixels, {beside:?}", differs.len());
    }
}

fn asked(worker: &Worker, at: [f64; 2]) -> Spot {
    worker.send(Command::Ask(at));
    let mut seen = Outbox::default();
    wait(worker, &mut seen, "answer", |seen| seen.spot.as_ref().is_some_and(|spot| spot.at == at));
    seen.spot.unwrap()
}

#[test]
fn what_lies_under_the_pointer_is_told_and_scenes_are_saved() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("charge.toml");
    std::fs::write(&file, format!("{}[render]\nsize = [400, 300]", plane())).unwrap();
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut seen = Outbox::default();
    worker.send(Command::Open(Request::of(file.to_str().unwrap()), None));
    wait(&worker, &mut seen, "picture", |seen| seen.opened.is_some() && seen.shown.is_some());
    let spots: Vec<Spot> = (0..20).map(|k| asked(&worker, [0.05 * f64::from(k), 0.5])).collect();
    assert!(spots[0].point.is_empty() && spots[0].value.is_none(), "{:?}", spots[0]);
    for spot in spots.iter().filter(|spot| !spot.point.is_empty()) {
        let [charge, lump] = [0.3, 0.7].map(|x| (spot.point[0] - x).hypot(spot.point[1] - 0.5));
        assert_eq!(spot.body.as_deref(), (lump < 0.15).then_some("lump"), "{spot:?}");
        // half a cell is 0.02
        if charge < 0.17 {
            assert!((spot.value.unwrap() - 8.0).abs() < 1e-3, "{spot:?}");
        } else if charge > 0.23 && lump > 0.2 {
            assert!((spot.value.unwrap() - 1.0).abs() < 1e-3, "{spot:?}");
        }
    }
    assert!(
        spots.iter().any(|spot| spot.body.is_some()) && spots.iter().any(|spot| spot.value > Some(7.0)),
        "{spots:?}"
    );

    let mut look = seen.opened.clone().unwrap().look;
    look.field = Field::Mach;
    worker.send(Command::Look { look: Box::new(look), moving: false });
    let mut scene = (*seen.opened.clone().unwrap().scene).clone();
    scene.gravity = [0.0, -5.0, 0.0];
    worker.send(Command::Change(Box::new(scene)));
    worker.send(Command::SaveScene);
    wait(&worker, &mut seen, "saved scene", |seen| seen.notes.iter().any(|note| note.text.contains("_saved_001.toml")));
    let saved = folder.path().join("charge_saved_001.toml");
    let again = Scene::find(saved.to_str().unwrap(), Changes::default()).unwrap();
    assert_eq!((again.gravity, again.output.fields[0]), ([0.0, -5.0, 0.0], Field::Mach));
}

/// What cannot be opened may have a size that can.
#[test]
fn a_scene_is_asked_for_at_its_small_size() {
    let plastic = Request { changes: Changes::variant("plastic"), ..Request::of("fig06_pumpkin") };
    let small = plastic.small().unwrap();
    assert_eq!(small.changes.variants, ["small", "plastic"]);
    assert!(small.load().unwrap().domain.cells[0] < plastic.load().unwrap().domain.cells[0]);
    assert_eq!([small.small(), Request::of("gas/sod").small()], [None, None]);
}
