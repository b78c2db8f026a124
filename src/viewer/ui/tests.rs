//! The user interface without a window: files that are dropped, and a camera that is taken off its path.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::*;
use crate::gpu::GpuOptions;

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
    assert!(ui.opening && ui.watch.is_some());
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
