//! vdb/NNNN.vdb: the gas as sparse volumes for Blender, Houdini and others, in OpenVDB's file version 224.
//!
//! The layout is that of OpenVDB 10 [Museth 2013, ACM TOG 32(3):27; openvdb/io/Archive.cc]: grids of the tree 5-4-3, active values only,
//! zlib. Values are halves where their range allows. Voxels that hold the ambient gas bit by bit, or none, are left out.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::Result;
use crate::export::vdb_tree::{Bytes, Tree};
use crate::export::{Exporter, Moment, Needs, atomic};
use crate::quantity::{self, Place, Values};
use crate::snapshot::{Snapshot, kind};

/// First word of every file.
const MAGIC: u64 = 0x5644_4220;
/// Version of the layout, and of the library that wrote it first.
const FILE_VERSION: u32 = 224;
const LIBRARY: [u32; 2] = [10, 0];
/// zlib, and active values only.
const COMPRESSION: u32 = 1 | 2;
/// Largest number of the format of 16 bits.
const MOST_HALF: f32 = 65504.0;
/// What is in kelvin where the scene says what its gas has.
const TEMPERATURE: &str = "temperature";
/// Quantities that are written.
const GRIDS: [&str; 10] =
    ["density", "pressure", TEMPERATURE, "velocity", "schlieren", "soot", "flames", "dust", "peak_pressure", "impulse"];

/// Writes `vdb/NNNN.vdb`.
#[derive(Debug)]
pub struct VdbExporter {
    folder: PathBuf,
}

impl VdbExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.join("vdb") }
    }

    /// Writes the file of a frame.
    ///
    /// # Errors
    /// [`crate::Error::Io`].
    pub(super) fn put(&self, index: u32, bytes: &[u8]) -> Result<()> {
        atomic::write(&self.folder.join(format!("{index:04}.vdb")), |file| file.write_all(bytes))
    }
}

impl Exporter for VdbExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        let snapshot = moment.snapshot.expect("a run reads the snapshot when an exporter needs it");
        self.put(moment.index, &volumes(snapshot, moment))
    }

    fn needs(&self) -> Needs {
        Needs { snapshot: true, cells: true, ..Needs::default() }
    }
}

/// Names of the grids of a state.
pub(super) fn names(snapshot: &Snapshot) -> Vec<&'static str> {
    let has = |name: &&str| quantity::all(snapshot, Place::Cell).any(|quantity| quantity.name == *name);
    GRIDS.into_iter().filter(has).collect()
}

/// The file with the gas of a state.
pub(super) fn volumes(snapshot: &Snapshot, moment: &Moment) -> Vec<u8> {
    let mut out = Bytes::default();
    out.words64(&[MAGIC]);
    out.words(&[FILE_VERSION, LIBRARY[0], LIBRARY[1]]);
    out.0.push(1); // the places of the grids follow
    out.0.extend_from_slice(unique(&moment.origin.hash, moment.index).as_bytes());
    let creator = concat!("brisance ", env!("CARGO_PKG_VERSION"));
    out.words(&[2]);
    out.text_entry("creator", creator);
    out.text_entry("scene", &moment.origin.title);
    let grid = |name: &&str| Volume::of(name, snapshot, moment.origin.kelvin);
    let grids: Vec<Volume> = GRIDS.par_iter().filter_map(grid).collect();
    out.words(&[grids.len() as u32]);
    for grid in &grids {
        grid.write(&mut out, snapshot);
    }
    out.0
}

/// Thirty-six letters that no other file has.
fn unique(hash: &str, index: u32) -> String {
    let text: String = hash.chars().chain("0".repeat(32).chars()).take(24).collect();
    let text = format!("{text}{index:08x}");
    [&text[..8], &text[8..12], &text[12..16], &text[16..20], &text[20..32]].join("-")
}

/// A grid in the making.
struct Volume {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    components: usize,
    values: Vec<f32>,
    active: Vec<bool>,
    background: [f32; 3],
}

