//! A run that the first program with a container left is read: drawn, converted, looked at; it does not go on.
//!
//! `tests/runs/first_form` is what commit 00f361f wrote of the scene in it, with one checkpoint.

use std::path::{Path, PathBuf};

use brisance::export::{container, states};

use crate::cli::{fails, succeeds};
use crate::common::folder_or_skip;

/// A copy of the run.
fn copy(to: &Path) -> PathBuf {
    let run = to.join("run");
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/runs/first_form");
    for folder in ["", "states", "checkpoints"] {
        std::fs::create_dir_all(run.join(folder)).unwrap();
        for entry in std::fs::read_dir(from.join(folder)).unwrap().map(Result::unwrap) {
            if entry.path().is_file() {
                std::fs::copy(entry.path(), run.join(folder).join(entry.file_name())).unwrap();
            }
        }
    }
    run
}

#[test]
fn a_run_of_the_first_form_is_drawn_and_converted_and_does_not_go_on() {
    let Some(place) = folder_or_skip() else { return };
    let run = copy(place.path());
    let text = run.display().to_string();
    succeeds(&["render", &text, "-q", "--size", "80x64"]);
    let pictures = [0, 1, 2].map(|k| std::fs::read(run.join(format!("again/frames/000{k}.png"))).unwrap());
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    let out = |name: &str| place.path().join(name).display().to_string();
    succeeds(&["convert", &text, "--to", "npz,vtk,vdb,usd", "-q", "--out", &out("states")]);
    // where no states of frames are left, checkpoints are read
    std::fs::remove_dir_all(run.join("states")).unwrap();
    succeeds(&["convert", &text, "--to", "npz", "-q", "--out", &out("checkpoints")]);
    let read = |name: &str| container::read(&place.path().join(name).join("arrays/0002.npz"), 1 << 20).unwrap().arrays;
    let (one, two) = (read("states"), read("checkpoints"));
    assert!(one.len() > 10 && one == two, "the checkpoint of the end holds the state of its frame");
    for verb in [&["run", "--resume", &text][..], &["run", "--branch", &format!("{text}@0.2"), "--out", &out("new")]] {
        let told = fails(6, verb);
        assert!(told.contains("in form 1") && told.contains("run the scene again"), "{told}");
    }
    assert!(states::list(&run).unwrap().is_empty() && !place.path().join("new/report.json").exists());
}

/// Its states are shown one after another, its checkpoint is one of them, and nothing is simulated.
#[cfg(feature = "viewer")]
#[test]
fn a_run_of_the_first_form_is_looked_at() {
    let Some(gpu) = crate::common::gpu_or_skip() else { return };
    let place = tempfile::tempdir().unwrap();
    let run = copy(place.path());
    for _ in 0..2 {
        let mut session =
            brisance::viewer::session::Session::open_run(&gpu, &run, &brisance::scene::Changes::default()).unwrap();
        assert!((session.time() - 0.2).abs() < 1e-6 && session.next().is_none(), "{}", session.time());
        let look = session.look();
        let last = session.draw(&look).unwrap();
        session.rewind(0.0).unwrap();
        let shown = std::iter::repeat_with(|| session.show_next().unwrap()).take_while(|shown| *shown).count();
        assert_eq!(shown + 1, session.kept().len());
        assert!(session.draw(&look).unwrap() == last);
        let told = session.advance(1, &mut Vec::new()).unwrap_err().to_string();
        assert!(told.contains("can only be looked at"), "{told}");
        // then from the checkpoint alone
        let _ = std::fs::remove_dir_all(run.join("states"));
    }
}
