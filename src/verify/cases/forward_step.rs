//! The forward-facing step in a wind tunnel at Mach 3.

use crate::Result;
use crate::render::{Plot, Style};
use crate::scene::Pair;
use crate::verify::exact::gasdynamics;
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// Who computed the positions, on 320 cells per unit.
const REFERENCE: &str = "MUSCL-HLLC, 320 per unit";
/// Pressure at which shocks are looked for.
const LEVEL: f64 = 4.0;

/// Why the triple point lies too high.
const TRIPLE_POINT: &str =
    "the more a method smears, the shorter the stem: 0.7312 by MUSCL-HLLC with 80 cells per unit";

/// Why the pressure just below the corner is too high with few cells.
const CORNER: &str = "two cells below the corner; with 80 cells per unit 11.95";

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("forward_step", "Forward-facing step at Mach 3", group::SUPERSONIC_2D, step,
        "P. Woodward, P. Colella, J. Comput. Phys. 54 (1984) 115; positions at t = 4 of an independent MUSCL-HLLC solver with 80, \
             160 and 320 cells per unit, no fix at the corner; Rayleigh's pitot formula.")];

fn step(session: &mut Session<'_>) -> Result<()> {
    let standard = |pair, cells| Setting { pair, integrator: Integrator::Predictor, cells };
    let settings = match session.suite {
        Suite::Quick => vec![standard(Pair::B1b0, 120)],
        Suite::Full => vec![standard(Pair::B1b0, 120), standard(Pair::B1b0, 240), standard(Pair::B2b1, 240)],
    };
    for setting in settings {
        let run = session.run("paper/fig15_stair_flow.toml", setting, &[])?;
        report(session, &run);
        session.plot(along_tunnel(&run));
    }
    Ok(())
}

/// Positions at t = 4. The gates are those for 80 cells per unit; half as many may miss by twice as much. That of the triple point is the one
/// of the double Mach reflection.
fn report(session: &mut Session<'_>, run: &Run) {
    let wide = 80.0 * run.scene.domain.spacing();
    let between = |value: f64, width: f64| Limit::Between(value - wide * width, value + wide * width);
    let first = |y: f64| Profile::along(run, 0, y).crossings(PRESSURE, LEVEL).next().unwrap_or(f64::NAN);
    let spacing = run.scene.domain.spacing();
    session.check(run, "bow shock at y = 0.1", first(0.1)).reference(0.3121, REFERENCE).pass(between(0.3121, 0.02));
    session.check(run, "bow shock at y = 0.5", first(0.5)).reference(0.4283, REFERENCE).pass(between(0.4283, 0.02));
    let stem = session.check(run, "Mach stem at the roof", first(1.0)).reference(0.5849, REFERENCE);
    stem.pass(between(0.5849, 0.05));
    let height = triple_point(run, first);
    let row = session.check(run, "height of the upper triple point", height).reference(0.7266, REFERENCE);
    row.pass(between(0.7266, 0.03)).known(between(0.7266, 0.06), TRIPLE_POINT);
    let surface = Profile::along(run, 0, 0.2 + 0.5 * spacing);
    let met = surface.steepest_rise(PRESSURE, [0.8, 2.0]);
    let row = session.check(run, "shock meets the step", met).reference(1.2969, REFERENCE).pass(between(1.2969, 0.07));
    if run.scene.numerics.pair == Pair::B2b1 {
        row.known(between(1.2969, 0.083), "one cell beyond with 80 per unit; a quarter of a cell between cells");
    }
    let face = Profile::along(run, 1, 0.6 - 0.5 * spacing).extremes(PRESSURE, [0.0, 0.2])[1];
    let pitot = gasdynamics::pitot_pressure(run.scene.gas.gamma, 3.0);
    let row = session.check(run, "highest pressure at the face", face).reference(pitot, "Rayleigh pitot").within(0.02);
    if wide > 1.5 {
        row.known(Limit::AtMost(12.4), CORNER);
    }
    let foot = Profile::along(run, 1, 0.6 - 0.5 * spacing).state[PRESSURE][0];
    let row = session.check(run, "pressure at the foot of the face", foot).reference(pitot, "Rayleigh pitot");
    row.pass(Limit::Between(11.8, pitot));
}

/// Height of the kink between bow shock and upper Mach stem: where the front between y = 0.6 and 0.95 is farthest from a straight line.
fn triple_point(run: &Run, front: impl Fn(f64) -> f64) -> f64 {
    let ends = [0.6, 0.95];
    let slope = (front(ends[1]) - front(ends[0])) / (ends[1] - ends[0]);
    let rows = (0..run.scene.domain.cells[1]).map(|row| run.scene.domain.cell_center([0, row, 0])[1]);
    let distance = |y: f64| front(y) - front(ends[0]) - slope * (y - ends[0]);
    let inside = rows.filter(|y| (ends[0]..ends[1]).contains(y));
    inside.max_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(f64::NAN)
}

/// Density along the middle of the tunnel.
fn along_tunnel(run: &Run) -> Plot {
    let line = Profile::along(run, 0, 0.5);
    // at x = 0.5, 1, 1.5, 2, 2.5
    let reference = vec![[0.5, 4.560], [1.0, 2.412], [1.5, 1.829], [2.0, 2.915], [2.5, 2.303]];
    Plot::new(format!("{}, y = 0.5", run.scene.title), "x", "density")
        .with(run.label.clone(), Style::Line, line.points(DENSITY))
        .with("MUSCL-HLLC, 160 per unit", Style::Marks, reference)
}
