//! `fragments.csv`: the pieces of all bodies in each frame as rigid wholes, and the pieces that they come from.

use std::path::Path;

use crate::export::csv::{Table, Value};
use crate::export::mesh;
use crate::scene::Scene;
use crate::snapshot::Snapshot;

/// Columns before those of a piece.
const COLUMNS: [&str; 3] = ["frame", "time", "fastest"];
/// Pieces of a frame that have a row at most, heaviest first: sand has as many as grains.
const MOST: usize = 1000;
/// A particle that was nowhere.
const NOWHERE: u32 = u32::MAX;

/// The table of pieces.
#[derive(Debug)]
pub(super) struct Fragments {
    /// The table.
    pub(super) table: Table,
    names: Vec<String>,
    /// The piece of each particle in the last frame, by its index; none before the first frame.
    before: Vec<u32>,
}

impl Fragments {
    /// Of the bodies of a scene, if there are any.
    pub(super) fn new(folder: &Path, scene: &Scene) -> Option<Self> {
        let own = mesh::columns();
        let columns: Vec<&str> = COLUMNS.into_iter().chain(own.iter().map(String::as_str)).collect();
        let table = Table::new(&folder.join("fragments.csv"), &columns);
        let names = scene.bodies.iter().map(|body| body.name.clone()).collect();
        (!scene.bodies.is_empty()).then_some(Self { table, names, before: Vec::new() })
    }

    /// Adds the pieces of a frame.
    pub(super) fn add(&mut self, frame: u32, time: f64, snapshot: &Snapshot) {
        let pieces = snapshot.piece_of_each();
        let mut all = snapshot.fragments(&pieces);
        all.sort_by(|one, other| other.mass.total_cmp(&one.mass).then(one.piece.cmp(&other.piece)));
        all.truncate(MOST);
        all.sort_by_key(|one| one.piece);
        for one in &all {
            let parent = self.before.get(one.piece as usize).copied().filter(|piece| *piece != NOWHERE);
            let head: [Value; 3] = [frame.into(), time.into(), snapshot.fastest().into()];
            self.table.push(head.into_iter().chain(mesh::row(one, parent, &self.names)));
        }
        let last = snapshot.particles.iter().map(|particle| particle.index + 1).max().unwrap_or(0);
        self.before = vec![NOWHERE; last as usize];
        for (particle, piece) in snapshot.particles.iter().zip(pieces) {
            self.before[particle.index as usize] = piece;
        }
    }

    /// The pieces of the last frame: each pair is the first of some particles in a row, and their piece.
    pub(super) fn runs(&self) -> Vec<[u32; 2]> {
        let mut runs: Vec<[u32; 2]> = Vec::new();
        for (index, piece) in (0..).zip(&self.before) {
            if runs.last().is_none_or(|run| run[1] != *piece) {
                runs.push([index, *piece]);
            }
        }
        // where the last ones end
        runs.extend(runs.last().map(|_| [self.before.len() as u32, NOWHERE]));
        runs
    }

    /// Goes on behind a frame whose pieces are known, in a scene of so many particles at most.
    pub(super) fn go_on(&mut self, runs: &[[u32; 2]], most: usize) {
        self.before.clear();
        for pair in runs.windows(2) {
            self.before.resize((pair[1][0] as usize).min(most), pair[0][1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::csv::Sheet;
    use crate::snapshot::ParticleSample;
    use crate::state::Grid;

    #[test]
    fn pieces_of_particles_are_kept_in_short() {
        let folder = tempfile::tempdir().unwrap();
        let scene = Scene::shipped("gas/sod.toml", &[]).unwrap();
        assert!(Fragments::new(folder.path(), &scene).is_none());
        let table = Table::new(&folder.path().join("fragments.csv"), &["frame"]);
        let mut own = Fragments { table, names: Vec::new(), before: vec![0, 0, 0, NOWHERE, 4, 0, 6] };
        let (runs, all) = (own.runs(), own.before.clone());
        assert_eq!(runs, [[0, 0], [3, NOWHERE], [4, 4], [5, 0], [6, 6], [7, NOWHERE]]);
        own.go_on(&runs, 100);
        assert_eq!(own.before, all);
        own.go_on(&[[0, 1], [u32::MAX, 2]], 5);
        assert_eq!(own.before, [1; 5]);
        own.go_on(&[], 5);
        assert!(own.runs().is_empty());
    }

    /// Particles of one body in a row, the second half of them so far away.
    fn row(gap: f32) -> Snapshot {
        let particle = |k: u32| ParticleSample {
            index: k,
            position: [0.5 + k as f32 + if k < 2 { 0.0 } else { gap }, 0.5, 0.5],
            velocity: [1.0, 0.0, 0.0],
            mass: 2.0,
            ..ParticleSample::default()
        };
        let grid = Grid { dimension: 1, cells: [16, 1, 1], frame: [0.0; 3], origin: [0.0; 3], spacing: 1.0 };
        Snapshot::of_particles((0.0, 0), grid, (0..4).map(particle).collect())
    }

    #[test]
    fn a_part_that_leaves_says_where_it_comes_from() {
        let folder = tempfile::tempdir().unwrap();
        let columns = mesh::columns();
        let columns: Vec<&str> = COLUMNS.into_iter().chain(columns.iter().map(String::as_str)).collect();
        let path = folder.path().join("fragments.csv");
        let mut own =
            Fragments { table: Table::new(&path, &columns), names: vec!["bar".to_owned()], before: Vec::new() };
        for (frame, gap) in [(0, 0.0), (1, 3.0), (2, 4.0)] {
            own.add(frame, 0.0, &row(gap));
        }
        own.table.save().unwrap();
        let sheet = Sheet::read(&path, &["parent", "body"]).unwrap().unwrap();
        assert_eq!(sheet.numbers("frame").unwrap(), [0.0, 1.0, 1.0, 2.0, 2.0]);
        assert_eq!(sheet.numbers("piece").unwrap(), [0.0, 0.0, 2.0, 0.0, 2.0]);
        assert_eq!(sheet.texts("parent").unwrap(), ["-", "0", "0", "0", "2"]);
        assert_eq!(sheet.numbers("mass").unwrap(), [8.0, 4.0, 4.0, 4.0, 4.0]);
    }
}
