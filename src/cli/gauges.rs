//! `gauges.csv`: what each gauge of the scene measures, one row per step.

use std::path::Path;

use glam::DVec3;

use super::loads::Loads;
use crate::diagnostics::{Borne, StepRecord};
use crate::export::csv::{Table, Value};
use crate::quantity::{self, Columns, LOAD, POINT};
use crate::scene::{GaugePlace, Scene};
use crate::state::loads;

/// Quantities of a gauge on a wall, an obstacle or a body.
fn of_loads() -> &'static [Columns<Borne>] {
    &LOAD[..LOAD.len() - 1]
}

/// Where a gauge's numbers stand in a record.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// A load, and what its moment is about, in the device's coordinates \[m\].
    Load(usize, DVec3),
    /// A point.
    Point(usize),
}

/// The table.
#[derive(Debug)]
pub(super) struct Gauges {
    sources: Vec<Source>,
    pub(super) table: Table,
}

impl Gauges {
    /// That of a scene; none where it has no gauges.
    pub(super) fn new(folder: &Path, scene: &Scene) -> Option<Self> {
        let (mut sources, mut points) = (Vec::new(), 0);
        let mut columns = vec!["step".to_owned(), "time".to_owned()];
        for gauge in &scene.gauges {
            let place = scene.gauge_place(gauge)?;
            let own = |columns: Vec<String>| columns.into_iter().map(|column| format!("{}_{column}", gauge.name));
            if let GaugePlace::Point(..) = place {
                sources.push(Source::Point(points));
                columns.extend(own(quantity::names(POINT)));
                points += 1;
            } else {
                sources.push(Source::Load(
                    loads::of_gauge(scene, place)?,
                    DVec3::from(gauge.about) - DVec3::from(scene.domain.frame()),
                ));
                columns.extend(own(quantity::names(of_loads())));
            }
        }
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        (!sources.is_empty()).then(|| Self { sources, table: Table::new(&folder.join("gauges.csv"), &columns) })
    }

    /// Adds a step, whose loads have been added up.
    pub(super) fn add(&mut self, record: &StepRecord, sums: &Loads) {
        let mut row: Vec<Value> = vec![record.step.into(), record.time.into()];
        for source in &self.sources {
            match *source {
                Source::Load(load, about) => {
                    let own = record.loads.get(load).copied().unwrap_or_default();
                    let borne = own.borne(about.into(), sums.impulse(load));
                    row.extend(quantity::row(of_loads(), &borne).map(Value::from));
                }
                Source::Point(point) => {
                    let own = record.points.get(point).copied().unwrap_or_default();
                    row.extend(quantity::row(POINT, &own).map(Value::from));
                }
            }
        }
        self.table.push(row);
    }
}
