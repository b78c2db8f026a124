//! mesh/NNNN.ply: the surfaces of all pieces of bodies; mesh/NNNN.csv: the pieces as rigid wholes;
//! mesh/NNNN.npy: the piece of each particle; mesh/obstacles.ply, once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::csv::{Table, Value};
use super::npy;
use super::ply::{self, Part};
use super::surface::Surface;
use crate::bodies::Fragment;
use crate::export::{Exporter, Moment, Needs, atomic};
use crate::quantity::{self, PIECE};
use crate::snapshot::Snapshot;
use crate::state::Grid;
use crate::{Error, Result, input};

/// Columns of a piece before its quantities.
const COLUMNS: [&str; 3] = ["piece", "parent", "body"];
/// Bytes of the pieces of a frame.
const MOST_PIECES: u64 = 4 << 30;
/// What stands for a parent that nobody knows.
const NONE: &str = "-";

/// Writes `mesh/NNNN.ply` and `mesh/NNNN.csv`, and `mesh/obstacles.ply` where there are obstacles.
#[derive(Debug)]
pub struct MeshExporter {
    folder: PathBuf,
    /// The piece of each particle in the last frame, by its index.
    before: Option<BTreeMap<u32, u32>>,
    /// The last frame of a run that goes on.
    last: Option<u32>,
    begun: bool,
}

impl MeshExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.join("mesh"), before: None, last: None, begun: false }
    }

    /// The surface of all obstacles, from their distance.
    fn obstacles(&self, moment: &Moment, grid: &Grid) -> Result<()> {
        let obstacles = &moment.origin.obstacles;
        if obstacles.is_empty() {
            return Ok(());
        }
        let (low, size, cell) = (grid.origin.map(f64::from), grid.extent().map(f64::from), f64::from(grid.spacing));
        let high: [f64; 3] = std::array::from_fn(|axis| low[axis] + size[axis]);
        let middle: [f64; 3] = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
        // where an obstacle goes on beyond the domain, the sides of the domain close it
        let inside = |point: [f64; 3]| {
            let sides = (0..3).map(|axis| (point[axis] - middle[axis]).abs() - 0.5 * size[axis]);
            sides.fold(f64::NEG_INFINITY, f64::max)
        };
        let distance = |point: [f64; 3]| {
            let place = std::array::from_fn(|axis| grid.frame[axis] + point[axis]);
            let shapes = obstacles.iter().map(|obstacle| obstacle.shape.distance(place));
            shapes.fold(f64::INFINITY, f64::min).max(inside(point))
        };
        let surface = Surface::of_distance([low, high], 0.5 * cell, distance);
        let path = self.folder.join("obstacles.ply");
        ply::write(&path, &about(moment), grid.frame, &[Part { surface, ..Part::default() }])
    }

    /// The pieces that fragments come from: where the particle that gives each its number was in the last frame. `now` has the piece of
    /// each particle.
    fn parents(&mut self, fragments: &[Fragment], now: &[[u32; 2]], path: &Path) -> Result<Vec<Option<u32>>> {
        if let Some(last) = self.last.take() {
            self.before = Some(read_pieces(&self.folder.join(format!("{last:04}.npy")))?);
        }
        let before = self.before.replace(now.iter().map(|[index, piece]| (*index, *piece)).collect());
        let head = npy::head(npy::Kind::U32, &[now.len(), 2]);
        atomic::write(path, |out| {
            out.write_all(&head)?;
            now.iter().flatten().try_for_each(|word| out.write_all(&word.to_le_bytes()))
        })?;
        Ok(fragments.iter().map(|one| before.as_ref().and_then(|before| before.get(&one.piece).copied())).collect())
    }

    fn table(&self, path: &Path, rows: &[(Fragment, Option<u32>)], names: &[String]) -> Result<()> {
        let columns = columns();
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        let mut table = Table::new(path, &columns);
        rows.iter().for_each(|(one, parent)| table.push(row(one, *parent, names)));
        table.save()
    }
}

/// Names of the columns of a piece.
pub(crate) fn columns() -> Vec<String> {
    COLUMNS.iter().map(|&name| name.to_owned()).chain(quantity::names(PIECE)).collect()
}

