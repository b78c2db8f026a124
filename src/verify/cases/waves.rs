//! Walls, strong blasts and smooth waves in 1D with exact solutions.

use crate::Result;
use crate::render::{Plot, Style};
use crate::riemann::ExactRiemann;
use crate::scene::{self, Changes, Pair};
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile, VELOCITY};
use crate::verify::harness::row::{Limit, Row};
use crate::verify::harness::session::{Integrator, Run, Session, Setting};
use crate::verify::harness::{Case, group};
use crate::verify::measure::sweep::{GATED, Point, Sweep, plot_density, plot_errors, report_order, sweeps};

/// Where exact values come from.
const EXACT: &str = "exact";

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("shock_reflection", "Reflection of a Mach 2 shock from a wall", group::WAVES, |session| sweep(session, "validation/shock_reflection.toml", reflected, report_reflection),
        "Rankine-Hugoniot relations."),
    Case::quick("noh_planar", "Planar Noh problem", group::WAVES, |session| sweep(session, "validation/noh_planar.toml", noh, report_noh),
        "W. F. Noh, J. Comput. Phys. 72 (1987) 78; exact."),
    Case::quick("sedov_planar", "Planar Sedov blast wave", group::WAVES, sedov,
        "L. I. Sedov, Similarity and Dimensional Methods in Mechanics, 1959; J. R. Kamm, F. X. Timmes, LA-UR-07-2849 (2007)."),
    Case::quick("density_wave", "Advected density wave", group::WAVES, |session| sweep(session, "validation/density_wave.toml", moved, report_uniform),
        "Exact: the density moves with the gas."),
    Case::quick("acoustic_wave", "Standing sound waves", group::WAVES, acoustic_wave,
        "Smooth flow test of Kwatra et al., J. Comput. Phys. 228 (2009) 4146, between walls at planes of symmetry; exact for small amplitudes."),
];

/// The exact state on the grid of a run.
type Exact = fn(&Run) -> Profile;
/// What is measured at 400 cells.
type Report = fn(&mut Session<'_>, &Run, &Profile);

fn sweep(session: &mut Session<'_>, path: &str, exact: Exact, report: Report) -> Result<()> {
    let mut measured = Vec::new();
    let mut title = String::new();
    for sweep in sweeps(session.suite) {
        let mut points: Vec<Point> = Vec::new();
        for &cells in &sweep.cells {
            let setting = Setting { pair: sweep.pair, integrator: sweep.integrator, cells };
            let run = session.run(path, setting, &[])?;
            let (ours, reference) = (Profile::of(&run.scene, &run.snapshot), exact(&run));
            let error = ours.l1(&reference, DENSITY);
            session.check(&run, "L1 density error", error).source(EXACT);
            points.push((cells, error, ours.density_deviation(&reference)));
            if cells == GATED {
                report(session, &run, &ours);
            }
            if setting == Setting::standard(GATED) {
                plot_density(session, &run, &ours, &reference);
            }
            title.clone_from(&run.scene.title);
        }
        report_order(session, &sweep, &points, None);
        if path.contains("density_wave") {
            // beyond, half of the error is what single precision rounds away, 1e-5
            let resolved: Vec<Point> = points.iter().copied().filter(|point| point.0 <= 800).collect();
            report_last_ratio(session, &sweep, &resolved, SMOOTH_RATIO, "Athena++, entropy wave");
        }
        measured.push((sweep.name(), points));
    }
    plot_errors(session, &title, measured);
    Ok(())
}

/// The share of the error that the last doubling leaves, and the most it may.
fn report_last_ratio<'a>(
    session: &'a mut Session<'_>,
    sweep: &Sweep,
    points: &[Point],
    most: f64,
    source: &str,
) -> Option<&'a mut Row> {
    let [.., before, last] = points else { return None };
    let row = session.push(&format!("error ratio of the doubling to {} cells", last.0), last.1 / before.1);
    row.setting = sweep.name();
    Some(row.source(source).pass(Limit::AtMost(most)))
}

/// Share of its error that a second-order scheme keeps per doubling in smooth flow.
const SMOOTH_RATIO: f64 = 0.33;

