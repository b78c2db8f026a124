//! Bodies with a prescribed motion, against gas dynamics: a piston in a tube, a closed chamber, a wedge in flight.

use crate::Result;
use crate::render::{Plot, Style};
use crate::snapshot::{Snapshot, kind};
use crate::verify::exact::gasdynamics::ObliqueShock;
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::plane::{fitted_line, upper_crossings};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("driven_piston", "Driven piston", group::COUPLING_1D, piston,
        "Exact: R. Courant, K. O. Friedrichs, Supersonic Flow and Shock Waves, 1948. The first speed is that of the test \"piston with constant velocity\" of the flow solver Eilmer (P. A. Jacobs, R. J. Gollan)."),
    Case::quick("compressed_chamber", "Chamber compressed by a slow piston", group::COUPLING_1D, chamber,
        "Exact: constant entropy. Piston validation of the material point code Uintah (MPMICE)."),
    Case::full("flying_wedge", "Wedge that flies at Mach 2", group::COUPLING, wedge,
        "Ames Research Staff, NACA report 1135, 1953; test \"M2wedge\" of the material point code Uintah (MPMICE)."),
];

/// Who says what a driven piston does.
const EXACT: &str = "Courant and Friedrichs 1948";
/// Ratio of specific heats.
const AIR: f64 = 1.4;

/// Gas between two x: mass per area of its gas cells \[kg m^-2\], volume-weighted pressure \[Pa\] and density \[kg m^-3\].
fn gas_between(scene: &crate::scene::Scene, stop: &Snapshot, [low, high]: [f64; 2]) -> [f64; 3] {
    let line = Profile::of(scene, stop);
    let inside = (0..line.cells())
        .filter(|k| (low..=high).contains(&line.center(*k)) && stop.kind[*k] & kind::MASK == kind::GAS);
    let (mut count, mut sums) = (0.0, [0.0; 2]);
    for cell in inside {
        count += 1.0;
        sums[0] += line.state[DENSITY][cell];
        sums[1] += line.state[PRESSURE][cell];
    }
    [sums[0] * line.spacing, sums[1] / count, sums[0] / count]
}

/// Why some gas is in no cell.
const LEDGER: &str =
    "what a cell holds when the piston covers it waits in the ledger and is given back over some steps";

/// Low and high face of the first body along x \[m\].
fn faces(stop: &Snapshot, half: f64) -> [f64; 2] {
    let middle = stop.bodies(1).swap_remove(0).centroid[0];
    [middle - half, middle + half]
}

fn piston(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[400] } else { &[200, 400, 800] };
    for (speed, time) in [(0.876_750, 0.912_461), (1.0, 0.9)] {
        for &cells in cells {
            let motion = [format!("bodies[0].motion.velocity=[{speed}]"), format!("time.until={time}")];
            let path = "validation/driven_piston.toml";
            // the last eight cells of its way
            let late = time - 0.08 / speed;
            let times = (0..=32).map(|k| late + (time - late) * f64::from(k) / 32.0);
            let mut journey = session.follow(path, Setting::standard(cells), &motion, times)?;
            journey.run.label = format!("{} Mach {speed}", journey.run.label);
            report_piston(session, &journey, speed, time);
        }
    }
    Ok(())
}

