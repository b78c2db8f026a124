//! Steady supersonic streams with closed formulas: wedge, corners, reflection.

use crate::Result;
use crate::render::{Plot, Style};
use crate::verify::exact::gasdynamics::{self, AIR, ObliqueShock, prandtl_meyer};
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::plane::{fitted_line, upper_crossings};

/// Mach number of the stream but in the reflection.
const MACH: f64 = 3.0;
/// Where oblique shocks come from.
const OBLIQUE: &str = "theta-beta-M relation";

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::full("compression_corner", "Supersonic compression corner", group::SUPERSONIC_2D, compression,
        "Oblique shock relations, NACA report 1135 (1953)."),
    Case::quick("wedge", "Supersonic wedge", group::SUPERSONIC_2D, wedge,
        "Oblique shock relations, NACA report 1135 (1953). The ramp cuts cells."),
    Case::full("expansion_corner", "Supersonic expansion corner", group::SUPERSONIC_2D, expansion,
        "Prandtl-Meyer function, NACA report 1135 (1953)."),
    Case::full("regular_reflection", "Regular reflection of an oblique shock", group::SUPERSONIC_2D, reflection,
        "H. C. Yee, R. F. Warming, A. Harten, AIAA paper 83-1943 (1983); exact oblique shock relations."),
];

/// Angle of a shock to the x axis, from where the pressure passes half its jump between two x \[deg\].
fn shock_angle(run: &Run, pressure: f64, range: [f64; 2]) -> f64 {
    let points = upper_crossings(run, PRESSURE, 0.5 * (1.0 + pressure), range);
    fitted_line(&points)[0].atan().to_degrees()
}

fn compression(session: &mut Session<'_>) -> Result<()> {
    let turn = 15_f64.to_radians();
    let Some(exact) = ObliqueShock::weak(AIR, MACH, turn) else { return Ok(()) };
    for run in session.runs("validation/compression_corner.toml", [100, 200])? {
        let angle = shock_angle(&run, exact.pressure, [0.3, 0.9]) + 15.0;
        let goal = exact.angle.to_degrees();
        let row = session.check(&run, "shock angle to the stream, degrees", angle).reference(goal, OBLIQUE);
        row.pass(Limit::Between(goal - 0.5, goal + 0.5));
        let wall = Profile::along(&run, 0, 0.0);
        let range = [0.3, 0.9];
        let pressure = wall.mean(PRESSURE, range);
        session.check(&run, "pressure at the wall", pressure).reference(exact.pressure, OBLIQUE).within(0.01);
        let density = Profile::along(&run, 1, 0.8).mean(DENSITY, [0.06, 0.16]) / 1.4;
        session.check(&run, "density ratio behind", density).reference(exact.density, OBLIQUE).within(0.01);
        session.plot(wall_plot(&run, &wall, exact.pressure));
    }
    Ok(())
}

fn wedge(session: &mut Session<'_>) -> Result<()> {
    wedge_of(session, "validation/wedge.toml", MACH, 15.0)?;
    if session.suite == Suite::Quick { Ok(()) } else { wedge_of(session, "validation/wedge_mach2.toml", 2.0, 10.0) }
}

fn wedge_of(session: &mut Session<'_>, path: &str, mach: f64, degrees: f64) -> Result<()> {
    let Some(exact) = ObliqueShock::weak(AIR, mach, degrees.to_radians()) else { return Ok(()) };
    for run in session.runs(path, [100, 200])? {
        let named = |quantity: &str| format!("Mach {mach}, {degrees} degrees: {quantity}");
        let angle = shock_angle(&run, exact.pressure, [0.35, 0.8]);
        let goal = exact.angle.to_degrees();
        let row = session.check(&run, &named("shock angle, degrees"), angle).reference(goal, OBLIQUE);
        row.pass(Limit::Between(goal - 0.5, goal + 0.5));
        let ramp = ramp_pressure(&run, [0.4, 0.9]);
        let mean = ramp.iter().map(|point| point[1]).sum::<f64>() / ramp.len() as f64;
        let row = session.check(&run, &named("mean pressure on the ramp"), mean);
        row.reference(exact.pressure, OBLIQUE).within(0.01);
        let spread = ramp.iter().map(|point| (point[1] / mean - 1.0).powi(2)).sum::<f64>() / ramp.len() as f64;
        let row = session.check(&run, &named("its unevenness, rms over mean"), spread.sqrt()).source("theory: even");
        row.pass(Limit::AtMost(0.01));
        let plot = Plot::new(format!("Wedge at Mach {mach}: pressure on the ramp"), "x", "pressure");
        let line = vec![[0.1, exact.pressure], [1.0, exact.pressure]];
        session.plot(plot.with(OBLIQUE, Style::Reference, line).with(run.label.clone(), Style::Marks, ramp));
    }
    Ok(())
}

/// Pressure in the first gas cell of every column between two x.
fn ramp_pressure(run: &Run, [low, high]: [f64; 2]) -> Vec<[f64; 2]> {
    let columns = (0..run.scene.domain.cells[0]).map(|column| run.scene.domain.cell_center([column, 0, 0])[0]);
    let first = |x: f64| Profile::along(run, 1, x).state[PRESSURE].iter().copied().find(|p| p.is_finite());
    columns.filter(|x| (low..=high).contains(x)).filter_map(|x| Some([x, first(x)?])).collect()
}

