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
use crate::diagnostics::StepRecord;
use crate::export::csv::{Mark, Table, Value};
use crate::quantity::{self, BODY, STEP};
use crate::scene::{MOST_PARTICLES, Scene};
use crate::snapshot::Snapshot;

/// Columns of `bodies.csv` before the quantities of a body.
const OF_BODIES: [&str; 3] = ["frame", "time", "body"];

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
        let more = if loads.of_bodies() { loads::body_columns() } else { Vec::new() };
        let head = OF_BODIES.map(str::to_owned).into_iter().chain(quantity::names(BODY)).chain(more).collect();
        let bodies = !scene.bodies.is_empty();
        Self {
            steps: Table::named(&folder.join("diagnostics.csv"), quantity::names(STEP)),
            bodies: bodies.then(|| Table::named(&folder.join("bodies.csv"), head)),
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
            self.steps.push(quantity::row(STEP, record).map(Value::from));
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
            let head: [Value; 3] = [frame.into(), time.into(), name.as_str().into()];
            let own = quantity::row(BODY, &body).map(Value::from);
            table.push(head.into_iter().chain(own).chain(self.loads.row(index)));
        }
    }

    /// Brings the files up to date.
    pub(super) fn save(&mut self) -> Result<()> {
        self.all().try_for_each(Table::save)
    }
}
