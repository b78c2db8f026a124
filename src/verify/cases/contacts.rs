//! Contacts that drift: where density alone steps, pressure and velocity stay even.

use crate::Result;
use crate::scene::Pair;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("drifting_contact", "Drifting contact", group::WAVES, drifting,
        "Exact: pressure and velocity stay even where density alone steps."),
];

/// Density of the slab, speed of the gas, largest deviation of the pressure.
const QUICK: &[(f64, f64, f64)] = &[(1000.0, 1.0, 5e-4), (1000.0, 0.1, 5e-5), (10.0, 1.0, 1e-5)];

fn drifting(session: &mut Session<'_>) -> Result<()> {
    let pairs = [(Pair::B1b0, Integrator::Predictor), (Pair::B1b0, Integrator::Ars222)];
    let count = if session.suite == Suite::Full { 2 } else { 1 };
    for &(pair, integrator) in &pairs[..count] {
        for &(density, speed, limit) in QUICK {
            let overrides = [
                format!("gas.regions[0].density={density:?}"),
                format!("gas.regions[0].velocity=[{speed:?}]"),
                format!("gas.ambient.velocity=[{speed:?}]"),
                format!("time.until={:?}", 1.0 / speed),
            ];
            let setting = Setting { pair, integrator, cells: 200 };
            let run = session.run("validation/drifting_contact.toml", setting, &overrides)?;
            let off = run.records.iter().map(|r| f64::from((r.pressure[1] - 1.0).max(1.0 - r.pressure[0])));
            let name = format!("density {density} : 1, speed {speed}: largest |p - 1| in one turn");
            session.check(&run, &name, off.fold(0.0, f64::max)).reference(0.0, "exact").pass(Limit::AtMost(limit));
        }
    }
    Ok(())
}
