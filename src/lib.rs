//! Brisance: compressible gas, shock waves and the solids they bend, tear and shatter, in one coupled pressure solve.
//!
//! A [`scene::Scene`] is what the user asks for; [`simulation::Simulation`] turns it into buffers and kernels and steps it on a
//! [`gpu::Gpu`]; [`simulation::Simulation::snapshot`] brings the state back; [`render::Renderer`] draws it; [`export`] writes it.
//!
//! ```no_run
//! use brisance::{gpu::{Gpu, GpuOptions}, scene::Scene, simulation::Simulation};
//!
//! let scene = Scene::load("scenes/gas/sod.toml", &["time.until=0.1".to_owned()])?;
//! let gpu = Gpu::new(&GpuOptions::default())?;
//! let mut simulation = Simulation::new(&gpu, &scene)?;
//! let steps = simulation.advance_to(scene.time.until)?;
//! println!("{} steps, density of the first cell {}", steps.len(), simulation.snapshot()?.density[0]);
//! # Ok::<(), brisance::Error>(())
//! ```
//!
//! Modules stand on floors and use lower floors only: `math`, `error`, `input`, `riemann`, `spelling`; `material`, `gpu`; `scene`, `numerics`;
//! `state`; `stage`, `snapshot`; `simulation`, `diagnostics`, `bodies`, `quantity`; `render`, `expect`; `export`, `verify`; `cli`, `viewer`. The rules of the
//! house are in `docs/inside/architecture.md`, the method in `docs/method`. Start reading at [`simulation::Simulation::record_step`].

pub mod bodies;
pub mod cli;
pub mod diagnostics;
pub mod error;
pub mod expect;
pub mod export;
pub mod gpu;
pub mod input;
pub mod material;
pub mod math;
pub mod numerics;
pub mod quantity;
pub mod render;
pub mod riemann;
pub mod scene;
pub mod simulation;
pub mod snapshot;
pub mod spelling;
pub mod stage;
pub mod state;
pub mod verify;
#[cfg(feature = "viewer")]
pub mod viewer;

pub use error::{Error, Result};

/// The programs of the pages are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/start/from_rust.md")]
struct Pages;
