//! The test suite: one binary, one module per subject.

mod analytic;
mod bench;
mod boundaries;
mod cli;
mod common;
mod cut;
mod determinism;
mod export;
mod frames;
mod gallery;
mod gpu;
mod images;
mod kernels;
mod layering;
mod layouts;
mod listed_operator;
mod live;
mod materials;
mod numerics;
mod quiet;
mod reference;
mod reference_exact;
mod reference_operator;
mod reference_solids;
mod reference_tables;
mod render;
mod scenes;
mod shaders;
mod solids;
mod supports;
mod surface;
mod synthetic;
mod twins;
mod verify;
#[cfg(feature = "viewer")]
mod viewer;
