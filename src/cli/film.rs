//! Films: whether one can be made, and what became of it.

use std::path::{Path, PathBuf};

use super::args::FilmOptions;
use crate::export::video;

/// The film that is asked for, with its pictures per second; none, and a warning, where there is no encoder.
pub(super) fn asked(options: &FilmOptions, frames: &Path) -> Option<(PathBuf, u32)> {
    let path = options.video.as_ref()?;
    if video::is_possible() {
        return Some((path.clone(), options.fps));
    }
    eprintln!(
        "warning: no film {}: ffmpeg is not installed or not on the PATH; the pictures are written all the same. With ffmpeg: \
         ffmpeg -framerate {} -i {}/%04d.png -pix_fmt yuv420p {}",
        path.display(),
        options.fps,
        frames.display(),
        path.display()
    );
    None
}

/// Tells what became of films: warnings always, success unless quiet.
pub(super) fn tell(notes: &[String], quiet: bool) {
    for note in notes.iter().filter(|note| !quiet || note.starts_with("warning")) {
        eprintln!("{note}");
    }
}
