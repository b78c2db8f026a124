//! Elastic bodies that are held at one end, against mechanics: bars and a beam.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::render::{Plot, Style};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::solids::mechanical;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("hanging_bar", "Bar under sudden gravity", group::SOLIDS, hanging,
        "Exact wave solution; S. P. Timoshenko, D. H. Young, Vibration Problems in Engineering, 1955."),
    Case::full("vibrating_bar", "Axial vibration of a bar", group::SOLIDS, vibrating,
        "Exact, d'Alembert; test \"axial vibration of a bar\" of the material point code Tesserae (A. de Vaucorbeil, V. P. Nguyen). There the first mode is the initial velocity; here the driven end makes it, exactly."),
    Case::full("cantilever", "Cantilever", group::SOLIDS, cantilever,
        "Beam of S. P. Timoshenko (Philosophical Magazine 41 (1921) 744) in plane strain, shear coefficient 5/6."),
    Case::full("sprung_piston", "Piston on a spring closes a chamber", group::COUPLING_1D, sprung,
        "Exact, linear: m w^2 = k + rho c w cot(w L / c). The spring is an elastic bar."),
];

/// Angular frequency of the piston on a spring.
const SPRUNG: f64 = 1.025_441;

fn sprung(session: &mut Session<'_>) -> Result<()> {
    let period = 2.0 * std::f64::consts::PI / SPRUNG;
    for cells in [220, 440] {
        let path = "validation/sprung_piston.toml";
        let journey = session.follow(path, Setting::standard(cells), &[], moments(3.0 * period, 48))?;
        let run = &journey.run;
        let times = turns(&run.records);
        let count = times.len().saturating_sub(1) as f64;
        let found =
            std::f64::consts::PI * count / (times.last().unwrap_or(&f64::NAN) - times.first().unwrap_or(&f64::NAN));
        let row = session.check(run, "angular frequency", found).reference(SPRUNG, "linear acoustics");
        row.within(0.01);
        session.check(run, "the same in a vacuum", 1.0).source("spring and mass");
        let swing = |half: f64| {
            let near = run.records.iter().filter(|r| ((r.time / period) - half).abs() < 0.3);
            near.map(|r| f64::from(r.solid.momentum[0]).abs()).fold(0.0, f64::max)
        };
        let row = session.check(run, "amplitude after two periods over that after one", swing(2.0) / swing(1.0));
        row.reference(1.0, "linear acoustics").within(0.05);
        let row = session.check(run, "energy, drift", journey.energy_drift());
        row.source("conservation law").pass(Limit::Between(-1e-3, 1e-3));
        let plot = Plot::new("Piston on a spring: momentum", "time", "momentum");
        let exact = run.records.iter().map(|r| [r.time, 0.2 * (SPRUNG * r.time).cos()]).collect();
        let ours = run.records.iter().map(|r| [r.time, r.solid.momentum[0].into()]).collect();
        session.plot(plot.with("linear", Style::Reference, exact).with(run.label.clone(), Style::Line, ours));
    }
    Ok(())
}

/// Who knows the exact vibration.
const EXACT: &str = "wave equation";

/// Times at which the momentum of the solids along x changes its sign, linear between steps \[s\].
fn turns(records: &[StepRecord]) -> Vec<f64> {
    let points: Vec<[f64; 2]> = records.iter().map(|r| [r.time, r.solid.momentum[0].into()]).collect();
    let pairs = points.windows(2).filter(|pair| pair[0][1] * pair[1][1] < 0.0);
    let zero = |pair: &[[f64; 2]]| pair[0][0] - pair[0][1] * (pair[1][0] - pair[0][0]) / (pair[1][1] - pair[0][1]);
    pairs.map(zero).collect()
}

