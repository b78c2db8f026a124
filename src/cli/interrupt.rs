//! Ctrl-C and SIGHUP ask to stop after the submission at work, with every frame that is drawn, film, tables and report. SIGTERM and an end
//! of processor time mean now: a batch system follows with SIGKILL, so frames that wait and films are given up; tables and report are
//! written. A second signal ends at once. Where nobody asks for wishes, as in set-up and up to the first picture, whose kernels a driver
//! may compile as they run, the first one ends at once, too, after the last words.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, Once, PoisonError};

use crate::Error;
use crate::export::video;

static SIGNALS: AtomicU32 = AtomicU32::new(0);
static URGENT: AtomicBool = AtomicBool::new(false);
static HEARD: AtomicU32 = AtomicU32::new(0);
static LISTEN: Once = Once::new();
static LAST_WORDS: Mutex<BTreeMap<PathBuf, LastWords>> = Mutex::new(BTreeMap::new());

/// What is done before the process ends at once.
type LastWords = Box<dyn FnMut() + Send>;

/// Starts listening; until then a signal ends the process at once.
pub(super) fn listen() {
    LISTEN.call_once(start);
}

/// Somebody who asks [`wish`] often enough, until it is dropped.
#[derive(Debug)]
pub(super) struct Heard(());

/// From now on somebody asks [`wish`] often enough.
pub(super) fn listen_between_steps() -> Heard {
    listen();
    HEARD.fetch_add(1, Ordering::SeqCst);
    Heard(())
}

impl Drop for Heard {
    fn drop(&mut self) {
        HEARD.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Whether to stop.
pub(super) fn wish() -> bool {
    SIGNALS.load(Ordering::SeqCst) > 0
}

/// Whether to stop now: whatever takes more than a moment is left out.
pub(super) fn urgent() -> bool {
    URGENT.load(Ordering::SeqCst)
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
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXCPU, SIGXFSZ};
    // A file that has come to its limit is an error of the one who writes it, as a full disk is.
    let _ = signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default());
    let mut ours = vec![SIGINT, SIGTERM, SIGXCPU];
    ours.extend(Some(SIGHUP).filter(|number| !is_ignored(*number)));
    // Without a handler a signal still stops the process; files are renamed into place, so those there are complete.
    let Ok(mut signals) = signal_hook::iterator::Signals::new(ours) else { return };
    std::thread::spawn(move || signals.forever().for_each(|number| signal([SIGTERM, SIGXCPU].contains(&number))));
}

/// Whether who started us wants a signal ignored, as `nohup` does; where the system does not say so, it is not.
#[cfg(unix)]
fn is_ignored(number: i32) -> bool {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = text.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (number - 1) & 1 == 1
}

#[cfg(not(unix))]
fn start() {
    let _ = ctrlc::set_handler(|| signal(false));
}

fn signal(urgent: bool) {
    URGENT.fetch_or(urgent, Ordering::SeqCst);
    let first = SIGNALS.fetch_add(1, Ordering::SeqCst) == 0;
    if first && HEARD.load(Ordering::SeqCst) > 0 {
        match urgent {
            true => {
                video::end_all();
                tell!(
                    "\nterminated: tables and report after this step, no frames that wait, no film; once more ends at once"
                );
            }
            false => {
                video::hurry();
                tell!("\ninterrupted: stopping after this step; once more ends at once");
            }
        }
        return;
    }
    if let Ok(mut all) = LAST_WORDS.try_lock() {
        all.values_mut().for_each(|words| words());
    }
    tell!("error: {}", Error::Interrupted);
    end(Error::Interrupted.exit_code());
}

/// Ends the process and those that it started; threads at work, such as a driver that compiles, are not waited for.
fn end(code: u8) -> ! {
    video::end_all();
    #[cfg(unix)]
    signal_hook::low_level::exit(code.into());
    #[cfg(not(unix))]
    std::process::exit(code.into());
}