/// A row of a piece, which comes from another one; `names` are those of the bodies.
pub(crate) fn row(one: &Fragment, parent: Option<u32>, names: &[String]) -> Vec<Value> {
    let parent = parent.map_or_else(|| NONE.to_owned(), |parent| parent.to_string());
    let body = names.get(one.body as usize).map_or("", String::as_str);
    let head: [Value; 3] = [one.piece.into(), parent.as_str().into(), body.into()];
    head.into_iter().chain(quantity::row(PIECE, one).map(Value::from)).collect()
}

impl Exporter for MeshExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        let snapshot = moment.snapshot.expect("a run reads the snapshot when an exporter needs it");
        if snapshot.grid.dimension != 3 {
            let text = "the format mesh: bodies have surfaces in scenes of three dimensions alone; vtk and npz hold their particles";
            return Err(Error::Usage(text.to_owned()));
        }
        if !std::mem::replace(&mut self.begun, true) {
            self.obstacles(moment, &snapshot.grid)?;
        }
        let each = snapshot.piece_of_each();
        let fragments = snapshot.fragments(&each);
        let indices = snapshot.particles.iter().map(|particle| particle.index);
        let now: Vec<[u32; 2]> = indices.zip(each).map(Into::into).collect();
        let name = format!("{:04}", moment.index);
        let parents = self.parents(&fragments, &now, &self.folder.join(&name).with_extension("npy"))?;
        let parts: Vec<Part> = fragments.par_iter().map(|one| part(one, snapshot)).collect();
        ply::write(&self.folder.join(&name).with_extension("ply"), &about(moment), snapshot.grid.frame, &parts)?;
        let volumes: Vec<f64> = parts.par_iter().map(|part| part.surface.volume()).collect();
        let inside = fragments.into_iter().zip(volumes).map(|(one, volume)| Fragment { volume, ..one });
        let rows: Vec<_> = inside.zip(parents).collect();
        self.table(&self.folder.join(name).with_extension("csv"), &rows, &moment.origin.source.bodies)
    }

    fn needs(&self) -> Needs {
        Needs { snapshot: true, obstacles: true, ..Needs::default() }
    }

    fn go_on(&mut self, frames: u32, _: &dyn Fn(u32) -> f64) -> Result<()> {
        self.last = frames.checked_sub(1);
        self.begun = frames > 0;
        Ok(())
    }
}

/// The surface of a piece, with what its particles say.
fn part(one: &Fragment, snapshot: &Snapshot) -> Part {
    let particles: Vec<_> = one.particles.iter().map(|index| &snapshot.particles[*index]).collect();
    let places: Vec<[f32; 3]> = particles.iter().map(|particle| particle.position).collect();
    let volume: f64 = particles.iter().map(|one| f64::from(one.volume0 * one.volume_ratio()).abs()).sum();
    let surface = Surface::of_particles(&places, (volume / places.len() as f64).cbrt() as f32);
    let numbers = |index: &u32| {
        let particle = particles[*index as usize];
        let [u, v, w] = particle.velocity;
        [u, v, w, particle.plastic_strain, particle.damage]
    };
    let corners = surface.nearest.iter().map(numbers).collect();
    Part { surface, corners, piece: one.piece, body: one.body }
}

/// Pieces by the indices of particles, as [`MeshExporter`] has left them.
fn read_pieces(path: &Path) -> Result<BTreeMap<u32, u32>> {
    let wrong = |reason: String| Error::spoilt(path, reason);
    let bytes = input::bytes(path, MOST_PIECES).map_err(|source| Error::io(path, source))?;
    let (shape, numbers) = npy::read(&bytes[..], bytes.len() as u64).map_err(wrong)?;
    match (numbers, &shape[..]) {
        (npy::Numbers::U32(words), [_, 2]) => Ok(words.as_chunks().0.iter().map(|[id, piece]| (*id, *piece)).collect()),
        (numbers, _) => {
            let bytes = numbers.bytes().len();
            Err(wrong(format!("no pairs of particles and pieces: {bytes} bytes of shape {shape:?}")))
        }
    }
}

/// Where a file comes from.
fn about(moment: &Moment) -> Vec<String> {
    let line = |text: &str| text.replace(['\n', '\r'], " ");
    let (title, hash, time) = (line(&moment.origin.title), &moment.origin.hash, moment.time);
    vec![
        format!("brisance {}: {title}", env!("CARGO_PKG_VERSION")),
        format!("scene {hash}, time {time:?} s, step {}", moment.step),
        "metres, z up; vx vy vz in m/s; piece: smallest id of its particles, see the csv beside".to_owned(),
    ]
}