/// The shock has left x = 0.5 at Mach 2 and has met the wall at 0.25: since then two equal streams collide at the wall.
fn reflected(run: &Run) -> Profile {
    let behind = (3.733_333_333_333_333, 1.25, 4.5);
    let exact = ExactRiemann::new(run.scene.gas.gamma, behind, (behind.0, -behind.1, behind.2));
    Profile::exact(&run.scene, &exact, 1.0, run.snapshot.time - 0.25)
}

/// Most errors of pressure and density behind the reflected shock where the gate is missed, and why.
fn known_reflection(run: &Run) -> Option<([f64; 2], &'static str)> {
    const START: &str = "what the start of the shock left of its heat in two cells, 0.9 % with b1b0";
    const RINGS: &str = "two solves leave what one over the whole step damps behind a strong shock that hardly moves";
    match (run.scene.numerics.pair, run.scene.integrator()) {
        (Pair::B1b0, scene::Integrator::Ars222) => Some(([0.011, 0.013], RINGS)),
        (Pair::B2b1, scene::Integrator::Ars222) => Some(([0.039, 0.028], RINGS)),
        (Pair::B2b1, scene::Integrator::Paper) => Some(([0.005, 0.0107], START)),
        (Pair::B2b1, _) => Some(([0.005, 0.0104], START)),
        (Pair::B1b0, _) => None,
    }
}

fn report_reflection(session: &mut Session<'_>, run: &Run, ours: &Profile) {
    let quiet = [0.7 + 8.0 * ours.spacing, 1.0 - 5.0 * ours.spacing];
    let pressure = ours.largest_deviation(PRESSURE, 15.0, quiet) / 15.0;
    let density = ours.largest_deviation(DENSITY, 8.4, quiet) / 8.4;
    let known = known_reflection(run);
    for (name, error, most) in [("pressure", pressure, 0.005), ("density", density, 0.01)] {
        let row = session.check(run, &format!("{name} at the wall, error"), error);
        row.reference(0.0, EXACT).pass(Limit::AtMost(most));
        if let Some(([pressure, density], why)) = known {
            row.known(Limit::AtMost(if name == "pressure" { pressure } else { density }), why);
        }
    }
    let deficit = 1.0 - ours.state[DENSITY][ours.cells() - 1] / 8.4;
    session.check(run, "wall heating, density missing", deficit).source(EXACT).pass(Limit::AtMost(0.1));
    let off = (ours.nearest_crossing(PRESSURE, 0.5 * (15.0 + 4.5), 0.7) - 0.7).abs() / ours.spacing;
    session.check(run, "reflected shock, cells off", off).source(EXACT).pass(Limit::AtMost(1.5));
}

fn noh(run: &Run) -> Profile {
    let exact = ExactRiemann::new(run.scene.gas.gamma, (1.0, 1.0, 1e-6), (1.0, -1.0, 1e-6));
    Profile::exact(&run.scene, &exact, 0.0, run.snapshot.time)
}

fn report_noh(session: &mut Session<'_>, run: &Run, ours: &Profile) {
    let quiet = [0.1, 0.4 - 8.0 * ours.spacing];
    let density = ours.largest_deviation(DENSITY, 6.0, quiet) / 6.0;
    let pressure = ours.largest_deviation(PRESSURE, 1.2, quiet) / 1.2;
    session.check(run, "density behind the shock, error", density).reference(0.0, EXACT).pass(Limit::AtMost(0.05));
    session.check(run, "pressure behind the shock, error", pressure).reference(0.0, EXACT).pass(Limit::AtMost(0.01));
    let deficit = 1.0 - ours.state[DENSITY][0] / 6.0;
    session.check(run, "wall heating, density missing", deficit).source("reported");
    let off = (ours.nearest_crossing(PRESSURE, 0.6, 0.4) - 0.4).abs() / ours.spacing;
    session.check(run, "shock, cells off", off).source(EXACT).pass(Limit::AtMost(1.5));
}

