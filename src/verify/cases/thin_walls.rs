//! Walls about as thick as a cell: gas stays on its side.

use crate::Result;
use crate::snapshot::kind;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("thin_vessel", "Vessel with walls of one cell", group::COUPLING, vessel,
        "Exact: a state of rest stays, whatever the wall's angle and particles."),
];

fn vessel(session: &mut Session<'_>) -> Result<()> {
    let angles: &[u32] = if session.suite == Suite::Quick { &[15, 30] } else { &[0, 15, 30, 45] };
    for &degrees in angles {
        for particles in [2, 3, 4] {
            let overrides = [
                format!("gas.regions[0].shape.rotate.degrees={degrees}"),
                format!("bodies[0].shape.rotate.degrees={degrees}"),
                format!("bodies[0].particles_per_cell={particles}"),
            ];
            let mut run = session.run("validation/thin_vessel.toml", Setting::standard(0), &overrides)?;
            run.label = format!("{} at {degrees} degrees, {particles} particles", run.label);
            let row = session.check(&run, "largest |p / p0 - 1| of gas on either side", unrest(&run));
            row.source("exact").pass(Limit::AtMost(1e-3));
            let floored = run.summary.floored as f64;
            session.check(&run, "cells where the energy floor acted", floored).source("exact").pass(Limit::AtMost(0.0));
        }
    }
    Ok(())
}

/// How far the gas is from the pressure of its side, which is that nearer to its own.
fn unrest(run: &Run) -> f64 {
    let gas = run.snapshot.kind.iter().zip(&run.snapshot.pressure).filter(|(kind, _)| **kind == kind::GAS);
    let off = |p: f64| f64::min((p - 1.0).abs(), (p / 10.0 - 1.0).abs());
    gas.map(|(_, pressure)| off(f64::from(*pressure))).fold(0.0, f64::max)
}
