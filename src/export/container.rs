//! The container of states: a file of NumPy's format npz, which is a zip archive of named arrays, with texts beside them.
//!
//! `numpy.load` reads the arrays; `head.json` says what they are. Members are deflated and carry a CRC-32. [NEP 1; APPNOTE 6.3]

use std::collections::BTreeMap;
use std::io::{self, Cursor, Read, Seek, Write};
use std::path::Path;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, ZipArchive};

use super::npy;
pub use super::npy::Numbers;
use super::units;
use crate::export::atomic;
use crate::scene::{self, RenderSettings, Scene};
use crate::{Error, Result, input};

/// What the head of every file names.
const FORMAT: &str = "brisance state";
/// Version of the format: that of the scene in it, which grows, too, when a reader of the version before would go wrong.
pub const VERSION: u32 = scene::FORM;
/// Member with the head.
const HEAD: &str = "head.json";
/// Member with the scene.
pub const SCENE: &str = "scene.toml";
/// How hard deflation tries: a run waits for a full state, the many light ones are to be small.
const fn level(form: Form) -> i64 {
    match form {
        Form::Fields => 2,
        Form::Full | Form::Arrays => 1,
    }
}
/// Texts of a file at most.
const MOST_TEXTS: usize = 16;
/// Bytes of texts and heads of arrays, and what arrays that do not compress may grow by.
const ROOM: u64 = 80 << 20;

/// How much a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// What pictures and converters need.
    Fields,
    /// All that a run needs to go on bit by bit.
    Full,
    /// Quantities for people and their scripts.
    Arrays,
}

/// Where a file comes from: the same for all files of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Version of the program.
    pub program: String,
    /// Name of the device and its driver.
    pub device: String,
    /// [`Scene::hash`].
    pub scene_hash: String,
    /// File or name of the scene; paths in it start there.
    pub scene_file: String,
    /// The scene with every default, as TOML.
    #[serde(skip)]
    pub scene: String,
    /// Its look.
    #[serde(skip)]
    pub render: RenderSettings,
    /// Names of its bodies and of its materials, by index.
    #[serde(skip)]
    pub bodies: Vec<String>,
    /// The same.
    #[serde(skip)]
    pub materials: Vec<String>,
}

impl Source {
    /// Of a scene of which nobody says where it lies.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            scene_hash: scene.hash(),
            scene: toml::to_string(scene).unwrap_or_default(),
            render: scene.render.clone(),
            bodies: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            materials: scene.materials.keys().cloned().collect(),
            ..Self::default()
        }
    }
}

/// The head of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    format: String,
    /// [`VERSION`] of the program that wrote it.
    pub version: u32,
    /// How much it holds.
    pub form: Form,
    /// Where it comes from.
    #[serde(flatten)]
    pub source: Source,
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// What the arrays are: names, and the unit of each column.
    pub arrays: BTreeMap<String, String>,
}

/// An array.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name.
    pub name: String,
    /// Elements along each axis, the last one fastest.
    pub shape: Vec<usize>,
    /// All of them.
    pub numbers: Numbers,
    /// What it is, with units.
    pub about: String,
}

impl Array {
    /// Rows of so many numbers.
    #[must_use]
    pub fn rows(name: &str, columns: usize, numbers: Numbers) -> Self {
        let rows = numbers.bytes().len() / (numbers.kind().width() * columns.max(1));
        let shape = if columns == 1 { vec![rows] } else { vec![rows, columns] };
        Self { name: name.to_owned(), shape, numbers, about: units::of(name).to_owned() }
    }

    /// Numbers of a row.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.shape.iter().skip(1).fold(1, |all: usize, side| all.saturating_mul(*side))
    }

    /// The numbers as those of a type.
    ///
    /// # Errors
    /// If they are of another size.
    pub fn typed<T: bytemuck::Pod>(self) -> std::result::Result<Vec<T>, String> {
        if size_of::<T>() == self.numbers.kind().width() * self.columns() {
            return Ok(self.numbers.cast());
        }
        Err(format!(
            "array `{}` has elements of {} numbers, which is not what belongs there",
            self.name,
            self.columns()
        ))
    }
}

/// A file.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// Its head.
    pub head: Head,
    /// Texts beside the head, by name.
    pub texts: BTreeMap<String, String>,
    /// The arrays.
    pub arrays: Vec<Array>,
}

impl Contents {
    /// Takes an array out.
    ///
    /// # Errors
    /// If it is not there.
    pub fn take(&mut self, name: &str) -> std::result::Result<Array, String> {
        let place = self.arrays.iter().position(|array| array.name == name);
        place.map(|place| self.arrays.swap_remove(place)).ok_or_else(|| format!("array `{name}` is missing"))
    }
}

