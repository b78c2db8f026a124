//! Elastic bodies in thin gas against mechanics: impact, waves, collision, spin.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::expect::Budget;
use crate::render::{Plot, Style};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::solids::{front, mean_velocity, mechanical};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("striking_bar", "Bar that strikes a wall", group::SOLIDS, bar,
        "Saint-Venant's solution; S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 1970, section 168."),
    Case::quick("elastic_waves", "Elastic waves", group::SOLIDS, waves,
        "Speed of plane longitudinal waves, exact."),
    Case::quick("colliding_discs", "Colliding discs", group::SOLIDS, discs,
        "D. Sulsky, Z. Chen, H. L. Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179, section 7.3; affine particle-in-cell code."),
    Case::quick("spinning_disc", "Spinning disc", group::SOLIDS, disc,
        "C. Jiang, C. Schroeder, J. Teran, J. Comput. Phys. 338 (2017) 137: angular momentum is kept."),
];

/// When the momentum of the solids along x passes a level from below, linear between steps \[s\].
fn passes(records: &[StepRecord], level: f64) -> f64 {
    let points: Vec<[f64; 2]> = records.iter().map(|r| [r.time, r.solid.momentum[0].into()]).collect();
    let found = points.windows(2).find(|pair| pair[0][1] < level && pair[1][1] >= level);
    found.map_or(f64::NAN, |pair| {
        pair[0][0] + (level - pair[0][1]) / (pair[1][1] - pair[0][1]) * (pair[1][0] - pair[0][0])
    })
}

fn bar(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[150] } else { &[150, 300, 600] };
    for &cells in cells {
        let run = session.run("validation/striking_bar.toml", Setting::standard(cells), &[])?;
        let momentum = 2.5;
        let [first, last] = [-0.5, 0.5].map(|share| passes(&run.records, share * momentum));
        // the force is constant while the bar touches: half of the change of momentum takes half of the time
        session.check(&run, "time of contact", 2.0 * (last - first)).reference(5.0, "2 L / c").within(0.03);
        session.check(&run, "stress", momentum / (last - first)).reference(1.0, "rho c v").within(0.03);
        let velocity = run.snapshot.bodies(1)[0].velocity[0];
        session.check(&run, "velocity of the rebound", velocity).reference(0.1, "Saint-Venant").within(0.03);
        session.check(&run, "energy left", run.snapshot_energy() / 0.125).reference(1.0, "exact");
        let plot = Plot::new("Bar that strikes a wall: momentum", "time", "momentum");
        let ours = run.records.iter().map(|r| [r.time, r.solid.momentum[0].into()]).collect();
        session.plot(plot.with(run.label.clone(), Style::Line, ours));
    }
    Ok(())
}

impl Run {
    /// Kinetic and elastic energy of the solids at the end \[J\].
    fn snapshot_energy(&self) -> f64 {
        self.records.last().map_or(f64::NAN, mechanical)
    }
}

fn waves(session: &mut Session<'_>) -> Result<()> {
    let most = if session.suite == Suite::Quick { 2 } else { 3 };
    for axes in 1..=most {
        let vector = |first: &str, other: &str| format!("[{}]", [first, other, other][..axes].join(", "));
        let mut shape = vec![
            format!("domain.dimension={axes}"),
            format!("domain.size={}", vector("1.0", "0.02")),
            format!("domain.cells={}", vector("200", "4")),
            format!("bodies[0].velocity={}", vector("0.1", "0.0")),
            format!("bodies[1].velocity={}", vector("0.0", "0.0")),
        ];
        for (body, center) in [(0, "0.275"), (1, "0.725")] {
            shape.push(format!("bodies[{body}].shape.box.center={}", vector(center, "0.01")));
            shape.push(format!("bodies[{body}].shape.box.size={}", vector("0.45", "0.02")));
        }
        let path = "validation/elastic_waves.toml";
        let journey = session.follow(path, Setting::standard(0), &shape, [0.003, 0.008])?;
        report_waves(session, &journey);
    }
    Ok(())
}

