//! The tables of a run: one row per step in `diagnostics.csv`, `probes.csv` and `gauges.csv`, one per frame and body in `bodies.csv`,
//! one per frame and piece in `fragments.csv`.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::fragments::Fragments;
use super::gauges::Gauges;
use super::loads::{self, Loads, Sum};
use super::probes::{self, Probes};
use crate::Result;
use crate::diagnostics::{StepRecord, Total};
use crate::export::csv::{Mark, Table, Value};
use crate::scene::{MOST_PARTICLES, Scene};
use crate::snapshot::Snapshot;

/// Columns of `diagnostics.csv`.
#[rustfmt::skip]
const STEP_COLUMNS: [&str; 53] = [
    "step", "time", "dt",
    "gas_mass", "gas_momentum_x", "gas_momentum_y", "gas_momentum_z", "gas_energy",
    "owed_mass", "owed_momentum_x", "owed_momentum_y", "owed_momentum_z", "owed_energy",
    "crossed_mass", "crossed_momentum_x", "crossed_momentum_y", "crossed_momentum_z", "crossed_energy",
    "solid_mass", "solid_momentum_x", "solid_momentum_y", "solid_momentum_z", "solid_kinetic_energy",
    "solid_elastic_energy", "solid_ghost_energy", "solid_plastic_heat",
    "given_momentum_x", "given_momentum_y", "given_momentum_z", "given_energy",
    "pcg_iterations", "pcg_residual", "substeps", "extra_vertices",
    "min_density", "max_density", "min_pressure", "max_pressure", "max_gas_speed", "max_solid_speed",
    "limited_cells", "floored_cells", "clamped_particles", "acoustic_courant", "newton_rounds", "elastic_iterations",
    "raised_cells", "gas_kinetic_energy", "owed_mass_of_either_sign", "min_entropy", "solid_fracture_energy",
    "broken_mass", "dense_cells",
];

/// Columns of `bodies.csv`.
#[rustfmt::skip]
const BODY_COLUMNS: [&str; 22] = [
    "frame", "time", "body", "particles", "mass", "x", "y", "z", "velocity_x", "velocity_y", "velocity_z",
    "angular_momentum_x", "angular_momentum_y", "angular_momentum_z",
    "min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "plastic_strain", "pieces",
];

/// How far the tables had come, by the names of their files.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Marks {
    /// How far each table had come.
    pub(super) files: BTreeMap<String, Mark>,
    /// What loads had come to.
    loads: Vec<Sum>,
    /// [`Fragments::runs`].
    #[serde(default)]
    pieces: Vec<[u32; 2]>,
}

/// The tables of one run.
#[derive(Debug)]
pub(super) struct Tables {
    steps: Table,
    bodies: Option<Table>,
    fragments: Option<Fragments>,
    probes: Option<Probes>,
    loads: Loads,
    gauges: Option<Gauges>,
    names: Vec<String>,
}

impl Tables {
    /// Tables of a scene in a folder; those without rows to come are left out.
    pub(super) fn new(folder: &Path, scene: &Scene) -> Self {
        let loads = Loads::new(folder, scene);
        let more = if loads.of_bodies() { &loads::BODY_COLUMNS[..] } else { &[] };
        let bodies = !scene.bodies.is_empty();
        Self {
            steps: Table::new(&folder.join("diagnostics.csv"), &STEP_COLUMNS),
            bodies: bodies.then(|| Table::new(&folder.join("bodies.csv"), &[&BODY_COLUMNS, more].concat())),
            fragments: Fragments::new(folder, scene),
            probes: Probes::new(folder, scene),
            loads,
            gauges: Gauges::new(folder, scene),
            names: scene.bodies.iter().map(|body| body.name.clone()).collect(),
        }
    }

