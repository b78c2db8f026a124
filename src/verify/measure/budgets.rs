//! What coupled cases measure: how bodies move, and whether mass, momentum and energy close.

use crate::bodies::BodyState;
use crate::render::{Plot, Style};
use crate::snapshot::{ParticleSample, Snapshot};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Session};

/// Who demands closed budgets.
const LAW: &str = "conservation law";

/// Where trajectories come from.
pub(in crate::verify) const LAGRANGIAN: &str = "Lagrangian solver";

/// A place and a velocity that are known at a time \[s, m, m/s\].
pub(in crate::verify) type Station = [f64; 3];

impl Journey {
    /// Time and state of a body at the start and at each stop.
    pub(in crate::verify) fn path(&self, body: usize) -> Vec<(f64, BodyState)> {
        let count = self.run.scene.bodies.len();
        let states = self.stops.iter().map(|stop| (stop.time, stop.bodies(count).swap_remove(body)));
        states.collect()
    }

    /// Momentum that the particles got, one by one, at the stop where it was most \[kg m/s\].
    fn exchanged(&self) -> f64 {
        let start = &self.stops[0].particles;
        let got = |stop: &Snapshot| {
            let pairs = stop.particles.iter().zip(start);
            let change = |k: usize, (now, then): (&ParticleSample, &ParticleSample)| {
                f64::from(now.velocity[k] - then.velocity[k]).powi(2)
            };
            pairs.map(|pair| f64::from(pair.0.mass) * (0..3).map(|k| change(k, pair)).sum::<f64>().sqrt()).sum::<f64>()
        };
        self.stops.iter().map(got).fold(0.0, f64::max)
    }

    /// What is missing from the momentum of gas, solids and walls \[kg m/s\].
    fn momentum_gap(&self) -> f64 {
        let [start, end] = &self.budgets;
        (0..3).map(|axis| (end.momentum[axis] - start.momentum[axis]).powi(2)).sum::<f64>().sqrt()
    }

    /// Relative change of energy, with what has crossed the sides.
    pub(in crate::verify) fn energy_drift(&self) -> f64 {
        self.budgets[1].drift_since(&self.budgets[0])["energy"]
    }
}

/// Rows on mass, momentum, energy and solver of a coupled run; the momentum is compared with what the solids got.
pub(in crate::verify) fn report(session: &mut Session<'_>, journey: &Journey, energy: Option<f64>) {
    report_against(session, journey, energy, journey.exchanged());
}

/// As [`report`], with a limit of the energy's drift and one that is known to be missed, with the reason.
pub(in crate::verify) fn report_energy(
    session: &mut Session<'_>,
    journey: &Journey,
    most: f64,
    (known, why): (f64, &'static str),
) {
    report(session, journey, None);
    let row = session.check(&journey.run, "energy, drift, goal", journey.energy_drift());
    row.source(LAW).pass(Limit::Between(-most, most)).known(Limit::Between(-known, known), why);
}

/// As [`report`], with the momentum compared with an impulse \[kg m/s\].
pub(in crate::verify) fn report_against(
    session: &mut Session<'_>,
    journey: &Journey,
    energy: Option<f64>,
    impulse: f64,
) {
    let run = &journey.run;
    let drift = journey.budgets[1].drift_since(&journey.budgets[0]);
    session.check(run, "gas mass, drift", drift["gas_mass"].abs()).source(LAW).pass(Limit::AtMost(1e-6));
    let row = session.check(run, "momentum missing, over that exchanged", journey.momentum_gap() / impulse);
    row.source(LAW).pass(Limit::AtMost(1e-4));
    let row = session.check(run, "energy, drift", journey.energy_drift());
    row.source(LAW);
    if let Some(most) = energy {
        row.pass(Limit::Between(-most, most));
    }
    session.check(run, "PCG iterations per step, mean", run.solver.mean_iterations).source("method");
}

/// How far displacement and velocity of the first body may be from those of a table, as a share of each \[1\].
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct Gates {
    /// Share of the displacement.
    pub place: f64,
    /// Share of the velocity.
    pub velocity: f64,
}

/// Rows on the displacement along x of the first body: the last entry of a table, and the worst of all.
pub(in crate::verify) fn report_motion(
    session: &mut Session<'_>,
    journey: &Journey,
    source: &str,
    table: &[Station],
    gates: Option<Gates>,
) {
    let path = journey.path(0);
    let start = path[0].1.centroid[0];
    let mut worst = [0.0_f64; 2];
    for (time, place, velocity) in table.iter().map(|[t, x, v]| (*t, *x, *v)) {
        let Some((_, body)) = path.iter().find(|(at, _)| (at - time).abs() < 1e-6 * time) else { continue };
        let ours = [body.centroid[0] - start, body.velocity[0]];
        let errors = [(ours[0] / place - 1.0).abs(), (ours[1] / velocity - 1.0).abs()];
        worst = [worst[0].max(errors[0]), worst[1].max(errors[1])];
        if Some(&[time, place, velocity]) == table.last() {
            session.check(&journey.run, &format!("displacement at {time}"), ours[0]).reference(place, source);
            session.check(&journey.run, &format!("velocity at {time}"), ours[1]).reference(velocity, source);
        }
    }
    let count = table.len();
    let names = [("displacement", gates.map(|gates| gates.place)), ("velocity", gates.map(|gates| gates.velocity))];
    for ((name, gate), error) in names.into_iter().zip(worst) {
        let row = session.check(&journey.run, &format!("{name}, largest relative error of {count} times"), error);
        row.source(source);
        if let Some(gate) = gate {
            row.pass(Limit::AtMost(gate));
        }
    }
}

/// Displacement of the first body over time, ours and that of a table.
pub(in crate::verify) fn motion_plot(journey: &Journey, source: &str, table: &[Station]) -> Plot {
    let path = journey.path(0);
    let start = path[0].1.centroid[0];
    let ours = path.iter().map(|(time, body)| [*time, body.centroid[0] - start]).collect();
    Plot::new(format!("{}: displacement", journey.run.scene.title), "time", "displacement")
        .with(source, Style::Reference, table.iter().map(|[time, place, _]| [*time, *place]).collect())
        .with(journey.run.label.clone(), Style::Marks, ours)
}
