//! The forms of what a run says of itself, `report.json` and `run.json`: what a later program wrote is refused.

use std::path::Path;

use serde_json::Value;

use super::report::{FORM, REPORT};
use super::stays_inside;
use crate::{Error, Result, input};

/// Name of the index.
pub const INDEX: &str = "run.json";
/// Version of its form: it grows when a reader of the form before would go wrong.
pub const INDEX_FORM: u32 = 1;

/// Each file with the latest form that is known, and the keys of its form and of the program that wrote it.
const FILES: [(&str, u32, &str, &str); 2] =
    [(REPORT, FORM, "form", "version"), (INDEX, INDEX_FORM, "version", "program")];

/// Refuses the folder of a run whose report or index has a form beyond the one that is known. Files that are not there, or cannot be
/// read, pass; one that names no form has the first. `outside`: they may lie elsewhere.
///
/// # Errors
/// [`Error::Spoilt`] with the file, its program and both forms; [`Error::Usage`] with a file that lies elsewhere.
pub fn known(run: &Path, outside: bool) -> Result<()> {
    FILES.iter().try_for_each(|(name, known, form, program)| {
        let path = run.join(name);
        if !outside {
            stays_inside(run, &path)?;
        }
        let text = input::text(&path, input::MOST_REPORT).unwrap_or_default();
        let read: Value = serde_json::from_str(&text).unwrap_or_default();
        let written = &read[form];
        if written.is_null() || written.as_u64().is_some_and(|written| written <= u64::from(*known)) {
            return Ok(());
        }
        let (program, this) = (read[program].as_str().unwrap_or("of no name"), env!("CARGO_PKG_VERSION"));
        let text =
            format!("brisance {program} wrote it in form {written}; this is {this}, which reads forms up to {known}");
        Err(Error::spoilt(&path, format_args!("{text}: take a newer program")))
    })
}