    /// The same after the rows of a run that goes on; its tables lie in `before`. A table whose columns have changed begins anew.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if a table is not what the run wrote.
    pub(super) fn continued(folder: &Path, scene: &Scene, (before, marks): (&Path, &Marks)) -> Result<Self> {
        let mut tables = Self::new(folder, scene);
        if let Some(probes) = &mut tables.probes {
            probes.go_on(before, marks)?;
        }
        for table in tables.all().filter(|table| !table.path().ends_with(probes::NAME)) {
            let name = table.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
            if let Some(mark) = marks.files.get(&name) {
                table.go_on_from((&before.join(name), mark))?;
            }
        }
        tables.loads.go_on(&marks.loads);
        if let Some(fragments) = &mut tables.fragments {
            fragments.go_on(&marks.pieces, MOST_PARTICLES as usize);
        }
        Ok(tables)
    }

    /// How far each table has come, by the name of its file.
    pub(super) fn marks(&mut self) -> Marks {
        let name = |table: &Table| table.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
        let files = self.all().map(|table| (name(table), table.mark())).collect();
        let pieces = self.fragments.as_ref().map_or_else(Vec::new, Fragments::runs);
        Marks { files, loads: self.loads.sums(), pieces }
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Table> {
        let gauges = self.gauges.as_mut().map(|gauges| &mut gauges.table);
        let fragments = self.fragments.as_mut().map(|fragments| &mut fragments.table);
        let probes = self.probes.as_mut().map(|probes| &mut probes.table);
        let own = [&mut self.steps].into_iter().chain(&mut self.bodies).chain(fragments).chain(probes);
        own.chain(self.loads.table()).chain(gauges)
    }

    /// Adds steps.
    pub(super) fn add_steps(&mut self, records: &[StepRecord]) {
        for record in records {
            self.steps.push(step_row(record));
            self.loads.add(record);
            if let Some(gauges) = &mut self.gauges {
                gauges.add(record, &self.loads);
            }
            if let Some(probes) = &mut self.probes {
                probes.add(record);
            }
        }
    }

    /// Adds the bodies of a frame, and their pieces.
    pub(super) fn add_bodies(&mut self, frame: u32, time: f64, snapshot: &Snapshot) {
        if let Some(fragments) = &mut self.fragments {
            fragments.add(frame, time, snapshot);
        }
        let Some(table) = &mut self.bodies else { return };
        for (index, (name, body)) in self.names.iter().zip(snapshot.bodies(self.names.len())).enumerate() {
            let head: [Value; 5] =
                [frame.into(), time.into(), name.as_str().into(), body.particles.into(), body.mass.into()];
            let vectors = [body.centroid, body.velocity, body.angular_momentum, body.extent[0], body.extent[1]];
            let values = vectors.into_iter().flatten().map(Value::from);
            let last = [body.plastic_strain.into(), body.pieces.into()];
            table.push(head.into_iter().chain(values).chain(last).chain(self.loads.row(index)));
        }
    }

    /// Brings the files up to date.
    pub(super) fn save(&mut self) -> Result<()> {
        self.all().try_for_each(Table::save)
    }
}

fn step_row(record: &StepRecord) -> Vec<Value> {
    let mut row: Vec<Value> = vec![record.step.into(), record.time.into(), record.dt.into()];
    for Total { mass, momentum: [x, y, z], energy } in [record.gas, record.owed, record.crossed, record.solid] {
        row.extend([mass, x, y, z, energy].map(Value::from));
    }
    row.extend([record.elastic_energy, record.ghost_energy, record.plastic_heat].map(Value::from));
    let [x, y, z] = record.given.momentum;
    row.extend([x, y, z, record.given.energy].map(Value::from));
    row.extend([record.iterations.into(), record.residual.into(), record.substeps.into(), record.extra.into()]);
    row.extend([record.density, record.pressure].into_iter().flatten().map(Value::from));
    row.extend([record.gas_speed, record.solid_speed].map(Value::from));
    row.extend([record.limited, record.floored, record.clamped].map(Value::from));
    row.extend([record.courant.into(), record.rounds.into(), record.elastic_iterations.into(), record.raised.into()]);
    row.extend([record.gas_kinetic, record.owed_either, record.min_entropy].map(Value::from));
    row.extend([record.fracture_energy, record.broken_mass].map(Value::from));
    row.push(record.dense.into());
    row
}
