//! An elastic panel that a shock in a tube bends, against an experiment and other codes.

use crate::Result;
use crate::render::{Plot, Style};
use crate::snapshot::Snapshot;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Session, Setting};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::full("shocked_panel", "Shock on a clamped panel", group::COUPLING, panel,
        "J. Giordano, G. Jourdan, Y. Burtschell, M. Medale, D. E. Zeitoun, L. Houas, Shock Waves 14 (2005) 103, panel of 50 mm; test \"shocked panel\" of the code M2C."),
];

/// Time and place of the tip in the code M2C \[ms, mm\].
const M2C: [[f64; 2]; 12] = [
    [0.2, 0.136],
    [0.4, 1.21],
    [0.6, 2.38],
    [0.8, 3.92],
    [1.0, 4.95],
    [1.2, 5.71],
    [1.4, 5.64],
    [1.6, 4.92],
    [1.8, 3.06],
    [2.0, 0.9],
    [2.2, -1.35],
    [2.4, -3.07],
];
/// The experiment, whose largest deflection is 6.2 mm, a simulation with 6.6 mm, and M2C.
const SOURCE: &str = "Giordano et al. 2005; M2C";

/// Why the pressure before the panel may be higher.
const PLATEAU: &str = "an explicit MUSCL-HLLC code with a rigid panel has 204 to 209 kPa along its face";

fn panel(session: &mut Session<'_>) -> Result<()> {
    let times = (1..=50).map(|k| 5e-5 * f64::from(k));
    let journey = session.follow("validation/shocked_panel.toml", Setting::standard(600), &[], times)?;
    let path = tip(&journey);
    let run = &journey.run;
    let peak = path.iter().copied().fold([0.0; 2], |best, now| if now[1] > best[1] { now } else { best });
    session.check(run, "tip, largest deflection [mm]", peak[1]).reference(6.2, SOURCE).pass(Limit::Between(5.2, 6.7));
    session.check(run, "its time [ms]", peak[0]).reference(1.29, SOURCE).pass(Limit::Between(1.15, 1.45));
    let back = path.windows(2).find(|two| two[1][0] > peak[0] && two[1][1] < 0.0);
    let zero = back.map_or(f64::NAN, |two| {
        let [[from, high], [to, low]] = [two[0], two[1]];
        from + (to - from) * high / (high - low)
    });
    session.check(run, "back at its place [ms]", zero).reference(2.09, SOURCE).pass(Limit::Between(1.95, 2.35));
    let before = journey.stops.iter().filter(|stop| (0.5e-3..=1.2e-3).contains(&stop.time));
    let pressures: Vec<f64> = before.map(|stop| pressure_at(&journey, stop, [-2e-3, 1e-2])).collect();
    let mean = pressures.iter().sum::<f64>() / pressures.len() as f64;
    let row = session.check(run, "pressure before it, 0.5 to 1.2 ms [kPa]", 1e-3 * mean);
    row.source(SOURCE).pass(Limit::Between(180.0, 200.0)).known(Limit::Between(180.0, 210.0), PLATEAU);
    let row = session.check(run, "PCG iterations per step, mean, goal", run.solver.mean_iterations);
    row.source("default rules").pass(Limit::AtMost(12.0));
    let plot = Plot::new("Panel in a shock tube: deflection of the tip", "time [ms]", "deflection [mm]");
    session.plot(plot.with("M2C", Style::Reference, M2C.to_vec()).with(run.label.clone(), Style::Line, path));
    Ok(())
}

/// Time and deflection of the tip \[ms, mm\]. The tip is what lies farthest to the right, or to the left.
fn tip(journey: &Journey) -> Vec<[f64; 2]> {
    let start = journey.stops[0].bodies(1).swap_remove(0).extent;
    let moved = |stop: &Snapshot| {
        let body = stop.bodies(1).swap_remove(0).extent;
        let [low, high] = [body[0][0] - start[0][0], body[1][0] - start[1][0]];
        [1e3 * stop.time, 1e3 * if high > -low { high } else { low }]
    };
    journey.stops.iter().map(moved).collect()
}

/// Pressure of the cell that holds a point \[Pa\].
fn pressure_at(journey: &Journey, stop: &Snapshot, point: [f64; 2]) -> f64 {
    let domain = &journey.run.scene.domain;
    let [column, row] = [0, 1].map(|axis| ((point[axis] - domain.origin[axis]) / domain.spacing()) as usize);
    stop.pressure[row * domain.cells[0] as usize + column].into()
}
