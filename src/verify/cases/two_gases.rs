//! Two gases: contacts, tubes, and a shock that meets helium.

use crate::Result;
use crate::riemann::ExactRiemann;
use crate::scene::Pair;
use crate::snapshot::{Snapshot, kind};
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile, VELOCITY};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Journey, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::sweep::exact_riemann;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("two_gas_contact", "Contacts of two gases", group::TUBES, contacts,
        "Exact: pressure and velocity stay even where gas and density alone step."),
    Case::quick("two_gas_tube", "Shock tube of two gases", group::TUBES, tubes,
        "Exact Riemann solution of two ideal gases."),
    Case::quick("helium_shock", "Shock into helium", group::TUBES, helium,
        "Exact Riemann solution of two ideal gases; states of J.-F. Haas, B. Sturtevant, J. Fluid Mech. 181 (1987) 41."),
    Case::quick("helium_bubble", "Shock over a helium bubble", group::UNSTEADY_2D, bubble,
        "J. J. Quirk, S. Karni, J. Fluid Mech. 318 (1996) 129; experiment: J.-F. Haas, B. Sturtevant, J. Fluid Mech. 181 (1987) 41."),
    Case::quick("two_gas_books", "Mass of both gases where bodies break", group::QUIET, books,
        "Conservation law."),
];

/// How far a mass fraction or volume fraction may leave its range: what the limiter leaves.
const OUTSIDE: f64 = 3e-6;

fn contacts(session: &mut Session<'_>) -> Result<()> {
    for integrator in [Integrator::Predictor, Integrator::Ars222] {
        // rounding: two solves per step add up to twice as much
        let ten = if integrator == Integrator::Ars222 { 2e-5 } else { 1e-5 };
        for (density, limit) in [(1.0, 1e-5), (10.0, ten), (1000.0, 5e-4)] {
            let setting = Setting { pair: Pair::B1b0, integrator, cells: 100 };
            let change = [format!("gas.regions[0].density={density:?}")];
            let run = session.run("validation/two_gas_contact.toml", setting, &change)?;
            even(session, &run, &format!("density {density} : 1"), limit);
        }
    }
    let pairs: &[Pair] = if session.suite == Suite::Full { &[Pair::B1b0, Pair::B2b1] } else { &[Pair::B1b0] };
    for &pair in pairs {
        let setting = Setting { pair, integrator: Integrator::Predictor, cells: 64 };
        let run = session.run("validation/two_gas_disc.toml", setting, &[] as &[String])?;
        even(session, &run, "disc, density 0.1 : 1", 1e-4);
    }
    Ok(())
}

/// Pressure and fractions of a run in which nothing but the contacts moves.
fn even(session: &mut Session<'_>, run: &Run, name: &str, limit: f64) {
    let off = run.records.iter().map(|r| f64::from((r.pressure[1] - 1.0).max(1.0 - r.pressure[0]))).fold(0.0, f64::max);
    let row = session.check(run, &format!("{name}: largest |p - 1|"), off);
    row.reference(0.0, "exact").pass(Limit::AtMost(limit));
    let row = session.check(run, &format!("{name}: how far fractions leave 0 to 1"), outside(&run.snapshot));
    row.reference(0.0, "exact").pass(Limit::AtMost(OUTSIDE));
    let masses = [run.records.first(), run.records.last()].map(|r| r.map_or(f64::NAN, |r| r.species_mass[0].into()));
    let row =
        session.check(run, &format!("{name}: mass of the second gas, drift"), (masses[1] / masses[0] - 1.0).abs());
    row.source("conservation law").pass(Limit::AtMost(1e-6));
}

/// How far mass and volume fractions leave their range.
fn outside(snapshot: &Snapshot) -> f64 {
    let gas = snapshot.species.iter().zip(&snapshot.kind).filter(|(_, kind)| **kind == kind::GAS);
    gas.flat_map(|(fractions, _)| *fractions).map(|share| f64::from((-share).max(share - 1.0))).fold(0.0, f64::max)
}

fn tubes(session: &mut Session<'_>) -> Result<()> {
    // what one gas of 1.667 gives is a little more than with 1.4
    let swapped = ["gas.gamma=1.667", "gas.species.monatomic.gamma=1.4"].map(str::to_owned);
    let cases: [(&str, &[String], [f64; 2]); 2] =
        [("1.4 | 1.667", &[], [0.0038, 0.0025]), ("1.667 | 1.4", &swapped, [0.0044, 0.0024])];
    for (name, changes, limits) in cases {
        for (integrator, limit) in [Integrator::Predictor, Integrator::Ars222].into_iter().zip(limits) {
            let setting = Setting { pair: Pair::B1b0, integrator, cells: 400 };
            let run = session.run("validation/two_gas_tube.toml", setting, changes)?;
            let (exact, jump) = exact_riemann(&run)?;
            let reference = Profile::exact(&run.scene, &exact, jump, run.snapshot.time);
            let error = Profile::of(&run.scene, &run.snapshot).l1(&reference, DENSITY);
            let row = session.check(&run, &format!("{name}: L1 density error"), error);
            row.source("exact Riemann solution").pass(Limit::AtMost(limit));
            let row = session.check(&run, &format!("{name}: how far fractions leave 0 to 1"), outside(&run.snapshot));
            row.reference(0.0, "exact").pass(Limit::AtMost(OUTSIDE));
        }
    }
    Ok(())
}

