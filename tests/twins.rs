//! The CPU reference on its own.

#[path = "suite/reference/mod.rs"]
mod reference;
#[path = "suite/reference_exact.rs"]
mod reference_exact;
#[path = "suite/reference_operator.rs"]
mod reference_operator;
#[path = "suite/reference_solids.rs"]
mod reference_solids;
#[path = "suite/reference_tables.rs"]
mod reference_tables;