fn report_piston(session: &mut Session<'_>, journey: &Journey, speed: f64, time: f64) {
    let run = &journey.run;
    let spacing = run.scene.domain.spacing();
    // the gates are for 400 cells; half as many may miss by twice as much
    let coarse = (400.0 / f64::from(run.scene.domain.cells[0])).max(1.0);
    let stop = &run.snapshot;
    let line = Profile::of(&run.scene, stop);
    let [back, face] = faces(stop, 0.1);
    // [Courant & Friedrichs 1948, section 69]: Ms^2 - (gamma + 1) / 2 Ms u / c - 1 = 0
    let mach = 0.6 * speed + (0.36 * speed * speed + 1.0).sqrt();
    let high = 1.0 + AIR * mach * speed;
    let shock = 1.6 + mach * time;
    let ahead = line.mean(PRESSURE, [face + 3.0 * spacing, shock - 8.0 * spacing]);
    session.check(run, "pressure ahead", ahead).reference(high, EXACT).within(0.01);
    let found = line.nearest_crossing(PRESSURE, 0.5 * (1.0 + high), shock);
    let row = session.check(run, "shock, cells off its place", (found - shock) / spacing);
    row.reference(0.0, EXACT).pass(Limit::Between(-1.5, 1.5));
    let low = (1.0 - 0.2 * speed).powi(7);
    let beside = journey.stops[1..].iter().map(|stop| {
        let back = faces(stop, 0.1)[0];
        gas_between(&run.scene, stop, [back - 2.5 * spacing, back])[1]
    });
    let beside: Vec<f64> = beside.collect();
    let mean = beside.iter().sum::<f64>() / beside.len() as f64;
    let row = session.check(run, "pressure at the face behind, mean over eight cells of the way", mean);
    row.reference(low, EXACT).within(0.02 * coarse);
    let off = beside.iter().map(|p| (p / low - 1.0).abs()).fold(0.0, f64::max);
    session.check(run, "the same, largest relative error at a time", off).source(EXACT);
    let plateau = line.mean(PRESSURE, [back - 0.3, back - 4.0 * spacing]);
    session.check(run, "pressure between fan and face", plateau).reference(low, EXACT).within(0.02);
    let middle = (1.0 - 0.1 * speed).powi(7);
    let place = 1.4 - (1.0 - 0.6 * speed) * time;
    let found = line.nearest_crossing(PRESSURE, middle, place);
    let row = session.check(run, "middle of the fan, cells off its place", (found - place) / spacing);
    row.reference(0.0, EXACT).pass(Limit::Between(-2.0, 2.0));
    let [now, start] =
        [(stop, face), (&journey.stops[0], 1.6)].map(|(stop, face)| gas_between(&run.scene, stop, [face, 4.0])[0]);
    let swept = AIR * speed * time;
    let row = session.check(run, "gas missing ahead, over that swept", (start - now) / swept);
    row.reference(0.0, "nothing leaks")
        .pass(Limit::Between(-1e-3, 1e-3))
        .known(Limit::Between(-5e-3 * coarse, 5e-3 * coarse), LEDGER);
    let drift = journey.budgets[1].drift_since(&journey.budgets[0])["gas_mass"];
    session
        .check(run, "gas mass of both sides and the ledger, drift", drift)
        .source("conservation law")
        .pass(Limit::AtMost(1e-6));
    let fan = [[1.4 - time, 1.0], [place, middle], [1.4 - (1.0 - 1.2 * speed) * time, low]];
    plot_piston(
        session,
        run,
        &line,
        [&fan[..], &[[back, low], [face, high], [shock, high], [shock, 1.0], [4.0, 1.0]]].concat(),
    );
}

/// Pressure along the tube, exact and ours.
fn plot_piston(session: &mut Session<'_>, run: &Run, line: &Profile, exact: Vec<[f64; 2]>) {
    let plot = Plot::new(format!("Driven piston, {}: pressure", run.label), "x", "pressure");
    let ours = line.points(PRESSURE);
    session.plot(plot.with(EXACT, Style::Reference, exact).with(run.label.clone(), Style::Marks, ours));
}

fn chamber(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[64] } else { &[64, 160, 320] };
    for &cells in cells {
        let speed = 0.034_116_5;
        let places = [0.5, 0.2];
        let times = places.map(|place| (1.0 - place) / speed);
        let until = [format!("time.until={}", times[1])];
        let journey = session.follow("validation/compressed_chamber.toml", Setting::standard(cells), &until, times)?;
        for ((place, share), stop) in places.into_iter().zip([0.01, 0.02]).zip(&journey.stops[1..]) {
            report_chamber(session, &journey.run, stop, place, share);
        }
    }
    Ok(())
}