fn helium(session: &mut Session<'_>) -> Result<()> {
    for integrator in [Integrator::Predictor, Integrator::Ars222] {
        let setting = Setting { pair: Pair::B1b0, integrator, cells: 800 };
        let stops = [0.12, 0.18];
        let journey = session.follow("validation/helium_shock.toml", setting, &[], stops)?;
        let (exact, _) = exact_riemann(&journey.run)?;
        let speeds = exact.wave_speeds();
        for (name, place, value, gate) in [
            ("transmitted shock, speed", place_of_shock as Place, speeds[4], 0.01),
            ("contact, speed", place_of_contact, speeds[2], 0.005),
            ("reflected expansion, speed of its middle", place_of_fan, fan_level(&exact).1, 0.01),
        ] {
            let [first, last] = [1, 2].map(|stop| place(&journey, stop, &exact));
            let ours = (last - first) / (stops[1] - stops[0]);
            session.check(&journey.run, name, ours).reference(value, "exact Riemann solution").within(gate);
        }
        let ours = Profile::of(&journey.run.scene, &journey.run.snapshot);
        let (contact, shock) = (place_of_contact(&journey, 2, &exact), place_of_shock(&journey, 2, &exact));
        let behind = [contact + 0.3 * (shock - contact), contact + 0.7 * (shock - contact)];
        for (name, quantity, value, gate) in [
            ("pressure between the waves", PRESSURE, exact.star_pressure, 0.001),
            ("velocity between the waves", VELOCITY, exact.star_velocity, 0.002),
        ] {
            let within = |cell: &usize| (behind[0]..=behind[1]).contains(&ours.center(*cell));
            let cells: Vec<usize> = (0..ours.cells()).filter(within).collect();
            let mean = cells.iter().map(|cell| ours.state[quantity][*cell]).sum::<f64>() / cells.len() as f64;
            session
                .check(&journey.run, &format!("{name}, mean"), mean)
                .reference(value, "exact Riemann solution")
                .within(gate);
        }
    }
    Ok(())
}

/// Place of a wave at a stop of a run.
type Place = fn(&Journey, usize, &ExactRiemann) -> f64;

fn profile(journey: &Journey, stop: usize) -> Profile {
    Profile::of(&journey.run.scene, &journey.stops[stop])
}

fn place_of_shock(journey: &Journey, stop: usize, exact: &ExactRiemann) -> f64 {
    let level = 0.5 * (exact.star_pressure + 1.0);
    profile(journey, stop).crossings(PRESSURE, level).next_back().unwrap_or(f64::NAN)
}

/// Where half of the volume is helium.
fn place_of_contact(journey: &Journey, stop: usize, _: &ExactRiemann) -> f64 {
    let profile = profile(journey, stop);
    let phi: Vec<f64> = journey.stops[stop].species.iter().map(|own| own[1].into()).collect();
    let edge = phi.windows(2).position(|pair| pair[0] < 0.5 && pair[1] >= 0.5);
    edge.map_or(f64::NAN, |k| profile.center(k) + profile.spacing * (0.5 - phi[k]) / (phi[k + 1] - phi[k]))
}

/// Pressure in the middle of the reflected expansion, and the speed of that place.
fn fan_level(exact: &ExactRiemann) -> (f64, f64) {
    let speeds = exact.wave_speeds();
    let middle = 0.5 * (speeds[0] + speeds[1]);
    (exact.sample(middle).2, middle)
}

fn place_of_fan(journey: &Journey, stop: usize, exact: &ExactRiemann) -> f64 {
    profile(journey, stop).crossings(PRESSURE, fan_level(exact).0).next().unwrap_or(f64::NAN)
}

/// Times at which the bubble is looked at \[s\].
const STOPS: [f64; 9] = [2e-5, 3e-5, 4e-5, 7e-5, 8e-5, 9e-5, 1.3e-4, 2e-4, 3e-4];

/// A wave of the bubble: its name, the stops between which its speed is measured, the published speed \[m s^-1\] and by whom.
type Wave = (&'static str, fn(&Profile, &[f64]) -> f64, [usize; 2], f64, &'static str);

const COMPUTED: &str = "Quirk and Karni 1996";

