//! The test suite: one binary, one module per subject.

mod cli;
mod common;
mod export;
mod gpu;
mod layering;
mod numerics;
mod render;
mod scenes;
mod shaders;
