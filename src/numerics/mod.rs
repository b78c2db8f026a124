//! Algorithms on buffers, without physics: reduction and prefix sum.

mod reduce;
mod scan;

pub use reduce::{Operator, Reduce};
pub use scan::Scan;
