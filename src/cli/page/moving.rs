//! The small moving picture of a page.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::export::apng;
use crate::render::Frame;
use crate::{Error, Result};

/// Pictures in it, at most.
const MOST: usize = 32;
/// Its width on the page of a run, at most \[pixels\].
const WIDTH: u32 = 320;
/// How long each picture stands \[ms\].
const DELAY: u16 = 120;

/// Of every how many pictures it has one.
fn every(pictures: usize) -> usize {
    pictures.div_ceil(MOST).max(1)
}

/// What it is made of, kept while a run writes its pictures: none of them is read and decoded again.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Small {
    width: u32,
    /// Of every how many pictures one is kept; 0 where none is.
    every: usize,
    pictures: BTreeMap<PathBuf, Frame>,
}

impl Default for Small {
    fn default() -> Self {
        Self::none(WIDTH)
    }
}

impl Small {
    /// All pictures are read again, to be so wide at most.
    pub(in crate::cli) fn none(width: u32) -> Self {
        Self { width, every: 0, pictures: BTreeMap::new() }
    }

    /// Of a run that will have so many pictures; those of before are read again.
    pub(in crate::cli) fn of(pictures: usize) -> Self {
        Self { every: every(pictures), ..Self::default() }
    }

    /// Keeps a picture that lies at a path, if the moving one will show it.
    pub(in crate::cli) fn keep(&mut self, index: u32, path: &Path, frame: &Frame) {
        if self.every > 0 && (index as usize).is_multiple_of(self.every) {
            self.pictures.insert(path.to_owned(), apng::shrunk(frame, self.width));
        }
    }

    /// The moving picture of these files.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if a picture that was not kept cannot be read.
    pub(super) fn of_files(&self, files: &[PathBuf]) -> Result<Vec<u8>> {
        let Some(first) = files.first() else { return Ok(Vec::new()) };
        let shown: Vec<&PathBuf> = files.iter().step_by(every(files.len())).collect();
        let small = |file: &&PathBuf| match self.pictures.get(*file) {
            Some(kept) => Ok(kept.clone()),
            None => apng::read(file).map(|frame| apng::shrunk(&frame, self.width)),
        };
        let frames: Vec<Frame> = shown.par_iter().map(small).collect::<Result<_>>()?;
        apng::moving(&frames, DELAY).map_err(|error| Error::io(first, std::io::Error::other(error)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::writer::{Files, FrameToWrite, Message, Writer};
    use crate::render::Picture;
    use crate::scene::{Domain, Gas, GasState, Scene};

    /// The files are gone when the page is made: what the run has kept is all that it takes.
    #[test]
    fn pictures_of_a_run_are_not_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let gas = Gas::new(GasState::new(1.0, 1.0));
        let scene = Scene::builder("box", Domain::new([8, 8], [1.0, 1.0]), gas).until(1.0).build().unwrap();
        let formats = vec!["png".to_owned()];
        let files = Files { folder: folder.path().to_owned(), formats, tables: true, ..Files::default() };
        let writer = Writer::start(files, &scene);
        for index in 0..=scene.time.frames {
            let picture = Picture { frame: Frame::filled(640, 16, [index as u8, 0, 9]), ..Picture::default() };
            let time = scene.frame_time(index);
            let frame = FrameToWrite { index, time, step: 0, pictures: vec![picture], snapshot: None, stored: None };
            assert!(writer.send(Message { frame: Some(frame), ..Message::default() }));
        }
        let (written, outcome) = writer.finish();
        outcome.unwrap();
        let path = |index: u32| folder.path().join("frames").join(format!("{index:04}.png"));
        let all: Vec<PathBuf> = (0..=scene.time.frames).map(path).collect();
        let read = Small::default().of_files(&all).unwrap();
        all.iter().for_each(|path| std::fs::remove_file(path).unwrap());
        assert!(Small::default().of_files(&all).is_err());
        assert_eq!(written.small.of_files(&all).unwrap(), read);
    }
}
