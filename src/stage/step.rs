//! What frames a step: its length, its sums, what it records.

mod gauges;
mod loads;
mod maps;
mod time_step;
mod totals;

pub use gauges::Gauges;
pub use loads::Loads;
pub use maps::Maps;
pub use time_step::{Decision, TimeStep};
pub use totals::Totals;
