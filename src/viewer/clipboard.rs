//! The system's clipboard.

use std::cell::RefCell;

thread_local! {
    /// Kept open: on some systems the text goes with the program that owns it.
    static CLIPBOARD: RefCell<Option<arboard::Clipboard>> = const { RefCell::new(None) };
}

/// Puts a text there; without a clipboard the text field beside the button still has it.
pub(super) fn copy(text: &str) {
    CLIPBOARD.with_borrow_mut(|clipboard| {
        if clipboard.is_none() {
            *clipboard = arboard::Clipboard::new().ok();
        }
        if let Some(clipboard) = clipboard {
            let _ = clipboard.set_text(text.to_owned());
        }
    });
}