/// The hill of density, moved; see the scene.
fn moved(run: &Run) -> Profile {
    let mut profile = Profile::of(&run.scene, &run.snapshot);
    let hill = |x: f64| {
        let at = x - run.snapshot.time;
        let factor = 1.0 - (2.0 * std::f64::consts::TAU * at).cos();
        if (0.5..1.0).contains(&at) { 1.0 + 0.125 * factor * factor } else { 1.0 }
    };
    for cell in 0..profile.cells() {
        let (x, width) = (profile.center(cell), profile.spacing);
        // Simpson's rule: means to fourth order
        profile.state[DENSITY][cell] = (hill(x - 0.5 * width) + 4.0 * hill(x) + hill(x + 0.5 * width)) / 6.0;
        profile.state[VELOCITY][cell] = 1.0;
        profile.state[PRESSURE][cell] = 1.0;
    }
    profile
}

fn report_uniform(session: &mut Session<'_>, run: &Run, ours: &Profile) {
    let everywhere = [ours.origin, ours.origin + ours.spacing * ours.cells() as f64];
    for (name, quantity) in [("pressure, largest change", PRESSURE), ("velocity, largest change", VELOCITY)] {
        let change = ours.largest_deviation(quantity, 1.0, everywhere);
        session.check(run, name, change).reference(0.0, EXACT).pass(Limit::AtMost(1e-3));
    }
}

/// The shock, its peak, and how the error falls; the layer of hot gas at the start is one cell thick at 100 cells.
fn sedov(session: &mut Session<'_>) -> Result<()> {
    // E = 1 on this side of the wall
    let place = (0.25_f64 / 0.538_548).cbrt();
    for sweep in sweeps(session.suite) {
        for &cells in sweep.cells.iter().filter(|cells| **cells >= GATED) {
            let setting = Setting { pair: sweep.pair, integrator: sweep.integrator, cells };
            let run = session.run("validation/sedov_planar.toml", setting, &[])?;
            let ours = Profile::of(&run.scene, &run.snapshot);
            let (peak, _) = ours.peak(DENSITY, [f64::NEG_INFINITY, f64::INFINITY]);
            // behind a strong shock 2 / (gamma + 1) of its speed squared, and the shock slows down like t^(-1/3)
            let speed = 2.0 * place / (3.0 * run.snapshot.time);
            let level = 0.5 * 2.0 / 2.4 * speed * speed;
            let found = ours.crossings(PRESSURE, level).next_back().unwrap_or(f64::NAN);
            session.check(&run, "place of the shock", found).reference(place, "Sedov; Kamm and Timmes").within(0.01);
            session.check(&run, "highest density", peak).reference(6.0, "Sedov").pass(Limit::AtLeast(4.0));
            if setting == Setting::standard(GATED) {
                let plot = Plot::new(run.scene.title.as_str(), "x", "density")
                    .with("exact front", Style::Reference, vec![[place, 1.0], [place, 6.0]])
                    .with(run.label.clone(), Style::Marks, ours.points(DENSITY));
                session.plot(plot);
            }
        }
    }
    Ok(())
}

/// Amplitudes of the longer and the shorter wave \[Pa\].
const SOUND: [f64; 2] = [6e5, 1e6];
/// Speed of sound \[m/s\].
const SPEED: f64 = 37_416.573_867_739_42;

