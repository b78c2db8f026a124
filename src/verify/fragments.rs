//! Isolated particles and all materials in strong flows.

use super::Case;
use super::books;
use super::drifting::GROUP;
use super::row::Limit;
use super::session::{Session, Setting, Suite};
use crate::Result;

/// The cases of this module.
pub(super) const CASES: &[Case] = &[
    Case {
        id: "fragments",
        title: "Shock through fragments",
        group: GROUP,
        quick: false,
        source: "Drag of the stream behind the shock; isolated particles as Y. Cao et al., ACM Trans. Graph. 41(5) (2022) 169, section 2.7, have them.",
        run: fragments,
    },
    Case {
        id: "materials_in_flow",
        title: "Materials in a strong flow",
        group: GROUP,
        quick: false,
        source: "Y. Cao et al., ACM Trans. Graph. 41(5) (2022) 169, Table 1: the moduli.",
        run: materials,
    },
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
        books::report(session, &journey, None);
    }
    Ok(())
}

/// Steps that each material must survive.
const STEPS: f64 = 1000.0;

/// Young's moduli with a heavy body, a thousand times as heavy as gas, and a light one in the same box.
fn materials(session: &mut Session<'_>) -> Result<()> {
    let quick = session.suite == Suite::Quick;
    let (cells, until) = if quick { (16, 8.5) } else { (32, 4.5) };
    let moduli: &[f64] = if quick { &[1e2] } else { &[1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8] };
    for &modulus in moduli {
        // sub-steps of the stiffest hold the step back: the steps count
        let until = if modulus > 1e4 { until * (1e4 / modulus).sqrt() } else { until };
        let kind = [format!("materials.stuff.neo_hookean.young_modulus={modulus:e}"), format!("time.until={until}")];
        let mut run = session.run("validation/materials_in_flow.toml", Setting::standard(cells), &kind)?;
        run.label = format!("{} E {modulus:e}", run.label);
        let finite = run.summary.max_speed.is_finite() && run.snapshot.energy.iter().all(|e| e.is_finite());
        let row = session.check(&run, "all values finite: 1", f64::from(u8::from(finite)));
        row.source("method").pass(Limit::AtLeast(1.0));
        session.check(&run, "steps", run.summary.steps as f64).source("method").pass(Limit::AtLeast(STEPS));
        session.check(&run, "largest speed", run.summary.max_speed).source("method");
        session.check(&run, "cells where the energy floor acted", run.summary.floored as f64).source("method");
        session.check(&run, "PCG iterations per step, mean", run.solver.mean_iterations).source("method");
    }
    Ok(())
}
