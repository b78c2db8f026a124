//! Open sides: what lay far away at the start is there when the waves have left, and air under gravity stays at rest.

use crate::Result;
use crate::scene::Changes;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("leaving_blast", "Pressure after a blast", group::OPEN_SIDES, blasts,
        "Exact: undisturbed gas far away brings its pressure back."),
    Case::quick("still_air", "Still air under gravity", group::OPEN_SIDES, air,
        "Exact: air in balance stays at rest."),
];

/// Pressures of the blast; whether it lies at a wall instead of in the middle; whether in the plane.
const QUICK: &[(f64, bool, bool)] =
    &[(2.0, false, false), (10.0, true, false), (100.0, false, false), (10.0, false, true)];
const FULL: &[(f64, bool, bool)] = &[
    (2.0, true, false),
    (10.0, false, false),
    (100.0, true, false),
    (2.0, false, true),
    (2.0, true, true),
    (10.0, true, true),
    (100.0, false, true),
    (100.0, true, true),
];

fn blasts(session: &mut Session<'_>) -> Result<()> {
    let more = if session.suite == Suite::Full { FULL } else { &[] };
    for &(pressure, corner, plane) in QUICK.iter().chain(more) {
        let mut overrides = vec![format!("gas.regions[0].pressure={pressure:?}"), "expect.probes=[]".to_owned()];
        if plane {
            let plane = ["domain.dimension=2", "domain.cells=[64, 64]", "domain.size=[1.0, 1.0]", "probes=[]"];
            overrides.extend(plane.map(str::to_owned));
            overrides.extend(["y_min", "y_max"].map(|side| format!("boundary.{side}=outlet")));
            overrides.push("gas.regions[0].shape.sphere.center=[0.5, 0.5]".to_owned());
        }
        if corner {
            let (center, walls) =
                if plane { ("[0.0, 0.0]", &["x_min", "y_min"][..]) } else { ("[0.0]", &["x_min"][..]) };
            overrides.push(format!("gas.regions[0].shape.sphere.center={center}"));
            overrides.extend(walls.iter().map(|side| format!("boundary.{side}=wall")));
        }
        let run = session.run("validation/leaving_blast.toml", Setting::standard(0), &overrides)?;
        let off = run.snapshot.pressure.iter().map(|p| f64::from(p - 1.0).abs()).fold(0.0, f64::max);
        let place = if corner { "from a wall" } else { "from the middle" };
        let name = format!("blast of {pressure} {place}, largest |p - 1| after five crossings");
        session.check(&run, &name, off).reference(0.0, "exact").pass(Limit::AtMost(0.01));
    }
    Ok(())
}

/// Sides that are walls instead of open, beside the ground; whether in space.
const AIR: &[(&[&str], bool)] = &[(&[], false), (&["x_min"], false), (&["y_max"], false), (&[], true)];

fn air(session: &mut Session<'_>) -> Result<()> {
    for &(walls, space) in AIR {
        let mut changes = if space { Changes::variant("space") } else { Changes::default() };
        changes.set.extend(walls.iter().map(|side| format!("boundary.{side}=wall")));
        let run = session.run("validation/still_air.toml", Setting::standard(0), changes)?;
        let name =
            if walls.is_empty() { "largest speed".to_owned() } else { format!("largest speed, wall at {}", walls[0]) };
        session.check(&run, &name, run.summary.max_speed).reference(0.0, "exact").pass(Limit::AtMost(0.01));
    }
    Ok(())
}
