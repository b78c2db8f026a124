//! Algorithms on buffers, without physics: reduction, prefix sum, conjugate gradients.

pub mod pcg;
mod reduce;
mod scan;

pub use pcg::{Pcg, PcgControl, PcgVectors, Width};
pub use reduce::{Operator, Reduce};
pub use scan::Scan;