impl Journey {
    /// Mean displacement along an axis, at the start and at each stop, of particles that lie at the start where `chosen` says \[s, m\].
    fn displacement(&self, axis: usize, chosen: impl Fn([f32; 3]) -> bool) -> Vec<[f64; 2]> {
        let start = &self.stops[0].particles;
        let list: Vec<usize> = (0..start.len()).filter(|k| chosen(start[*k].position)).collect();
        let mean = |stop: &crate::snapshot::Snapshot| {
            let moved = |k: &usize| f64::from(stop.particles[*k].position[axis] - start[*k].position[axis]);
            list.iter().map(moved).sum::<f64>() / list.len() as f64
        };
        self.stops.iter().map(|stop| [stop.time, mean(stop)]).collect()
    }
}

/// Times from 0 to `until`, without the first.
fn moments(until: f64, count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(move |k| until * f64::from(k) / f64::from(count))
}

fn hanging(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[65] } else { &[65, 130, 260, 520] };
    let (fallen, period, until) = (0.004_905, 0.126_491_1, 0.14);
    for &cells in cells {
        let end = [format!("time.until={until}")];
        let times = moments(until, 28);
        let journey = session.follow("validation/hanging_bar.toml", Setting::standard(cells), &end, times)?;
        let run = &journey.run;
        let tip = 1.2 - 0.5 * run.scene.domain.spacing();
        let path = journey.displacement(0, |at| f64::from(at[0]) > tip);
        let [least, most] =
            path[1..].iter().fold([f64::INFINITY, 0.0], |[a, b]: [f64; 2], p| [a.min(p[1]), b.max(p[1])]);
        let row = session.check(run, "largest displacement of the tip, over the static one", most / fallen);
        row.reference(2.0, EXACT).within(0.02).known(Limit::Between(2.0, 2.08), CLAMP);
        let row = session.check(run, "least one after a period", least / fallen);
        row.reference(0.0, EXACT).pass(Limit::Between(-0.02, 0.1));
        let found = turns(&run.records).get(1).copied().unwrap_or(f64::NAN);
        session.check(run, "period", found).reference(period, EXACT).within(0.02);
        let exact = (0..=56).map(|k| f64::from(k) * 0.0025).map(|time| [time, fallen * swing(time / period)]).collect();
        let plot = Plot::new("Bar under sudden gravity: tip", "time", "displacement");
        session.plot(plot.with(EXACT, Style::Reference, exact).with(run.label.clone(), Style::Marks, path));
    }
    Ok(())
}

/// Displacement of the tip over the static one at a time in periods: parabolas between waves that pass the tip. [d'Alembert]
fn swing(time: f64) -> f64 {
    let phase = (time + 0.25).rem_euclid(1.0) - 0.25;
    if phase < 0.25 { 16.0 * phase * phase } else { 2.0 - 16.0 * (phase - 0.5).powi(2) }
}

/// Why the bar is too long.
const CLAMP: &str = "a clamp ends on a node, up to half a cell inside its face, and rubber softens: 1 % of the modulus at the strain of 2 %";
/// Why the beam bends too far.
const LONG: &str =
    "a clamp ends on a node, half a cell inside its face: the beam is 1/128 longer, which bends it 3.2 % more";
/// Why the centre is late.
const PHASE: &str =
    "after four periods that are 0.1 % (coarse: 0.4 %) too long: the clamp ends up to half a cell inside its face";

