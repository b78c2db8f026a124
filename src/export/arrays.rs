//! arrays/NNNN.npz: quantities of cells and particles for scripts, by the names of the table of quantities.
//!
//! Arrays of cells have the shape z, y, x, and the components last; those of particles begin with `particle_`.

use std::path::{Path, PathBuf};

use bytemuck::cast_slice;

use super::container::{self, Array, Form};
use super::npy::Kind;
use crate::Result;
use crate::export::{Exporter, Moment, Needs};
use crate::quantity::{Place, Values, all};
use crate::snapshot::Snapshot;

/// Writes `arrays/NNNN.npz`.
#[derive(Debug)]
pub struct ArrayExporter {
    folder: PathBuf,
}

impl ArrayExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.join("arrays") }
    }
}

impl Exporter for ArrayExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        let snapshot = moment.snapshot.expect("a run reads the snapshot when an exporter needs it");
        let path = self.folder.join(format!("{:04}.npz", moment.index));
        let at = (moment.time, moment.step);
        container::write(&path, (Form::Arrays, &moment.origin.source), at, &[], &arrays(snapshot))
    }

    fn needs(&self) -> Needs {
        Needs { snapshot: true, ..Needs::default() }
    }
}

/// All quantities of a state, and where its cells and particles are.
fn arrays(snapshot: &Snapshot) -> Vec<Array> {
    let grid = &snapshot.grid;
    let [x, y, z] = grid.cells.map(|n| n as usize);
    let mut arrays = Vec::new();
    let mut add = |name: String, shape: &[usize], components: usize, (kind, bytes): (Kind, Vec<u8>), about: String| {
        let mut shape = shape.to_vec();
        if components > 1 {
            shape.push(components);
        }
        arrays.push(Array { name, kind, shape, bytes, about });
    };
    let position: Vec<f32> = snapshot.particles.iter().flat_map(|particle| particle.position).collect();
    let count = snapshot.particles.len();
    add("origin".into(), &[3], 1, (Kind::F32, cast_slice(&grid.origin).to_vec()), "low corner of the cells [m]".into());
    add("spacing".into(), &[1], 1, (Kind::F32, cast_slice(&[grid.spacing]).to_vec()), "edge of a cell [m]".into());
    add("particle_position".into(), &[count], 3, (Kind::F32, cast_slice(&position).to_vec()), "position [m]".into());
    for quantity in all(snapshot, Place::Cell).chain(all(snapshot, Place::Particle)) {
        let (name, shape) = match quantity.place {
            Place::Cell => (quantity.name.to_owned(), vec![z, y, x]),
            Place::Particle => (format!("particle_{}", quantity.name), vec![count]),
        };
        let bytes = match quantity.of(snapshot) {
            Values::Real(values) => (Kind::F32, cast_slice(&values).to_vec()),
            Values::Whole(values) => (Kind::U32, cast_slice(&values).to_vec()),
        };
        add(name, &shape, quantity.components, bytes, format!("{}, unit {}", quantity.caption, quantity.unit));
    }
    arrays
}
