//! arrays/NNNN.npz: quantities of cells and particles for scripts, by the names of the table of quantities.
//!
//! Arrays of cells have the shape z, y, x, and the components last; those of particles begin with `particle_`.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::container::{self, Array, Form};
use super::npy::Numbers;
use crate::Result;
use crate::export::{Exporter, Moment, Needs};
use crate::quantity::{Place, Quantity, Values, all};
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
        container::write(&path, (Form::Arrays, &moment.origin.source), at, &[], arrays(snapshot))
    }

    fn needs(&self) -> Needs {
        Needs { snapshot: true, cells: true, ..Needs::default() }
    }
}

/// All quantities of a state, and where its cells and particles are.
fn arrays(snapshot: &Snapshot) -> impl IndexedParallelIterator<Item = Array> {
    let (grid, particles) = (&snapshot.grid, &snapshot.particles);
    let far = grid.is_far();
    let places = particles.iter().flat_map(|particle| snapshot.place_of(particle));
    let position = if far { Numbers::F64(places.collect()) } else { Numbers::F32(places.map(|x| x as f32).collect()) };
    let low = if far { Numbers::F64(grid.low().to_vec()) } else { Numbers::F32(grid.origin.to_vec()) };
    let real = |name: &str, shape: &[usize], numbers: Numbers, about: &str| Array {
        name: name.to_owned(),
        shape: shape.to_vec(),
        numbers,
        about: about.to_owned(),
    };
    let places = vec![
        real("origin", &[3], low, "low corner of the cells [m]"),
        real("spacing", &[1], Numbers::F32(vec![grid.spacing]), "edge of a cell [m]"),
        real("particle_position", &[particles.len(), 3], position, "position [m]"),
    ];
    let mut quantities: Vec<&Quantity> = all(snapshot, Place::Cell).chain(all(snapshot, Place::Particle)).collect();
    quantities.sort_by_key(|quantity| std::cmp::Reverse(quantity.components)); // the long ones are not to be waited for at the end
    places.into_par_iter().chain(quantities.into_par_iter().map(|quantity| array(snapshot, quantity)))
}

fn array(snapshot: &Snapshot, quantity: &Quantity) -> Array {
    let [x, y, z] = snapshot.grid.cells.map(|n| n as usize);
    let (name, mut shape) = match quantity.place {
        Place::Cell => (quantity.name.to_owned(), vec![z, y, x]),
        Place::Particle => (format!("particle_{}", quantity.name), vec![snapshot.particles.len()]),
    };
    if quantity.components > 1 {
        shape.push(quantity.components);
    }
    let numbers = match quantity.of(snapshot) {
        Values::Real(values) => Numbers::F32(values),
        Values::Whole(values) => Numbers::U32(values),
    };
    Array { name, shape, numbers, about: quantity.about() }
}
