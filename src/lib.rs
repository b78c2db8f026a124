//! Brisance: compressible gas, shock waves and the solids they bend, tear and shatter, in one coupled pressure solve.
//!
//! A [`Scene`] is an experiment: a TOML file, or made in code by [`Scene::builder`]. [`Simulation`] turns it into buffers and kernels and
//! steps it on a [`Gpu`]; [`Simulation::snapshot`] brings the state back as a [`Snapshot`]; a [`Renderer`] draws it.
//!
//! ```
//! use brisance::{Domain, Gas, GasState, Gpu, Scene, Shape, Simulation};
//!
//! let gas = Gas::new(GasState::new(1.0, 1.0)).region(Shape::sphere([0.5, 0.5], 0.1), GasState::new(1.0, 10.0));
//! let scene = Scene::builder("A blast in a box", Domain::new([32, 32], [1.0, 1.0]), gas).build()?;
//! let mut simulation = Simulation::new(&Gpu::best()?, &scene)?;
//! simulation.advance_to(0.1)?;
//! let middle = simulation.snapshot()?.gas_at([0.5, 0.5]).expect("no body lies there");
//! assert!(middle.pressure < 10.0 && middle.pressure > 1.0);
//! # Ok::<(), brisance::Error>(())
//! ```
//!
//! A [`Scene`] is checked wherever it comes from: [`Scene::load`], [`SceneBuilder::build`] and [`Simulation::new`] refuse the same mistakes in
//! the same words. Units are consistent and chosen by the scene, in kg, m and s for example. Longer programs stand in `examples/`.
//!
//! The method is told in `docs/method`, the floors on which the modules stand in `docs/inside/architecture.md`. Start reading at
//! [`Simulation::record_step`].

pub mod error;
pub mod gpu;
pub mod material;
pub mod quantity;
pub mod render;
pub mod scene;
pub mod simulation;
pub mod snapshot;

#[doc(hidden)]
pub mod bodies;
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod diagnostics;
#[doc(hidden)]
pub mod expect;
#[doc(hidden)]
pub mod explosive;
#[doc(hidden)]
pub mod export;
#[doc(hidden)]
pub mod input;
#[doc(hidden)]
pub mod math;
#[doc(hidden)]
pub mod numerics;
#[doc(hidden)]
pub mod riemann;
#[doc(hidden)]
pub mod spelling;
#[doc(hidden)]
pub mod stage;
#[doc(hidden)]
pub mod state;
#[doc(hidden)]
pub mod structure;
#[cfg(feature = "verify")]
#[doc(hidden)]
pub mod verify;
#[cfg(feature = "viewer")]
#[doc(hidden)]
pub mod viewer;

pub use error::{Error, Result};
pub use gpu::{Gpu, GpuOptions};
pub use material::Material;
pub use render::{Picture, Renderer};
pub use scene::{Body, Boundaries, Boundary, Domain, Field, Gas, GasState, Scene, SceneBuilder, Shape};
pub use simulation::Simulation;
pub use snapshot::{GasSample, ParticleSample, Snapshot};

/// The programs of the pages are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/start/from_rust.md")]
struct Pages;
