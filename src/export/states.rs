//! states/NNNN.npz: what pictures and converters need, bit by bit, so that they can be made again without simulating.

use std::io;
use std::path::{Path, PathBuf};

use bytemuck::{Pod, cast_slice};
use rayon::prelude::*;

use super::container::{self, Array, Contents, Form, Source, VERSION};
use super::npy::Numbers;
use crate::export::{Exporter, Moment, Needs};
use crate::render::{Stored, StoredParticles};
use crate::scene::EquationOfState;
use crate::snapshot::{CellRows, ParticleRows, Snapshot, kind};
use crate::state::{Grid, MemoryPlan, arrays};
use crate::{Error, Result};

/// Bytes of a slot of the grid, and of a particle.
const SLOT: u64 = 56;
const PARTICLE: u64 = 160;

/// Writes `states/NNNN.npz`.
#[derive(Debug)]
pub struct StateExporter {
    folder: PathBuf,
}

impl StateExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder_of(folder) }
    }
}

impl Exporter for StateExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        let stored = moment.stored.expect("a run reads what an exporter needs");
        write(&self.folder.join(format!("{:04}.npz", moment.index)), &moment.origin.source, stored)
    }

    fn needs(&self) -> Needs {
        Needs { stored: true, ..Needs::default() }
    }
}

/// Where the states of a run lie.
#[must_use]
pub fn folder_of(run: &Path) -> PathBuf {
    run.join("states")
}

/// Frame numbers and files of a run's states, in order.
///
/// # Errors
/// [`Error::Io`] if the folder cannot be read.
pub fn list(run: &Path) -> Result<Vec<(u32, PathBuf)>> {
    Ok(numbered(&folder_of(run))?
        .into_iter()
        .filter_map(|(number, path)| Some((u32::try_from(number).ok()?, path)))
        .collect())
}

/// Files of a folder that a number names, in order; none where there is no folder.
pub(super) fn numbered(folder: &Path) -> Result<Vec<(u64, PathBuf)>> {
    let failed = |source: io::Error| Error::io(folder, source);
    let mut found = Vec::new();
    let entries = match std::fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(found),
        entries => entries.map_err(failed)?,
    };
    for entry in entries {
        let path = entry.map_err(failed)?.path();
        let number = path.file_stem().and_then(|stem| stem.to_str()?.parse().ok());
        if let Some(number) = number.filter(|_| path.extension().is_some_and(|extension| extension == "npz")) {
            found.push((number, path));
        }
    }
    found.sort();
    Ok(found)
}

/// Writes one state of a run.
///
/// # Errors
/// [`Error::Io`].
pub fn write(path: &Path, source: &Source, state: &Stored) -> Result<()> {
    let mut arrays: Vec<(&str, usize, &[f32])> =
        vec![("conserved", 4, cast_slice(&state.conserved)), ("energy", 1, &state.energy)];
    let further = [
        ("species", 1, &state.species[..]),
        ("owed", 1, &state.owed),
        ("maps", 4, cast_slice(&state.maps)),
        ("dust", 1, &state.dust),
    ];
    arrays.extend(further.into_iter().filter(|(_, _, values)| !values.is_empty()));
    let affine = state.particles.as_ref().map_or(Vec::new(), |own| turning_alone(&own.affine));
    if let Some(particles) = &state.particles {
        let own = particles.arrays().map(|(name, values)| (name, if name == "affine" { &affine } else { values }));
        arrays.extend(own.map(|(name, values)| (name, 4, cast_slice(values))));
    }
    let real =
        |(name, columns, values): (&str, usize, &[f32])| Array::rows(name, columns, Numbers::F32(values.to_vec()));
    let kind = rayon::iter::once(()).map(|()| Array::rows("kind", 1, Numbers::U8(state.kind.clone())));
    let rows = arrays.into_par_iter().map(real).chain(kind);
    container::write(path, (Form::Fields, source), (state.time, state.step), &[], rows)
}

/// The affine matrices without what nobody asks for: the differences that turn are kept to the bit, the rest is zero.
fn turning_alone(affine: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let turning = |[a, b, c]: &[[f32; 4]; 3]| {
        let [x, y, z] = [b[2] - c[1], c[0] - a[2], a[1] - b[0]];
        [[0.0, z, 0.0, a[3]], [0.0, 0.0, x, b[3]], [y, 0.0, 0.0, c[3]]]
    };
    affine.as_chunks().0.par_iter().flat_map_iter(turning).collect()
}

/// Bytes that the arrays of a state have at most, in a scene of so many slots and particles.
#[must_use]
pub fn most_bytes(slots: u64, particles: u64) -> u64 {
    SLOT * slots + PARTICLE * particles
}

/// Arrays of cells.
const OF_CELLS: [&str; 7] = ["conserved", "energy", "species", "kind", "owed", "maps", "dust"];

/// Reads one state and the hash of its scene; its arrays may have `most` bytes in all. Without `cells` theirs stay
/// unread.
///
/// # Errors
/// [`Error::Spoilt`] if the file is no whole state, [`Error::Io`] if it cannot be read.
pub fn read(path: &Path, most: u64, cells: bool) -> Result<(String, Stored)> {
    read_of(path, most, cells, None)
}

