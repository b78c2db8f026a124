//! Isolated particles and all materials in strong flows.

use crate::Result;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Session, Setting};
use crate::verify::harness::{Case, group};
use crate::verify::measure::budgets;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::full("fragments", "Shock through fragments", group::COUPLING, fragments,
        "Drag of the stream behind the shock; isolated particles as Y. Cao et al., ACM Trans. Graph. 41(5) (2022) 169, section 2.7, have them."),
    Case::full("materials_in_flow", "Materials in a strong flow", group::COUPLING, materials,
        "Y. Cao et al., ACM Trans. Graph. 41(5) (2022) 169, Table 1: its materials."),
];

/// Density of the fragments, the end of the run, and what their mean velocity must lie between then.
const CLOUDS: [(f64, f64, Limit); 3] = [
    (1000.0, 0.2, Limit::Between(0.15, 0.6)),
    (10.0, 0.275, Limit::Between(2.1, 2.4)),
    (1.0, 0.275, Limit::Between(2.1, 2.4)),
];

fn fragments(session: &mut Session<'_>) -> Result<()> {
    for (density, until, limit) in CLOUDS {
        let weight = [format!("bodies[0].density={density}"), format!("time.until={until}")];
        let mut journey =
            session.follow("validation/fragments.toml", Setting::standard(0), &weight, [0.5 * until, until])?;
        journey.run.label = format!("{} density {density}", journey.run.label);
        let run = &journey.run;
        let (_, body) = journey.path(0).swap_remove(2);
        session.check(run, "particles inside", body.particles as f64).source("method");
        let row = session.check(run, "mean velocity at the end", body.velocity[0]);
        row.reference(if density > 100.0 { 0.3 } else { 2.222 }, "drag").pass(limit);
        session.check(run, "cells where the energy floor acted", run.summary.floored as f64).source("method");
        session.check(run, "largest speed of the gas", run.summary.max_speed).source("method").pass(Limit::AtMost(8.0));
        budgets::report(session, &journey, None);
    }
    Ok(())
}

/// Steps that each material must survive.
const STEPS: f64 = 1000.0;

/// Figure, Young's modulus, Poisson ratio, and yield stress of what is plastic.
type Material = (&'static str, f64, f64, Option<f64>);

/// Materials of Table 1, and the stiffest without yield.
const TABLE_1: [Material; 20] = [
    ("1 body", 2e4, 0.22, Some(600.0)),
    ("1 tyres", 1.5e3, 0.22, None),
    ("2 strong elastic", 1600.0, 0.22, None),
    ("2 weak elastic", 200.0, 0.22, None),
    ("2 iron", 2e4, 0.22, Some(600.0)),
    ("3", 100.0, 0.3, None),
    ("4 strong", 1e8, 0.27, Some(1.7e6)),
    ("4 weak", 5e7, 0.334, Some(5.2e5)),
    ("5", 1e6, 0.25, None),
    ("6 elastic", 1.5e3, 0.25, None),
    ("6 plastic", 2e4, 0.25, Some(600.0)),
    ("8", 1e6, 0.25, Some(2.6e3)),
    ("10 strong elastic", 1e3, 0.35, None),
    ("10 weak elastic", 200.0, 0.35, None),
    ("10 strong plastic", 1e4, 0.35, Some(150.0)),
    ("10 weak plastic", 5e3, 0.35, Some(75.0)),
    ("11", 1e8, 0.25, Some(2.6e5)),
    ("12", 1e6, 0.25, Some(6e4)),
    ("19", 1e3, 0.22, None),
    ("11, without yield", 1e8, 0.25, None),
];

/// From this modulus on a step would need hundreds of elastic sub-steps.
const STIFF: f64 = 1e6;

/// Each as a body a thousand times as heavy as the gas and as one lighter than it, in the same box; the stiff ones by backward Euler.
fn materials(session: &mut Session<'_>) -> Result<()> {
    TABLE_1.into_iter().try_for_each(|material| in_flow(session, material))
}

fn in_flow(session: &mut Session<'_>, (figure, modulus, poisson, yield_stress): Material) -> Result<()> {
    let elasticity = if modulus < STIFF { "explicit" } else { "implicit" };
    // the steps count: backward Euler holds them to 1000 cells of the elastic wave
    let until = f64::min(7.5, 3.2 * (1e8 / modulus).sqrt());
    let elastic = format!("young_modulus = {modulus:e}, poisson_ratio = {poisson}");
    let law = match yield_stress {
        None => format!("{{ neo_hookean = {{ {elastic} }} }}"),
        Some(stress) => format!("{{ von_mises = {{ {elastic}, yield_stress = {stress:e} }} }}"),
    };
    let kind =
        [format!("materials.stuff={law}"), format!("time.until={until}"), format!("numerics.elasticity={elasticity}")];
    let path = "validation/materials_in_flow.toml";
    let mut journey = session.follow(path, Setting::standard(0), &kind, [0.5 * until, until])?;
    journey.run.label = format!("{} figure {figure} {elasticity}", journey.run.label);
    let run = &journey.run;
    let finite = run.summary.max_speed.is_finite() && run.snapshot.energy.iter().all(|e| e.is_finite());
    let row = session.check(run, "all values finite: 1", f64::from(u8::from(finite)));
    row.source("method").pass(Limit::AtLeast(1.0));
    session.check(run, "steps", run.summary.steps as f64).source("method").pass(Limit::AtLeast(STEPS));
    session.check(run, "largest speed", run.summary.max_speed).source("method");
    session.check(run, "cells where the energy floor acted", run.summary.floored as f64).source("method");
    let clamped: u64 = run.records.iter().map(|record| u64::from(record.clamped)).sum();
    session.check(run, "particles clamped", clamped as f64).source("method");
    budgets::report(session, &journey, None);
    Ok(())
}
