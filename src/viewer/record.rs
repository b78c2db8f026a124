//! Pictures to the disk: single ones, and every one of a recording. A thread encodes and writes; its queue is short.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;

use super::model::Shown;
use crate::export::{Exporter, Moment, Origin, png::PngExporter};
use crate::{Error, Result};

/// Pictures that may wait.
const QUEUE: usize = 4;

/// A recording under way.
#[derive(Debug)]
pub struct Recording {
    folder: PathBuf,
    queue: SyncSender<Shown>,
    thread: JoinHandle<Result<()>>,
    accepted: u32,
}

impl Recording {
    /// Starts one in a new folder below `parent`.
    ///
    /// # Errors
    /// [`Error::Io`] if the folder cannot be made.
    pub fn start(parent: &Path, origin: Origin) -> Result<Self> {
        let folder = free(parent, "recording");
        std::fs::create_dir_all(&folder).map_err(|source| Error::io(&folder, source))?;
        let (queue, pictures) = sync_channel(QUEUE);
        let place = folder.clone();
        let thread = std::thread::spawn(move || write_all(&pictures, &place, &origin));
        Ok(Self { folder, queue, thread, accepted: 0 })
    }

    /// Takes a picture; false if the writer has stopped. A full queue makes it wait, so that no picture is missing.
    pub fn add(&mut self, shown: &Shown) -> bool {
        let sent = match self.queue.try_send(shown.clone()) {
            Err(TrySendError::Full(shown)) => self.queue.send(shown).is_ok(),
            outcome => outcome.is_ok(),
        };
        self.accepted += u32::from(sent);
        sent
    }

    /// Pictures taken so far.
    pub fn count(&self) -> u32 {
        self.accepted
    }

    /// Waits until everything is written; where it is and how to make a video of it.
    ///
    /// # Errors
    /// [`Error::Io`] if something could not be written.
    pub fn finish(self) -> Result<String> {
        drop(self.queue);
        match self.thread.join() {
            Ok(outcome) => outcome?,
            Err(panic) => std::panic::resume_unwind(panic),
        }
        let frames = self.folder.join("frames");
        if self.accepted == 0 {
            return Ok("recording stopped; there was no new picture".to_owned());
        }
        Ok(format!("{} pictures in {}{}", self.accepted, frames.display(), video(&self.folder, self.accepted)))
    }
}

/// A film of the pictures where ffmpeg is installed; what to add to the message about them.
fn video(folder: &Path, pictures: u32) -> String {
    let film = folder.join("film.mp4");
    if pictures < 2 {
        return String::new();
    }
    let made = std::process::Command::new("ffmpeg")
        .args(["-loglevel", "error", "-y", "-framerate", "30", "-i"])
        .arg(folder.join("frames/%04d.png"))
        .args(["-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p"])
        .arg(&film)
        .stdin(std::process::Stdio::null())
        .output();
    match made {
        Ok(output) if output.status.success() => format!(", film in {}", film.display()),
        Ok(_) => "; ffmpeg could not make a film of pictures of several sizes".to_owned(),
        Err(_) => "; install ffmpeg for a film".to_owned(),
    }
}

fn write_all(pictures: &Receiver<Shown>, folder: &Path, origin: &Origin) -> Result<()> {
    let mut exporter = PngExporter::new(folder);
    for (index, shown) in pictures.iter().enumerate() {
        write(&mut exporter, index as u32, &shown, origin)?;
    }
    Ok(())
}

fn write(exporter: &mut PngExporter, index: u32, shown: &Shown, origin: &Origin) -> Result<()> {
    let pictures = std::slice::from_ref(&*shown.picture);
    let (time, step) = (shown.time, shown.step);
    exporter.write(&Moment { index, origin, time, step, pictures, snapshot: None, stored: None })
}

/// Saves one picture below a folder and tells where.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn save(parent: &Path, shown: &Shown, origin: &Origin) -> Result<PathBuf> {
    let folder = parent.join("screenshots");
    let file = |index: u32| folder.join("frames").join(format!("{index:04}.png"));
    let index = (0..).find(|&index| !file(index).exists()).unwrap_or(0);
    write(&mut PngExporter::new(&folder), index, shown, origin)?;
    Ok(file(index))
}

/// A path below a folder that does not exist yet: `name`, with a number.
fn free(parent: &Path, name: &str) -> PathBuf {
    let path = |number: u32| parent.join(format!("{name}_{number:03}"));
    path((1..).find(|&number| !path(number).exists()).unwrap_or(1))
}
