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
    pub run: fn(&mut Session<'_>) -> Result<()>,
}
