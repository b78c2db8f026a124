//! Algorithms on buffers, without physics: copy, reduction, prefix sum, conjugate gradients.

mod copy;
pub mod pcg;
mod reduce;
mod scan;

pub use copy::{Rounds, copy_bandwidth};
pub use pcg::{Block, Dots, Groups, Layout, Levels, Pcg, PcgControl, PcgVectors};
pub use reduce::{Operator, Reduce};
pub use scan::Scan;
