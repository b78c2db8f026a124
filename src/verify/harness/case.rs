//! One entry of the registry.

use super::session::Session;
use crate::Result;

/// One entry of the registry.
#[derive(Debug)]
pub struct Case {
    /// Name on the command line and in tables, unique.
    pub id: &'static str,
    /// One line for people.
    pub title: &'static str,
    /// Heading in the report.
    pub group: &'static str,
    /// Whether the quick suite has it.
    pub quick: bool,
    /// Where the problem and its numbers come from.
    pub source: &'static str,
    /// Runs it.
    pub run: Run,
}

/// What runs a case.
type Run = fn(&mut Session<'_>) -> Result<()>;

impl Case {
    /// A case of both suites: name, title, heading, what runs it, and where its numbers come from.
    pub(crate) const fn quick(
        id: &'static str,
        title: &'static str,
        group: &'static str,
        run: Run,
        source: &'static str,
    ) -> Self {
        Self { id, title, group, quick: true, source, run }
    }

    /// A case of the full suite alone.
    pub(crate) const fn full(
        id: &'static str,
        title: &'static str,
        group: &'static str,
        run: Run,
        source: &'static str,
    ) -> Self {
        Self { quick: false, ..Self::quick(id, title, group, run, source) }
    }
}
