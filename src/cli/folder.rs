//! The folder of a run: it belongs to one process at a time, which lists what it writes there; nothing else is ever removed.

use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Component, Path, PathBuf};

use crate::export::atomic;
use crate::export::report::REPORT;
use crate::{Error, Result, input};

/// Marks the folder while a process writes into it: process id, its start, host.
const LOCK: &str = ".brisance.lock";
/// The files that a run wrote, one path a line, from its folder.
const LIST: &str = "written.txt";
/// Names that are tried beside a folder that is taken.
const MOST_NAMES: u32 = 10_000;

/// A folder that this process owns, until it lets go.
#[derive(Debug)]
pub(super) struct Folder {
    /// Where.
    pub(super) path: PathBuf,
    lock: PathBuf,
    /// What was made for it, itself and then folders above it; they go again where nothing is written there.
    made: Vec<PathBuf>,
}

impl Folder {
    /// Takes a folder that the user named: what an earlier run left there is replaced only by `force`, and stays until
    /// [`Folder::clear`].
    ///
    /// # Errors
    /// [`Error::Usage`] if another process writes there, or a run is there; [`Error::Io`] if the folder cannot be written.
    pub(super) fn take(path: &Path, force: bool) -> Result<Self> {
        let folder = Self::locked(path)?;
        if folder.holds_a_run() && !force {
            let message = "holds a run; --force replaces what that run wrote, another --out keeps it";
            return Err(Error::Usage(format!("{} {message}", path.display())));
        }
        Ok(folder)
    }

    /// Takes the folder, or the first of `NAME_2`, `NAME_3`, ... that holds no run and that no other process has.
    ///
    /// # Errors
    /// [`Error::Io`] if none can be written.
    pub(super) fn next_free(path: &Path) -> Result<Self> {
        for number in 1..MOST_NAMES {
            let mut name = path.file_name().unwrap_or_default().to_owned();
            if number > 1 {
                name.push(format!("_{number}"));
            }
            match Self::locked(&path.with_file_name(name)) {
                Ok(folder) if !folder.holds_a_run() => return Ok(folder),
                Ok(_) | Err(Error::Usage(_)) => {}
                Err(error) => return Err(error),
            }
        }
        Err(Error::Usage(format!("{} and {MOST_NAMES} beside it hold runs; name another --out", path.display())))
    }

    /// Takes the folder of a run that goes on; everything stays but what a killed process left half written.
    ///
    /// # Errors
    /// [`Error::Usage`] if another process writes there, or no run is there.
    pub(super) fn again(path: &Path) -> Result<Self> {
        let folder = Self::locked(path)?;
        match path.join(REPORT).is_file() {
            true => {
                folder.remove_abandoned();
                Ok(folder)
            }
            false => Err(Error::Usage(format!("{} is no folder of a run: it has no report.json", path.display()))),
        }
    }

    /// Marks a folder while something is done there that one process does for all; what is there stays.
    ///
    /// # Errors
    /// As those of [`Folder::take`] of a folder without a run.
    pub(super) fn locked(path: &Path) -> Result<Self> {
        let new = path.ancestors().take_while(|above| !above.as_os_str().is_empty() && !above.exists());
        let made: Vec<PathBuf> = new.map(Path::to_owned).collect();
        fs::create_dir_all(path).map_err(|source| Error::io(path, source))?;
        let lock = path.join(LOCK);
        for _ in 0..2 {
            match mark(&lock) {
                Ok(()) => return Ok(Self { path: path.to_owned(), lock, made }),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(Error::io(&lock, error)),
            }
            let text = input::text(&lock, 1 << 12).unwrap_or_default();
            if !is_stale(&text) {
                let who = text.trim().replace('\n', " ");
                let message = format!("{} belongs to another run (process, start, host: {who})", path.display());
                return Err(Error::Usage(format!("{message}; if it has ended, remove {}", lock.display())));
            }
            let _ = fs::remove_file(&lock);
        }
        Err(Error::Usage(format!("{}: another run was faster", path.display())))
    }

