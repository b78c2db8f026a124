//! Gas under gravity: at rest, and a bubble that rises.

use crate::Result;
use crate::render::{Plot, Style};
use crate::verify::exact::profile::{PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("hydrostatic_column", "Hydrostatic column", group::GRAVITY, column,
        "Exact: what is in balance stays at rest."),
    Case::quick("hot_bubble", "Start of a hot bubble", group::GRAVITY, bubble,
        "Potential flow, added mass of a cylinder; G. K. Batchelor, An Introduction to Fluid Dynamics, 1967, section 6.8."),
];

/// Why the column moves.
fn column(session: &mut Session<'_>) -> Result<()> {
    // sound crosses the column thirty times; the full suite waits for slow growth too
    let until = if session.suite == Suite::Quick { vec!["time.until=30.0".to_owned()] } else { Vec::new() };
    let run = session.run("validation/hydrostatic_column.toml", Setting::standard(0), &until)?;
    let fall = (-run.scene.gravity[1] * run.scene.domain.size[1]).sqrt();
    let row = session.check(&run, "largest speed over sqrt(gravity height)", run.summary.max_speed / fall);
    row.reference(0.0, "exact").pass(Limit::AtMost(1e-3));
    // the last step is shorter, and every change of the step upsets the balance anew
    let late = run.records.get(run.records.len() * 3 / 4).map_or(f64::NAN, |record| f64::from(record.gas_speed));
    session
        .check(&run, "the same at three quarters of the steps", late / fall)
        .reference(0.0, "exact")
        .pass(Limit::AtMost(1e-3));
    let line = Profile::along(&run, 1, 0.1);
    let start: Vec<[f64; 2]> =
        line.points(PRESSURE).iter().map(|[y, _]| [*y, run.scene.gas_at([0.1, *y, 0.0]).pressure]).collect();
    let plot = Plot::new("Hydrostatic column: pressure", "height", "pressure").with("exact", Style::Reference, start);
    session.plot(plot.with(run.label.clone(), Style::Marks, line.points(PRESSURE)));
    Ok(())
}

/// Two runs, the second twice as long: sound that the sudden start sends out gives the bubble a speed of its own, which the difference
/// does not contain.
fn bubble(session: &mut Session<'_>) -> Result<()> {
    let standard = Setting::standard(0);
    // eight cells per radius make it 9 to 10 % too slow whatever the ratio, sixteen 5 %
    let fine = Setting::standard(320);
    let two_solves = Setting { integrator: Integrator::Ars222, ..fine };
    let all = [(0.5, standard), (0.25, fine), (0.25, two_solves), (0.1, standard)];
    let count = if session.suite == Suite::Quick { 1 } else { all.len() };
    for (ratio, setting) in all.into_iter().take(count) {
        let acceleration = (1.0 - ratio) / (1.0 + ratio);
        let density = format!("gas.regions[0].density={}", 1.4 * ratio);
        let mut climbs = Vec::new();
        let mut last = None;
        for part in [0.5, 1.0] {
            let gravity: f64 = 1e-4;
            let until = part * (0.2 / (acceleration * gravity)).sqrt();
            let all = [density.clone(), format!("time.until={until}")];
            let run = session.run("validation/hot_bubble.toml", setting, &all)?;
            climbs.push(centroid(&run));
            last = Some((run, gravity, until));
        }
        if let Some((run, gravity, until)) = last {
            let half = 0.5 * until;
            let ours = (climbs[1] - 2.0 * climbs[0]) / (half * half * gravity);
            let name = format!("acceleration over gravity, density ratio {ratio}");
            session.check(&run, &name, ours).reference(acceleration, "added mass").within(0.1);
            // inside it moves at one speed, outside on the axis as over the square of the distance
            let sheet = 4.0 * RADIUS * acceleration * gravity * until;
            let name = format!("circulation of the right half, density ratio {ratio}");
            session.check(&run, &name, circulation(&run) / sheet).reference(1.0, "potential flow").within(0.1);
        }
    }
    if session.suite == Suite::Full { rolls_up(session, standard) } else { Ok(()) }
}

/// Of the bubble.
const RADIUS: f64 = 1.0;

/// Ten times the gravity: gas from below pierces the bubble, which becomes two vortices, in space a ring.
fn rolls_up(session: &mut Session<'_>, setting: Setting) -> Result<()> {
    let changes = ["gravity=[0.0, -1e-3]", "gas.waves[0].vector=[0.0, 2e-3]", "time.until=190.0"];
    let run = session.run("validation/hot_bubble.toml", setting, &changes.map(str::to_owned))?;
    let outside = run.scene.gas.ambient.density;
    let [nx, ny, _] = run.scene.domain.cells.map(|n| n as usize);
    let missing = |x: usize, y: usize| (1.0 - f64::from(run.snapshot.density[x + nx * y]) / outside).max(0.0);
    let columns: Vec<f64> = (0..nx).map(|x| (0..ny).map(|y| missing(x, y)).sum()).collect();
    let widest = columns.iter().copied().fold(0.0, f64::max);
    let row = session.check(&run, "lighter gas on the axis, over that of the fullest column", columns[0] / widest);
    row.source("a bubble that keeps its shape has 1").pass(Limit::AtMost(0.6));
    let risen = centroid(&run) / RADIUS;
    session.check(&run, "rise of the middle of the lighter gas, in radii", risen).pass(Limit::Between(1.0, 4.0));
    Ok(())
}

/// Line integral of the velocity around the domain: up along the axis, and back along the other sides.
fn circulation(run: &Run) -> f64 {
    let domain = &run.scene.domain;
    let [nx, ny, _] = domain.cells.map(|n| n as usize);
    let velocity = |x: usize, y: usize, axis: usize| f64::from(run.snapshot.velocity[x + nx * y][axis]);
    let across: f64 = (0..nx).map(|x| velocity(x, ny - 1, 0) - velocity(x, 0, 0)).sum();
    let up: f64 = (0..ny).map(|y| velocity(0, y, 1) - velocity(nx - 1, y, 1)).sum();
    domain.spacing() * (across + up)
}

/// Height of the middle of the lighter gas.
fn centroid(run: &Run) -> f64 {
    let outside = run.scene.gas.ambient.density;
    let [nx, ..] = run.scene.domain.cells;
    let (mut sum, mut weight) = (0.0, 0.0);
    for (cell, density) in run.snapshot.density.iter().enumerate() {
        let missing = outside - f64::from(*density);
        // sound and stratification change the density by less
        if missing > 0.01 * outside {
            let center = run.scene.domain.cell_center([cell as u32 % nx, cell as u32 / nx, 0]);
            sum += missing * center[1];
            weight += missing;
        }
    }
    sum / weight
}
