//! Films: whether one can be made, and what became of it.

use std::path::{Path, PathBuf};

use super::args::FilmOptions;
use crate::export::video;
use crate::{Error, Result};

/// A film that is asked for.
#[derive(Debug, Default)]
pub(super) struct Asked {
    /// Where it goes, and its pictures per second.
    pub(super) film: Option<(PathBuf, u32)>,
    /// Why there will be none.
    pub(super) lost: Option<String>,
}

/// The film that is asked for; a warning where there is no encoder: the pictures are worth the run all the same.
pub(super) fn asked(options: &FilmOptions, frames: &Path) -> Asked {
    let Some(path) = &options.video else { return Asked::default() };
    if video::is_possible() {
        return Asked { film: Some((path.clone(), options.fps)), lost: None };
    }
    let lost = format!("no film {}: ffmpeg is not installed or not on the PATH", path.display());
    tell!(
        "warning: {lost}; the pictures are written all the same. With ffmpeg: ffmpeg -framerate {} -i {}/%04d.png -pix_fmt yuv420p {}",
        options.fps,
        frames.display(),
        path.display()
    );
    Asked { film: None, lost: Some(lost) }
}

/// Tells what became of films, and returns the error of those that were not made.
pub(super) fn tell(films: &[std::result::Result<String, String>], quiet: bool) -> Result<()> {
    let mut lost = Vec::new();
    for film in films {
        match film {
            Ok(_) if quiet => {}
            Ok(made) => tell!("{made}"),
            Err(reason) => {
                tell!("warning: {reason}");
                lost.push(reason.as_str());
            }
        }
    }
    if lost.is_empty() { Ok(()) } else { Err(Error::Film(lost.join("; "))) }
}
