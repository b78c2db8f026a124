//! A pane that a load cracks or not: by which pressures and impulses, beside a spring with a mass.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::render::{Plot, Style};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("broken_pane", "Pane of glass under a blast: pressure and impulse that crack it", group::SOLIDS, pane,
        "J. M. Biggs, Introduction to Structural Dynamics, 1964: clamped strip as a spring with a mass; T. Krauthammer et al., \
         Int. J. Impact Eng. 35 (2008) 771: curves of pressure and impulse."),
];

/// Free width and thickness \[m\], density \[kg m^-3\], modulus in plane strain and strength \[Pa\].
const SPAN: f64 = 0.12;
const THICKNESS: f64 = 0.01;
const DENSITY: f64 = 2500.0;
const MODULUS: f64 = 7e10 / (1.0 - 0.22 * 0.22);
const STRENGTH: f64 = 4.5e7;
/// Height of the pane, with what is clamped \[m\].
const HEIGHT: f64 = 0.13;
/// Pressure of the air \[Pa\].
const AIR: f64 = 101_325.0;

/// Steady pressure at which the supports of an elastic strip have the strength \[Pa\].
fn elastic_strength() -> f64 {
    2.0 * STRENGTH * (THICKNESS / SPAN).powi(2)
}

/// Steady pressure that breaks the pane over that of an elastic strip, as the slow load of the full suite finds it: the cells about the clamps bear
/// their mean stress.
const STATIC: f64 = 1.33;

/// First angular frequency of a clamped strip \[s^-1\].
fn frequency() -> f64 {
    22.373 / SPAN.powi(2) * THICKNESS * (MODULUS / (12.0 * DENSITY)).sqrt()
}

/// What the load of a run does.
struct Seen {
    /// Largest pressure \[Pa\], and impulse per area \[Pa s\], until it breaks or has swung once.
    peak: f64,
    impulse: f64,
    /// Steady pressure that would bend a spring with the mass of the strip as far \[Pa\], until then.
    demand: f64,
    /// Whether something has broken.
    broken: bool,
}

/// Pressure on the pane over the time.
fn pressures(records: &[StepRecord]) -> impl Iterator<Item = [f64; 2]> {
    records
        .iter()
        .map(|record| [record.dt.into(), record.loads.first().map_or(0.0, |load| f64::from(load.force[0]) / HEIGHT)])
}

/// The largest displacement of a spring with a mass under pressures over steps, as the pressure that holds it there.
fn response(loads: impl Iterator<Item = [f64; 2]>) -> f64 {
    const PARTS: u32 = 20;
    let square = frequency().powi(2);
    let (mut held, mut rate, mut most) = (0.0, 0.0, 0.0_f64);
    for [dt, pressure] in loads {
        let dt = dt / f64::from(PARTS);
        for _ in 0..PARTS {
            rate += square * (pressure - held) * dt;
            held += rate * dt;
        }
        most = most.max(held);
    }
    most
}

impl Seen {
    fn of(run: &Run) -> Self {
        let breaks = run.records.iter().position(|record| record.broken_mass > 0.0);
        let records = &run.records[..breaks.map_or(run.records.len(), |step| step + 1)];
        Seen {
            peak: pressures(records).map(|[_, p]| p).fold(0.0, f64::max),
            impulse: pressures(records).map(|[dt, p]| dt * p).sum(),
            demand: response(pressures(records)),
            broken: breaks.is_some(),
        }
    }

    /// Of the static strength, found with the pane itself.
    fn share(&self) -> f64 {
        self.demand / (STATIC * elastic_strength())
    }
}

/// Runs the pane beside a layer of gas at a pressure, from one instant on. A layer of all the room there is loads it for good.
fn shot(session: &mut Session<'_>, layer: f64, pressure: f64) -> Result<(Run, Seen)> {
    let density = 1.225 * (pressure / AIR).powf(1.0 / 1.4);
    let changes = [
        format!("gas.regions[0].shape.box.center=[{:?}, 0.065]", 0.04 - 0.5 * layer),
        format!("gas.regions[0].shape.box.size=[{layer:?}, {HEIGHT:?}]"),
        format!("gas.regions[0].pressure={pressure:?}"),
        format!("gas.regions[0].density={density:?}"),
        "time.until=1.6e-4".to_owned(),
    ];
    let run = session.run("validation/broken_pane.toml", Setting::standard(0), &changes[..])?;
    let seen = Seen::of(&run);
    Ok((run, seen))
}

/// Depth of the layer \[m\], pressures that the pane bears and that break it \[Pa\], and how far the spring may be off.
const ASYMPTOTES: [(&str, f64, [f64; 2], f64); 2] =
    [("steady load", 0.04, [4.4e5, 5.8e5], 0.1), ("impulse", 0.005, [1.6e6, 3.0e6], 0.2)];

