//! Bodies that gas drives in 1D: a slab between two gases, guns, and an elastic half space.

use crate::Result;
use crate::render::{Plot, Style};
use crate::scene::Pair;
use crate::verify::exact::profile::{PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::budgets::{self, Gates, LAGRANGIAN, Station, motion_plot, report_motion};
use crate::verify::measure::solids::{front, mean_velocity};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("driven_slab", "Compressed gas drives a slab", group::COUPLING_1D, slab,
        "Rigid piston between two gases: Lagrangian Godunov scheme with exact Riemann problems at the piston, 1500 cells per side."),
    Case::quick("lagrange_gun", "Lagrange gun", group::COUPLING_1D, gun,
        "J. Corner, Theory of the Interior Ballistics of Guns, 1950; Lagrangian solver with exact Riemann problems at the shot, 3200 cells."),
    Case::quick("piston_into_vacuum", "Piston into a vacuum", group::COUPLING_1D, vacuum,
        "Free piston in the tests of the flow solver Eilmer (P. A. Jacobs, R. J. Gollan); exact simple wave."),
    Case::quick("elastic_half_space", "Shock on an elastic half space", group::COUPLING_1D, half_space,
        "Exact: Hugoniot curve of the gas and acoustic impedance of the solid."),
];

/// Density and modulus of a slab, its motion, and the share of a cell that its place may be off.
type Slab = (f64, f64, [Station; 4], f64);

/// Heavy, middle and light.
#[rustfmt::skip]
const SLABS: [Slab; 3] = [
    (50.0, 1e4, [[0.2, 0.001_671, 0.054_41], [0.3, 0.011_299, 0.137_63], [0.4, 0.028_946, 0.213_74], [0.5, 0.053_727, 0.279_10]], 0.5),
    (5.0, 1e4, [[0.2, 0.013_630, 0.402_61], [0.3, 0.070_573, 0.690_69], [0.4, 0.145_909, 0.796_11], [0.5, 0.227_467, 0.828_77]], 0.5),
    (0.5, 1e3, [[0.2, 0.043_072, 0.840_23], [0.3, 0.127_444, 0.844_89], [0.4, 0.212_257, 0.845_62], [0.5, 0.284_318, 0.017_58]], 1.0),
];

fn slab(session: &mut Session<'_>) -> Result<()> {
    let quick = session.suite == Suite::Quick;
    let cells: &[u32] = if quick { &[100] } else { &[100, 200, 400] };
    // the middle one stands for all in the quick suite
    for (density, modulus, table, share) in SLABS.iter().filter(|slab| !quick || slab.0 == 5.0) {
        let coarse = Setting { pair: Pair::B2b1, ..Setting::standard(cells[0]) };
        let settings = cells.iter().map(|&cells| Setting::standard(cells)).chain((!quick).then_some(coarse));
        for setting in settings {
            let cells = setting.cells;
            let kind = [
                format!("bodies[0].density={density}"),
                format!("materials.stiff.neo_hookean.young_modulus={modulus}"),
            ];
            let times = table.iter().map(|station| station[0]);
            let mut journey = session.follow("coupled/piston.toml", setting, &kind, times)?;
            journey.run.label = format!("{} density {density}", journey.run.label);
            let path = journey.path(0);
            let start = path[0].1.centroid[0];
            let error = table.iter().zip(&path[1..]).map(|(station, (_, body))| body.centroid[0] - start - station[1]);
            let error = error.fold(0.0, |most: f64, error| most.max(error.abs())) * f64::from(cells);
            let row = session.check(&journey.run, "largest error of the place, cells", error);
            row.source(LAGRANGIAN).pass(Limit::AtMost(*share));
            report_motion(session, &journey, LAGRANGIAN, table, None);
            let known = (6e-4, VIBRATES);
            budgets::report_energy(session, &journey, if *modulus > 1e3 { 3e-4 } else { 1e-3 }, known);
            if cells == cells.min(200) {
                session.plot(motion_plot(&journey, LAGRANGIAN, table));
            }
        }
    }
    Ok(())
}

/// Displacement and velocity of a shot as heavy as the gas that drives it.
const GUN: [Station; 5] = [
    [0.5, 0.105_505, 0.390_930],
    [1.0, 0.369_822, 0.651_657],
    [2.0, 1.208_118, 0.997_582],
    [3.0, 2.324_708, 1.214_254],
    [4.0, 3.602_828, 1.331_576],
];

fn gun(session: &mut Session<'_>) -> Result<()> {
    // 100, 200 and 400 in the chamber
    let cells: &[u32] = if session.suite == Suite::Quick { &[520] } else { &[520, 1040, 2080] };
    for &cells in cells {
        let times = GUN.iter().map(|station| station[0]);
        let journey = session.follow("validation/lagrange_gun.toml", Setting::standard(cells), &[], times)?;
        // the gates are for 200 cells in the chamber; half as many may miss by twice as much
        let coarse = 1040.0 / f64::from(cells.min(1040));
        let gates = Gates { place: 0.01 * coarse, velocity: 0.015 * coarse };
        report_motion(session, &journey, LAGRANGIAN, &GUN, Some(gates));
        budgets::report(session, &journey, None);
        if cells == cells.min(1040) {
            session.plot(motion_plot(&journey, LAGRANGIAN, &GUN));
        }
    }
    Ok(())
}

