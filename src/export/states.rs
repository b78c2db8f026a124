//! states/NNNN.state: what pictures are drawn from, bit by bit, so that they can be drawn again without simulating.
//!
//! A file is the line `brisance state 2`, a line of JSON (time, step, scene, and per array its name, the bytes of an element and its
//! stored bytes), then the arrays. Each is a zlib stream of its bytes in little-endian order, sorted by their place in an element: first
//! all first bytes, then all second ones. [RFC 1950]

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use bytemuck::{Pod, cast_slice, pod_collect_to_vec};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};

use crate::export::{Exporter, Moment, Needs, atomic};
use crate::render::{Stored, StoredParticles};
use crate::{Error, Result, input};

/// First line of every file; the number is that of the format.
const MAGIC: &str = "brisance state 2";

/// Bytes of a number in all arrays but the kinds.
const WORD: usize = 4;
/// Bytes of a slot of the grid, and of a particle.
const SLOT: u64 = 28;
const PARTICLE: u64 = 160;

/// Writes `states/NNNN.state`.
#[derive(Debug)]
pub struct StateExporter {
    folder: PathBuf,
}

/// The second line of a file.
#[derive(Debug, Serialize, Deserialize)]
struct Head {
    time: f64,
    step: u64,
    scene: String,
    arrays: Vec<Array>,
}

/// An array of a file.
#[derive(Debug, Serialize, Deserialize)]
struct Array {
    name: String,
    /// Bytes of an element.
    width: usize,
    /// Bytes before and after compression.
    bytes: usize,
    stored: usize,
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
        write(&self.folder.join(format!("{:04}.state", moment.index)), &moment.origin.hash, stored)
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
    let folder = folder_of(run);
    let failed = |source: io::Error| Error::io(&folder, source);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let number = path.file_stem().and_then(|stem| stem.to_str()?.parse().ok());
        if let Some(number) = number.filter(|_| path.extension().is_some_and(|extension| extension == "state")) {
            found.push((number, path));
        }
    }
    found.sort();
    Ok(found)
}

/// Writes one state; `scene` is the hash of its scene.
///
/// # Errors
/// [`Error::Io`].
pub fn write(path: &Path, scene: &str, state: &Stored) -> Result<()> {
    let mut arrays: Vec<(&str, usize, &[u8])> = vec![
        ("conserved", WORD, cast_slice(&state.conserved)),
        ("energy", WORD, cast_slice(&state.energy)),
        ("kind", 1, &state.kind),
    ];
    if !state.owed.is_empty() {
        arrays.push(("owed", WORD, cast_slice(&state.owed)));
    }
    if let Some(particles) = &state.particles {
        arrays.extend(particles.arrays().map(|(name, array)| (name, WORD, cast_slice(array))));
    }
    let mut head = Head { time: state.time, step: state.step, scene: scene.to_owned(), arrays: Vec::new() };
    let mut streams = Vec::new();
    for (name, width, bytes) in arrays {
        let stream = deflated(bytes, width).map_err(|source| Error::io(path, source))?;
        head.arrays.push(Array { name: name.to_owned(), width, bytes: bytes.len(), stored: stream.len() });
        streams.push(stream);
    }
    atomic::write(path, |out| {
        writeln!(out, "{MAGIC}")?;
        serde_json::to_writer(&mut *out, &head)?;
        out.write_all(b"\n")?;
        streams.iter().try_for_each(|stream| out.write_all(stream))
    })
}

/// Bytes that the arrays of a state have at most, in a scene of so many slots and particles.
#[must_use]
pub fn most_bytes(slots: u64, particles: u64) -> u64 {
    SLOT * slots + PARTICLE * particles
}

/// Reads one state and the hash of its scene; its arrays may have `most` bytes in all.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read or is no whole state.
pub fn read(path: &Path, most: u64) -> Result<(String, Stored)> {
    // what does not compress grows by less than its head
    let file =
        input::bytes(path, most.saturating_add(most / 8) + (1 << 20)).map_err(|source| Error::io(path, source))?;
    parse(&file, most).map_err(|reason| {
        let text = format!("{reason}; run the scene again with --export states");
        Error::io(path, io::Error::new(io::ErrorKind::InvalidData, text))
    })
}

