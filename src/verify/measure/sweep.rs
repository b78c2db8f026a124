//! What cases in 1D measure: errors of density over resolutions, element pairs and time integrations.

use super::tube_errors::{self, Errors, RESOLUTIONS};
use crate::render::{Plot, Style};
use crate::riemann::ExactRiemann;
use crate::scene::Pair;
use crate::verify::exact::profile::{DENSITY, Profile};
use crate::verify::harness::row::{Limit, Row, short};
use crate::verify::harness::session::{Integrator, Run, Session, Setting, Suite, pair_name};
use crate::{Error, Result};

/// Cells at which plateaus and shocks are measured.
pub(in crate::verify) const GATED: u32 = 400;
/// Errors may exceed those of the same method in double precision by this factor.
const MARGIN: f64 = 1.05;
/// Gates of well-known schemes and where they come from.
pub(in crate::verify) const PEERS: &str = "second-order LLF; good: HLLC";

/// Runs of one pair and integrator at growing resolution.
pub(in crate::verify) struct Sweep {
    pub(in crate::verify) pair: Pair,
    pub(in crate::verify) integrator: Integrator,
    pub(in crate::verify) cells: Vec<u32>,
}

impl Sweep {
    /// Name in plots.
    pub(in crate::verify) fn name(&self) -> String {
        format!("{} {}", pair_name(self.pair), self.integrator.name())
    }
}

/// What a suite runs of a 1D case.
pub(in crate::verify) fn sweeps(suite: Suite) -> Vec<Sweep> {
    let quick = RESOLUTIONS.into_iter().filter(|cells| *cells <= GATED).collect::<Vec<_>>();
    let pairs = [Pair::B1b0, Pair::B2b1];
    match suite {
        Suite::Quick => {
            let cells = |pair| if pair == Pair::B1b0 { quick.clone() } else { vec![GATED] };
            pairs.map(|pair| Sweep { pair, integrator: Integrator::Predictor, cells: cells(pair) }).into()
        }
        Suite::Full => {
            let all = [Integrator::Predictor, Integrator::Paper, Integrator::Ars222]
                .map(|integrator| pairs.map(|pair| Sweep { pair, integrator, cells: RESOLUTIONS.to_vec() }));
            all.into_iter().flatten().collect()
        }
    }
}

/// A measured error of a sweep: cells, L1 density error, deviation of Cao et al.'s eq. (38).
pub(in crate::verify) type Point = (u32, f64, f64);

/// Plots of the errors over the cells: L1, and the measure and axes of [Cao et al. 2022, fig. 16].
pub(in crate::verify) fn plot_errors(session: &mut Session<'_>, title: &str, measured: Vec<(String, Vec<Point>)>) {
    let mut l1 = Plot::new(format!("{title}: L1 density error"), "cells", "L1 error").logarithmic();
    let mut squared =
        Plot::new(format!("{title}: squared density deviation, eq. (38)"), "cells", "deviation").logarithmic();
    for (name, points) in &measured {
        let series = |value: fn(&Point) -> f64| points.iter().map(|p| [f64::from(p.0), value(p)]).collect::<Vec<_>>();
        l1 = l1.with(name.as_str(), Style::Both, series(|p| p.1));
        squared = squared.with(name.as_str(), Style::Both, series(|p| p.2));
    }
    if let Some((first, last)) = measured.first().and_then(|(_, points)| points.first().zip(points.last())) {
        let slope = |power: f64, start: f64| {
            [first.0, last.0]
                .map(|n| [f64::from(n), 1.5 * start * (f64::from(first.0) / f64::from(n)).powf(power)])
                .to_vec()
        };
        l1 = l1.with("order 1", Style::Guide, slope(1.0, first.1));
        // the deviation of a jump smeared over a fixed number of cells falls like the square of its width
        squared = squared.with("order 2", Style::Guide, slope(2.0, first.2));
    }
    session.plot(l1);
    if measured.iter().flat_map(|(_, points)| points).all(|point| point.2 > 0.0) {
        session.plot(squared);
    }
    if let Some((_, points)) = measured.into_iter().next() {
        session.curve(title, points.into_iter().map(|point| [f64::from(point.0), point.2]).collect());
    }
}

/// The exact solution of a tube and the place of its jump.
pub(in crate::verify) fn exact_riemann(run: &Run) -> Result<(ExactRiemann, f64)> {
    run.scene.riemann().ok_or_else(|| Error::Scene(format!("{}: no Riemann problem", run.scene.title)))
}

/// L1 density error against that of the method in double precision.
pub(in crate::verify) fn report_double<'s>(
    session: &'s mut Session<'_>,
    run: &Run,
    errors: Option<&Errors>,
    setting: Setting,
    error: f64,
) -> &'s mut Row {
    let row = session.check(run, "L1 density error", error);
    match errors.and_then(|errors| tube_errors::expected(errors, setting)) {
        Some(expected) => {
            let row = row.reference(expected, "double precision x 1.05").pass(Limit::AtMost(MARGIN * expected));
            if setting.integrator == Integrator::Ars222 && setting.cells == RESOLUTIONS[RESOLUTIONS.len() - 1] {
                row.known(
                    Limit::AtMost(1.08 * expected),
                    "single precision: 5.6 and 6.8 % more behind the strongest shocks",
                );
            }
            row
        }
        None => row.source("reference solution"),
    }
}

/// Order of the last doubling, and the worst share that an error keeps per doubling, with the most it may keep.
pub(in crate::verify) fn report_order<'s>(
    session: &'s mut Session<'_>,
    sweep: &Sweep,
    points: &[Point],
    most: Option<f64>,
) -> Option<&'s mut Row> {
    let ratios: Vec<f64> = points.windows(2).map(|pair| pair[1].1 / pair[0].1).collect();
    session.push("observed order, last doubling", -ratios.last()?.log2()).setting = sweep.name();
    let row = session.push("largest error ratio per doubling", ratios.iter().fold(0.0, |a: f64, b| a.max(*b)));
    row.setting = sweep.name();
    if let Some(most) = most {
        row.source("Athena++ demands 0.6 of Sod").pass(Limit::AtMost(most)).good(Limit::AtMost(0.6));
    }
    Some(row)
}

/// Density with the exact solution behind it.
pub(in crate::verify) fn plot_density(session: &mut Session<'_>, run: &Run, ours: &Profile, reference: &Profile) {
    let name = if run.scene.riemann().is_some() { "exact" } else { "reference" };
    let plot = Plot::new(format!("{}, t = {}", run.scene.title, short(run.snapshot.time)), "x", "density")
        .with(name, Style::Reference, reference.points(DENSITY))
        .with(run.label.clone(), Style::Marks, ours.points(DENSITY));
    session.plot(plot);
}
