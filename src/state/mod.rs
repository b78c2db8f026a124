//! Buffers and their host mirrors, no algorithms.

pub mod grid;

pub use grid::Grid;
