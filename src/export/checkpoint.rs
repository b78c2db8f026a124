//! checkpoints/STEP.npz: all that a run needs to go on bit by bit, and how far it had come.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bytemuck::cast_slice;
use rayon::prelude::*;

use super::container::{self, Array, Contents, Form, Head, SCENE, Source};
use super::npy::{Kind, Numbers};
use super::states::numbered;
use crate::simulation::{Host, Saved, SavedArray};
use crate::{Error, Result};

/// Member with what the run says of itself.
pub const RUN: &str = "run.toml";

/// File of the checkpoint after so many steps, from the folder of its run.
#[must_use]
pub fn file_of(step: u64) -> String {
    format!("checkpoints/{step:08}.npz")
}

/// Steps and files of a run's checkpoints, in order.
///
/// # Errors
/// [`Error::Io`] if the folder cannot be read.
pub fn list(run: &Path) -> Result<Vec<(u64, PathBuf)>> {
    numbered(&run.join("checkpoints"))
}

/// Writes a checkpoint of a run; `about` is what the run says of itself. Of those before, as many stay as make `keep` with this one.
///
/// # Errors
/// [`Error::Io`].
pub fn write(run: &Path, source: &Source, saved: &Saved, about: &str, keep: usize) -> Result<PathBuf> {
    let path = run.join(file_of(saved.step));
    let arrays = saved.arrays.par_iter().map(array);
    container::write(&path, (Form::Full, source), (saved.time, saved.step), &[(RUN, about)], arrays)?;
    let all = list(run)?;
    for (_, old) in &all[..all.len().saturating_sub(keep.max(1))] {
        if *old != path {
            std::fs::remove_file(old).map_err(|source| Error::io(old, source))?;
        }
    }
    Ok(path)
}

fn array(saved: &SavedArray) -> Array {
    let words = &saved.words;
    let numbers = if saved.real { Numbers::F32(cast_slice(words).to_vec()) } else { Numbers::U32(words.clone()) };
    Array::rows(&saved.name, saved.columns, numbers)
}

/// The texts of a checkpoint: its head, the scene, and what the run says of itself.
///
/// # Errors
/// [`Error::Io`] if it cannot be read or is no checkpoint.
pub fn read_texts(path: &Path) -> Result<(Head, String, String)> {
    let (head, texts) = container::read_texts(path)?;
    if head.form != Form::Full {
        return Err(Error::spoilt(path, "holds what pictures need, no whole state; only checkpoints do"));
    }
    let take = |texts: &BTreeMap<String, String>, name: &str| {
        texts.get(name).cloned().ok_or_else(|| Error::spoilt(path, format!("{name} is missing")))
    };
    let (scene, about) = (take(&texts, SCENE)?, take(&texts, RUN)?);
    Ok((head, scene, about))
}

/// Reads time, step and buffers; `host` is empty. The arrays may have `most` bytes in all.
///
/// # Errors
/// [`Error::Io`] if it cannot be read or is no checkpoint.
pub fn read(path: &Path, most: u64) -> Result<Saved> {
    let Contents { head, arrays, .. } = container::read(path, most)?;
    let mut saved = Saved { time: head.time, step: head.step, host: Host::default(), arrays: Vec::new() };
    for array in arrays {
        let columns = array.columns();
        let Array { name, numbers, .. } = array;
        let kind = numbers.kind();
        if !matches!(kind, Kind::F32 | Kind::U32) {
            return Err(Error::spoilt(path, format!("array `{name}` has no words of 32 bits")));
        }
        saved.arrays.push(SavedArray { name, real: kind == Kind::F32, columns, words: numbers.cast() });
    }
    Ok(saved)
}