fn parse(file: &[u8], most: u64) -> std::result::Result<(String, Stored), String> {
    let mut lines = file.splitn(3, |byte| *byte == b'\n');
    if lines.next() != Some(MAGIC.as_bytes()) {
        return Err(format!("not a file that begins with `{MAGIC}`"));
    }
    let head: Head = serde_json::from_slice(lines.next().unwrap_or_default())
        .map_err(|error| format!("its second line cannot be read: {error}"))?;
    let mut rest = lines.next().unwrap_or_default();
    let promised = head.arrays.iter().fold(0u64, |sum, array| sum.saturating_add(array.bytes as u64));
    if promised > most {
        return Err(format!("its arrays have {promised} bytes, those of the scene at most {most}"));
    }
    let mut arrays = Vec::new();
    for array in head.arrays {
        let (stream, behind) = rest.split_at_checked(array.stored).ok_or("the file is cut")?;
        rest = behind;
        let bytes = inflated(stream, &array).map_err(|error| format!("{}: {error}", array.name))?;
        arrays.push((array.name, bytes));
    }
    let mut take = |name: &str| {
        let place = arrays.iter().position(|(own, _)| own == name).ok_or(format!("{name} is missing"));
        place.map(|place| arrays.swap_remove(place).1)
    };
    let conserved = typed(take("conserved")?)?;
    let (energy, kind) = (typed(take("energy")?)?, take("kind")?);
    let owed = take("owed").map_or(Ok(Vec::new()), typed)?;
    let particles = match take("position") {
        Err(_) => None,
        Ok(position) => Some(StoredParticles {
            position: typed(position)?,
            velocity: typed(take("velocity")?)?,
            affine: typed(take("affine")?)?,
            deformation: typed(take("deformation")?)?,
            stress: typed(take("stress")?)?,
        }),
    };
    Ok((head.scene, Stored { time: head.time, step: head.step, conserved, energy, owed, kind, particles }))
}

fn typed<T: Pod>(bytes: Vec<u8>) -> std::result::Result<Vec<T>, String> {
    if bytes.len().is_multiple_of(size_of::<T>()) {
        Ok(pod_collect_to_vec(&bytes))
    } else {
        Err("an array ends within an element".to_owned())
    }
}

/// Sorted by their place in an element, the bytes of neighbours are alike and compress well.
fn deflated(bytes: &[u8], width: usize) -> io::Result<Vec<u8>> {
    let sorted: Vec<u8> = (0..width).flat_map(|place| bytes.iter().skip(place).step_by(width).copied()).collect();
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(&sorted)?;
    encoder.finish()
}

fn inflated(stream: &[u8], Array { width, bytes, .. }: &Array) -> io::Result<Vec<u8>> {
    let wrong = |text: &str| io::Error::new(io::ErrorKind::InvalidData, text.to_owned());
    if *width == 0 || !bytes.is_multiple_of(*width) {
        return Err(wrong("its size is no multiple of its elements"));
    }
    let mut sorted = Vec::new();
    ZlibDecoder::new(stream).take(*bytes as u64 + 1).read_to_end(&mut sorted)?;
    if sorted.len() != *bytes {
        return Err(wrong("it has another size than the head says"));
    }
    let count = bytes / width;
    Ok((0..*bytes).map(|i| sorted[i % width * count + i / width]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> Stored {
        let rows = |count: usize| (0..count).map(|k| [k as f32, -0.0, f32::NAN, 1e-40]).collect::<Vec<_>>();
        let particles = StoredParticles::of([1, 1, 3, 3, 2].map(|n| rows(5 * n)));
        let (energy, kind) = ((0..27).map(|k| 1.0 / k as f32).collect(), (0..27).map(|k| k % 4).collect());
        Stored {
            time: 0.1 + 0.2,
            step: 7,
            conserved: rows(27),
            energy,
            owed: vec![0.5; 27],
            kind,
            particles: Some(particles),
        }
    }

    /// As text, where NaN equals itself and -0 is not 0.
    fn text(state: &Stored) -> String {
        format!("{state:?}")
    }

    #[test]
    fn a_state_comes_back_bit_by_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("states/0003.state");
        for particles in [state().particles, None] {
            let state = Stored { particles, ..state() };
            write(&path, "cafe", &state).unwrap();
            let (scene, again) = read(&path, 1 << 20).unwrap();
            assert_eq!((scene.as_str(), text(&again)), ("cafe", text(&state)));
        }
        assert_eq!(list(folder.path()).unwrap(), [(3, path)]);
    }

    #[test]
    fn what_is_no_state_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0000.state");
        write(&path, "cafe", &state()).unwrap();
        let whole = std::fs::read(&path).unwrap();
        let told = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            read(&path, 1 << 20).unwrap_err().to_string()
        };
        assert!(told(b"P6 2 2").contains("brisance state 2"));
        assert!(told(&whole[..whole.len() - 9]).contains("the file is cut"));
        assert!(told(&whole[..30]).contains("second line"));
        let mut broken = whole.clone();
        let last = broken.len() - 40;
        broken[last..].fill(0xff);
        assert!(told(&broken).contains("stress"), "{}", told(&broken));
    }
}
