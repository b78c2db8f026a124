//! What must not happen: noise that grows in gas at rest, and mass or energy that a closed box loses.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::scene::Pair;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("rest_noise", "Noise on gas at rest", group::QUIET, rest_noise,
        "The second law: nothing feeds noise of 1e-3 in a closed box. The goal is a pressure noise below 2e-3 after 300 steps in \
                 which sound crosses 0.5, 5 and 20 cells."),
    Case::full("closed_box", "Closed boxes for 10,000 steps", group::QUIET, closed_box,
        "Conservation of mass and energy, in single precision."),
];

/// Steps of every run with noise.
const STEPS: u32 = 300;
/// Ends a run a little before its last step would need a short one more.
const SHORT: f64 = 1e-6;

/// A box: dimension, cells along each axis, Courant numbers.
type Room = (u32, u32, &'static [f64]);

fn rest_noise(session: &mut Session<'_>) -> Result<()> {
    let quick: &[Room] = &[(2, 32, &[5.0]), (3, 12, &[0.5, 5.0, 20.0])];
    let full: &[Room] = &[(2, 64, &[0.5, 5.0, 20.0]), (3, 16, &[0.5, 5.0, 20.0]), (3, 32, &[0.5, 5.0, 20.0])];
    let (rooms, integrators): (_, &[Integrator]) = match session.suite {
        Suite::Quick => (quick, &[Integrator::Predictor]),
        Suite::Full => (full, &[Integrator::Predictor, Integrator::Ars222]),
    };
    for &integrator in integrators {
        for &(dimension, cells, courants) in rooms {
            for &courant in courants {
                rest_noise_in(session, (Pair::default(), integrator), [dimension, cells], courant)?;
            }
        }
    }
    rest_noise_in(session, (Pair::B2b1, Integrator::Predictor), [2, 32], 5.0)
}

fn rest_noise_in(
    session: &mut Session<'_>,
    (pair, integrator): (Pair, Integrator),
    [dimension, cells]: [u32; 2],
    courant: f64,
) -> Result<()> {
    let list = |value: &str| vec![value; dimension as usize].join(", ");
    // cells of edge 1
    let step = courant / 1.4_f64.sqrt();
    let until = f64::from(STEPS) * step * (1.0 - SHORT);
    let overrides = [
        format!("domain.dimension={dimension}"),
        format!("domain.cells=[{}]", list(&cells.to_string())),
        format!("domain.size=[{}]", list(&format!("{cells}.0"))),
        format!("time.fixed_step={step}"),
        format!("time.until={until}"),
        "probes=[]".to_owned(),
        "expect.probes=[]".to_owned(),
    ];
    let setting = Setting { pair, integrator, cells: 0 };
    let run = session.run("validation/rest_noise.toml", setting, &overrides)?;
    let off = |record: &StepRecord| f64::from((record.pressure[1] - 1.0).max(1.0 - record.pressure[0]));
    let [last, first] = [run.records.last(), run.records.first()].map(|record| record.map_or(f64::NAN, off));
    let named = |what: &str| format!("Courant {courant}: largest |dp| / p after {what}");
    let row = session.check(&run, &named("300 steps"), last);
    row.source("goal: twice the noise at the start").pass(Limit::AtMost(2e-3));
    session.check(&run, &named("the first step"), first).source("reported");
    Ok(())
}

/// A round explosion off the centre of a box, and a shock that runs to and fro in a tube.
fn closed_box(session: &mut Session<'_>) -> Result<()> {
    let off_center = "gas.regions[0].shape={ sphere = { center = [0.17, -0.06], radius = 0.4 } }";
    let boxes = [("paper/fig16_convergence.toml", 32, 0.005, Some(off_center)), ("gas/sod.toml", 100, 0.002, None)];
    for (path, cells, step, more) in boxes {
        let until = 10_000.0 * step * (1.0 - SHORT);
        let mut overrides = vec![format!("time.fixed_step={step}"), format!("time.until={until}")];
        overrides.extend(more.map(str::to_owned));
        for (pair, integrator) in
            [(Pair::B1b0, Integrator::Predictor), (Pair::B2b1, Integrator::Predictor), (Pair::B1b0, Integrator::Ars222)]
        {
            let journey = session.follow(path, Setting { pair, integrator, cells }, &overrides, [until])?;
            let (run, drift) = (&journey.run, journey.budgets[1].drift_since(&journey.budgets[0]));
            session.check(run, "steps", run.summary.steps as f64).pass(Limit::AtLeast(1e4));
            let row = session.check(run, "gas mass, change over its start", drift["gas_mass"].abs());
            row.source("conservation law").pass(Limit::AtMost(1e-6));
            let row = session.check(run, "energy, change over its start", drift["energy"].abs());
            row.source("conservation law").pass(Limit::AtMost(1e-5));
            let floored = run.summary.floored as f64;
            session.check(run, "cells where the energy floor acted, all steps", floored).source("method");
        }
    }
    Ok(())
}
