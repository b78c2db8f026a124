//! Brisance: compressible gas, shock waves and the solids they bend, tear and shatter, in one coupled pressure solve.

pub mod bodies;
pub mod cli;
pub mod diagnostics;
pub mod error;
pub mod expect;
pub mod export;
pub mod gpu;
pub mod material;
pub mod math;
pub mod numerics;
pub mod render;
pub mod riemann;
pub mod scene;
pub mod simulation;
pub mod snapshot;
pub mod stage;
pub mod state;
#[cfg(feature = "viewer")]
pub mod viewer;

pub use error::{Error, Result};
