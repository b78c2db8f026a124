//! The folder of a run: what an earlier run left there makes room.

use std::path::Path;

use crate::{Error, Result};

/// What a run writes into its folder, besides the report.
#[rustfmt::skip]
const OURS: [&str; 9] = [
    "frames", "fields", "particles", "states", "fields.pvd", "particles.pvd", "diagnostics.csv", "bodies.csv", "probes.csv",
];

/// Makes the folder. If it holds the report of an earlier run, that run's files go, so that no old frame stays among new
/// ones; anything else in the folder stays.
///
/// # Errors
/// [`Error::Io`] if the folder cannot be written.
pub(super) fn prepare(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|source| Error::io(folder, source))?;
    if !folder.join("report.json").is_file() {
        return Ok(());
    }
    for name in OURS {
        let path = folder.join(name);
        let removed = if path.is_dir() { std::fs::remove_dir_all(&path) } else { std::fs::remove_file(&path) };
        match removed {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(Error::io(path, error)),
            _ => {}
        }
    }
    Ok(())
}
