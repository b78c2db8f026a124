//! Subsonic flow through a duct whose ends say how fast it is.

use crate::Result;
use crate::render::{Plot, Style};
use crate::scene::Changes;
use crate::verify::exact::gasdynamics::total_pressure;
use crate::verify::exact::profile::{Profile, VELOCITY};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("subsonic_duct", "Subsonic duct: inlets of given total and fixed state", group::SUBSONIC, duct,
        "Isentropic flow, NACA report 1135 (1953): the ratio of the pressures of reservoir and room gives Mach 0.5."),
];

/// Who says so.
const ISENTROPIC: &str = "isentropic flow";
/// Mach number for the pressures of the scene.
const MACH: f64 = 0.5;

fn duct(session: &mut Session<'_>) -> Result<()> {
    for (changes, inlet) in [(Changes::default(), "total inlet"), (Changes::variant("fixed"), "fixed inlet")] {
        let run = session.run("validation/subsonic_duct.toml", Setting::standard(0), changes)?;
        report(session, &run, inlet);
    }
    Ok(())
}

/// Means over the duct, and how uneven it is.
fn report(session: &mut Session<'_>, run: &Run, inlet: &str) {
    let (gamma, gas) = (run.scene.gas.gamma, &run.snapshot);
    let count = gas.density.len() as f64;
    let mean = |sum: f64| sum / count;
    let density = mean(gas.density.iter().copied().map(f64::from).sum());
    let pressure = mean(gas.pressure.iter().copied().map(f64::from).sum());
    let velocity = mean(gas.velocity.iter().map(|v| f64::from(v[0])).sum());
    let mach = velocity / (gamma * pressure / density).sqrt();
    let rest = 1.0 / total_pressure(gamma, MACH);
    let dense = rest.powf(1.0 / gamma);
    let flow = dense * MACH * (gamma * rest / dense).sqrt();
    let named = |what: &str| format!("{inlet}: {what}");
    session.check(run, &named("Mach number"), mach).reference(MACH, ISENTROPIC).within(0.01);
    session.check(run, &named("flow of mass"), density * velocity).reference(flow, ISENTROPIC).within(0.01);
    session.check(run, &named("pressure"), pressure).reference(rest, ISENTROPIC).within(0.005);
    let total = pressure * total_pressure(gamma, mach);
    session.check(run, &named("total pressure"), total).reference(1.0, ISENTROPIC).within(0.005);
    let uneven = gas.pressure.iter().map(|p| (f64::from(*p) / pressure - 1.0).abs()).fold(0.0, f64::max);
    let row = session.check(run, &named("pressure, largest deviation from its mean"), uneven);
    row.source(ISENTROPIC).pass(Limit::AtMost(0.005));
    let speeds = Profile::along(run, 0, 0.5).points(VELOCITY);
    let exact = vec![[0.0, flow / dense], [4.0, flow / dense]];
    let plot = Plot::new(format!("{}: speed on the axis", run.scene.title), "x", "speed");
    session.plot(plot.with(ISENTROPIC, Style::Reference, exact).with(run.label.clone(), Style::Marks, speeds));
}