/// The same of a scene whose buffers are known: a full state that this form of program wrote has no other arrays.
///
/// # Errors
/// As [`read`].
pub fn read_of(path: &Path, most: u64, cells: bool, plan: Option<&MemoryPlan>) -> Result<(String, Stored)> {
    let contents = container::read_some(path, most, |name| cells || !OF_CELLS.contains(&name))?;
    let full = contents.head.form == Form::Full && contents.head.version == VERSION;
    let foreign = |array: &&Array| full && plan.is_some_and(|plan| !plan.has_array(&array.name));
    if let Some(array) = contents.arrays.iter().find(foreign) {
        return Err(Error::spoilt(path, format_args!("array `{}` is none of a state of this scene", array.name)));
    }
    let scene = contents.head.source.scene_hash.clone();
    let stored = stored(contents, cells).map_err(|reason| Error::spoilt(path, &reason))?;
    Ok((scene, stored))
}

/// A state as tables and exporters see it, of a grid and gas; of one that was read without its cells the particles alone.
#[must_use]
pub fn snapshot(stored: Stored, grid: Grid, gases: EquationOfState) -> Snapshot {
    let rows = stored.particles.unwrap_or_default();
    let StoredParticles { position, velocity, affine, deformation, stress } = rows;
    let rows = ParticleRows { position, velocity, affine, deformation, stress };
    let moment = (stored.time, stored.step);
    if stored.kind.is_empty() {
        return Snapshot::of_rows(grid, gases, moment, &rows);
    }
    let cells = CellRows {
        conserved: stored.conserved,
        energy: stored.energy,
        species: stored.species,
        owed: stored.owed,
        maps: stored.maps,
        dust: stored.dust,
        kind: stored.kind,
    };
    Snapshot::of(grid, gases, moment, &cells, &rows)
}

/// What a file of either form holds of a state, with its cells or without.
fn stored(mut contents: Contents, cells: bool) -> std::result::Result<Stored, String> {
    let (time, step) = (contents.head.time, contents.head.step);
    let empty = Stored {
        time,
        step,
        conserved: Vec::new(),
        energy: Vec::new(),
        species: Vec::new(),
        owed: Vec::new(),
        maps: Vec::new(),
        dust: Vec::new(),
        kind: Vec::new(),
        particles: None,
    };
    let without = if cells { with_cells(&mut contents, empty)? } else { empty };
    let particles = if has(&contents, "position") { of_particles(&mut contents)? } else { None };
    if let Some(array) = contents.arrays.first().filter(|_| contents.head.form == Form::Fields) {
        return Err(format!("array `{}` is none of a state", array.name));
    }
    Ok(Stored { particles, ..without })
}

/// A state with the cells that a file has.
fn with_cells(contents: &mut Contents, state: Stored) -> std::result::Result<Stored, String> {
    let conserved: Vec<[f32; 4]> = take(contents, "conserved")?;
    let mut energy: Vec<f32> = take(contents, "energy")?;
    let species =
        if has(contents, "species") { take(contents, "species")? } else { species_of(&energy, conserved.len()) };
    energy.truncate(conserved.len()); // a full state has scratch behind it
    let kind = match take::<u8>(contents, "kind") {
        Ok(kind) => kind,
        Err(_) => take::<u32>(contents, "cells")?.into_iter().map(|word| word as u8 & kind::MASK).collect(),
    };
    let owed = if has(contents, "owed") { take(contents, "owed")? } else { owed_of(contents, conserved.len())? };
    let maps = if has(contents, "maps") { take(contents, "maps")? } else { Vec::new() };
    let mut dust: Vec<f32> = if has(contents, "dust") { take(contents, "dust")? } else { Vec::new() };
    dust.truncate(conserved.len()); // a full state has what lies on the ground behind it
    Ok(Stored { conserved, energy, species, owed, maps, dust, kind, ..state })
}

/// The particles that a file has, if there are any.
fn of_particles(contents: &mut Contents) -> std::result::Result<Option<StoredParticles>, String> {
    let position: Vec<[f32; 4]> = take(contents, "position")?;
    if position.is_empty() {
        return Ok(None);
    }
    let [velocity, affine] = [take(contents, "velocity")?, take(contents, "affine")?];
    let [deformation, stress] = [take(contents, "deformation")?, take(contents, "stress")?];
    Ok(Some(StoredParticles { position, velocity, affine, deformation, stress }))
}

/// What is known of the second gas, of a full state with so many slots; empty without one.
fn species_of(energy: &[f32], slots: usize) -> Vec<f32> {
    let last = if energy.len() > arrays::BURN_TIME * slots { arrays::UNBURNED } else { arrays::SPECIES_VOLUME };
    energy.get(arrays::SPECIES_DENSITY * slots..(last + 1) * slots).map_or(Vec::new(), <[f32]>::to_vec)
}