/// Displacement and velocity of the piston \[s, m, m/s\].
const PISTON: [Station; 4] = [
    [0.01, 0.547_039, 102.6614],
    [0.02, 1.955_868, 175.5305],
    [0.03, 4.001_974, 231.4999],
    [0.04, 6.550_091, 276.6528],
];

fn vacuum(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[330] } else { &[660, 1320] };
    for &cells in cells {
        let times = PISTON.iter().map(|station| station[0]);
        let journey = session.follow("validation/piston_into_vacuum.toml", Setting::standard(cells), &[], times)?;
        let coarse = 660.0 / f64::from(cells.min(660));
        let gates = Gates { place: 0.01 * coarse, velocity: 0.01 * coarse };
        report_motion(session, &journey, "simple wave", &PISTON, Some(gates));
        budgets::report(session, &journey, None);
        if cells <= 660 {
            session.plot(motion_plot(&journey, "simple wave", &PISTON));
        }
    }
    Ok(())
}

/// Half spaces: name, density, speed of longitudinal waves sqrt((lambda + 2 mu) / rho).
const HALF_SPACES: [(&str, f64, f64); 2] = [("soft", 20.0, 5.0), ("stiff", 100.0, 10.0)];
/// Why the gas gains a little energy from a stiff slab.
const VIBRATES: &str =
    "the gas pays with the mean velocity of a step; how a stiff slab vibrates within it is not counted";
/// Who knows the state at the surface.
const HUGONIOT: &str = "Hugoniot curve and impedance";

/// Velocity and pressure at the surface of a half space of an acoustic impedance: where its line p = 1 + Z u meets the Hugoniot curve of
/// the gas behind the shock. [Toro 2009, eq. 4.6]
fn surface_state(impedance: f64) -> [f64; 2] {
    let (density, speed, pressure) = (3.733_333, 1.25, 4.5);
    let (a, b) = (2.0 / (2.4 * density), pressure / 6.0);
    let gas = |u: f64| {
        let stopped: f64 = speed - u;
        pressure + stopped / (2.0 * a) * (stopped + (stopped * stopped + 4.0 * a * (b + pressure)).sqrt())
    };
    let (mut low, mut high) = (0.0, speed);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if gas(middle) > 1.0 + impedance * middle { low = middle } else { high = middle }
    }
    [low, gas(low)]
}

fn half_space(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[400] } else { &[400, 800] };
    let count = if session.suite == Suite::Quick { 1 } else { 2 };
    for (name, density, speed) in HALF_SPACES.into_iter().take(count) {
        for &cells in cells {
            let modulus = density * speed * speed / 1.346_153_8; // of the scene's Poisson ratio
            let kind =
                [format!("bodies[0].density={density}"), format!("materials.soft.neo_hookean.young_modulus={modulus}")];
            // the shock arrives at 0.1, then waves have run 0.25 and 0.5
            let times = [0.1 + 0.25 / speed, 0.1 + 0.5 / speed];
            let path = "validation/elastic_half_space.toml";
            let mut journey = session.follow(path, Setting::standard(cells), &kind, times)?;
            journey.run.label = format!("{} {name}", journey.run.label);
            report_surface(session, &journey, density, speed);
        }
    }
    Ok(())
}

fn report_surface(session: &mut Session<'_>, journey: &Journey, density: f64, speed: f64) {
    let [_, early, late] = &journey.stops[..] else { return };
    let run = &journey.run;
    let exact = surface_state(density * speed);
    let behind = mean_velocity(late, [0.1, 0.3]);
    let fronts = [early, late].map(|stop| front(stop, 0.5 * exact[0]));
    let waves = (fronts[1] - fronts[0]) / (late.time - early.time);
    session.check(run, "velocity behind the wave", behind).reference(exact[0], HUGONIOT).within(0.03);
    session.check(run, "speed of the stress wave", waves).reference(speed, HUGONIOT).within(0.01);
    // two cells beside the surface belong to the interface; the reflected shock runs at about the speed of sound ahead of the first
    let seen = [-0.4 * (late.time - 0.1), -2.0 * run.scene.domain.spacing()];
    let gas = Profile::of(&run.scene, late).mean(PRESSURE, seen);
    session.check(run, "pressure at the surface", gas).reference(exact[1], HUGONIOT).within(0.01);
    budgets::report(session, journey, None);
    let run_to = exact_front(late.time, speed);
    let line = vec![[0.0, exact[0]], [run_to, exact[0]], [run_to, 0.0], [0.9, 0.0]];
    let plot = Plot::new(format!("Stress wave in the half space, {}", run.label), "depth", "velocity");
    let points = late.particles.iter().map(|p| [f64::from(p.position[0]), f64::from(p.velocity[0])]).collect();
    session.plot(plot.with("exact", Style::Reference, line).with(run.label.clone(), Style::Marks, points));
}

/// Depth of a wave that set out when the shock arrived.
fn exact_front(time: f64, speed: f64) -> f64 {
    speed * (time - 0.1)
}
