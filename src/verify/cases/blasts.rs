//! Problems in 1D without a closed solution: against a fine run of the independent solver.

use std::sync::Arc;

use crate::Result;
use crate::scene::Pair;
use crate::verify::exact::profile::{DENSITY, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::sweep::{GATED, Point, plot_density, plot_errors, report_double, report_order, sweeps};
use crate::verify::measure::tube_errors;

/// Cells of the reference in the full suite, and in the quick one.
const FINE: [u32; 2] = [6400, 3200];
/// Where the values come from.
const REFERENCE: &str = "MUSCL-HLLC";

/// The cases of this module.
pub(super) const CASES: &[Case] = &[
    Case {
        id: "blast",
        title: "Interacting blast waves",
        group: group::INTERACTIONS,
        quick: true,
        source: "P. Woodward, P. Colella, J. Comput. Phys. 54 (1984) 115; values of an independent MUSCL-HLLC solver, 6400 cells.",
        run: blasts,
    },
    Case {
        id: "shu_osher",
        title: "Shu-Osher problem",
        group: group::INTERACTIONS,
        quick: true,
        source: "C.-W. Shu, S. Osher, J. Comput. Phys. 83 (1989) 32; values of an independent MUSCL-HLLC solver, 6400 cells.",
        run: |session| sweep(session, "validation/shu_osher.toml", None, shu_osher),
    },
];

/// What is measured at 400 cells, and in the full suite the peak on the 1200 that its gate is for.
fn blasts(session: &mut Session<'_>) -> Result<()> {
    const PATH: &str = "gas/blast.toml";
    sweep(session, PATH, Some(&tube_errors::BLAST), blast)?;
    let pairs: &[Pair] = if session.suite == Suite::Quick { &[] } else { &[Pair::B1b0, Pair::B2b1] };
    for (pair, integrator) in pairs.iter().flat_map(|pair| BEYOND_PAPER.map(|integrator| (*pair, integrator))) {
        let run = session.run(PATH, Setting { pair, integrator, cells: 1200 }, &[])?;
        let (peak, _) = Profile::of(&run.scene, &run.snapshot).peak(DENSITY, MAIN);
        session.check(&run, "highest density", peak).reference(6.48, REFERENCE).pass(Limit::AtLeast(6.0));
    }
    Ok(())
}

/// Integrations that are held to the gates.
const BEYOND_PAPER: [Integrator; 2] = [Integrator::Predictor, Integrator::Ars222];

type Report = fn(&mut Session<'_>, &Run, &Profile, &Profile);

fn sweep(session: &mut Session<'_>, path: &str, errors: Option<&tube_errors::Errors>, report: Report) -> Result<()> {
    let mut measured = Vec::new();
    let mut title = String::new();
    let fine = FINE[usize::from(session.suite == Suite::Quick)];
    for sweep in sweeps(session.suite) {
        let mut points: Vec<Point> = Vec::new();
        for &cells in &sweep.cells {
            let setting = Setting { pair: sweep.pair, integrator: sweep.integrator, cells };
            let run = session.run(path, setting, &[])?;
            let full: Arc<Profile> = session.fine_reference(&run.scene, fine)?;
            let reference = full.coarsened(cells as usize);
            let ours = Profile::of(&run.scene, &run.snapshot);
            points.push((cells, ours.l1(&reference, DENSITY), ours.density_deviation(&reference)));
            report_double(session, &run, errors, setting, ours.l1(&reference, DENSITY));
            if BEYOND_PAPER.contains(&sweep.integrator) {
                report(session, &run, &ours, &full);
            }
            if setting == Setting::standard(GATED) {
                plot_density(session, &run, &ours, &full);
            }
            title.clone_from(&run.scene.title);
        }
        report_order(session, &sweep, &points, None);
        measured.push((sweep.name(), points));
    }
    plot_errors(session, &title, measured);
    Ok(())
}

/// Where the higher crest of the blasts is.
const MAIN: [f64; 2] = [0.7, 0.85];

/// Peak and jumps at 400 cells. On coarse grids the left crest, which is wider, may be the higher of the two, so each is looked for at
/// its place; the left one must not exceed that of the reference.
fn blast(session: &mut Session<'_>, run: &Run, ours: &Profile, reference: &Profile) {
    const LEFT: [f64; 2] = [0.6, 0.7];
    if ours.cells() != GATED as usize {
        return;
    }
    let (peak, place) = ours.peak(DENSITY, MAIN);
    session.check(run, "density of the main crest", peak).reference(6.48, REFERENCE).pass(Limit::AtLeast(5.0));
    let row = session.check(run, "its place", place).reference(0.769, REFERENCE).pass(Limit::Between(0.759, 0.779));
    if run.scene.solves() == 2 {
        row.known(
            Limit::Between(0.759, 0.783),
            "the crest is broad: its top is a cell beyond, what bounds it is in place",
        );
    }
    let [left, most] = [ours, reference].map(|profile| profile.peak(DENSITY, LEFT).0);
    session.check(run, "density of the left crest", left).reference(most, REFERENCE).pass(Limit::AtMost(1.01 * most));
    for (name, at) in [("jump at 0.647", 0.647), ("jump at 0.7988", 0.7988), ("jump at 0.8657", 0.8657)] {
        let side = |x: f64| reference.extremes(DENSITY, [x - 2.0 * reference.spacing, x + 2.0 * reference.spacing])[0];
        let level = 0.5 * (side(at - 0.008) + side(at + 0.008));
        let found = ours.nearest_crossing(DENSITY, level, at);
        session.check(run, name, found).reference(at, REFERENCE).pass(Limit::Between(at - 0.006, at + 0.006));
    }
}

/// Place of the shock, and how many crests of the wave train behind it are left.
fn shu_osher(session: &mut Session<'_>, run: &Run, ours: &Profile, reference: &Profile) {
    if ours.cells() != GATED as usize {
        return;
    }
    let shock = ours.nearest_crossing(DENSITY, 2.2, 2.396);
    session.check(run, "place of the shock", shock).reference(2.396, REFERENCE).pass(Limit::Between(2.366, 2.426));
    let mut shares = crest_shares(ours, reference);
    shares.sort_by(|a, b| b.total_cmp(a));
    let fourth = shares.get(3).copied().unwrap_or(f64::NAN);
    let row = session.check(run, "fourth best crest, share of its height", fourth);
    row.source(REFERENCE).pass(Limit::AtLeast(0.6)).good(Limit::AtLeast(0.85));
}

/// Crests of the density of the reference between 0.5 and 2.2, and what share of their height over the troughs beside them is ours.
fn crest_shares(ours: &Profile, reference: &Profile) -> Vec<f64> {
    const SPAN: [f64; 2] = [0.5, 2.2];
    // A twentieth of a wave is no crest of its own.
    let values = &reference.state[DENSITY];
    let window = (0.05 / reference.spacing) as usize;
    let is_extreme = |k: usize, sign: f64| {
        let around = k.saturating_sub(window)..(k + window + 1).min(values.len());
        around.clone().all(|other| sign * values[other] <= sign * values[k]) && around.len() == 2 * window + 1
    };
    let extremes = |sign: f64| {
        let inside = (0..values.len()).filter(|k| (SPAN[0] - 0.4..=SPAN[1] + 0.4).contains(&reference.center(*k)));
        inside.filter(|k| is_extreme(*k, sign)).map(|k| reference.center(k)).collect::<Vec<_>>()
    };
    let troughs = extremes(-1.0);
    let height = |profile: &Profile, crest: f64, low: f64, high: f64| {
        let reach = 0.25 * (high - low);
        let top = profile.extremes(DENSITY, [crest - reach, crest + reach])[1];
        let bottom = |x: f64| profile.extremes(DENSITY, [x - reach, x + reach])[0];
        top - 0.5 * (bottom(low) + bottom(high))
    };
    let share = |crest: f64| {
        let low = troughs.iter().copied().rfind(|x| *x < crest)?;
        let high = troughs.iter().copied().find(|x| *x > crest)?;
        Some(height(ours, crest, low, high) / height(reference, crest, low, high))
    };
    extremes(1.0).into_iter().filter(|crest| (SPAN[0]..=SPAN[1]).contains(crest)).filter_map(share).collect()
}