/// Error at fixed acoustic Courant number; delay and damping of the longer wave by what a probe at a node of the shorter one sees.
fn acoustic_wave(session: &mut Session<'_>) -> Result<()> {
    let mut measured = Vec::new();
    for sweep in sweeps(session.suite) {
        let mut points: Vec<Point> = Vec::new();
        for &cells in &sweep.cells {
            let setting = Setting { pair: sweep.pair, integrator: sweep.integrator, cells };
            let run = session.run("validation/acoustic_wave.toml", setting, &[])?;
            let ours = Profile::of(&run.scene, &run.snapshot);
            let reference = standing_wave(&run, &ours);
            let error = ours.l1(&reference, PRESSURE) / (SOUND[0] + SOUND[1]);
            session.check(&run, "L1 pressure error over amplitude", error).source(EXACT);
            points.push((cells, error, f64::NAN));
            if cells == GATED {
                report_sound(session, &run);
            }
            if setting == Setting::standard(GATED) {
                let plot = Plot::new("Standing sound waves: pressure above 1e9", "x", "pressure")
                    .with(EXACT, Style::Reference, above(&reference))
                    .with(run.label.clone(), Style::Marks, above(&ours));
                session.plot(plot);
            }
        }
        report_order(session, &sweep, &points, None);
        if sweep.integrator == Integrator::Ars222 {
            // beyond, the error is that of the exact solution, which is for small amplitudes: 0.0014
            let resolved: Vec<Point> = points.iter().copied().filter(|point| point.0 <= 400).collect();
            report_last_ratio(session, &sweep, &resolved, SMOOTH_RATIO, "Athena++, sound wave");
        } else {
            let row = report_last_ratio(session, &sweep, &points, 0.5, "first order");
            if let Some(row) = row.filter(|_| sweep.integrator == Integrator::Paper) {
                row.known(Limit::AtMost(0.52), "on its way to first order: 0.63, 0.57, 0.53, 0.51");
            }
        }
        measured.push((sweep.name(), points));
    }
    small_steps(session)?;
    plot_errors(session, "Standing sound waves", measured);
    Ok(())
}

/// At the steps of explicit schemes the scene takes two solves; one is reported beside it.
fn small_steps(session: &mut Session<'_>) -> Result<()> {
    let one = Setting::standard(200);
    let two = Setting { integrator: Integrator::Auto, ..one };
    for (setting, changes, source, most) in [
        (two, Changes::variant("small_steps"), "explicit schemes", 0.005),
        (one, Changes::default().set("time.max_courant=0.5"), "first order in time: 0.0076", 0.008),
    ] {
        let run = session.run("validation/acoustic_wave.toml", setting, changes)?;
        let ours = Profile::of(&run.scene, &run.snapshot);
        let error = ours.l1(&standing_wave(&run, &ours), PRESSURE) / (SOUND[0] + SOUND[1]);
        let row = session.check(&run, "L1 pressure error over amplitude, Courant 0.5", error);
        row.source(source).pass(Limit::AtMost(most));
    }
    Ok(())
}

/// The exact pressure on the grid of a run.
fn standing_wave(run: &Run, ours: &Profile) -> Profile {
    let mut reference = ours.clone();
    let tau = std::f64::consts::TAU;
    for cell in 0..ours.cells() {
        let x = ours.center(cell);
        let mode = |k: f64| (tau * k * x).cos() * (tau * k * SPEED * run.snapshot.time).cos();
        reference.state[PRESSURE][cell] = 1e9 + SOUND[0] * mode(1.0) + SOUND[1] * mode(2.0);
    }
    reference
}

fn above(profile: &Profile) -> Vec<[f64; 2]> {
    profile.points(PRESSURE).into_iter().map(|[x, p]| [x, p - 1e9]).collect()
}

/// The longer wave passes zero at 1/4, 3/4, 5/4 and 7/4 of its period, and has its second trough at 3/2.
fn report_sound(session: &mut Session<'_>, run: &Run) {
    let signal: Vec<[f64; 2]> = (run.records.iter())
        .filter_map(|record| Some([record.time * SPEED, f64::from(record.probes.first()?.pressure) - 1e9]))
        .collect();
    let crossing = |pair: &[[f64; 2]]| {
        let ([t, a], [next, b]) = (pair[0], pair[1]);
        ((a < 0.0) != (b < 0.0)).then(|| t + (next - t) * a / (a - b))
    };
    let last = signal.windows(2).rev().find_map(crossing).unwrap_or(f64::NAN);
    session.check(run, "delay after 7/4 periods", (last / 1.75 - 1.0).abs()).source(EXACT).pass(Limit::AtMost(0.02));
    let trough = signal.iter().filter(|[t, _]| (1.25..1.75).contains(t)).map(|[_, p]| *p).fold(f64::NAN, f64::min);
    let left = -trough / (SOUND[0] * std::f64::consts::FRAC_1_SQRT_2);
    session.check(run, "amplitude left after 3/2 periods", left).reference(1.0, EXACT);
}
