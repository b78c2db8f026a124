//! Films: raw pictures through a pipe to ffmpeg, one film per view. It encodes in processes of its own, beside the simulation.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::export::encoder::{self, ENCODER, Encoder};
use crate::export::{Exporter, Moment, png};
use crate::render::Frame;
use crate::{Error, Result};

/// Whether films can be made here.
#[must_use]
pub fn is_possible() -> bool {
    encoder::answers()
}

/// Gives encoders a moment only, from now on: somebody waits for the end.
pub fn hurry() {
    encoder::hurry();
}

/// Ends every encoder, and those to come, where there is no time to wait for films.
pub fn end_all() {
    encoder::end_all();
}

/// Pictures per second where nobody asks for another number.
pub const FRAME_RATE: u32 = 25;

/// Writes the first picture of each view to a film: `film.mp4` for the scene's own look, `film_VIEW.mp4` for the others.
#[derive(Debug)]
pub struct VideoExporter {
    path: PathBuf,
    /// Pictures per second of the film.
    rate: u32,
    films: Vec<Film>,
    /// Pictures that a run has drawn before it goes on, and where they lie.
    before: u32,
    frames: PathBuf,
}

/// One film in the making.
#[derive(Debug)]
struct Film {
    view: String,
    path: PathBuf,
    /// Where it grows until it is complete.
    draft: PathBuf,
    encoder: Option<Encoder>,
    size: [u32; 2],
    /// Why it was given up.
    failed: Option<String>,
}

impl VideoExporter {
    /// A film of so many pictures per second, which lie in a folder, too.
    #[must_use]
    pub fn new(path: &Path, rate: u32, frames: &Path) -> Self {
        Self { path: path.to_owned(), rate, films: Vec::new(), before: 0, frames: frames.to_owned() }
    }

    fn film(&mut self, view: &str, moment: &Moment, frame: &Frame) -> Result<&mut Film> {
        let place = match self.films.iter().position(|film| film.view == view) {
            Some(place) => place,
            None => {
                let mut film = Film::start(&self.path, self.rate, view, moment, frame)?;
                for index in 0..self.before {
                    film.add_again(&self.frames.join(view).join(format!("{index:04}.png")));
                }
                self.films.push(film);
                self.films.len() - 1
            }
        };
        Ok(&mut self.films[place])
    }
}

impl Exporter for VideoExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        let mut last = None;
        for picture in moment.pictures {
            if last.replace(picture.view.as_str()) != Some(picture.view.as_str()) {
                self.film(&picture.view, moment, &picture.frame)?.add(&picture.frame);
            }
        }
        Ok(())
    }

    fn go_on(&mut self, frames: u32, _: &dyn Fn(u32) -> f64) -> Result<()> {
        self.before = frames;
        Ok(())
    }

    fn finish(&mut self) -> Vec<std::result::Result<String, String>> {
        self.films.drain(..).map(Film::finish).collect()
    }
}

/// `film_VIEW.mp4` beside `film.mp4`; `prefix` and `suffix` go around the name.
fn named(path: &Path, view: &str, prefix: &str, suffix: &str) -> PathBuf {
    let text = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_os_string();
    let mut name = OsString::from(prefix);
    name.push(text(path.file_stem()));
    if !view.is_empty() {
        name.push(format!("_{view}"));
    }
    name.push(format!("{suffix}."));
    name.push(path.extension().unwrap_or("mp4".as_ref()));
    path.with_file_name(name)
}

/// Whether the format has an index that can stand before the pictures, so that a film plays while it is still loaded.
fn starts_at_once(path: &Path) -> bool {
    let extension = path.extension().map(|end| end.to_string_lossy().to_lowercase());
    extension.is_some_and(|end| ["mp4", "m4v", "mov"].contains(&end.as_str()))
}

impl Film {
    fn start(path: &Path, rate: u32, view: &str, moment: &Moment, frame: &Frame) -> Result<Self> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|source| Error::io(folder, source))?;
        }
        let (film, draft) = (named(path, view, "", ""), named(path, view, ".", "_draft"));
        let mut command = Command::new(ENCODER);
        command.args(["-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgb24"]);
        command.args(["-video_size", &format!("{}x{}", frame.width, frame.height)]);
        command.args(["-framerate", &rate.to_string(), "-i", "pipe:0"]);
        // Most players want 4:2:0, which wants even sides. Without tags they guess the matrix from the size. [ITU-R BT.709-6]
        let even = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv";
        command.args(["-vf", even, "-pix_fmt", "yuv420p", "-color_range", "tv"]);
        command.args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"]);
        if starts_at_once(&draft) {
            command.args(["-movflags", "+faststart"]);
        }
        command.args(["-metadata", &format!("title={}", moment.origin.title)]);
        command.args(["-metadata", &format!("comment=brisance, scene {}", moment.origin.hash)]);
        command.arg(&draft);
        let encoder = Encoder::start(command).map_err(|source| Error::io(ENCODER, source))?;
        let size = [frame.width, frame.height];
        Ok(Self { view: view.to_owned(), path: film, draft, encoder: Some(encoder), size, failed: None })
    }

    /// Takes a picture. A film that fails does not stop the run, whose pictures are on the disk all the same.
    fn add(&mut self, frame: &Frame) {
        let Some(encoder) = self.encoder.as_mut().filter(|_| self.failed.is_none()) else { return };
        let rgb = frame.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        self.failed = if [frame.width, frame.height] == self.size {
            encoder.add(rgb).err()
        } else {
            Some("pictures of several sizes make no film".to_owned())
        };
    }

    /// Takes a picture that was drawn before.
    fn add_again(&mut self, path: &Path) {
        match png::read(path) {
            Ok(frame) => self.add(&frame),
            Err(error) => self.failed = Some(format!("{error}; a film that goes on needs the pictures before")),
        }
    }

    /// Waits for the encoder; where the film is, or why there is none.
    fn finish(mut self) -> std::result::Result<String, String> {
        let ended = self.encoder.take().map_or(Ok(()), Encoder::finish);
        let said =
            ended.as_ref().err().filter(|said| !said.is_empty()).map_or_else(String::new, |said| format!("; {said}"));
        let reason = self.failed.take().map(|reason| reason + &said);
        let moved = match reason {
            None => ended.and_then(|()| std::fs::rename(&self.draft, &self.path).map_err(|error| error.to_string())),
            Some(reason) => Err(reason),
        };
        let film = self.path.display();
        moved
            .map(|()| format!("film in {film}"))
            .map_err(|reason| format!("no film {film}: {ENCODER}: {}", reason.trim()))
    }
}

impl Drop for Film {
    fn drop(&mut self) {
        // A film that was finished has no draft any more.
        let _ = std::fs::remove_file(&self.draft);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn films_of_views_stand_beside_the_film() {
        let path = Path::new("out/a.b.mkv");
        assert_eq!(named(path, "", "", ""), path);
        assert_eq!(named(path, "top", "", ""), Path::new("out/a.b_top.mkv"));
        assert!(starts_at_once(Path::new("a.MP4")) && !starts_at_once(path));
        assert_eq!(named(Path::new("film"), "top", ".", "_draft"), Path::new(".film_top_draft.mp4"));
    }
}
