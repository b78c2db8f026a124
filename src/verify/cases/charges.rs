//! Charges against the curves that engineers use: the near field by itself, carried on to where they are wanted, and an octant on the grid.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::expect::Gauge;
use crate::explosive::kingery_bulmash::{Blast, Burst, blast};
use crate::explosive::{NearField, explosive};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// Who measured.
const CURVES: &str = "Kingery and Bulmash";

/// The cases of this module.
pub(super) const CASES: &[Case] = &[
    Case {
        id: "radial_burst",
        title: "TNT in free air, in one dimension",
        group: group::EXPLOSIONS,
        quick: true,
        source: "C. N. Kingery, G. Bulmash, ARBRL-TR-02555, 1984: spherical air burst.",
        run: radial,
    },
    Case {
        id: "air_burst",
        title: "TNT in free air, an octant",
        group: group::EXPLOSIONS,
        quick: true,
        source: "C. N. Kingery, G. Bulmash, ARBRL-TR-02555, 1984: spherical air burst.",
        run: octant,
    },
    Case {
        id: "closed_room",
        title: "TNT in a closed room",
        group: group::EXPLOSIONS,
        quick: true,
        source: "Balance of energy: what is left when the waves have died down is the energy of the charge as pressure.",
        run: room,
    },
];

/// Why peaks on the grid are too low.
const COARSE: &str = "a peak of few cells is cut off";

/// A distance \[m\], and the widest zone \[m\] with which the wave of a kilogram is carried there.
const DISTANCES: [(f64, f64); 6] = [(1.0, 0.005), (2.0, 0.005), (4.0, 0.01), (8.0, 0.02), (15.0, 0.01), (30.0, 0.015)];

fn radial(session: &mut Session<'_>) -> Result<()> {
    let count = if session.suite == Suite::Quick { 3 } else { DISTANCES.len() };
    for (distance, width) in DISTANCES.into_iter().take(count) {
        let Some((gauge, measured)) = radial_gauge(distance, width) else { continue };
        let gated = if distance < 2.0 { Gated::Nothing } else { Gated::All };
        judge(session, &format!("{distance} m"), &gauge, &measured, gated);
    }
    Ok(())
}

/// What a gauge sees of a kilogram of TNT in a radial run, and what it should.
fn radial_gauge(distance: f64, width: f64) -> Option<(Gauge, Blast)> {
    let tnt = explosive("tnt")?;
    let (density, pressure) = (1.225, 101_325.0);
    let field = NearField { explosive: tnt, mass: 1.0, axes: 3, density, pressure, gamma: 1.4, afterburn: true };
    let measured = blast(Burst::Air, 1.0, distance)?;
    let until = measured.arrival + 2.0 * measured.positive_phase?;
    let mut expansion = field.start(distance + 2.0, width);
    let (mut times, mut pressures) = (vec![0.0], vec![field.pressure]);
    while expansion.time < until {
        expansion.step(until);
        times.push(expansion.time);
        pressures.push(expansion.pressure_at(distance));
    }
    Some((late(&times, &pressures)?, measured))
}

/// A gauge whose wave arrives with half of its peak: fronts are some cells wide.
fn late(times: &[f64], pressures: &[f64]) -> Option<Gauge> {
    let gauge = Gauge::of(times, pressures)?;
    let risen = pressures.iter().position(|p| p - gauge.first > 0.5 * gauge.peak_overpressure)?;
    Some(Gauge { arrival: Some(times[risen]), ..gauge })
}

/// What of a gauge is judged.
#[derive(Clone, Copy, PartialEq)]
enum Gated {
    Nothing,
    /// A front of few cells has no peak and no time.
    Impulse,
    /// All; the peak may miss its gate by this share.
    WithPeak(f64),
    All,
}

/// Compares a gauge with the curves.
fn judge(session: &mut Session<'_>, place: &str, gauge: &Gauge, measured: &Blast, gated: Gated) {
    let values = [
        ("arrival", gauge.arrival.unwrap_or(f64::NAN), measured.arrival, 0.05),
        ("overpressure", gauge.peak_overpressure, measured.overpressure, 0.1),
        ("impulse", gauge.impulse, measured.impulse, 0.15),
    ];
    for (name, ours, value, gate) in values {
        let row = session.push(&format!("{name} at {place}"), ours).reference(value, CURVES);
        if gated != Gated::Nothing && (name == "impulse" || gated != Gated::Impulse) {
            row.within(gate);
        }
        if let Gated::WithPeak(share) = gated
            && name == "overpressure"
        {
            row.known(Limit::Between((1.0 - share) * value, (1.0 + share) * value), COARSE);
        }
    }
}

fn octant(session: &mut Session<'_>) -> Result<()> {
    let fine = session.suite == Suite::Full;
    let cells = if fine { 96 } else { 24 };
    let run = session.run("validation/air_burst.toml", Setting::standard(cells), &[] as &[String])?;
    let times: Vec<f64> = run.records.iter().map(|record| record.time).collect();
    for (index, probe) in run.scene.probes.iter().enumerate() {
        let pressure = |record: &StepRecord| record.probes.get(index).map(|seen| f64::from(seen.pressure));
        let pressures: Vec<f64> = run.records.iter().filter_map(pressure).collect();
        let distance = probe.position.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (Some(gauge), Some(measured)) = (late(&times, &pressures), blast(Burst::Air, 1.0, distance)) else {
            continue;
        };
        let place = format!("{}, {}", probe.name, run.label);
        judge(session, &place, &gauge, &measured, if fine { Gated::WithPeak(0.2) } else { Gated::Impulse });
    }
    Ok(())
}

/// Time in which the waves of the room die down \[s\].
const QUIET: f64 = 0.05;

fn room(session: &mut Session<'_>) -> Result<()> {
    let mut changes: Vec<String> = ["x_max", "y_max", "z_max"].map(|side| format!("boundary.{side}=wall")).into();
    changes.extend([format!("time.until={QUIET}"), "charges[0].afterburn=false".to_owned(), "probes=[]".to_owned()]);
    let run = session.run("validation/air_burst.toml", Setting::standard(24), &changes)?;
    let (scene, gamma) = (&run.scene, run.scene.gas.gamma);
    let energy: f64 =
        scene.charges.iter().filter_map(|own| Some(own.ball()?.0 * own.made_of()?.specific_energy())).sum();
    let volume = scene.domain.cell_volume() * scene.domain.cell_count() as f64;
    let mean = run.snapshot.pressure.iter().map(|p| f64::from(*p)).sum::<f64>() / run.snapshot.pressure.len() as f64;
    let rise = mean - scene.gas.ambient.pressure;
    let row = session.check(&run, "rise of the mean pressure", rise);
    row.reference((gamma - 1.0) * energy / volume, "balance of energy").within(0.05);
    Ok(())
}
