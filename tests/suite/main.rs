//! The test suite: one binary, one module per subject.

mod cli;
mod common;
mod export;
mod gpu;
mod layering;
mod numerics;
mod reference;
mod reference_exact;
mod reference_operator;
mod reference_solids;
mod reference_tables;
mod render;
mod scenes;
mod shaders;