impl Volume {
    fn of(name: &str, snapshot: &Snapshot, kelvin: Option<f64>) -> Option<Self> {
        let quantity = quantity::all(snapshot, Place::Cell).find(|quantity| quantity.name == name)?;
        let Values::Real(mut values) = quantity.of(snapshot) else { return None };
        let kelvin = kelvin.filter(|_| name == TEMPERATURE);
        if let Some(kelvin) = kelvin {
            values.par_iter_mut().for_each(|value| *value = (f64::from(*value) * kelvin) as f32);
        }
        let components = quantity.components;
        // the background is what most of the far corner holds: gas at rest, which no front has reached
        let gas = |cell: &usize| snapshot.kind[*cell] == kind::GAS;
        let last = (0..snapshot.kind.len()).rev().find(gas);
        let at = |cell: usize| &values[components * cell..components * (cell + 1)];
        let mut background = [0.0; 3];
        if let Some(last) = last {
            background[..components].copy_from_slice(at(last));
        }
        let differs = |cell: usize| at(cell).iter().zip(&background).any(|(a, b)| a.to_bits() != b.to_bits());
        let active = (0..snapshot.kind.len()).into_par_iter().map(|cell| gas(&cell) && differs(cell)).collect();
        let unit = if kelvin.is_some() { "K" } else { quantity.unit };
        let (name, symbol) = (quantity.name, if kelvin.is_some() { "T" } else { quantity.symbol });
        Some(Self { name, symbol, unit, components, values, active, background })
    }

    fn write(&self, out: &mut Bytes, snapshot: &Snapshot) {
        let half = self.values.par_iter().all(|value| value.abs() < MOST_HALF);
        let kind = if self.components == 3 { "Tree_vec3s_5_4_3" } else { "Tree_float_5_4_3" };
        out.text(self.name);
        out.text(&format!("{kind}{}", if half { "_HalfFloat" } else { "" }));
        out.text("");
        let places = out.0.len();
        out.words64(&[0; 3]);
        let start = out.0.len();
        out.words(&[COMPRESSION]);
        self.write_meta(out, snapshot, half);
        write_transform(out, snapshot);
        let tree = Tree::new(snapshot.grid.cells, (&self.values, self.components), &self.active, half);
        tree.write_topology(out, self.background);
        let blocks = out.0.len();
        tree.write_values(out);
        let end = out.0.len();
        for (k, place) in [start, blocks, end].into_iter().enumerate() {
            out.0[places + 8 * k..places + 8 * (k + 1)].copy_from_slice(&(place as u64).to_le_bytes());
        }
    }

    fn write_meta(&self, out: &mut Bytes, snapshot: &Snapshot, half: bool) {
        let fog = if ["density", "soot", "dust"].contains(&self.name) { "fog volume" } else { "unknown" };
        out.words(&[if self.components == 3 { 9 } else { 8 }]);
        out.text_entry("class", fog);
        out.text_entry("name", self.name);
        out.text_entry("symbol", self.symbol);
        out.text_entry("unit", self.unit);
        out.text_entry("up_axis", "Z");
        out.entry("meters_per_unit", "double", &1.0f64.to_le_bytes());
        out.entry("time", "double", &snapshot.time.to_le_bytes());
        out.entry("is_saved_as_half_float", "bool", &[u8::from(half)]);
        if self.components == 3 {
            out.text_entry("vector_type", "contravariant relative");
        }
    }
}

/// Voxels lie where the cells do, in metres; the place of a voxel is its middle.
fn write_transform(out: &mut Bytes, snapshot: &Snapshot) {
    let edge = f64::from(snapshot.grid.spacing);
    let middle = snapshot.grid.low().map(|low| low + 0.5 * edge);
    out.text("UniformScaleTranslateMap");
    out.reals(&middle);
    for value in [edge, edge, 1.0 / edge, 1.0 / (edge * edge), 0.5 / edge] {
        out.reals(&[value; 3]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Grid;

    #[test]
    fn temperatures_are_in_kelvin_where_the_scene_says_what_its_gas_has() {
        let grid = Grid { dimension: 2, cells: [2, 1, 1], frame: [0.0; 3], origin: [0.0; 3], spacing: 0.5 };
        let mut gas = Snapshot::of_particles((0.0, 0), grid, Vec::new());
        (gas.kind, gas.density, gas.pressure) = (vec![kind::GAS; 2], vec![0.5, 1.0], vec![2.0, 1.0]);
        let of = |kelvin| Volume::of(TEMPERATURE, &gas, kelvin).unwrap();
        let (plain, kelvin) = (of(None), of(Some(300.0)));
        assert_eq!((plain.unit, plain.values), ("m^2 s^-2", vec![4.0, 1.0]));
        assert_eq!((kelvin.unit, kelvin.values, kelvin.background), ("K", vec![1200.0, 300.0], [300.0, 0.0, 0.0]));
        let [low, high] = [None, Some(300.0)].map(|kelvin| Volume::of("density", &gas, kelvin).unwrap().values);
        assert_eq!(low, high);
    }
}
