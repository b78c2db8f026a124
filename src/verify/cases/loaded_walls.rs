//! Walls that bear a load: at rest the gas on either side keeps its temperature, whatever the step and the mass of the wall.

use crate::Result;
use crate::scene::{Changes, Pair};
use crate::snapshot::{Snapshot, kind};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("loaded_plate", "Plate that bears a load", group::COUPLING_1D, plates,
        "Exact: a wall that bears its load is at rest."),
    Case::quick("loaded_ring", "Ring and shell that bear a load", group::COUPLING, rings,
        "Exact: a wall that bears its load is at rest."),
];

/// One way to run a wall.
struct Way {
    pair: Pair,
    changes: Changes,
    /// For tables.
    label: String,
    /// End \[s\].
    until: f64,
    /// How far the temperature may be from 1.
    temperature: f64,
    /// How far it is known to be, where that is more.
    known: Option<f64>,
}

/// Why light plates miss it.
const START: &str = "a plate of a fiftieth of its column's mass takes its load within a step; what that leaves beside it at the start stays";

impl Way {
    fn new((pair, implicit, courant): (Pair, bool, f64), until: f64, changes: impl Into<Changes>) -> Self {
        let elasticity = if implicit { "implicit" } else { "explicit" };
        let changes = changes.into().set(format!("time.until={until:?}")).set(format!("time.max_courant={courant:?}"));
        let changes = changes.set(format!("numerics.elasticity={elasticity}"));
        let label = format!("Courant {courant}, {elasticity}");
        Way { pair, changes, label, until, temperature: 0.03, known: None }
    }
}

/// Densities of a plate of four cells: 0.02 to 20 times the mass of 100 cells of the gas at rest.
const DENSITIES: [f64; 4] = [0.5, 5.0, 50.0, 500.0];

fn plates(session: &mut Session<'_>) -> Result<()> {
    let all = |pair| {
        let ways = [0.25, 0.5, 1.0, 2.0].map(|courant| DENSITIES.map(|density| (courant, density)));
        let ways = ways.into_iter().flatten();
        ways.flat_map(move |(courant, density)| [false, true].map(|implicit| (pair, implicit, courant, density)))
    };
    let ways: Vec<(Pair, bool, f64, f64)> = match session.suite {
        Suite::Quick => vec![
            (Pair::B1b0, false, 2.0, 50.0),
            (Pair::B2b1, false, 1.0, 500.0),
            (Pair::B1b0, true, 2.0, 0.5),
            (Pair::B2b1, true, 0.5, 5.0),
        ],
        Suite::Full => all(Pair::B1b0).chain(all(Pair::B2b1)).collect(),
    };
    // the gas of the dense side has the same speed of sound
    let steps = if session.suite == Suite::Quick { 250.0 } else { 2000.0 };
    for (pair, implicit, courant, density) in ways {
        let until = (steps * courant / 1.4_f64.sqrt()).ceil();
        let mut way = Way::new((pair, implicit, courant), until, &[format!("bodies[0].density={density:?}")]);
        way.label = format!("{}, density {density}", way.label);
        way.known = (density < 1.0).then_some(0.1);
        wall(session, "validation/loaded_plate.toml", 0, way)?;
    }
    Ok(())
}

/// Pair, implicit or not, Courant number, thickness in cells.
type Ring = (Pair, bool, f64, f64);

fn rings(session: &mut Session<'_>) -> Result<()> {
    let quick = session.suite == Suite::Quick;
    let few: [Ring; 3] = [(Pair::B1b0, false, 2.0, 1.5), (Pair::B2b1, false, 1.0, 3.0), (Pair::B1b0, true, 2.0, 2.0)];
    let more: [Ring; 8] = [
        (Pair::B1b0, false, 2.0, 1.0),
        (Pair::B1b0, false, 0.5, 2.0),
        (Pair::B1b0, false, 2.0, 2.0),
        (Pair::B1b0, false, 2.0, 4.0),
        (Pair::B1b0, true, 2.0, 1.5),
        (Pair::B1b0, true, 0.5, 4.0),
        (Pair::B2b1, false, 2.0, 1.5),
        (Pair::B2b1, true, 2.0, 3.0),
    ];
    let cells = if quick { 40 } else { 48 };
    for (pair, implicit, courant, thickness) in few.into_iter().chain(more.into_iter().filter(|_| !quick)) {
        let thick = format!("bodies[0].shape.shell.thickness={:?}", thickness / f64::from(cells));
        let mut way = Way::new((pair, implicit, courant), 2.0, &[thick]);
        way.label = format!("{}, {thickness} cells", way.label);
        way.temperature = if thickness < 2.0 { 0.1 } else { 0.03 };
        wall(session, "validation/loaded_ring.toml", cells, way)?;
    }
    let space = Way::new((Pair::B1b0, false, 2.0), 0.5, Changes::variant("space"));
    wall(session, "validation/loaded_ring.toml", 0, Way { temperature: 0.1, ..space })
}

/// Rows of one wall: temperatures, mass on the dense side, owed gas.
fn wall(session: &mut Session<'_>, path: &str, cells: u32, way: Way) -> Result<()> {
    let setting = Setting { pair: way.pair, ..Setting::standard(cells) };
    let times = [0.25, 0.5, 0.75, 1.0].map(|share| share * way.until);
    let mut journey = session.follow(path, setting, &way.changes, times)?;
    journey.run.label = format!("{}, {}", journey.run.label, way.label);
    let (stops, run) = (&journey.stops[1..], &journey.run);
    let most = stops.iter().map(warmth).fold(0.0, f64::max);
    let row = session.check(run, "temperature, largest |T - 1| of gas at four times", most);
    row.source("exact").pass(Limit::AtMost(way.temperature));
    if let Some(known) = way.known {
        row.known(Limit::AtMost(known), START);
    }
    let masses: Vec<f64> = stops.iter().map(|stop| dense_mass(&journey, stop)).collect();
    let change = masses.iter().map(|mass| (mass / masses[0] - 1.0).abs()).fold(0.0, f64::max);
    session.check(run, "mass of the dense side, change", change).source("exact").pass(Limit::AtMost(0.005));
    let owed = run.records.last().map_or(0.0, |last| f64::from(last.owed.mass) / f64::from(last.gas.mass));
    session.check(run, "owed gas over gas", owed.abs()).source("exact").pass(Limit::AtMost(0.04));
    Ok(())
}

/// How far the temperature of the gas is from 1, that of both sides.
fn warmth(stop: &Snapshot) -> f64 {
    let gas = stop.kind.iter().zip(stop.pressure.iter().zip(&stop.density)).filter(|(own, _)| **own == kind::GAS);
    gas.map(|(_, (pressure, density))| (f64::from(pressure / density) - 1.0).abs()).fold(0.0, f64::max)
}

/// Mass of the gas where it was dense at the start \[kg\].
fn dense_mass(journey: &Journey, stop: &Snapshot) -> f64 {
    let start = &journey.stops[0];
    let gas = stop.kind.iter().zip(&stop.density).zip(&start.density).filter(|((own, _), _)| **own == kind::GAS);
    let dense = gas.filter(|(_, then)| **then > 5.0);
    journey.run.scene.domain.cell_volume() * dense.map(|((_, now), _)| f64::from(*now)).sum::<f64>()
}
