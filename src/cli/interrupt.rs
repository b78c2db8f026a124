//! Ctrl-C and SIGTERM: the first asks to finish the current frame, the second to stop after the current submission.

use std::sync::Once;
use std::sync::atomic::{AtomicU32, Ordering};

static SIGNALS: AtomicU32 = AtomicU32::new(0);
static LISTEN: Once = Once::new();

/// How much the user wants to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Wish {
    /// Go on.
    GoOn,
    /// Stop when the frame is written.
    AfterFrame,
    /// Stop now.
    Now,
}

/// Starts listening; until then a signal ends the process at once.
pub(super) fn listen() {
    LISTEN.call_once(|| {
        // Without a handler Ctrl-C still stops the process; files are renamed into place, so those there are complete.
        let _ = ctrlc::set_handler(|| {
            if SIGNALS.fetch_add(1, Ordering::Relaxed) == 0 {
                eprintln!("\ninterrupted: finishing the current frame; once more stops without it");
            }
        });
    });
}

/// What the signals so far mean.
pub(super) fn wish() -> Wish {
    match SIGNALS.load(Ordering::Relaxed) {
        0 => Wish::GoOn,
        1 => Wish::AfterFrame,
        _ => Wish::Now,
    }
}
