//! Verification: a registry of cases that run shipped scenes and compare them with numbers from elsewhere.
//!
//! A [`Case`] runs scenes through a [`Session`] and leaves rows and plots there. Adding one is a `Case` in the list of a
//! module, or a new module with a list and its line in [`cases()`]; rows on positivity and on the solver come by themselves.
//!
//! ```ignore
//! Case::quick("wedge", "title", group::GAS_2D, wedge, "source")
//!
//! fn wedge(session: &mut Session<'_>) -> Result<()> {
//!     let run = session.run("validation/wedge.toml", Setting::standard(200), &[])?;
//!     let angle = shock_angle(&run.snapshot);
//!     session.check(&run, "shock angle [deg]", angle).reference(32.24, "theta-beta-M relation").pass(..);
//!     session.plot(Plot::new("..", "x", "y").line("ours", points));
//!     Ok(())
//! }
//! ```

mod cases;
mod exact;
mod harness;
mod measure;

pub use cases::{cases, select};
pub use exact::profile::Profile;
pub use exact::{gasdynamics, muscl, muscl_plane};
pub use harness::row::{Limit, Row, Solver, Verdict, short};
pub use harness::session::{Common, Findings, Integrator, Journey, Run, Session, Setting, pair_name};
pub use harness::{Case, Head, Suite, html, iteration_bound, json, markdown, perform, table};
