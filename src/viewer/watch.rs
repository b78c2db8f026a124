//! Notices that a scene file was saved.

use std::path::PathBuf;
use std::time::{Duration, Instant, SystemTime};

/// Time between two looks at the file.
const PERIOD: Duration = Duration::from_millis(400);

/// A file under watch.
#[derive(Debug)]
pub(super) struct Watch {
    path: PathBuf,
    seen: Option<SystemTime>,
    next: Instant,
}

impl Watch {
    pub(super) fn new(path: PathBuf) -> Self {
        let seen = modified(&path);
        Self { path, seen, next: Instant::now() + PERIOD }
    }

    /// Whether the file was saved since the last time that this was true; looks seldom. A file that is gone for a moment, as while
    /// an editor replaces it, is not a change.
    pub(super) fn saved(&mut self) -> bool {
        if Instant::now() < self.next {
            return false;
        }
        self.next = Instant::now() + PERIOD;
        let now = modified(&self.path);
        let saved = now.is_some() && now != self.seen;
        if saved {
            self.seen = now;
        }
        saved
    }

    /// When to look again.
    pub(super) fn period() -> Duration {
        PERIOD
    }
}

fn modified(path: &PathBuf) -> Option<SystemTime> {
    std::fs::metadata(path).and_then(|data| data.modified()).ok()
}
