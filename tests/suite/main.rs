//! The test suite: one binary, one module per subject.

#![allow(clippy::disallowed_macros)]

mod analytic;
mod arrays;
mod bench;
mod bent;
mod bits;
mod boundaries;
mod budgets;
mod charges;
mod checkpoint;
mod cli;
mod cold;
mod common;
mod contacts;
mod cut;
mod cut_bodies;
mod debris;
mod determinism;
mod dust;
mod earlier;
mod export;
mod far_field;
mod flow;
mod folders;
mod fracture;
mod frames;
mod fuzz;
mod gallery;
mod gauges;
mod generated;
mod gpu;
#[cfg(feature = "viewer")]
mod hand;
mod hardware;
mod images;
#[cfg(feature = "viewer")]
mod joins;
mod kernels;
mod keys;
mod launches;
mod layering;
mod layouts;
mod least_step;
mod listed_operator;
mod live;
mod loads;
mod map_coordinates;
mod maps;
mod materials;
#[cfg(feature = "viewer")]
mod mesh_joins;
mod numerics;
mod open_sides;
mod pages;
mod pieces;
mod preconditioner;
mod prose;
mod quiet;
mod reference_exact;
mod reference_operator;
mod reference_solids;
mod reference_tables;
mod render;
mod rooms;
mod scenes;
mod shaders;
mod skin;
mod solids;
mod species;
mod spoilt;
mod still;
mod stream;
mod supports;
mod surface;
mod sweeps;
mod synthetic;
mod thin_walls;
mod twins;
mod two_gas_twin;
#[cfg(feature = "verify")]
mod verify;
#[cfg(feature = "viewer")]
mod viewer;
mod voids;
mod walls;
mod warnings;
#[cfg(feature = "viewer")]
mod window;
mod words;
#[cfg(unix)]
mod written;