fn report_waves(session: &mut Session<'_>, journey: &Journey) {
    let [_, early, late] = &journey.stops[..] else { return };
    let run = &journey.run;
    // lambda = mu = 4e5 at this Poisson ratio
    let speed = 34.641;
    let fronts = [early, late].map(|stop| front(stop, 0.025));
    let measured = (fronts[1] - fronts[0]) / (late.time - early.time);
    session.check(run, "speed of the wave", measured).reference(speed, "(lambda + 2 mu) / rho").within(0.01);
    let behind = mean_velocity(late, [0.4, 0.6]);
    session.check(run, "velocity behind", behind).reference(0.05, "symmetry").within(0.01);
    let points = late.particles.iter().map(|p| [f64::from(p.position[0]), f64::from(p.velocity[0])]).collect();
    let run_to = 0.5 + speed * late.time;
    let exact = vec![[0.5, 0.05], [run_to, 0.05], [run_to, 0.0], [0.95, 0.0]];
    let plot = Plot::new(format!("Elastic waves, {}D", run.scene.domain.dimension), "x", "velocity");
    session.plot(plot.with("exact", Style::Reference, exact).with(run.label.clone(), Style::Marks, points));
}

/// Cells, and the least share of the energy that must be left.
const DISCS: [(u32, f64); 2] = [(20, 0.60), (40, 0.77)];

fn discs(session: &mut Session<'_>) -> Result<()> {
    let count = if session.suite == Suite::Quick { 1 } else { DISCS.len() };
    for (cells, kept) in DISCS.into_iter().take(count) {
        let journey = session.follow("validation/colliding_discs.toml", Setting::standard(cells), &[], [3.0])?;
        let run = &journey.run;
        let start = journey.stops[0].bodies(2);
        let kinetic = |bodies: &[crate::bodies::BodyState]| {
            bodies.iter().map(|b| 0.5 * b.mass * (b.velocity[0].powi(2) + b.velocity[1].powi(2))).sum::<f64>()
        };
        let all = kinetic(&start);
        let energies = run.records.iter().map(|record| mechanical(record) / all);
        session
            .check(run, "largest energy over that at the start", energies.fold(0.0, f64::max))
            .source("mechanics")
            .pass(Limit::AtMost(1.01));
        let row = session.check(run, "energy left at 3", run.snapshot_energy() / all);
        row.source("affine particle-in-cell code").pass(Limit::AtLeast(kept));
        let [low, high] = [0, 1].map(|body| journey.path(body)[1].1.velocity);
        let momentum = (low[0] + high[0]).hypot(low[1] + high[1]) * start[0].mass;
        let scale = start[0].mass * 0.1 * std::f64::consts::SQRT_2;
        session
            .check(run, "momentum over that of a disc", momentum / scale)
            .source("symmetry")
            .pass(Limit::AtMost(1e-4));
        let met = run.records.iter().find(|record| mechanical(record) - f64::from(record.solid.energy) > 1e-3 * all);
        let time = met.map_or(f64::NAN, |record| record.time);
        // quadratic weights feel each other 2.5 cells early
        let early = 1.085_79 - 2.5 * run.scene.domain.spacing() / (0.2 * std::f64::consts::SQRT_2);
        session.check(run, "time of contact", time).reference(1.085_79, "exact").pass(Limit::AtLeast(early));
    }
    Ok(())
}

fn disc(session: &mut Session<'_>) -> Result<()> {
    let quick = session.suite == Suite::Quick;
    let run_until = if quick { 0.1 * std::f64::consts::PI } else { std::f64::consts::TAU };
    let until = [format!("time.until={run_until}")];
    let journey = session.follow("validation/spinning_disc.toml", Setting::standard(0), &until, [run_until])?;
    let path = journey.path(0);
    let [start, end] = [0, 1].map(|k| path[k].1.angular_momentum[2]);
    let row = session.check(&journey.run, "angular momentum, share lost", (end / start - 1.0).abs());
    row.reference(0.0, "Jiang et al. 2017").pass(Limit::AtMost(1e-2)).good(Limit::AtMost(1e-4));
    session.check(&journey.run, "angular momentum at the start", start).reference(25.133, "m R^2 omega / 2");
    let moved = (path[1].1.centroid[0] - 0.3).hypot(path[1].1.centroid[1] - 0.3);
    session.check(&journey.run, "centre, moved by", moved).source("exact").pass(Limit::AtMost(1e-3));
    let kinetic = journey.run.records.last().map_or(f64::NAN, |record| record.solid.energy.into());
    // the affine motion of particles counts in both
    let rigid = 0.5 * start * 10.0;
    session.check(&journey.run, "kinetic energy at the end", kinetic).reference(rigid, "rigid").within(0.02);
    let drift = Budget::drift_since(&journey.budgets[1], &journey.budgets[0])["energy"];
    session.check(&journey.run, "energy, drift", drift).source("conservation law");
    Ok(())
}
