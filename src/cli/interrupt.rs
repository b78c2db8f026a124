//! Ctrl-C, SIGTERM and SIGHUP: the first asks to stop after the submission at work, with tables and report; a second ends at once. Where
//! nobody asks for wishes, as in set-up and while kernels compile, the first one ends at once, too, after the last words.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, Once, PoisonError};

use crate::Error;

static SIGNALS: AtomicU32 = AtomicU32::new(0);
static HEARD: AtomicBool = AtomicBool::new(false);
static LISTEN: Once = Once::new();
static LAST_WORDS: Mutex<BTreeMap<PathBuf, LastWords>> = Mutex::new(BTreeMap::new());

/// What is done before the process ends at once.
type LastWords = Box<dyn FnMut() + Send>;

/// Starts listening; until then a signal ends the process at once.
pub(super) fn listen() {
    LISTEN.call_once(start);
}

/// From now on somebody asks [`wish`] often enough.
pub(super) fn listen_between_steps() {
    listen();
    HEARD.store(true, Ordering::SeqCst);
}

/// Whether to stop.
pub(super) fn wish() -> bool {
    SIGNALS.load(Ordering::SeqCst) > 0
}

/// What to do about a folder before the process ends at once; with none nothing any more.
pub(super) fn last_words(folder: &Path, words: Option<LastWords>) {
    let mut all = LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner);
    match words {
        Some(words) => all.insert(folder.to_owned(), words),
        None => all.remove(folder),
    };
}

#[cfg(unix)]
fn start() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    // Without a handler a signal still stops the process; files are renamed into place, so those there are complete.
    let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP]) else { return };
    std::thread::spawn(move || signals.forever().for_each(|_| signal()));
}

#[cfg(not(unix))]
fn start() {
    let _ = ctrlc::set_handler(signal);
}

fn signal() {
    let first = SIGNALS.fetch_add(1, Ordering::SeqCst) == 0;
    if first && HEARD.load(Ordering::SeqCst) {
        tell!("\ninterrupted: stopping after this step; once more ends at once");
        return;
    }
    if let Ok(mut all) = LAST_WORDS.try_lock() {
        all.values_mut().for_each(|words| words());
    }
    tell!("error: {}", Error::Interrupted);
    end(Error::Interrupted.exit_code());
}

/// Ends the process; threads at work, such as a driver that compiles, are not waited for.
fn end(code: u8) -> ! {
    #[cfg(unix)]
    signal_hook::low_level::exit(code.into());
    #[cfg(not(unix))]
    std::process::exit(code.into());
}