/// Writes a state at a time \[s\] after so many steps. Each array is made, deflated and dropped by one thread.
///
/// # Errors
/// [`Error::Io`].
pub fn write(
    path: &Path,
    (form, source): (Form, &Source),
    (time, step): (f64, u64),
    texts: &[(&str, &str)],
    arrays: impl IntoParallelIterator<Item = Array, Iter: IndexedParallelIterator>,
) -> Result<()> {
    let packed = arrays
        .into_par_iter()
        .with_max_len(1)
        .map(|array| packed(&array, level(form)).map(|packed| (array.name, array.about, packed)));
    let packed: Vec<_> = packed.collect::<io::Result<_>>().map_err(|source| Error::io(path, source))?;
    let arrays = packed.iter().map(|(name, about, _)| (name.clone(), about.clone())).collect();
    let source = source.clone();
    let scene = source.scene.clone();
    let head = Head { format: FORMAT.to_owned(), version: VERSION, form, source, time, step, arrays };
    atomic::write(path, |out| {
        let mut zip = ZipWriter::new_stream(out);
        let options = deflated(level(form));
        zip.start_file(HEAD, options)?;
        serde_json::to_writer_pretty(&mut zip, &head)?;
        for (name, text) in [(SCENE, scene.as_str())].iter().chain(texts) {
            zip.start_file(*name, options)?;
            zip.write_all(text.as_bytes())?;
        }
        for (_, _, own) in &packed {
            zip.raw_copy_file(ZipArchive::new(Cursor::new(own))?.by_index_raw(0)?)?;
        }
        zip.finish().map(|_| ()).map_err(io::Error::from)
    })
}

fn deflated(level: i64) -> SimpleFileOptions {
    SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).compression_level(Some(level))
}

/// An array as an archive of its own, of which files take over what is deflated.
fn packed(array: &Array, level: i64) -> io::Result<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let bytes = array.numbers.bytes();
    let large = bytes.len() as u64 >= u64::from(u32::MAX);
    zip.start_file(format!("{}.npy", array.name), deflated(level).large_file(large))?;
    zip.write_all(&npy::head(array.numbers.kind(), &array.shape))?;
    zip.write_all(bytes)?;
    Ok(zip.finish()?.into_inner())
}

/// Reads a file; its arrays may have `most` bytes in all.
///
/// # Errors
/// [`Error::Io`] if it cannot be read or is no whole state.
pub fn read(path: &Path, most: u64) -> Result<Contents> {
    read_some(path, most, |_| true)
}

/// The same with those arrays alone whose names are wanted.
pub(super) fn read_some(path: &Path, most: u64, wanted: impl Fn(&str) -> bool) -> Result<Contents> {
    let bytes = input::bytes(path, most.saturating_add(ROOM)).map_err(|source| Error::io(path, source))?;
    parse(&bytes, most, wanted).map_err(|reason| Error::spoilt(path, &reason))
}

/// Reads the head and the texts of a file, without its arrays.
///
/// # Errors
/// As [`read`].
pub fn read_texts(path: &Path) -> Result<(Head, BTreeMap<String, String>)> {
    let about = std::fs::metadata(path).map_err(|source| Error::io(path, source))?;
    if !about.is_file() {
        return Err(Error::spoilt(path, "no regular file"));
    }
    let file = std::fs::File::open(path).map_err(|source| Error::io(path, source))?;
    let mut archive = opened(io::BufReader::new(file)).map_err(|reason| Error::spoilt(path, &reason))?;
    let read = head(&mut archive).and_then(|head| Ok((head, texts(&mut archive)?)));
    read.map_err(|reason| Error::spoilt(path, &reason))
}

fn opened<R: Read + Seek>(from: R) -> std::result::Result<ZipArchive<R>, String> {
    ZipArchive::new(from).map_err(|error| format!("the file is cut, or no state of brisance: {error}"))
}

fn head<R: Read + Seek>(archive: &mut ZipArchive<R>) -> std::result::Result<Head, String> {
    let text = member(archive, HEAD, input::MOST_REPORT).map_err(|error| format!("no state of brisance: {error}"))?;
    let about: serde_json::Value = serde_json::from_slice(&text).map_err(|error| format!("{HEAD}: {error}"))?;
    if about["format"] != FORMAT {
        return Err(format!("no state of brisance: {HEAD} names the format {}", about["format"]));
    }
    let version = &about["version"];
    if !version.as_u64().is_some_and(|version| (1..=u64::from(VERSION)).contains(&version)) {
        return Err(format!(
            "a state of version {version}; this program reads versions up to {VERSION}: use a newer one"
        ));
    }
    serde_json::from_value(about).map_err(|error| format!("{HEAD}: {error}"))
}

