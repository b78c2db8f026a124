//! `gauges.csv`: what each gauge of the scene measures, one row per step.

use std::path::Path;

use glam::DVec3;

use super::loads::Loads;
use crate::diagnostics::{Load, PointRecord, StepRecord};
use crate::export::csv::{Table, Value};
use crate::scene::{GaugePlace, Scene};
use crate::state::loads;

/// Columns of a gauge on a wall, an obstacle or a body, after its name.
const LOAD_COLUMNS: [&str; 10] = [
    "force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z", "pressure", "impulse_x", "impulse_y",
    "impulse_z",
];

/// Columns of a gauge on a point of a body, after its name.
#[rustfmt::skip]
const POINT_COLUMNS: [&str; 20] = [
    "displacement_x", "displacement_y", "displacement_z", "velocity_x", "velocity_y", "velocity_z",
    "elastic_strain_xx", "elastic_strain_yy", "elastic_strain_zz", "elastic_strain_xy", "elastic_strain_yz", "elastic_strain_zx",
    "stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_zx", "plastic_strain", "damage",
];

/// Where a gauge's numbers stand in a record.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// A load, and what its moment is about \[m\].
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
            let own =
                |columns: &[&str]| columns.iter().map(|column| format!("{}_{column}", gauge.name)).collect::<Vec<_>>();
            if let GaugePlace::Point(..) = place {
                sources.push(Source::Point(points));
                columns.extend(own(&POINT_COLUMNS));
                points += 1;
            } else {
                sources.push(Source::Load(loads::of_gauge(scene, place)?, gauge.about.into()));
                columns.extend(own(&LOAD_COLUMNS));
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
                    row.extend(load_row(&own, about));
                    row.extend(sums.impulse(load).map(Value::from));
                }
                Source::Point(point) => row.extend(point_row(&record.points.get(point).copied().unwrap_or_default())),
            }
        }
        self.table.push(row);
    }
}

/// Force, moment about a point, and pressure.
fn load_row(load: &Load, about: DVec3) -> impl Iterator<Item = Value> {
    let force = DVec3::from(load.force.map(f64::from));
    let moment = DVec3::from(load.moment.map(f64::from)) - about.cross(force);
    force.to_array().into_iter().chain(moment.to_array()).chain([load.pressure.into()]).map(Value::from)
}

fn point_row(point: &PointRecord) -> impl Iterator<Item = Value> {
    let PointRecord { displacement, velocity, elastic_strain, stress, plastic_strain, damage } = *point;
    let tensors = elastic_strain.into_iter().chain(stress);
    displacement.into_iter().chain(velocity).chain(tensors).chain([plastic_strain, damage]).map(Value::from)
}
