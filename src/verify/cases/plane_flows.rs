//! Unsteady flow in the plane: a vortex that must not change, a double Mach reflection.

use glam::{DMat3, DVec3};

use crate::Result;
use crate::render::{Plot, Style};
use crate::scene::Pair;
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Run, Session, Setting, Suite, pair_name};
use crate::verify::harness::{Case, group};
use crate::verify::measure::plane::fitted_line;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("isentropic_vortex", "Isentropic vortex", group::UNSTEADY_2D, vortex,
        "C.-W. Shu, ICASE report 97-65 (1997); exact."),
    Case::quick("double_mach_reflection", "Double Mach reflection", group::UNSTEADY_2D, double_mach,
        "P. Woodward, P. Colella, J. Comput. Phys. 54 (1984) 115; positions of an independent MUSCL-HLLC solver with 480 cells per unit."),
];

/// Why the vortex misses its gates.
const VORTEX: &str = "one solve per step is of first order in time, and deepens the vortex; ars222 is of second order";

fn vortex(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[32, 64] } else { &[32, 64, 128] };
    let exact = 0.493_807;
    let mut plot = Plot::new("Isentropic vortex: L2 density error", "cells", "error").logarithmic();
    let quick = [(Pair::B1b0, Integrator::Predictor), (Pair::B1b0, Integrator::Ars222)];
    let full = [quick[0], (Pair::B2b1, Integrator::Predictor), quick[1]];
    for &(pair, integrator) in if session.suite == Suite::Quick { &quick[..] } else { &full[..] } {
        let name = format!("{} {}", pair_name(pair), integrator.name());
        let one_solve = integrator == Integrator::Predictor;
        let mut errors: Vec<[f64; 2]> = Vec::new();
        for &cells in cells {
            let setting = Setting { pair, integrator, cells };
            let run = session.run("validation/isentropic_vortex.toml", setting, &[])?;
            let start = run.scene.initial_gas();
            let square = run.snapshot.density.iter().zip(&start).map(|(now, then)| (f64::from(*now) - then[0]).powi(2));
            let error = (square.sum::<f64>() / start.len() as f64).sqrt();
            let row = session.check(&run, "L2 density error", error).source("exact");
            if cells == 64 && pair == Pair::B1b0 {
                row.pass(Limit::AtMost(if one_solve { 0.0065 } else { 0.004 }));
            }
            let lowest = run.snapshot.density.iter().copied().fold(f32::NAN, f32::min);
            let row = session.check(&run, "lowest density", lowest.into()).reference(exact, "exact");
            if cells == 128 {
                row.pass(Limit::Between(exact - 0.05 * (1.0 - exact), exact + 0.05 * (1.0 - exact)));
            }
            if setting == Setting::standard(64) {
                session.plot(vortex_plot(&run));
            }
            errors.push([f64::from(cells), error]);
        }
        for two in errors.windows(2) {
            let order = (two[0][1] / two[1][1]).log2();
            let row = session.push(&format!("order from {} to {} cells", two[0][0], two[1][0]), order);
            row.source("second order").setting.clone_from(&name);
            if two[1][0] == 128.0 {
                row.pass(Limit::AtLeast(1.8));
                if one_solve {
                    row.known(Limit::AtLeast(0.6), VORTEX);
                }
            }
        }
        plot = plot.with(name, Style::Both, errors);
    }
    session.plot(plot);
    Ok(())
}

/// Density through the middle, now and at the start.
fn vortex_plot(run: &Run) -> Plot {
    let line = Profile::along(run, 0, 0.0);
    let exact = (0..200).map(|k| {
        let x = -5.0 + 0.05 * f64::from(k);
        [x, run.scene.gas_at([x, 0.0, 0.0]).density]
    });
    Plot::new("Isentropic vortex after one passage, y = 0", "x", "density")
        .with("exact", Style::Reference, exact.collect())
        .with(run.label.clone(), Style::Marks, line.points(DENSITY))
}

/// Where the published values come from.
const REFERENCE: &str = "MUSCL-HLLC, 480 per unit";

fn double_mach(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[208] } else { &[208, 416] };
    for &cells in cells {
        let run = session.run("validation/double_mach_reflection.toml", Setting::standard(cells), &[])?;
        // gates are those for 120 cells per unit
        let wide = (120.0 * run.scene.domain.spacing()).max(1.0);
        let front = |y: f64| {
            let line = Profile::along(&run, 0, y);
            line.crossings(PRESSURE, 40.0).next_back().unwrap_or(f64::NAN)
        };
        let exact = |y: f64| 1.0 / 6.0 + (y + 20.0 * run.snapshot.time) / 3_f64.sqrt();
        let off = (front(0.8) - exact(0.8)).abs() / run.scene.domain.spacing();
        session.check(&run, "incident shock at y = 0.8, cells off", off).source("exact").pass(Limit::AtMost(1.0));
        let row = session.check(&run, "foot of the Mach stem", front(0.0)).reference(2.789, REFERENCE);
        row.pass(Limit::Between(2.789 - 0.02 * wide, 2.789 + 0.02 * wide));
        let [x, height] = triple_point(front, exact);
        for (name, ours, reference) in [("x", x, 2.739), ("height", height, 0.4365)] {
            let row = session.check(&run, &format!("{name} of the triple point"), ours).reference(reference, REFERENCE);
            row.pass(Limit::Between(reference - 0.03 * wide, reference + 0.03 * wide));
        }
        let row = session.check(&run, "stem off a parabola, cells", kink(&run, height, front));
        row.source("no kink").pass(Limit::AtMost(1.0));
        let heights = (0..100).map(|k| 0.01 * f64::from(k));
        let plot = Plot::new("Double Mach reflection: foremost shock", "x", "y");
        let incident = heights.clone().map(|y| [exact(y), y]).collect();
        let plot = plot.with("incident shock", Style::Reference, incident);
        session.plot(plot.with(run.label.clone(), Style::Marks, heights.map(|y| [front(y), y]).collect()));
    }
    Ok(())
}

/// Where the stem, as a straight line from its upper half, meets the incident shock.
fn triple_point(front: impl Fn(f64) -> f64, incident: impl Fn(f64) -> f64) -> [f64; 2] {
    let points: Vec<[f64; 2]> = (0..15).map(|k| 0.22 + 0.01 * f64::from(k)).map(|y| [y, front(y)]).collect();
    let [slope, offset] = fitted_line(&points);
    let rate = incident(1.0) - incident(0.0);
    let height = (incident(0.0) - offset) / (slope - rate);
    [offset + slope * height, height]
}

/// Largest distance between the stem, row by row from the wall to nine tenths of its height, and the parabola closest to it, in cells.
fn kink(run: &Run, height: f64, front: impl Fn(f64) -> f64) -> f64 {
    let rows = (0..run.scene.domain.cells[1]).map(|row| run.scene.domain.cell_center([0, row, 0])[1]);
    let points: Vec<[f64; 2]> = rows.filter(|y| *y < 0.9 * height).map(|y| [y, front(y)]).collect();
    let basis = |y: f64| DVec3::new(1.0, y, y * y);
    let mut matrix = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for [y, x] in &points {
        let b = basis(*y);
        matrix += DMat3::from_cols(b * b.x, b * b.y, b * b.z);
        right += b * *x;
    }
    let fit = matrix.inverse() * right;
    let off = points.iter().map(|[y, x]| (basis(*y).dot(fit) - x).abs());
    off.fold(f64::NAN, f64::max) / run.scene.domain.spacing()
}
