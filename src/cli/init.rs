//! `init` and `show`: a scene to start from, and the text of a shipped one.

use std::path::{Path, PathBuf};

use super::args::InitOptions;
use crate::export::atomic;
use crate::scene::{scene_file, shipped_named};
use crate::{Error, Result, input};

/// A blast on a body in 2D.
const BLAST: &str = include_str!("../../assets/start/blast_2d.toml");
/// The same in 3D.
const BLAST_3D: &str = include_str!("../../assets/start/blast_3d.toml");
/// A shock tube.
const SHOCK_TUBE: &str = include_str!("../../assets/start/shock_tube.toml");

/// What leads editors to the schema, which `brisance schema > scene.schema.json` writes beside a scene.
const SCHEMA_LINE: &str = "#:schema scene.schema.json";

/// Writes a scene to start from; a file that is there stays.
///
/// # Errors
/// [`Error::Usage`] if the file is there; [`Error::Scene`] if the scene to start from is unknown; [`Error::Io`].
pub(super) fn init(options: &InitOptions) -> Result<()> {
    let text = match &options.from {
        Some(name) => standing_alone(&text_of(name)?),
        None if options.shock_tube => SHOCK_TUBE.to_owned(),
        None if options.in_3d => BLAST_3D.to_owned(),
        None => BLAST.to_owned(),
    };
    let mut path = PathBuf::from(&options.name);
    if path.extension().is_none_or(|end| end != "toml") {
        path.as_mut_os_string().push(".toml");
    }
    if path.exists() {
        return Err(Error::Usage(format!("{} is there; give another name", path.display())));
    }
    atomic::write(&path, |out| out.write_all(text.as_bytes()))?;
    let name = path.display();
    say!("{name}: `brisance check {name}` checks it, `brisance run {name}` runs it, docs/scenes lists every key");
    Ok(())
}

/// The text of a scene file, or of a shipped scene.
fn text_of(name: &str) -> Result<String> {
    match scene_file(name) {
        Some(path) => input::text(path, input::MOST_SCENE).map_err(|source| Error::io(path, source)),
        None => Ok(shipped_named(name)?.text),
    }
}

/// A scene whose first line leads to a schema beside it, wherever it lies.
fn standing_alone(text: &str) -> String {
    let rest = match text.split_once('\n') {
        Some((first, rest)) if first.starts_with("#:schema") => rest,
        _ => text,
    };
    format!("{SCHEMA_LINE}\n{rest}")
}

/// Prints the text of a scene.
///
/// # Errors
/// [`Error::Scene`] if there is none of that name.
pub(super) fn show(name: &str) -> Result<()> {
    say!("{}", text_of(name)?.trim_end());
    Ok(())
}

/// Refuses to write over what somebody may have written by hand: the scene itself, or a file that is read as a mesh or a scene.
///
/// # Errors
/// [`Error::Usage`] that names the file.
pub(super) fn not_an_input(path: &Path, scene: &str) -> Result<()> {
    let end = path.extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
    let read = ["toml", "obj", "stl", "ply", "gltf", "glb", "bin"].contains(&end.as_str());
    let same =
        || path.canonicalize().ok().is_some_and(|own| Path::new(scene).canonicalize().is_ok_and(|other| own == other));
    if path.exists() && (read || same()) {
        return Err(Error::Usage(format!("{} is an input and stays as it is; name another file", path.display())));
    }
    Ok(())
}