fn pane(session: &mut Session<'_>) -> Result<()> {
    for (name, layer, ends, off) in ASYMPTOTES {
        for (breaks, pressure) in [false, true].into_iter().zip(ends) {
            let (run, seen) = shot(session, layer, pressure)?;
            let what = if breaks { "cracks it" } else { "is borne" };
            let broken = f64::from(u8::from(seen.broken));
            let row = session.check(&run, &format!("{name} that {what}: cracked"), broken);
            let one = f64::from(u8::from(breaks));
            row.reference(one, "spring with a mass").pass(Limit::Between(one, one));
            let row = session.check(&run, &format!("{name} that {what}: load over strength"), seen.share());
            row.reference(1.0, "spring with a mass");
            row.pass(if breaks { Limit::AtLeast(1.0 - off) } else { Limit::AtMost(1.0 + off) });
        }
    }
    if session.suite == Suite::Full {
        slow(session)?;
        curve(session)?;
    }
    Ok(())
}

/// A load that rises so slowly that the pane follows it.
fn slow(session: &mut Session<'_>) -> Result<()> {
    let changes = [
        "gas.regions=[]",
        "time.until=7e-4",
        "boundary.x_min={ timed_inlet = { rule = \"total\", table = [{ time = 0.0, density = 1.225, pressure = 101325.0 }, \
         { time = 1.2e-3, density = 7.0, pressure = 1.3e6 }] } }",
    ];
    let run = session.run("validation/broken_pane.toml", Setting::standard(0), &changes.map(str::to_owned))?;
    let seen = Seen::of(&run);
    let row = session.check(
        &run,
        "slow load that cracks it, over that of an elastic strip",
        seen.demand / elastic_strength(),
    );
    row.reference(1.0, "beam").within(0.1).known(Limit::Between(STATIC - 0.05, STATIC + 0.05), COARSE);
    Ok(())
}

/// Why the pane is stronger than a beam.
const COARSE: &str = "cells about a clamp bear their mean stress, which is less than that at the surface";

/// Layers of gas \[m\], and pressures between which the pane breaks \[Pa\].
const LAYERS: [(f64, [f64; 2]); 5] = [
    (0.04, [4.0e5, 6.0e5]),
    (0.02, [4.0e5, 1.2e6]),
    (0.01, [6.0e5, 2.4e6]),
    (0.005, [1.0e6, 4.0e6]),
    (0.0025, [2.0e6, 1.0e7]),
];

/// Bisects over the pressure of every layer.
fn curve(session: &mut Session<'_>) -> Result<()> {
    let (mut borne, mut broke) = (Vec::new(), Vec::new());
    for (layer, [mut low, mut high]) in LAYERS {
        let mut shares = [f64::NAN; 2];
        let mut last = None;
        while high > 1.06 * low {
            let middle = (low * high).sqrt();
            let (run, seen) = shot(session, layer, middle)?;
            let side = if seen.broken { &mut broke } else { &mut borne };
            side.push([seen.impulse, seen.peak]);
            shares[usize::from(seen.broken)] = seen.share();
            if seen.broken {
                high = middle
            } else {
                low = middle
            }
            last = Some(run);
        }
        let Some(run) = last else { continue };
        let name = format!("layer of {} mm: load that cracks it, over strength", 1e3 * layer);
        session.check(&run, &name, 0.5 * (shares[0] + shares[1])).reference(1.0, "spring with a mass").within(0.2);
    }
    session.plot(
        Plot::new("Pane: pressure and impulse that crack it", "impulse [Pa s]", "peak pressure [Pa]")
            .logarithmic()
            .with("spring with a mass, triangles", Style::Reference, triangles())
            .with("borne", Style::Marks, borne)
            .with("cracked", Style::Marks, broke),
    );
    Ok(())
}

/// Impulse and peak of triangular loads that a spring of the static strength just bears.
fn triangles() -> Vec<[f64; 2]> {
    const STEPS: u32 = 2000;
    let period = std::f64::consts::TAU / frequency();
    let of = |length: f64| {
        // until the load is over and a period more, or until it has swung once under what lasts
        let dt = (length.min(period) + period) / f64::from(STEPS);
        let load = |step: u32| [dt, (1.0 - (f64::from(step) + 0.5) * dt / length).max(0.0)];
        let peak = STATIC * elastic_strength() / response((0..STEPS).map(load));
        [0.5 * peak * length, peak]
    };
    (0..40).map(|k| of(period * 0.03 * 1.15_f64.powi(k))).collect()
}