fn report_chamber(session: &mut Session<'_>, run: &Run, stop: &Snapshot, place: f64, share: f64) {
    let [mass, pressure, density] = gas_between(&run.scene, stop, [0.0, place]);
    let named = |quantity: &str| format!("face at {place}: {quantity}");
    let row = session.check(run, &named("mean pressure"), pressure);
    row.reference(place.powf(-AIR), "constant entropy").within(share);
    session.check(run, &named("mean density"), density).reference(1.0 / place, "conservation law").within(share);
    let row = session.check(run, &named("trapped mass"), mass).reference(1.0, "conservation law");
    row.within(5e-3).known(Limit::Between(0.985, 1.0), LEDGER);
    let entropy = pressure / density.powf(AIR);
    session.check(run, &named("p over density^gamma"), entropy).reference(1.0, "constant entropy").within(0.01);
}

/// Mach number of the wedge; the scene has it as its speed.
const MACH: f64 = 2.006_772_3;
/// Pressures at the flank of a wedge that flies and of one that stands in a stream.
const WEDGE: &str = "NACA report 1135";

/// What is known of the misses.
const STEPS: &str = "the flank is a stair of cells, and the flow close to detachment; the standing wedge misses, too";

fn wedge(session: &mut Session<'_>) -> Result<()> {
    let Some(exact) = ObliqueShock::weak(AIR, MACH, 20_f64.to_radians()) else { return Ok(()) };
    let path = "validation/flying_wedge.toml";
    let mut flying = session.run(path, Setting::standard(360), &[])?;
    flying.label = format!("{} flies", flying.label);
    let stream = format!("{{ density = 1.4, velocity = [{MACH}, 0.0], pressure = 1.0 }}");
    let standing = [
        "bodies[0].motion.velocity=[0.0, 0.0]".to_owned(),
        "bodies[0].shape.polygon.points=[[1.0, 0.0], [3.0, 0.0], [2.0, 0.363970]]".to_owned(),
        format!("gas.ambient={stream}"),
        format!("boundary.x_min={{ inlet = {stream} }}"),
    ];
    let mut stood = session.run(path, Setting::standard(360), &standing)?;
    stood.label = format!("{} in a stream", stood.label);
    let pressures = [&flying, &stood].map(|run| report_wedge(session, run, &exact));
    let row = session.push("pressure at the flank, in flight over in a stream", pressures[0] / pressures[1]);
    row.reference(1.0, "Galileo").within(0.02).known(Limit::Between(0.97, 1.07), STEPS);
    Ok(())
}

fn report_wedge(session: &mut Session<'_>, run: &Run, exact: &ObliqueShock) -> f64 {
    let tip = run.snapshot.bodies(1).swap_remove(0).centroid[0] - 1.0;
    let points = upper_crossings(run, PRESSURE, 0.5 * (1.0 + exact.pressure), [tip + 0.3, tip + 0.9]);
    let angle = fitted_line(&points)[0].atan().to_degrees();
    let goal = exact.angle.to_degrees();
    let row = session.check(run, "angle of the shock, degrees", angle).reference(goal, WEDGE);
    row.pass(Limit::Between(goal - 1.5, goal + 1.5)).known(Limit::AtLeast(48.0), STEPS);
    // the middle third of the flank, two to six cells off its steps
    let (domain, slope) = (&run.scene.domain, 20_f64.to_radians().tan());
    let columns = (0..domain.cells[0]).map(|column| domain.cell_center([column, 0, 0])[0]);
    let middle = columns.filter(|x| (tip + 0.35..=tip + 0.65).contains(x));
    let [near, off]: [Vec<f64>; 2] = [[0.0, 1.0], [2.0, 6.0]].map(|range| {
        let band = |x: f64| range.map(|cells| (x - tip) * slope + (cells + 0.5) * domain.spacing());
        let means = middle.clone().map(|x| Profile::along(run, 1, x).mean(PRESSURE, band(x)));
        means.filter(|p| p.is_finite()).collect()
    });
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let row = session.check(run, "pressure at the middle of the flank", mean(&off));
    row.reference(exact.pressure, WEDGE).within(0.03).known(Limit::AtLeast(0.96 * exact.pressure), STEPS);
    session.check(run, "the same in the cells next to it", mean(&near)).reference(exact.pressure, WEDGE);
    mean(&off)
}
