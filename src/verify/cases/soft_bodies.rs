//! Bodies in gas far above their stiffness: they gain no energy, and the run comes to its end.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("soft_bodies", "Soft balls under high pressure", group::COUPLING, soft_bodies,
        "Conservation of energy."),
];

/// Pressures of the hot gas over Young's modulus of the balls, and ends of the runs \[s\].
const RATIOS: [[f64; 2]; 3] = [[100.0, 0.2], [10.0, 0.5], [1000.0, 0.1]];

fn soft_bodies(session: &mut Session<'_>) -> Result<()> {
    let count = if session.suite == Suite::Quick { 1 } else { RATIOS.len() };
    for [ratio, until] in RATIOS.into_iter().take(count) {
        let overrides = [format!("gas.regions[0].pressure={:?}", 100.0 * ratio), format!("time.until={until:?}")];
        let mut run = session.run("validation/soft_bodies.toml", Setting::standard(0), &overrides)?;
        run.label = format!("{}, p / E {ratio}", run.label);
        let energies: Vec<f64> = run.records.iter().map(energy).collect();
        let start = energies.first().copied().unwrap_or(f64::NAN);
        let most = energies.iter().fold(f64::NEG_INFINITY, |most, own| most.max(*own));
        let row = session.check(&run, "energy, most over its start", most / start - 1.0);
        row.source("conservation law").pass(Limit::AtMost(0.02));
        let end = energies.last().copied().unwrap_or(f64::NAN);
        let row = session.check(&run, "energy, change at the end", end / start - 1.0);
        row.source("conservation law").pass(Limit::Between(-0.02, 0.02));
        session.check(&run, "least volume of a particle over that at rest", least_volume(&run)).source("method");
    }
    Ok(())
}

/// Energy of gas, ledger and bodies \[J\]; the walls of the box do no work.
fn energy(record: &StepRecord) -> f64 {
    let bodies = record.elastic_energy + record.ghost_energy + record.plastic_heat;
    f64::from(record.gas.energy) + f64::from(record.owed.energy) + f64::from(record.solid.energy + bodies)
}

fn least_volume(run: &Run) -> f64 {
    run.snapshot.particles.iter().map(|particle| f64::from(particle.volume_ratio())).fold(f64::INFINITY, f64::min)
}
