//! The user interface without a window: files that are dropped, and a camera that is taken off its path.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::super::adding::{Form, MeshFile};
use super::super::model::{Answer, Look, Opened, Outbox};
use super::*;
use crate::gpu::GpuOptions;
use crate::scene::Field;

/// A file as the window hands it over.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Err("only the path is asked for".to_owned())
    }
}

fn frame(ui: &mut Ui, context: &egui::Context, dropped: &[&str]) {
    let files = dropped.iter().map(|path| Arc::new(Dropped(PathBuf::from(path))) as egui::DroppedFileHandle);
    let input = egui::RawInput { dropped_files: files.collect(), ..egui::RawInput::default() };
    // nothing is drawn here
    context.run_ui(input, |root| ui.show(root)).textures_delta.clear();
}

/// No device is needed: what is no scene is told before one is opened.
#[test]
fn a_dropped_file_is_opened_and_its_mistakes_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dropped.toml");
    std::fs::write(&path, "title = \"no scene\"").unwrap();
    let worker = Worker::start(GpuOptions::default(), || {});
    let (mut ui, context) = (Ui::new(worker, None, None), egui::Context::default());
    frame(&mut ui, &context, &[]);
    assert!(ui.request.is_none());
    let name = path.to_str().unwrap();
    frame(&mut ui, &context, &[name, "second.toml"]);
    assert_eq!(ui.request, Some(Request::of(name)), "the first of several files");
    assert!(ui.is_opening() && ui.watch.is_some());
    let start = Instant::now();
    while ui.notes.is_empty() {
        assert!(start.elapsed() < Duration::from_secs(30), "no word about the mistake");
        std::thread::sleep(Duration::from_millis(10));
        frame(&mut ui, &context, &[]);
    }
    let (_, note) = &ui.notes[0];
    assert!(note.weight == Weight::Wrong && note.text.contains("dropped.toml"), "{}", note.text);
    assert_eq!(ui.status.phase, Phase::Failed);
}

/// It opens no scene; the form has it, and the next click adds it.
#[test]
fn a_dropped_mesh_becomes_the_next_body() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Block.OBJ");
    std::fs::write(&path, crate::viewer::adding::mesh::tests::BLOCK).unwrap();
    let worker = Worker::start(GpuOptions::default(), || {});
    let (mut ui, context) = (Ui::new(worker, None, None), egui::Context::default());
    frame(&mut ui, &context, &[path.to_str().unwrap()]);
    assert!(ui.request.is_none() && !ui.is_opening());
    let start = Instant::now();
    while ui.notes.is_empty() {
        assert!(start.elapsed() < Duration::from_secs(30), "no word about the gallery");
        std::thread::sleep(Duration::from_millis(10));
        frame(&mut ui, &context, &[]);
    }
    assert!(ui.notes[0].1.text.contains("open a scene first"), "{}", ui.notes[0].1.text);
    // the worker of this test opens nothing: what it would find is given
    ui.open(Request::of("playground_2d"));
    ui.heed(vec![Answer::Opened], Some(opened("playground_2d")));
    let view = ui.view.as_mut().unwrap();
    (view.panel.open, view.panel.adding.armed) = (false, false);
    let mesh = MeshFile::read(&path, &view.scene, false).unwrap();
    view.receive(Outbox { mesh: Some(mesh), ..Outbox::default() });
    let adding = &view.panel.adding;
    assert!(view.panel.open && adding.armed && adding.next.form == Form::Mesh, "{adding:?}");
    assert!(adding.next.size > 3.0 * view.scene.domain.spacing());
    frame(&mut ui, &context, &[]);
    assert!(ui.path.is_none());
    ui.view.as_mut().unwrap().panel.adding.browse = true;
    frame(&mut ui, &context, &[]);
    assert!(ui.path.is_some(), "the dialog");
}

fn opened(name: &str) -> Opened {
    let request = Request::of(name);
    let scene = Arc::new(request.load().unwrap());
    let look = Look { field: Field::Density, settings: scene.own_look() };
    Opened { request, scene, particles: 0, look, fitted: None, device: String::new(), software: true }
}

/// The scene that is open stays, and what is asked of it waits, until it is known what becomes of the next one.
#[test]
fn a_scene_stays_until_another_one_is_right() {
    let worker = Worker::start(GpuOptions::default(), || {});
    let mut ui = Ui::new(worker, None, None);
    let request = |ui: &Ui| ui.request.as_ref().map(|request| request.name.clone());
    let title = |ui: &Ui| ui.view.as_ref().map(|view| view.scene.title.clone());
    // the worker of this test has no device: its answers are not listened to
    ui.open(Request::of("gas/sod"));
    assert_eq!((request(&ui).as_deref(), title(&ui), ui.is_opening()), (Some("gas/sod"), None, true));
    ui.heed(vec![Answer::Opened], Some(opened("gas/sod")));
    let first = title(&ui);
    assert!(first.is_some() && !ui.is_opening() && ui.wish == Some(true));

    ui.open_path(Path::new("wrong.toml"));
    assert!(ui.is_opening());
    ui.heed(vec![Answer::Refused], None);
    assert_eq!((request(&ui).as_deref(), title(&ui), ui.is_opening()), (Some("gas/sod"), first.clone(), false));

    // two at once: the first is wrong
    ui.open_path(Path::new("wrong.toml"));
    ui.open(Request::of("playground_2d"));
    ui.heed(vec![Answer::Refused, Answer::Opened], Some(opened("playground_2d")));
    assert_eq!(request(&ui).as_deref(), Some("playground_2d"));
    assert!(title(&ui) != first && !ui.is_opening());

    // whoever goes back to the gallery waits for nothing
    ui.open(Request::of("gas/sod"));
    ui.back();
    assert!(!ui.is_opening());
    ui.heed(vec![Answer::Opened], Some(opened("gas/sod")));
    assert_eq!((request(&ui), title(&ui)), (None, None));

    ui.open(Request::of("gas/sod"));
    ui.heed(vec![Answer::Failed], None);
    assert_eq!((request(&ui).as_deref(), title(&ui), ui.is_opening()), (Some("gas/sod"), None, false));
}

#[test]
fn a_mistake_folds_and_a_line_of_a_file_does_not() {
    let context = egui::Context::default();
    let size = |text: &str| {
        let mut size = egui::Vec2::ZERO;
        let show = |root: &mut EguiUi| {
            let shown = egui::ScrollArea::both().show(root, |ui| mistake(ui, text));
            size = shown.content_size;
        };
        context.run_ui(egui::RawInput::default(), show).textures_delta.clear();
        size
    };
    let [short, long] = [5, 60].map(|count| "close the surface ".repeat(count));
    let line = size(&short).y;
    let folded = size(&format!("  = {long}"));
    assert!(folded.x <= 660.0 && folded.y > 1.5 * line, "{folded} for lines of {line}");
    let marked = size(&format!("12 | {long}"));
    assert!(marked.x > 1000.0 && marked.y < 1.5 * line, "{marked} for lines of {line}");
    assert!(
        is_of_file("   |     ^^^^")
            && is_of_file("4 | x = 1")
            && !is_of_file("error: a | b")
            && !is_of_file("12 cells")
    );
}
