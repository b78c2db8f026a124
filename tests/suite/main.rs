//! The test suite: one binary, one module per subject.

mod common;
mod gpu;
mod layering;
mod numerics;
mod shaders;
