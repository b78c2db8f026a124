//! Gas beside bodies is not colder than entropy allows.

use crate::Result;
use crate::snapshot::{Snapshot, kind};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Session, Setting};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("held_disc", "Held disc in a stream at Mach 2.5", group::ENTROPY, held_disc,
        "Minimum entropy principle [Tadmor 1986]: p / rho^gamma never falls below that of the stream."),
];

/// Looks per run.
const LOOKS: u32 = 8;

/// Lowest p / rho^gamma over that of the stream, where both are 1, and the largest Mach number of the gas.
fn extremes(snapshot: &Snapshot, gamma: f64) -> [f64; 2] {
    let mut found = [f64::INFINITY, 0.0_f64];
    for (index, _) in snapshot.kind.iter().enumerate().filter(|(_, own)| **own == kind::GAS) {
        let (density, pressure) = (f64::from(snapshot.density[index]), f64::from(snapshot.pressure[index]));
        let speed = snapshot.velocity[index].iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt();
        found[0] = found[0].min(pressure / density.powf(gamma));
        found[1] = found[1].max(speed / (gamma * pressure / density).sqrt());
    }
    found
}

fn held_disc(session: &mut Session<'_>) -> Result<()> {
    let path = "validation/held_disc.toml";
    let times = (1..=LOOKS).map(|k| 0.2 * f64::from(k) / f64::from(LOOKS));
    let journey = session.follow(path, Setting::standard(0), &[], times)?;
    let gamma = journey.run.scene.gas.gamma;
    let all: Vec<[f64; 2]> = journey.stops.iter().map(|stop| extremes(stop, gamma)).collect();
    let least = all.iter().map(|own| own[0]).fold(f64::INFINITY, f64::min);
    let fastest = all.iter().map(|own| own[1]).fold(0.0, f64::max);
    let run = &journey.run;
    let row = session.check(run, "lowest p / rho^gamma over that of the stream, all looks", least);
    row.source("minimum entropy principle").pass(Limit::AtLeast(0.89));
    let row = session.check(run, "largest Mach number, all looks", fastest);
    row.source("half of what it was where the thin cell paid for all").pass(Limit::AtMost(12.0));
    let drift = journey.budgets[1].drift_since(&journey.budgets[0])["energy"].abs();
    session.check(run, "energy, change over its start", drift).source("conservation law").pass(Limit::AtMost(3e-5));
    let floored = run.summary.floored as f64;
    session.check(run, "cells where the energy floor acted, all steps", floored).source("method");
    Ok(())
}
