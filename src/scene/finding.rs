//! What is wrong with a scene: key, message and remedy.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::ops::Range;

/// Findings that are told at most.
pub(crate) const MOST_TOLD: usize = 20;
/// Letters of a path, a message or an advice that are told.
const MOST_LETTERS: usize = 1000;

/// What of a scene a finding follows from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum About {
    /// The value at its key alone.
    Value,
    /// That value beside those of other keys.
    #[default]
    Several,
    /// What other shapes leave to a body.
    Remainder,
}

/// Something wrong with a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finding {
    /// Key path, `bodies[0].shape.sphere.radius`; empty for the whole scene.
    pub path: String,
    /// What is wrong, with the value.
    pub message: String,
    /// What is allowed and what to do.
    pub help: String,
    /// Where in the text of the scene; found by the path when absent.
    pub span: Option<Range<usize>>,
    /// What it follows from.
    pub about: About,
}

impl Finding {
    /// A finding at a key.
    pub(crate) fn new(path: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        let (path, message, help) = (path.into(), message.into(), help.into());
        Finding { path, message, help, span: None, about: About::default() }
    }

    /// One about a value that is wrong beside whatever other keys.
    pub(crate) fn of_value(path: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Finding { about: About::Value, ..Finding::new(path, message, help) }
    }

    /// A number outside of its limits.
    pub(crate) fn out_of_range(path: impl Into<String>, value: impl Display, help: impl Into<String>) -> Self {
        Finding::of_value(path, format!("{value} is out of range"), help)
    }

    /// The same of a key below another one.
    pub(crate) fn below(self, path: &str) -> Self {
        Finding { path: format!("{path}.{}", self.path), ..self }
    }

    /// The same with as many letters as somebody reads.
    pub(crate) fn clipped(&self) -> Self {
        let [path, message, help] = [&self.path, &self.message, &self.help].map(|text| clip(text));
        Finding { path, message, help, span: None, about: self.about }
    }
}

/// The keys that something has been said of.
pub(crate) struct Told(BTreeSet<String>);

impl Told {
    /// Those of findings.
    pub(crate) fn new(findings: &[Finding]) -> Self {
        Told(findings.iter().map(|finding| finding.path.clone()).collect())
    }

    /// Whether some key begins like this one.
    pub(crate) fn below(&self, path: &str) -> bool {
        self.0.range(path.to_owned()..).next().is_some_and(|key| key.starts_with(path))
    }
}

/// The first letters of a long text, and how many bytes it has.
fn clip(text: &str) -> String {
    match text.char_indices().nth(MOST_LETTERS) {
        Some((end, _)) => format!("{}... ({} bytes)", &text[..end], text.len()),
        None => text.to_owned(),
    }
}
