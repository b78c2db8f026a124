//! run.json: what a run has left, for every verb and script that takes its folder.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::export::forms::{INDEX, INDEX_FORM};
use crate::export::{Origin, atomic, checkpoint};
use crate::{Error, Result, input};

/// The index of a run's folder; all paths are relative to it.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Index {
    version: u32,
    program: String,
    device: String,
    title: String,
    scene_hash: String,
    scene_file: String,
    /// Formats of which every frame has files.
    formats: Vec<String>,
    tables: Vec<String>,
    frames: Vec<Moment>,
    checkpoints: Vec<Left>,
}

/// A frame.
#[derive(Debug, Serialize, Deserialize)]
struct Moment {
    frame: u32,
    /// \[s\]
    time: f64,
    step: u64,
}

/// A checkpoint.
#[derive(Debug, Serialize, Deserialize)]
struct Left {
    file: String,
    /// \[s\]
    time: f64,
    step: u64,
}

impl Index {
    /// Of a run of which the first `frames` frames are there.
    pub(super) fn begin(
        folder: &Path,
        origin: &Origin,
        (formats, tables): (&[String], Vec<String>),
        frames: u32,
    ) -> Self {
        let text = input::text(&folder.join(INDEX), input::MOST_REPORT).ok().filter(|_| frames > 0);
        let mut before: Self = text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        before.frames.retain(|moment| moment.frame < frames);
        before.checkpoints.retain(|left| frames > 0 && folder.join(&left.file).is_file());
        let source = origin.source.clone();
        Self {
            version: INDEX_FORM,
            program: source.program,
            device: source.device,
            title: origin.title.clone(),
            scene_hash: source.scene_hash,
            scene_file: source.scene_file,
            formats: formats.to_vec(),
            tables,
            ..before
        }
    }

    /// Adds a frame at a time \[s\] after so many steps.
    pub(super) fn add_frame(&mut self, frame: u32, time: f64, step: u64) {
        self.frames.push(Moment { frame, time, step });
    }

    /// Adds a checkpoint, and forgets those that are there no more.
    pub(super) fn add_checkpoint(&mut self, folder: &Path, time: f64, step: u64) {
        let file = checkpoint::file_of(step);
        self.checkpoints.retain(|left| left.file != file && folder.join(&left.file).is_file());
        self.checkpoints.push(Left { file, time, step });
    }

    /// Writes it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(super) fn save(&self, folder: &Path) -> Result<()> {
        let path = folder.join(INDEX);
        let text = serde_json::to_vec_pretty(self).map_err(|error| Error::io(&path, error.into()))?;
        atomic::write(&path, |out| out.write_all(&text))
    }
}
