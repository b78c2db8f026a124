//! What must not happen: bodies at rest, or drifting with the gas, in a uniform state.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("slab_at_rest", "Slab at rest", group::COUPLING_1D, |session| rest(session, "coupled/slab_at_rest.toml", [0.7, 13.2]),
        "Exact: a uniform state stays."),
    Case::quick("shell_at_rest", "Shell at rest", group::COUPLING, |session| rest(session, "paper/fig13_ghost_update.toml", [2.0, 26.4]),
        "Exact: a uniform state stays; Y. Cao et al., ACM Trans. Graph. 41(5) (2022) 169, Fig. 13."),
    Case::quick("translation", "Disc that drifts with the gas", group::COUPLING, translation,
        "Exact; L. Monasse et al., J. Comput. Phys. 231 (2012) 2977, demand it."),
];

/// Why the gas is not quite at rest.
const RESIDUAL: &str = "what a step leaves is the tolerance of the solve, 1e-5; it does not grow";

/// Why a tighter tolerance does not cure it for good.
const ROUNDING: &str = "single precision: a shell is at 3e-6 after 250 steps";

/// What the mean of a random walk grows by from the first to the second half of its steps: 2 sqrt(2) - 1.
const RANDOM_WALK: f64 = 1.83;

/// Largest speed over that of sound, and how its mean grows from the first to the second half of a run, until the first end in the quick suite and the second in
/// the full one, 1000 steps.
fn rest(session: &mut Session<'_>, path: &str, ends: [f64; 2]) -> Result<()> {
    let until = ends[usize::from(session.suite == Suite::Full)];
    still_to(session, path, until, None)?;
    // with steps of a sound crossing of two cells, what is left at rest is the tolerance of the solve
    still_to(session, path, 0.5 * until, Some(1e-7))
}

/// Rows of [`rest`], with the tolerance of the scene or another.
fn still_to(session: &mut Session<'_>, path: &str, until: f64, tolerance: Option<f64>) -> Result<()> {
    let tighter: Vec<String> = tolerance.iter().map(|tolerance| format!("numerics.tolerance={tolerance:e}")).collect();
    let mut journey = session.follow(path, Setting::standard(0), &tighter, [0.5 * until, until])?;
    if let Some(tolerance) = tolerance {
        journey.run.label = format!("{} tolerance {tolerance:e}", journey.run.label);
    }
    let sound = journey.run.scene.gas.ambient.sound_speed(journey.run.scene.gas.gamma);
    let half = journey.run.records.iter().filter(|record| record.time <= 0.5 * until).count();
    let speeds = |records: &[StepRecord]| -> Vec<f64> {
        records.iter().map(|record| f64::from(record.gas_speed.max(record.solid_speed)) / sound).collect()
    };
    let largest = speeds(&journey.run.records).into_iter().fold(0.0, f64::max);
    let mean = |records: &[StepRecord]| speeds(records).iter().sum::<f64>() / records.len() as f64;
    let parts = [mean(&journey.run.records[..half]), mean(&journey.run.records[half..])];
    let row = session.check(&journey.run, "largest speed over that of sound", largest);
    let (most, why) = if tolerance.is_none() { (1e-3, RESIDUAL) } else { (1e-5, ROUNDING) };
    row.reference(0.0, "exact").pass(Limit::AtMost(1e-6)).known(Limit::AtMost(most), why);
    // what the steps leave adds up like a random walk; the quick suite is too short to tell that from growth
    let full = session.suite == Suite::Full && tolerance.is_none();
    let row = session.check(&journey.run, "largest speed, mean of the second half over the first", parts[1] / parts[0]);
    row.source("no more than a random walk");
    if full {
        row.pass(Limit::AtMost(RANDOM_WALK));
    }
    budgets_at_rest(session, &journey, false);
    Ok(())
}

/// Where energy goes while a body moves.
const DAMPED: &str = "each transfer between particles and grid damps what varies within a cell";

/// Budgets where nothing is exchanged: the gap of the momentum has nothing to be compared with but mass times speed of sound.
fn budgets_at_rest(session: &mut Session<'_>, journey: &Journey, moves: bool) {
    let [start, end] = &journey.budgets;
    let drift = end.drift_since(start);
    let run = &journey.run;
    for (name, most) in [("gas_mass", 1e-6), ("energy", 3e-5)] {
        let quantity = format!("{}, drift", name.replace('_', " "));
        let row = session.check(run, &quantity, drift[name].abs()).source("conservation law").pass(Limit::AtMost(most));
        if moves && name == "energy" {
            row.known(Limit::AtMost(5e-5), DAMPED);
        }
    }
    session.check(run, "PCG iterations per step, mean", run.solver.mean_iterations).source("method");
}

/// Why the pressure changes.
const COVERED: &str =
    "cells that the body covers or leaves are gas or solid as a whole, and their gas is settled over some steps";

fn translation(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[60] } else { &[60, 120] };
    for &cells in cells {
        let path = "validation/translation.toml";
        let journey = session.follow(path, Setting::standard(cells), &[], [0.85, 1.7])?;
        let run = &journey.run;
        let change: Vec<f32> = run.records.iter().map(|r| (r.pressure[1] - 1.0).max(1.0 - r.pressure[0])).collect();
        let mean = change.iter().map(|most| f64::from(*most)).sum::<f64>() / change.len() as f64;
        let row = session.check(run, "pressure, largest change, mean of all steps", mean);
        row.reference(0.0, "exact").pass(Limit::AtMost(1e-2)).known(Limit::AtMost(0.12), COVERED);
        let most = change.iter().copied().fold(0.0, f32::max);
        let row = session.check(run, "pressure, largest change of all steps", most.into());
        row.reference(0.0, "exact").pass(Limit::AtMost(1e-2)).known(Limit::AtMost(0.25), COVERED);
        let (_, body) = journey.path(0).swap_remove(2);
        let off = (body.centroid[0] - 1.45).hypot(body.centroid[1] - 0.5) / run.scene.domain.spacing();
        session.check(run, "centre, cells off its place", off).source("exact").pass(Limit::AtMost(0.1));
        budgets_at_rest(session, &journey, true);
    }
    Ok(())
}
