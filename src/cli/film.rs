//! Films: whether one can be made, and what became of it.

use std::path::{Path, PathBuf};

use super::args::FilmOptions;
use crate::export::video;
use crate::{Error, Result};

/// The film that is asked for, with its pictures per second; none, and a warning, where there is no encoder.
pub(super) fn asked(options: &FilmOptions, frames: &Path) -> Option<(PathBuf, u32)> {
    let path = options.video.as_ref()?;
    if video::is_possible() {
        return Some((path.clone(), options.fps));
    }
    tell!(
        "warning: no film {}: ffmpeg is not installed or not on the PATH; the pictures are written all the same. With ffmpeg: \
         ffmpeg -framerate {} -i {}/%04d.png -pix_fmt yuv420p {}",
        path.display(),
        options.fps,
        frames.display(),
        path.display()
    );
    None
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
