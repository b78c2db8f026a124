//! How cases are run, judged and told: the registry's entry, sessions, rows, tables, pages.

mod case;
mod document;
pub(super) mod group;
mod perform;
pub(super) mod row;
pub(super) mod session;
mod table;

pub use case::Case;
pub use document::{Head, html, json, markdown};
pub use perform::perform;
pub use session::Suite;
pub use table::table;

/// Conjugate gradient iterations that suffice for a relative residual in a uniform gas: half of sqrt(k) ln(2 / residual) with
/// the condition k = 1 + 4 d C^2 of the scaled operator, C = c dt / dx. For 1e-7 this is 8.4 sqrt(k).
/// [Saad, Iterative Methods for Sparse Linear Systems, 2003, eq. 6.128]
pub fn iteration_bound(dimension: u32, courant: f64, residual: f64) -> f64 {
    0.5 * (1.0 + 4.0 * f64::from(dimension) * courant * courant).sqrt() * (2.0 / residual).ln()
}