fn wall_plot(run: &Run, wall: &Profile, exact: f64) -> Plot {
    Plot::new(format!("{}: pressure at the wall", run.scene.title), "x", "pressure")
        .with("exact", Style::Reference, vec![[0.0, exact], [run.scene.domain.size[0], exact]])
        .with(run.label.clone(), Style::Marks, wall.points(PRESSURE))
}

/// Share of the turn at which the edges of the fan are measured: at the very edges the slope has a kink, which no grid resolves.
const EDGE: f64 = 0.05;

/// Pressure on the characteristic of the fan where the stream has turned by an angle \[rad\], and its angle to the wall \[deg\].
fn characteristic(turned: f64) -> (f64, f64) {
    let mach = gasdynamics::expanded_mach(AIR, MACH, turned);
    let pressure = gasdynamics::total_pressure(AIR, MACH) / gasdynamics::total_pressure(AIR, mach);
    (pressure, ((1.0 / mach).asin() + 15_f64.to_radians() - turned).to_degrees())
}

fn expansion(session: &mut Session<'_>) -> Result<()> {
    let turn = 15_f64.to_radians();
    let behind = gasdynamics::expanded_mach(AIR, MACH, turn);
    let exact = gasdynamics::total_pressure(AIR, MACH) / gasdynamics::total_pressure(AIR, behind);
    for run in session.runs("validation/expansion_corner.toml", [100, 200])? {
        let wall = Profile::along(&run, 0, 0.0);
        let pressure = wall.mean(PRESSURE, [0.5, 0.9]);
        session.check(&run, "pressure at the wall", pressure).reference(exact, "Prandtl-Meyer").within(0.01);
        for (name, share) in [("leading edge", EDGE), ("middle", 0.5), ("trailing edge", 1.0 - EDGE)] {
            let (level, goal) = characteristic(share * turn);
            let points = upper_crossings(&run, PRESSURE, level, [0.3, 0.9]);
            let angle = fitted_line(&points)[0].atan().to_degrees();
            let row =
                session.check(&run, &format!("{name} of the fan, degrees"), angle).reference(goal, "Prandtl-Meyer");
            row.pass(Limit::Between(goal - 1.0, goal + 1.0));
        }
        session.plot(fan_plot(&run, behind));
    }
    Ok(())
}

/// Pressure over the height in the fan at x = 0.8, ours and exact.
fn fan_plot(run: &Run, behind: f64) -> Plot {
    let x = 0.8;
    let exact = (0..=60).map(|k| {
        let mach = MACH + (behind - MACH) * f64::from(k) / 60.0;
        let turned = prandtl_meyer(AIR, mach) - prandtl_meyer(AIR, MACH);
        let angle = (1.0 / mach).asin() + 15_f64.to_radians() - turned;
        [x * angle.tan(), gasdynamics::total_pressure(AIR, MACH) / gasdynamics::total_pressure(AIR, mach)]
    });
    Plot::new("Prandtl-Meyer fan at x = 0.8", "height", "pressure")
        .with("exact", Style::Reference, exact.collect())
        .with(run.label.clone(), Style::Marks, Profile::along(run, 1, x).points(PRESSURE))
}

fn reflection(session: &mut Session<'_>) -> Result<()> {
    let ahead = 2.9;
    let incident = ObliqueShock::at_angle(AIR, ahead, 29_f64.to_radians());
    let Some(reflected) = ObliqueShock::weak(AIR, incident.mach, incident.deflection) else { return Ok(()) };
    let before = incident.pressure / AIR;
    let exact = before * reflected.pressure;
    for cells in [80, 160, 320] {
        let run = session.run("validation/regular_reflection.toml", Setting::standard(cells), &[])?;
        let wall = Profile::along(&run, 0, 0.0);
        let pressure = wall.mean(PRESSURE, [2.6, 3.8]);
        session.check(&run, "pressure behind", pressure).reference(exact, OBLIQUE).within(0.01);
        let density = wall.mean(DENSITY, [2.6, 3.8]);
        let goal = incident.density * reflected.density;
        session.check(&run, "density behind", density).reference(goal, OBLIQUE).within(0.01);
        let place = 1.0 / incident.angle.tan();
        let met = wall.nearest_crossing(PRESSURE, 0.5 * (1.0 / AIR + exact), place);
        // half a cell above the wall, where the exact reflected shock is 1.16 cells behind the impact
        session.check(&run, "half of the rise along the wall's cells", met).reference(place, OBLIQUE);
        let [slope, offset] = fitted_line(&upper_crossings(&run, PRESSURE, 0.5 * (1.0 / AIR + before), [0.4, 1.4]));
        let row = session.check(&run, "incident shock, extended to the wall", -offset / slope);
        row.reference(place, OBLIQUE).pass(Limit::Between(place - 0.03, place + 0.03));
        let points = upper_crossings(&run, PRESSURE, 0.5 * (before + exact), [2.4, 3.4]);
        let angle = fitted_line(&points)[0].atan().to_degrees();
        let goal = (reflected.angle - incident.deflection).to_degrees();
        session.check(&run, "reflected shock to the wall, degrees", angle).reference(goal, OBLIQUE);
        session.plot(wall_plot(&run, &wall, exact));
    }
    Ok(())
}
