//! Riemann problems in 1D: errors against the exact solution over resolutions, element pairs and time integrations.

use crate::Result;
use crate::riemann::ExactRiemann;
use crate::scene::Pair;
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile, VELOCITY};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::sweep::{
    GATED, PEERS, Point, Sweep, exact_riemann, plot_density, plot_errors, report_double, report_order, sweeps,
};
use crate::verify::measure::tube_errors::{self, Errors};

/// Plateaus may be off by this share; a sharp method stays below half of it.
const PLATEAU: f64 = 0.01;
/// Shocks may be off by this many cells.
const SHOCK_CELLS: f64 = 1.5;

/// Where exact values come from.
const EXACT: &str = "exact Riemann solution";
const KWATRA: &str = "Kwatra et al., J. Comput. Phys. 228 (2009) 4146; exact Riemann solution.";
const TORO: &str =
    "E. F. Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, 2009, section 10.8; exact Riemann solution.";

/// One problem.
struct Tube {
    /// Path below `scenes/`.
    path: &'static str,
    /// Errors of this method in double precision.
    errors: Option<&'static Errors>,
    /// L1 density error at 100 and 400 cells that a plain scheme reaches, then that of a sharp one.
    peers: [[f64; 2]; 2],
    /// Errors must fall at least to this share per doubling.
    ratio: Option<f64>,
    /// Whether there is a plateau to measure.
    plateau: bool,
    /// How far the error per doubling misses its gate, and why.
    known_ratio: Option<(f64, &'static str)>,
    /// What else is measured at [`GATED`] cells.
    extra: fn(&mut Session<'_>, &Run, &Profile),
}

fn nothing(_: &mut Session<'_>, _: &Run, _: &Profile) {}

fn tube(session: &mut Session<'_>, tube: &Tube) -> Result<()> {
    let mut measured = Vec::new();
    let mut title = String::new();
    let two_solves = Sweep { pair: Pair::B1b0, integrator: Integrator::Ars222, cells: vec![GATED] };
    let quick = (session.suite == Suite::Quick).then_some(two_solves);
    for sweep in sweeps(session.suite).into_iter().chain(quick) {
        let mut points: Vec<Point> = Vec::new();
        for &cells in &sweep.cells {
            let setting = Setting { pair: sweep.pair, integrator: sweep.integrator, cells };
            let run = session.run(tube.path, setting, &[])?;
            let (exact, jump) = exact_riemann(&run)?;
            let reference = Profile::exact(&run.scene, &exact, jump, run.snapshot.time);
            let ours = Profile::of(&run.scene, &run.snapshot);
            let (error, deviation) = (ours.l1(&reference, DENSITY), ours.density_deviation(&reference));
            report_error(session, tube, &run, setting, error);
            points.push((cells, error, deviation));
            if cells == GATED {
                session.check(&run, "density deviation, eq. (38)", deviation).source("Cao et al. 2022, eq. (38)");
                if sweep.integrator != Integrator::Paper {
                    report_waves(session, tube, &run, &ours, (&exact, jump));
                    (tube.extra)(session, &run, &ours);
                }
                if setting == Setting::standard(GATED) {
                    plot_density(session, &run, &ours, &reference);
                }
            }
            title.clone_from(&run.scene.title);
        }
        if let Some(row) = report_order(session, &sweep, &points, tube.ratio)
            && let Some((most, reason)) = tube.known_ratio
            && sweep.integrator == Integrator::Paper
        {
            row.known(Limit::AtMost(most), reason);
        }
        measured.push((sweep.name(), points));
    }
    plot_errors(session, &title, measured);
    Ok(())
}

/// L1 error against that of the method in double precision, and against well-known schemes.
fn report_error(session: &mut Session<'_>, tube: &Tube, run: &Run, setting: Setting, error: f64) {
    let peers = [100, 400].iter().position(|cells| *cells == setting.cells);
    let peers = peers.filter(|_| setting.integrator == Integrator::Predictor).map(|k| tube.peers.map(|gate| gate[k]));
    let row = report_double(session, run, tube.errors, setting, error);
    if let (None, Some([pass, _])) = (row.pass, peers) {
        row.source(PEERS).pass(Limit::AtMost(pass));
    }
    if let Some([_, good]) = peers.filter(|[_, good]| good.is_finite()) {
        row.good(Limit::AtMost(good));
    }
}

/// Pressure and velocity between the waves, and the places of the shocks.
fn report_waves(session: &mut Session<'_>, tube: &Tube, run: &Run, ours: &Profile, exact: (&ExactRiemann, f64)) {
    if tube.plateau {
        report_plateaus(session, run, ours, exact);
    }
    let (exact, jump) = exact;
    let place = exact.wave_speeds().map(|speed| jump + speed * run.snapshot.time);
    let ends = [ours.state[PRESSURE][0], ours.state[PRESSURE][ours.cells() - 1]];
    for (side, name) in ["left shock, cells off", "right shock, cells off"].into_iter().enumerate() {
        let is_shock = place[3 * side] == place[3 * side + 1];
        let strength = (exact.star_pressure / ends[side] - 1.0).abs();
        if is_shock && strength > 1e-3 {
            let level = 0.5 * (exact.star_pressure + ends[side]);
            let found = ours.nearest_crossing(PRESSURE, level, place[4 * side]);
            let off = (found - place[4 * side]).abs() / ours.spacing;
            session.check(run, name, off).source(EXACT).pass(Limit::AtMost(SHOCK_CELLS));
        }
    }
}

/// Pressure and velocity in the middle thirds of the parts between outer waves and contact.
fn report_plateaus(session: &mut Session<'_>, run: &Run, ours: &Profile, exact: (&ExactRiemann, f64)) {
    let (exact, jump) = exact;
    let ends = [ours.origin, ours.origin + ours.spacing * ours.cells() as f64];
    let place = exact.wave_speeds().map(|speed| (jump + speed * run.snapshot.time).clamp(ends[0], ends[1]));
    let middle = |low: f64, high: f64| [low + (high - low) / 3.0, high - (high - low) / 3.0];
    let parts = [middle(place[1], place[2]), middle(place[2], place[3])];
    let (density, velocity, pressure) = exact.sample(exact.wave_speeds()[2]);
    // Where nothing moves, the speed of sound is the measure.
    let speed = if velocity.abs() > 1e-6 { velocity.abs() } else { (run.scene.gas.gamma * pressure / density).sqrt() };
    for (name, quantity, value, scale) in [
        ("plateau pressure, error", PRESSURE, pressure, pressure),
        ("plateau velocity, error", VELOCITY, velocity, speed),
    ] {
        let worst =
            parts.map(|part| ours.largest_deviation(quantity, value, part)).into_iter().fold(f64::NAN, f64::max);
        let row = session.check(run, name, worst / scale).source(EXACT);
        row.pass(Limit::AtMost(PLATEAU)).good(Limit::AtMost(0.5 * PLATEAU));
        if run.scene.numerics.pair == Pair::B2b1 && run.scene.solves() == 2 {
            row.known(Limit::AtMost(0.015), "waves of the start lie between the weak shock of Mach 3 and its fan");
        }
    }
}

const SOD: Tube = Tube {
    path: "gas/sod.toml",
    errors: Some(&tube_errors::SOD),
    peers: [[0.0109, 0.00334], [0.00518, 0.00139]],
    ratio: Some(0.65),
    plateau: true,
    known_ratio: None,
    extra: nothing,
};
const LAX: Tube = Tube {
    path: "gas/lax.toml",
    errors: Some(&tube_errors::LAX),
    peers: [[0.0338, 0.0134], [0.016, 0.00616]],
    known_ratio: Some((0.67, "the error at 200 cells is lower than its neighbours suggest")),
    ..SOD
};
const STRONG: Tube = Tube {
    path: "gas/strong_shock_tube.toml",
    errors: Some(&tube_errors::STRONG),
    peers: [[0.0246, 0.00859], [0.0151, 0.00489]],
    ratio: None,
    extra: strong_peak,
    ..SOD
};
const MACH3: Tube = Tube {
    path: "gas/mach3.toml",
    errors: Some(&tube_errors::MACH3),
    peers: [[0.0439, 0.014], [0.0146, 0.00375]],
    extra: no_expansion_shock,
    ..SOD
};
const HIGH_MACH: Tube = Tube {
    path: "gas/high_mach.toml",
    errors: Some(&tube_errors::HIGH_MACH),
    peers: [[1.7, 0.867], [f64::NAN; 2]],
    ratio: None,
    ..SOD
};
const RAREFACTIONS: Tube = Tube {
    path: "gas/rarefactions.toml",
    errors: Some(&tube_errors::RAREFACTIONS),
    peers: [[0.0165, 0.00559], [0.00616, 0.00146]],
    ratio: None,
    // between the fans lies the heated near-vacuum that `vacuum_heating` measures
    plateau: false,
    extra: vacuum_heating,
    ..SOD
};
const MODIFIED_SOD: Tube = Tube {
    path: "validation/modified_sod.toml",
    errors: None,
    peers: [[0.0146, 0.00493], [0.00648, 0.00203]],
    ratio: None,
    ..SOD
};
const CONTACT: Tube = Tube {
    path: "validation/stationary_contact.toml",
    errors: None,
    peers: [[0.0204, 0.00822], [1e-6; 2]],
    ratio: None,
    ..SOD
};

/// The layer of dense gas between contact and shock is thin: its peak must not drown.
fn strong_peak(session: &mut Session<'_>, run: &Run, ours: &Profile) {
    let place =
        exact_riemann(run).map(|(exact, jump)| jump + exact.wave_speeds()[2] * run.snapshot.time).unwrap_or(f64::NAN);
    let layer = (0..ours.cells()).filter(|cell| ours.center(*cell) > place).map(|cell| ours.state[DENSITY][cell]);
    let peak = layer.fold(f64::NAN, f64::max);
    session.check(run, "density peak behind the shock", peak).reference(0.75, EXACT).pass(Limit::AtLeast(0.70));
}

/// A scheme without entropy keeps a jump where the rarefaction starts.
fn no_expansion_shock(session: &mut Session<'_>, run: &Run, ours: &Profile) {
    let near = |cell: &usize| (ours.center(*cell) - 0.5).abs() < 10.0 * ours.spacing;
    let jump = |cell: usize| (ours.state[DENSITY][cell + 1] / ours.state[DENSITY][cell] - 1.0).abs();
    let largest = (0..ours.cells() - 1).filter(near).map(jump).fold(f64::NAN, f64::max);
    let row = session.check(run, "largest relative density step at the sonic point", largest);
    row.source("exact fan: 0.013 per cell").pass(Limit::AtMost(0.026));
}

/// Most schemes heat the middle of the near-vacuum.
fn vacuum_heating(session: &mut Session<'_>, run: &Run, ours: &Profile) {
    let middle = ours.cells() / 2;
    let energy = |cell: usize| ours.state[PRESSURE][cell] / (0.4 * ours.state[DENSITY][cell]);
    let row = session.check(run, "internal energy in the middle", energy(middle).max(energy(middle - 1)));
    row.reference(0.216_669, EXACT).pass(Limit::AtMost(2.0 * 0.216_669));
    if run.scene.solves() == 2 {
        row.known(Limit::AtMost(0.48), "less wide than with one solve, but hotter");
    }
}

macro_rules! tubes {
    ($($id:literal, $title:literal, $tube:ident, $source:expr;)*) => {
        /// The cases of this module.
        pub(super) const CASES: &[Case] = &[
            $(Case::quick($id, $title, group::TUBES, |session| tube(session, &$tube), $source),)*
        ];
    };
}

tubes! {
    "sod", "Sod shock tube", SOD, "G. A. Sod, J. Comput. Phys. 27 (1978) 1; exact Riemann solution.";
    "lax", "Lax shock tube", LAX, "P. D. Lax, Comm. Pure Appl. Math. 7 (1954) 159; exact Riemann solution.";
    "strong_shock_tube", "Strong shock tube", STRONG, KWATRA;
    "mach3", "Mach 3 shock tube", MACH3, KWATRA;
    "high_mach", "High Mach flow", HIGH_MACH, KWATRA;
    "rarefactions", "Two symmetric rarefactions", RAREFACTIONS,
        "Einfeldt et al., J. Comput. Phys. 92 (1991) 273; exact Riemann solution.";
    "modified_sod", "Modified Sod tube: a sonic point in the rarefaction", MODIFIED_SOD, TORO;
    "stationary_contact", "Stationary contact", CONTACT, TORO;
}