/// All bytes of a member; its checksum holds.
fn member<R: Read + Seek>(archive: &mut ZipArchive<R>, name: &str, most: u64) -> std::result::Result<Vec<u8>, String> {
    let file = archive.by_name(name).map_err(|error| format!("{name}: {error}"))?;
    let size = file.size();
    if size > most {
        return Err(format!("{name} has {size} bytes, what belongs there has at most {most}"));
    }
    let mut bytes = Vec::new();
    let room = usize::try_from(size).is_ok_and(|size| bytes.try_reserve_exact(size).is_ok());
    if !room {
        return Err(format!("{name}: there is no memory for its {size} bytes"));
    }
    file.take(size + 1).read_to_end(&mut bytes).map_err(|error| format!("{name}: {error}"))?;
    if bytes.len() as u64 > size {
        return Err(format!("{name} has more than its {size} bytes"));
    }
    Ok(bytes)
}

fn names<R: Read + Seek>(archive: &mut ZipArchive<R>) -> std::result::Result<Vec<String>, String> {
    let named = |name: zip::result::ZipResult<std::borrow::Cow<'_, str>>| name.map(std::borrow::Cow::into_owned);
    archive.file_names().map(named).collect::<zip::result::ZipResult<_>>().map_err(|error| error.to_string())
}

/// All texts but the head.
fn texts<R: Read + Seek>(archive: &mut ZipArchive<R>) -> std::result::Result<BTreeMap<String, String>, String> {
    let mut found = BTreeMap::new();
    for name in names(archive)?.into_iter().filter(|name| name != HEAD && !name.ends_with(".npy")).take(MOST_TEXTS) {
        let text = String::from_utf8(member(archive, &name, input::MOST_REPORT)?);
        found.insert(name.clone(), text.map_err(|error| format!("{name}: {error}"))?);
    }
    Ok(found)
}

fn parse(bytes: &[u8], most: u64, wanted: impl Fn(&str) -> bool) -> std::result::Result<Contents, String> {
    let mut archive = opened(Cursor::new(bytes))?;
    let (head, texts) = (head(&mut archive)?, texts(&mut archive)?);
    let is_wanted = |name: &String| name.strip_suffix(".npy").is_some_and(&wanted);
    let names: Vec<String> = names(&mut archive)?.into_iter().filter(is_wanted).collect();
    let mut promised = 0u64;
    for name in &names {
        let own = name.trim_end_matches(".npy");
        if !head.arrays.contains_key(own) {
            return Err(format!("array `{own}` is none of a state: {HEAD} does not name it"));
        }
        let size = archive.by_name(name).map_err(|error| format!("{name}: {error}"))?.size();
        promised = promised.saturating_add(size);
        if size > most.saturating_add(npy::MOST_HEAD) || promised > most.saturating_add(ROOM) {
            return Err(too_many(name, most));
        }
    }
    let read = |name: &String| array(&mut archive.clone(), name, most);
    let mut arrays: Vec<Array> = names.par_iter().with_max_len(1).map(read).collect::<std::result::Result<_, _>>()?;
    let mut left = most;
    for array in &mut arrays {
        left = left.checked_sub(array.numbers.bytes().len() as u64).ok_or_else(|| too_many(&array.name, most))?;
        array.about = head.arrays.get(&array.name).cloned().unwrap_or_default();
    }
    let missing = head.arrays.keys().find(|name| wanted(name) && arrays.iter().all(|array| array.name != **name));
    match missing {
        Some(name) => Err(format!("array `{name}` is missing")),
        None => Ok(Contents { head, texts, arrays }),
    }
}

fn too_many(name: &str, most: u64) -> String {
    format!("{name}: the arrays have more bytes than belong there, which are at most {most}")
}

/// An array that has a member to itself; nothing is known of what it is.
fn array<R: Read + Seek>(archive: &mut ZipArchive<R>, name: &str, most: u64) -> std::result::Result<Array, String> {
    let file = archive.by_name(name).map_err(|error| format!("{name}: {error}"))?;
    let size = file.size();
    if size > most.saturating_add(npy::MOST_HEAD) {
        return Err(too_many(name, most));
    }
    let (shape, numbers) = npy::read(file, size).map_err(|reason| format!("{name}: {reason}"))?;
    let own = name.strip_suffix(".npy").unwrap_or(name);
    Ok(Array { name: own.to_owned(), shape, numbers, about: String::new() })
}