const WAVES: [Wave; 6] = [
    ("incident shock", |row, _| front(row, 130_000.0), [1, 3], 422.0, COMPUTED),
    ("refracted shock in the bubble", |row, _| front(row, 104_000.0), [3, 4], 943.0, COMPUTED),
    ("transmitted shock", |row, _| front(row, 104_000.0), [6, 7], 377.0, COMPUTED),
    ("upstream edge, at first", |row, phi| edge(row, phi, false), [2, 5], 178.0, COMPUTED),
    ("jet", |row, phi| edge(row, phi, false), [8, 9], 227.0, COMPUTED),
    ("downstream edge", |row, phi| edge(row, phi, true), [8, 9], 146.0, COMPUTED),
];

/// Where the pressure falls below a level for the last time.
fn front(row: &Profile, level: f64) -> f64 {
    row.crossings(PRESSURE, level).next_back().unwrap_or(f64::NAN)
}

/// First or last place where half of the volume is of the second gas.
fn edge(row: &Profile, phi: &[f64], last: bool) -> f64 {
    let crosses = |k: &usize| (phi[*k] < 0.5) != (phi[*k + 1] < 0.5);
    let mut all = (0..row.cells() - 1).filter(crosses);
    let found = if last { all.next_back() } else { all.next() };
    found.map_or(f64::NAN, |k| row.center(k) + row.spacing * (0.5 - phi[k]) / (phi[k + 1] - phi[k]))
}

fn bubble(session: &mut Session<'_>) -> Result<()> {
    let cells = if session.suite == Suite::Full { 500 } else { 250 };
    let setting = Setting { pair: Pair::B1b0, integrator: Integrator::Ars222, cells };
    let journey = session.follow("validation/helium_bubble.toml", setting, &["time.until=3e-4".to_owned()], STOPS)?;
    let full = session.suite == Suite::Full;
    for (name, place, [first, last], speed, source) in WAVES {
        let at = |stop: usize| {
            let snapshot = &journey.stops[stop];
            let row =
                if name == "incident shock" { last_row(snapshot) } else { Profile::of(&journey.run.scene, snapshot) };
            let phi: Vec<f64> = snapshot.species[..row.cells()].iter().map(|own| own[1].into()).collect();
            place(&row, &phi)
        };
        let ours = (at(last) - at(first)) / (STOPS[last - 1] - STOPS[first - 1]);
        let row = session.check(&journey.run, &format!("speed of the {name}"), ours).reference(speed, source);
        // 250 cells are too coarse for the one that is over first
        if full || !name.starts_with("refracted") {
            row.within(0.03);
        }
    }
    let row = session.check(&journey.run, "how far fractions leave 0 to 1", outside(&journey.run.snapshot));
    row.reference(0.0, "exact").pass(Limit::AtMost(OUTSIDE));
    Ok(())
}

/// The row of cells beside the far wall.
fn last_row(snapshot: &Snapshot) -> Profile {
    let cells = snapshot.grid.cells[0] as usize;
    let wide = |values: &[f32]| values[values.len() - cells..].iter().map(|value| f64::from(*value)).collect();
    let state = [wide(&snapshot.density), vec![0.0; cells], wide(&snapshot.pressure)];
    Profile { origin: snapshot.grid.origin[0].into(), spacing: snapshot.grid.spacing.into(), state }
}

/// Bodies that stretch and that tear let another gas out, in closed boxes.
fn books(session: &mut Session<'_>) -> Result<()> {
    let torn = [r#"boundary.x_max="wall""#, "time.until=0.4"];
    let scenes: [(&str, u32, &[&str]); 2] =
        [("validation/exploding_shell.toml", 0, &[]), ("demos/bursting_diaphragm_2d.toml", 160, &torn)];
    for (path, cells, more) in scenes {
        let own = ["gas.species.products.gamma=1.25", r#"gas.regions[0].species="products""#];
        let changes: Vec<String> = own.iter().chain(more).map(|text| (*text).to_owned()).collect();
        let journey = session.follow(path, Setting::standard(cells), &changes, [0.35])?;
        let (run, drift) = (&journey.run, journey.budgets[1].drift_since(&journey.budgets[0]));
        let held = |k: usize| run.records.get(k).map_or(f64::NAN, |own| own.species_mass.map(f64::from).iter().sum());
        let second = (held(run.records.len() - 1) / held(0) - 1.0).abs();
        let name = path.split(['/', '.']).nth(1).unwrap_or_default().replace('_', " ");
        let row = session.check(run, &format!("{name}: mass of the second gas, drift"), second);
        row.source("conservation law").pass(Limit::AtMost(1e-6));
        let row = session.check(run, &format!("{name}: mass of all gas, drift"), drift["gas_mass"].abs());
        row.source("conservation law").pass(Limit::AtMost(1e-6));
        let row = session.check(run, &format!("{name}: how far fractions leave 0 to 1"), outside(&run.snapshot));
        row.reference(0.0, "exact").pass(Limit::AtMost(OUTSIDE));
    }
    Ok(())
}
