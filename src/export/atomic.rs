//! Files appear complete or not at all: written under a temporary name in the same folder, then renamed.

use std::cell::RefCell;
use std::collections::HashSet;
use std::fs::DirEntry;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::{Error, Result};

/// How the names of files begin and end that are being written.
const ASIDE: (&str, &str) = (".brisance-", ".tmp");

/// Files that a thread has written.
#[derive(Default)]
struct Written {
    seen: HashSet<PathBuf>,
    new: Vec<PathBuf>,
}

thread_local! {
    static WRITTEN: RefCell<Option<Written>> = const { RefCell::new(None) };
}

/// From now on this thread remembers what it writes.
pub fn remember() {
    WRITTEN.set(Some(Written::default()));
}

/// What this thread has written for the first time since the last call, once it remembers.
#[must_use]
pub fn newly_written() -> Vec<PathBuf> {
    WRITTEN
        .with_borrow_mut(|written| written.as_mut().map_or_else(Vec::new, |written| std::mem::take(&mut written.new)))
}

/// Writes `path` through `fill`, creating its folder; an existing file is replaced only when everything was written.
pub fn write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    try_write(path, fill).map_err(|source| Error::io(path, source))
}

fn try_write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(ASIDE.0).suffix(ASIDE.1);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // tempfile's own 0600 would hide the results from the user's group; the umask still applies.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder)?;
    // the file itself: errors of the temporary one would name it, too
    let mut writer = BufWriter::with_capacity(1 << 20, file.as_file());
    fill(&mut writer)?;
    writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.persist(path)?;
    WRITTEN.with_borrow_mut(|written| {
        if let Some(written) = written
            && written.seen.insert(path.to_owned())
        {
            written.new.push(path.to_owned());
        }
    });
    Ok(())
}

/// Removes what a killed process left half written in a folder and the folders in it, as far as they can be read.
///
/// No other process may write there; folders that `is_foreign` names stay as they are, and no link is followed.
pub fn remove_abandoned(folder: &Path, is_foreign: impl Fn(&Path) -> bool) {
    for entry in entries(folder) {
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) && !is_foreign(&entry.path()) {
            entries(&entry.path()).for_each(|entry| remove_if_aside(&entry));
        } else {
            remove_if_aside(&entry);
        }
    }
}

fn entries(folder: &Path) -> impl Iterator<Item = DirEntry> {
    std::fs::read_dir(folder).into_iter().flatten().flatten()
}

fn remove_if_aside(entry: &DirEntry) {
    let name = entry.file_name();
    let name = name.to_string_lossy();
    if name.starts_with(ASIDE.0) && name.ends_with(ASIDE.1) && entry.file_type().is_ok_and(|kind| kind.is_file()) {
        // one that stays is in nobody's way
        let _ = std::fs::remove_file(entry.path());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_left_half_written_goes_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let kept = [".mine.tmp", "frames/0000.png", "other/.brisance-b.tmp"].map(|name| folder.path().join(name));
        let gone = [".brisance-a.tmp", "frames/.brisance-a.tmp"].map(|name| folder.path().join(name));
        for path in kept.iter().chain(&gone) {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        remove_abandoned(folder.path(), |path| path.ends_with("other"));
        assert!(kept.iter().all(|path| path.exists()) && !gone.iter().any(|path| path.exists()));
    }

    #[test]
    fn failed_write_keeps_the_old_file_and_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/file.txt");
        write(&path, |out| out.write_all(b"first")).unwrap();
        let failed = write(&path, |out| {
            out.write_all(b"second")?;
            Err(io::Error::other("disk full"))
        });
        assert_eq!(failed.unwrap_err().to_string(), format!("{}: disk full", path.display()));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "first");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }
}