fn vibrating(session: &mut Session<'_>) -> Result<()> {
    let (held, period, speed) = (5.0, 10.0, 0.063_661_977);
    for cells in [150, 300, 600] {
        let run = session.run("validation/vibrating_bar.toml", Setting::standard(cells), &[])?;
        let free: Vec<StepRecord> = run.records.iter().filter(|record| record.time > 1.01 * held).cloned().collect();
        let times = turns(&free);
        let count = times.len().saturating_sub(1) as f64;
        let found = 2.0 * (times.last().unwrap_or(&f64::NAN) - times.first().unwrap_or(&f64::NAN)) / count;
        session.check(&run, "period", found).reference(period, EXACT).within(0.01);
        let angle = |time: f64| 2.0 * std::f64::consts::PI * (time - held) / period;
        let velocity = |record: &StepRecord| f64::from(record.solid.momentum[0]) / 25.0;
        let off = free.iter().map(|record| (velocity(record) / speed - angle(record.time).cos()).abs());
        let row = session.check(&run, "velocity of the centre, largest error over its peak", off.fold(0.0, f64::max));
        row.reference(0.0, EXACT).pass(Limit::AtMost(0.025)).known(Limit::AtMost(0.11), PHASE);
        let energy = [free.first(), free.last()].map(|record| record.map_or(f64::NAN, mechanical));
        session.check(&run, "energy when the end is held", energy[0]).reference(0.0625, EXACT);
        let row = session.check(&run, "energy after four periods, over that", energy[1] / energy[0]);
        row.reference(1.0, EXACT).within(0.01);
        let plot = Plot::new("Axial vibration: velocity of the centre", "time", "velocity");
        let exact = free.iter().map(|record| [record.time, speed * angle(record.time).cos()]).collect();
        let ours = free.iter().map(|record| [record.time, velocity(record)]).collect();
        session.plot(plot.with(EXACT, Style::Reference, exact).with(run.label.clone(), Style::Marks, ours));
    }
    Ok(())
}

/// Mean, amplitude and angular frequency of the harmonic vibration that fits points best, with the frequency within a quarter of a
/// guess. It starts at rest in its lowest place. [least squares]
fn vibration(points: &[[f64; 2]], guess: f64) -> [f64; 3] {
    let fit = |frequency: f64| {
        let line: Vec<[f64; 2]> = points.iter().map(|p| [1.0 - (frequency * p[0]).cos(), p[1]]).collect();
        let square: f64 = line.iter().map(|p| p[0] * p[0]).sum();
        let mean = line.iter().map(|p| p[0] * p[1]).sum::<f64>() / square;
        (mean, line.iter().map(|p| (p[1] - mean * p[0]).powi(2)).sum::<f64>())
    };
    let all = (0..=1000).map(|k| guess * (0.75 + 0.0005 * f64::from(k)));
    let best = all.min_by(|a, b| fit(*a).1.total_cmp(&fit(*b).1)).unwrap_or(f64::NAN);
    let (mean, error) = fit(best);
    [mean, (error / points.len() as f64).sqrt(), best]
}

fn cantilever(session: &mut Session<'_>) -> Result<()> {
    // q L^4 / (8 E' I) + q L^2 / (2 k G A), and the first root of the frequency equation
    let (bent, frequency) = (0.100_059, BEAM);
    for cells in [40, 80] {
        let times = moments(82.0, 82);
        let journey = session.follow("validation/cantilever.toml", Setting::standard(cells), &[], times)?;
        let run = &journey.run;
        let tip = 9.0 - 0.5 * run.scene.domain.spacing();
        let path: Vec<[f64; 2]> =
            journey.displacement(1, |at| f64::from(at[0]) > tip).iter().map(|p| [p[0], -p[1]]).collect();
        let [mean, rest, found] = vibration(&path, frequency);
        // the gates are for eight cells through the depth
        let gate = if cells >= 80 { 0.03 } else { 0.1 };
        let row = session.check(run, "static deflection: mean of the vibration", mean);
        row.reference(bent, "Timoshenko's beam").within(gate).known(Limit::Between(bent, 1.045 * bent), LONG);
        let row = session.check(run, "angular frequency", found);
        row.reference(frequency, "Timoshenko's beam").within(gate);
        session
            .check(run, "rms of what is not that vibration, over the deflection", rest / mean)
            .source("higher modes");
        let plot = Plot::new("Cantilever under sudden gravity: tip", "time", "deflection");
        let exact = path.iter().map(|p| [p[0], bent * (1.0 - (frequency * p[0]).cos())]).collect();
        session.plot(plot.with("first mode", Style::Reference, exact).with(run.label.clone(), Style::Marks, path));
    }
    Ok(())
}

/// Angular frequency of the first mode of the cantilever \[rad s^-1\].
const BEAM: f64 = 0.156_515;
