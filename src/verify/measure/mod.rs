//! What several cases measure in their runs.

pub(super) mod budgets;
pub(super) mod plane;
pub(super) mod solids;
pub(super) mod sweep;
pub(super) mod tube_errors;
