//! What must not happen: bodies at rest, or drifting with the gas, in a uniform state.

use crate::Result;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Run, Session, Setting, Suite};
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

/// Share of density, pressure and speed of sound that disturbs the gas, to see whether it grows.
const NOISE: f64 = 1e-6;

/// Why noise in gas grows faster beside a body.
const ALTERNATING: &str =
    "what alternates from cell to cell is unseen by the solve, and with bodies the velocities of cells feed it";

/// What the mean of a random walk grows by from the first to the second half of its steps: 2 sqrt(2) - 1.
const RANDOM_WALK: f64 = 1.83;

/// Largest speed over that of sound, until the first end in the quick suite and the second in the full one, 1000 steps: as the scene is, and
/// with noise on the gas, whose mean may grow like a random walk only.
fn rest(session: &mut Session<'_>, path: &str, ends: [f64; 2]) -> Result<()> {
    let until = ends[usize::from(session.suite == Suite::Full)];
    let (journey, _) = still_to(session, path, until, &[])?;
    let row = session.check(&journey.run, SPEED, largest(&journey.run));
    row.reference(0.0, "exact").pass(Limit::AtMost(1e-6));
    budgets_at_rest(session, &journey, false);
    let noise = [format!("gas.noise={NOISE:e}")];
    let (mut journey, growth) = still_to(session, path, until, &noise)?;
    journey.run.label = format!("{} noise {NOISE:e}", journey.run.label);
    let row = session.check(&journey.run, SPEED, largest(&journey.run));
    row.source("the tolerance of the solve, in every step").pass(Limit::AtMost(1e-3));
    // the quick suite is too short to tell a random walk from growth
    let full = session.suite == Suite::Full;
    let row = session.check(&journey.run, "largest speed, mean of the second half over the first", growth);
    row.source("no more than a random walk");
    if full {
        row.pass(Limit::AtMost(RANDOM_WALK)).known(Limit::AtMost(3.0), ALTERNATING);
    }
    budgets_at_rest(session, &journey, false);
    Ok(())
}

const SPEED: &str = "largest speed over that of sound";

/// Largest speed of gas and bodies over that of sound, of each step.
fn speeds(run: &Run) -> Vec<f64> {
    let sound = run.scene.gas.ambient.sound_speed(run.scene.gas.gamma);
    run.records.iter().map(|record| f64::from(record.gas_speed.max(record.solid_speed)) / sound).collect()
}

fn largest(run: &Run) -> f64 {
    speeds(run).into_iter().fold(0.0, f64::max)
}

/// Runs a scene with changes; its largest speed, mean of the second half over that of the first.
fn still_to(session: &mut Session<'_>, path: &str, until: f64, changes: &[String]) -> Result<(Journey, f64)> {
    let journey = session.follow(path, Setting::standard(0), changes, [0.5 * until, until])?;
    let half = journey.run.records.iter().filter(|record| record.time <= 0.5 * until).count();
    let speeds = speeds(&journey.run);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let growth = mean(&speeds[half..]) / mean(&speeds[..half]);
    Ok((journey, growth))
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
