//! Algorithms on buffers, without physics: copy, reduction, prefix sum, conjugate gradients.

mod copy;
pub mod pcg;
mod reduce;
mod scan;

pub use copy::{Rounds, copy_bandwidth};
pub use pcg::{Block, Dots, Layout, Levels, Pcg, PcgControl, PcgVectors, Width};
pub use reduce::{Operator, Reduce};
pub use scan::Scan;