/// The mass owed, of a full state; nothing where only the ring has a ledger.
fn owed_of(contents: &mut Contents, slots: usize) -> std::result::Result<Vec<f32>, String> {
    if !has(contents, "owed_flow") {
        return Ok(Vec::new());
    }
    let ledger: Vec<[f32; 4]> = take(contents, "owed_flow")?;
    Ok(if ledger.len() == slots { ledger.iter().map(|entry| entry[0]).collect() } else { Vec::new() })
}

fn has(contents: &Contents, name: &str) -> bool {
    contents.arrays.iter().any(|array| array.name == name)
}

fn take<T: Pod>(contents: &mut Contents, name: &str) -> std::result::Result<Vec<T>, String> {
    contents.take(name)?.typed()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> Stored {
        let rows = |count: usize| (0..count).map(|k| [k as f32, -0.0, f32::NAN, 1e-40]).collect::<Vec<_>>();
        let mut particles = StoredParticles::of([1, 1, 3, 3, 2].map(|n| rows(5 * n)));
        particles.affine = turning_alone(&particles.affine);
        let (energy, kind) = ((0..27).map(|k| 1.0 / k as f32).collect(), (0..27).map(|k| k % 4).collect());
        Stored {
            time: 0.1 + 0.2,
            step: 7,
            conserved: rows(27),
            energy,
            species: vec![0.25; 54],
            owed: vec![0.5; 27],
            maps: rows(27),
            dust: vec![0.125; 27],
            kind,
            particles: Some(particles),
        }
    }

    fn source() -> Source {
        let text = |text: &str| text.to_owned();
        Source {
            program: text("1"),
            device: text("none"),
            scene_hash: text("cafe"),
            scene_file: text("a.toml"),
            scene: text("title = \"a\"\n"),
            ..Source::default()
        }
    }

    /// As text, where NaN equals itself and -0 is not 0.
    fn text(state: &Stored) -> String {
        format!("{state:?}")
    }

    #[test]
    fn a_state_comes_back_bit_by_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("states/0003.npz");
        for particles in [state().particles, None] {
            let state = Stored { particles, ..state() };
            write(&path, &source(), &state).unwrap();
            let (scene, again) = read(&path, 1 << 20, true).unwrap();
            assert_eq!((scene.as_str(), text(&again)), ("cafe", text(&state)));
            let (_, without) = read(&path, 1 << 20, false).unwrap();
            assert_eq!(format!("{:?}", without.particles), format!("{:?}", state.particles));
            assert!(without.conserved.is_empty() && without.kind.is_empty() && without.wrong_particles().is_none());
            let whole = container::read(&path, 1 << 20).unwrap();
            assert_eq!(whole.texts[container::SCENE], source().scene);
            assert_eq!((whole.head.time, whole.head.step, whole.head.form), (0.1 + 0.2, 7, Form::Fields));
            assert!(whole.head.arrays["conserved"].contains("kg m^-3"));
        }
        assert_eq!(list(folder.path()).unwrap(), [(3, path)]);
        assert_eq!(list(&folder.path().join("none")).unwrap(), []);
    }

    /// What samples of particles say of the affine motion is the same to the bit.
    #[test]
    fn the_turning_of_particles_is_kept() {
        let affine: Vec<[f32; 4]> = (0..9).map(|k| [1.0, 0.3, -7.0, 0.5].map(|x| x * (k as f32 + 0.1).sin())).collect();
        let rows = |affine: Vec<[f32; 4]>| ParticleRows {
            position: vec![[0.5; 4]; 3],
            velocity: vec![[0.5; 4]; 3],
            affine,
            deformation: vec![[0.0, 0.0, 0.0, 1.0]; 9],
            stress: vec![[0.0; 4]; 6],
        };
        let grid = Grid { dimension: 3, cells: [1; 3], frame: [0.0; 3], origin: [0.0; 3], spacing: 1.0 };
        let [whole, kept] = [affine.clone(), turning_alone(&affine)].map(|affine| {
            let sample = |p| rows(affine.clone()).sample(&grid, p);
            [0, 1, 2].map(sample).map(|own| (own.vorticity, own.ghost_pressure, own.plastic_strain, own.material))
        });
        assert_eq!(whole, kept);
    }

    #[test]
    fn what_is_no_state_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0000.npz");
        write(&path, &source(), &state()).unwrap();
        let whole = std::fs::read(&path).unwrap();
        let told = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            read(&path, 1 << 20, true).unwrap_err().to_string()
        };
        assert!(told(b"P6 2 2").contains("no state of brisance"));
        assert!(told(&whole[..whole.len() - 9]).contains("the file is cut"));
        assert!(told(&whole[..whole.len() / 2]).contains("the file is cut"));
        let found = whole.windows(10).position(|window| window == b"energy.npy").unwrap();
        let mut broken = whole.clone();
        broken[found + 40..found + 60].fill(0xff);
        let message = told(&broken);
        assert!(message.contains("energy"), "{message}");
        std::fs::write(&path, &whole).unwrap();
        assert!(read(&path, 100, true).unwrap_err().to_string().contains("at most"));
    }
}