    /// Whether a run is there; one that ended before its first frame is none that somebody misses.
    fn holds_a_run(&self) -> bool {
        let text = input::text(&self.path.join(REPORT), input::MOST_REPORT);
        let read = text.ok().and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok());
        let nothing = |report: serde_json::Value| report["steps"] == 0 && report["frames"] == 0;
        self.path.join(REPORT).is_file() && !read.is_some_and(nothing)
    }

    /// Removes files that were never finished; runs in folders below this one keep theirs.
    fn remove_abandoned(&self) {
        atomic::remove_abandoned(&self.path, |below| below.join(LOCK).exists() || below.join(REPORT).exists());
    }

    /// Removes what the list names, what was never finished, and folders that are empty then.
    ///
    /// # Errors
    /// [`Error::Io`] if something cannot be removed.
    pub(super) fn clear(&self) -> Result<()> {
        self.remove_abandoned();
        let list = self.path.join(LIST);
        let text = match input::text(&list, input::MOST_REPORT) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            text => text.map_err(|source| Error::io(&list, source))?,
        };
        for line in text.lines().filter(|line| !line.is_empty()) {
            let Some(file) = self.inside(Path::new(line)) else { continue };
            match fs::remove_file(&file) {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(Error::io(file, error)),
                _ => {}
            }
            // a folder that still holds something stays
            let above = file.ancestors().skip(1).take_while(|above| *above != self.path);
            let _ = above.map(fs::remove_dir).take_while(std::result::Result::is_ok).count();
        }
        fs::remove_file(&list).map_err(|source| Error::io(&list, source))
    }

    /// A path of the list, if no `..` and no link leads out of the folder.
    fn inside(&self, path: &Path) -> Option<PathBuf> {
        let plain = path.components().all(|part| matches!(part, Component::Normal(_)));
        let file = self.path.join(path);
        let links = file.ancestors().skip(1).take_while(|above| *above != self.path).any(Path::is_symlink);
        (plain && !links).then_some(file)
    }

    /// Adds to the list what was written.
    ///
    /// # Errors
    /// [`Error::Io`] if the list cannot be written.
    pub(super) fn note(path: &Path, written: &[PathBuf]) -> Result<()> {
        let list = path.join(LIST);
        let inside = written.iter().filter_map(|file| file.strip_prefix(path).ok());
        let text: String = inside.map(|file| format!("{}\n", file.display())).collect();
        let opened = OpenOptions::new().append(true).create(true).open(&list);
        opened.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|source| Error::io(&list, source))
    }

    /// Where the mark is, for those who end without being dropped.
    pub(super) fn lock(&self) -> &Path {
        &self.lock
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.lock);
        // a folder that holds something stays
        let _ = self.made.iter().map(fs::remove_dir).take_while(std::result::Result::is_ok).count();
    }
}

/// Makes a mark with its text at once: who finds it empty takes it for one of a process that was killed.
fn mark(lock: &Path) -> std::io::Result<()> {
    let aside = lock.with_extension(format!("{}.{}", std::process::id(), host()));
    fs::write(&aside, owner())?;
    let made = fs::hard_link(&aside, lock);
    let _ = fs::remove_file(&aside);
    match made {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            // a disk without such links
            let mut file = OpenOptions::new().write(true).create_new(true).open(lock)?;
            write!(file, "{}", owner())
        }
        made => made,
    }
}

/// This process: id, start in ticks since the machine's, host.
fn owner() -> String {
    let id = std::process::id();
    format!("{id}\n{}\n{}\n", started(&id.to_string()).unwrap_or_default(), host())
}

/// Whether the process of a mark has ended: it was on this host, and no process of its id and start is there.
fn is_stale(text: &str) -> bool {
    let mut lines = text.lines();
    let (Some(id), Some(start), Some(on)) = (lines.next(), lines.next(), lines.next()) else {
        // a process that was killed between making the mark and writing it
        return text.is_empty();
    };
    cfg!(target_os = "linux") && on == host() && started(id).is_none_or(|now| now != start)
}

/// When a process started, where the system says so.
fn started(id: &str) -> Option<String> {
    let number: u32 = id.parse().ok()?;
    let text = fs::read_to_string(format!("/proc/{number}/stat")).ok()?;
    text.rsplit(')').next()?.split_ascii_whitespace().nth(19).map(str::to_owned)
}

fn host() -> String {
    let linux = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let other = || std::env::var("COMPUTERNAME").or_else(|_| std::env::var("HOSTNAME")).ok();
    linux.or_else(other).map_or_else(|| "unknown".to_owned(), |name| name.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_listed_goes() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("run");
        let folder = Folder::take(&path, false).unwrap();
        fs::create_dir_all(path.join("frames/deep")).unwrap();
        let outside = place.path().join("outside.txt");
        for file in
            [path.join("frames/0000.png"), path.join("frames/mine.png"), path.join("frames/deep/1"), outside.clone()]
        {
            fs::write(file, "x").unwrap();
        }
        let written = ["frames/0000.png", "frames/deep/1", "../outside.txt"].map(|name| path.join(name));
        Folder::note(&path, &written).unwrap();
        fs::write(path.join("report.json"), "{}").unwrap();
        drop(folder);
        assert!(Folder::take(&path, false).unwrap_err().to_string().contains("--force"));
        assert_eq!(Folder::next_free(&path).unwrap().path, place.path().join("run_2"));
        let folder = Folder::take(&path, true).unwrap();
        assert!(
            path.join("frames/0000.png").exists(),
            "what a run left stays until it is certain that another one begins"
        );
        folder.clear().unwrap();
        assert!(Folder::take(&path, true).unwrap_err().to_string().contains("belongs to another run"));
        assert!(path.join("frames/mine.png").exists() && outside.exists());
        assert!(!path.join("frames/0000.png").exists() && !path.join("frames/deep").exists());
        drop(folder);
        assert!(!path.join(LOCK).exists());
        let unused = place.path().join("a/b");
        drop(Folder::take(&unused, false).unwrap());
        assert!(!place.path().join("a").exists(), "folders that nothing was written to go again");
    }

    #[test]
    fn the_mark_of_a_process_that_has_ended_is_stale() {
        let own = owner();
        assert!(!is_stale(&own) && is_stale(""));
        assert!(!is_stale("1\n0\nelsewhere\n"));
        if cfg!(target_os = "linux") {
            assert!(is_stale(&format!("4000000\n12\n{}\n", host())), "no such process");
            assert!(is_stale(&format!("{}\n0\n{}\n", std::process::id(), host())), "its id was used again");
        }
    }
}
