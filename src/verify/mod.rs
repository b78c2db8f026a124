//! Verification: a registry of cases that run shipped scenes and compare them with numbers from elsewhere.
//!
//! A [`Case`] runs scenes through a [`Session`] and leaves rows and plots there. Adding one is a `Case` in the list of a
//! module, or a new module with a list and its line in [`cases`]; rows on positivity and on the solver come by themselves.
//!
//! ```ignore
//! Case { id: "wedge", title: "..", group: "2D gas", quick: true, source: "..", run: wedge }
//!
//! fn wedge(session: &mut Session<'_>) -> Result<()> {
//!     let run = session.run("validation/wedge.toml", Setting::standard(200), &[])?;
//!     let angle = shock_angle(&run.snapshot);
//!     session.check(&run, "shock angle [deg]", angle).reference(32.24, "theta-beta-M relation").pass(..);
//!     session.plot(Plot::new("..", "x", "y").line("ours", points));
//!     Ok(())
//! }
//! ```

mod ablations;
mod athena;
mod blast_2d;
mod blasts;
mod books;
mod bow_shocks;
mod buoyancy;
mod clamped;
mod cold;
mod contacts;
mod cylinders;
mod document;
mod drifting;
mod driven;
mod duct;
mod explosions;
mod forward_step;
mod fragments;
pub mod gasdynamics;
mod jet;
mod line_explosion;
mod loaded_walls;
pub mod muscl;
pub mod muscl_plane;
mod open_sides;
mod panel;
mod pistons;
mod plane;
mod plane_flows;
mod plates;
mod plot;
mod profile;
mod quiet;
mod riemann_2d;
mod row;
mod session;
mod shells;
mod soft_bodies;
mod solids;
mod steady;
mod table;
mod thin_walls;
mod tube_errors;
mod tubes;
mod waves;

pub(crate) use document::STYLE;
pub use document::{Head, html, json, markdown};
pub(crate) use plot::escape;
pub use plot::{Plot, Style};
pub use profile::Profile;
pub use row::{Limit, Row, Solver, Verdict, short};
pub use session::{Common, Findings, Integrator, Journey, Run, Session, Setting, Suite, pair_name};
pub use table::table;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::Result;
use crate::gpu::Gpu;

/// One entry of the registry.
#[derive(Debug)]
pub struct Case {
    /// Name on the command line and in tables, unique.
    pub id: &'static str,
    /// One line for people.
    pub title: &'static str,
    /// Heading in the report.
    pub group: &'static str,
    /// Whether the quick suite has it.
    pub quick: bool,
    /// Where the problem and its numbers come from.
    pub source: &'static str,
    /// Runs it.
    pub run: fn(&mut Session<'_>) -> Result<()>,
}

/// All cases in the order of the report, those of a group together.
pub fn cases() -> impl Iterator<Item = &'static Case> {
    let lines = [tubes::CASES, athena::CASES, blasts::CASES, waves::CASES];
    let blasts = [blast_2d::CASES, line_explosion::CASES, explosions::CASES];
    let streams = [forward_step::CASES, steady::CASES, bow_shocks::CASES, jet::CASES];
    let coupled = [
        plates::CASES,
        pistons::CASES,
        drifting::CASES,
        driven::CASES,
        panel::CASES,
        shells::CASES,
        cylinders::CASES,
        cold::CASES,
        fragments::CASES,
        thin_walls::CASES,
        soft_bodies::CASES,
        loaded_walls::CASES,
    ];
    let gas = lines.into_iter().chain(blasts).chain(streams).chain([
        duct::CASES,
        riemann_2d::CASES,
        plane_flows::CASES,
        buoyancy::CASES,
        quiet::CASES,
        open_sides::CASES,
        contacts::CASES,
    ]);
    let by_file = gas.chain(coupled).chain([solids::CASES, clamped::CASES, ablations::CASES]).flatten();
    let mut cases: Vec<&Case> = by_file.collect();
    let by_file = cases.clone();
    cases.sort_by_key(|case| by_file.iter().position(|first| first.group == case.group));
    cases.into_iter()
}

/// Cases of a suite whose identifier, title or group contains `filter`, capitals or not.
#[must_use]
pub fn select(suite: Suite, filter: &str) -> Vec<&'static Case> {
    let filter = filter.to_lowercase();
    let named =
        |case: &Case| [case.id, case.title, case.group].iter().any(|text| text.to_lowercase().contains(&filter));
    cases().filter(|case| (case.quick || suite == Suite::Full) && named(case)).collect()
}

/// Runs cases, as many at a time as there are devices, and brings together what they found in the order of the cases. Small runs
/// leave a device idle between their dispatches; two at a time fill it. `done` is called after each case, with what it found.
///
/// # Errors
/// Beside what was found: the first driver error or wrong scene. No case starts after it.
pub fn perform(
    devices: &[Gpu],
    common: &Common<'_>,
    cases: &[&'static Case],
    done: &(dyn Fn(&Findings) + Sync),
) -> (Findings, Result<()>) {
    // the last cases run longest and start first
    let left = AtomicUsize::new(cases.len());
    let found = Mutex::new((0..cases.len()).map(|_| None).collect::<Vec<Option<_>>>());
    let work = |gpu: &Gpu| {
        while let Ok(index) = left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1)) {
            let index = index - 1;
            let result = Session::perform(gpu, common, cases[index]);
            if result.1.is_err() {
                left.store(0, Ordering::Relaxed);
            }
            done(&result.0);
            found.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(result);
        }
    };
    std::thread::scope(|scope| {
        for gpu in devices {
            scope.spawn(|| work(gpu));
        }
    });
    let mut findings = Findings::default();
    let mut outcome = Ok(());
    for (own, result) in found.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter().flatten() {
        findings.add(own);
        outcome = outcome.and(result);
    }
    findings.overview();
    (findings, outcome)
}

/// Conjugate gradient iterations that suffice for a relative residual in a uniform gas: half of sqrt(k) ln(2 / residual) with
/// the condition k = 1 + 4 d C^2 of the scaled operator, C = c dt / dx. For 1e-7 this is 8.4 sqrt(k).
/// [Saad, Iterative Methods for Sparse Linear Systems, 2003, eq. 6.128]
#[must_use]
pub fn iteration_bound(dimension: u32, courant: f64, residual: f64) -> f64 {
    0.5 * (1.0 + 4.0 * f64::from(dimension) * courant * courant).sqrt() * (2.0 / residual).ln()
}
