//! The shock cells of a plane supersonic jet.

use crate::Result;
use crate::render::{Plot, Style};
use crate::verify::exact::gasdynamics::{ObliqueShock, jet_cell_length};
use crate::verify::exact::profile::{PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting};
use crate::verify::harness::{Case, group};

/// The scene.
const SCENE: &str = "validation/mach_diamond.toml";
/// Ratio of specific heats, Mach number of the nozzle, pressure there over that around it.
const JET: [f64; 3] = [1.4, 3.0, 0.5];
/// Pressure around the jet; that in the nozzle is 1.
const AMBIENT: f64 = 2.0;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::full("mach_diamond", "Mach diamond in a plane jet", group::SUPERSONIC_2D, diamond,
        "Cao et al. 2022, figure 18; oblique shock relations; L. Prandtl, Phys. Z. 5 (1904) 599; D. C. Pack, Q. J. Mech. Appl. Math. 3 (1950) 173."),
];

fn diamond(session: &mut Session<'_>) -> Result<()> {
    let length = jet_cell_length(JET[0], JET[1], JET[2]);
    for cells in [120, 240] {
        let run = session.run(SCENE, Setting::standard(cells), &[])?;
        let axis = Profile::along(&run, 0, 0.0);
        let crossing = report_crossing(session, &run, &axis);
        let spacing = spacing(&cell_starts(&axis));
        let row = session.check(&run, "length of cells 2 to 4", spacing).reference(length, "Prandtl, Pack; weak waves");
        row.within(0.1);
        session.plot(axis_plot(&run, &axis, crossing, length));
    }
    // the first crossing alone with 40 cells across the nozzle
    let short = ["domain.cells=[120, 80]", "domain.size=[3.0, 2.0]", "time.until=5.0"].map(str::to_owned);
    let run = session.run(SCENE, Setting::standard(0), &short)?;
    report_crossing(session, &run, &Profile::along(&run, 0, 0.0));
    Ok(())
}

/// Where the shocks from the lips cross; returns where they should.
fn report_crossing(session: &mut Session<'_>, run: &Run, axis: &Profile) -> f64 {
    let lip = ObliqueShock::of_pressure(JET[0], JET[1], 1.0 / JET[2]);
    // behind the crossing the shock is reflected once more
    let behind = ObliqueShock::weak(JET[0], lip.mach, lip.deflection).map_or(f64::NAN, |shock| shock.pressure);
    let first = axis.crossings(PRESSURE, 0.5 * (1.0 + AMBIENT * behind)).next().unwrap_or(f64::NAN);
    let crossing = 0.5 / lip.angle.tan();
    let row = session.check(run, "lip shocks cross at", first).reference(crossing, "oblique shock relations");
    let late = Limit::Between(crossing, crossing + 1.7 * axis.spacing);
    row.within(0.03).known(late, "at most 1.7 cells late: the pressure at the crossing rises over eight cells");
    crossing
}

/// Where the pressure on the axis rises through that around the jet.
fn cell_starts(axis: &Profile) -> Vec<f64> {
    let rising = |x: &f64| {
        let cell = ((x - axis.origin) / axis.spacing - 0.5).floor() as usize;
        axis.state[PRESSURE][cell + 1] > axis.state[PRESSURE][cell]
    };
    axis.crossings(PRESSURE, AMBIENT).filter(rising).collect()
}

/// Mean length of the second to the fourth cell, or of those there are.
fn spacing(starts: &[f64]) -> f64 {
    let last = starts.len().min(5);
    if last < 3 { f64::NAN } else { (starts[last - 1] - starts[1]) / (last - 2) as f64 }
}

fn axis_plot(run: &Run, axis: &Profile, crossing: f64, length: f64) -> Plot {
    let marks = (0..4).flat_map(|k| {
        let x = crossing + f64::from(k) * length;
        [[x, 0.0], [x, AMBIENT], [x, 0.0]]
    });
    Plot::new("Mach diamond: pressure on the axis", "x over height of the nozzle", "pressure")
        .with("first crossing, cells of weak waves", Style::Guide, marks.collect())
        .with(run.label.clone(), Style::Line, axis.points(PRESSURE))
}
