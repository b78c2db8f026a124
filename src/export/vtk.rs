//! VTK XML files: gas as image data (.vti), particles as poly data (.vtp), time series (.pvd).
//!
//! Arrays are those of the table of quantities, appended in blocks that zlib compresses, with 64-bit byte counts.
//! [VTK file formats, docs.vtk.org]

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use bytemuck::{Pod, cast_slice};
use flate2::{Compress, Compression, FlushCompress, Status};
use rayon::prelude::*;

use crate::Result;
use crate::export::{Exporter, Moment, Needs, atomic};
use crate::quantity::{self, Place, Values};
use crate::snapshot::{Snapshot, kind};

/// What opens them in ParaView.
const SCRIPT: &str = "open_in_paraview.py";

/// Writes `fields/NNNN.vti`, `particles/NNNN.vtp`, `fields.pvd`, `particles.pvd` that give each file its time, and a script for ParaView.
#[derive(Debug)]
pub struct VtkExporter {
    folder: PathBuf,
    fields: Vec<(f64, String)>,
    particles: Vec<(f64, String)>,
    /// Whether the script is there.
    begun: bool,
}

impl VtkExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), fields: Vec::new(), particles: Vec::new(), begun: false }
    }
}

impl Exporter for VtkExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        let snapshot = moment.snapshot.expect("a run reads the snapshot when an exporter needs it");
        let name = format!("fields/{:04}.vti", moment.index);
        write_fields(&self.folder.join(&name), snapshot)?;
        self.fields.push((moment.time, name));
        write_series(&self.folder.join("fields.pvd"), &self.fields)?;
        if !snapshot.particles.is_empty() {
            let name = format!("particles/{:04}.vtp", moment.index);
            let source = &moment.origin.source;
            write_particles(&self.folder.join(&name), snapshot, [&source.bodies, &source.materials])?;
            self.particles.push((moment.time, name));
            write_series(&self.folder.join("particles.pvd"), &self.particles)?;
        }
        if std::mem::replace(&mut self.begun, true) {
            Ok(())
        } else {
            write_script(&self.folder.join(SCRIPT), snapshot)
        }
    }

    fn go_on(&mut self, frames: u32, time: &dyn Fn(u32) -> f64) -> Result<()> {
        self.begun = frames > 0 && self.folder.join(SCRIPT).is_file();
        for index in 0..frames {
            for (folder, extension, series) in
                [("fields", "vti", &mut self.fields), ("particles", "vtp", &mut self.particles)]
            {
                let name = format!("{folder}/{index:04}.{extension}");
                if self.folder.join(&name).is_file() {
                    series.push((time(index), name));
                }
            }
        }
        Ok(())
    }

    fn needs(&self) -> Needs {
        Needs { snapshot: true, cells: true, ..Needs::default() }
    }
}

/// Writes the quantities of the gas as cell data. Inactive axes have no extent and lie at the origin, as the particles do.
///
/// Cells without gas are hidden (`vtkGhostType`), and their values are 0; `kind` says what those cells are.
pub fn write_fields(path: &Path, snapshot: &Snapshot) -> Result<()> {
    let grid = &snapshot.grid;
    let active = |axis: usize| (axis as u32) < grid.dimension;
    let extent: Vec<_> = (0..3).map(|axis| format!("0 {}", if active(axis) { grid.cells[axis] } else { 0 })).collect();
    let extent = extent.join(" ");
    let origin = match grid.is_far() {
        true => grid.low().map(|coordinate| format!("{coordinate:?}")),
        false => grid.origin.map(|coordinate| format!("{coordinate:?}")),
    };
    let spacing = grid.spacing;

    let mut file = Appended::new("ImageData");
    let _ = writeln!(
        file.head,
        "<ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{spacing:?} {spacing:?} {spacing:?}\">",
        origin.join(" ")
    );
    file.field_data(snapshot, Place::Cell, &[]);
    let _ = writeln!(file.head, "<Piece Extent=\"{extent}\">\n<CellData Scalars=\"density\" Vectors=\"velocity\">");
    file.quantities(snapshot, Place::Cell);
    let hidden: Vec<u8> = snapshot.kind.iter().map(|cell| if *cell == kind::GAS { 0 } else { HIDDEN }).collect();
    file.array("vtkGhostType", 1, &hidden);
    file.head.push_str("</CellData>\n</Piece>\n</ImageData>\n");
    atomic::write(path, |out| file.write(out))
}

/// Writes the quantities of the particles, each a point with a vertex cell of its own. `names`: of the bodies and of the materials.
pub fn write_particles(path: &Path, snapshot: &Snapshot, names: [&[String]; 2]) -> Result<()> {
    let particles = &snapshot.particles;
    let count = particles.len();
    let mut file = Appended::new("PolyData");
    file.head.push_str("<PolyData>\n");
    file.field_data(snapshot, Place::Particle, &[("bodies", names[0]), ("materials", names[1])]);
    let _ = writeln!(
        file.head,
        "<Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">"
    );
    file.head.push_str("<PointData Scalars=\"plastic_strain\" Vectors=\"velocity\">\n");
    file.quantities(snapshot, Place::Particle);
    file.head.push_str("</PointData>\n<Points>\n");
    if snapshot.grid.is_far() {
        let places: Vec<f64> = particles.iter().flat_map(|particle| snapshot.place_of(particle)).collect();
        file.array("Points", 3, &places);
    } else {
        let places: Vec<f32> = particles.iter().flat_map(|particle| particle.position).collect();
        file.array("Points", 3, &places);
    }
    file.head.push_str("</Points>\n<Verts>\n");
    file.array("connectivity", 1, &(0..count as i32).collect::<Vec<_>>());
    file.array("offsets", 1, &(1..=count as i32).collect::<Vec<_>>());
    file.head.push_str("</Verts>\n</Piece>\n</PolyData>\n");
    atomic::write(path, |out| file.write(out))
}

/// Writes a collection that gives each file, relative to `path`, its physical time \[s\].
pub fn write_series(path: &Path, files: &[(f64, String)]) -> Result<()> {
    atomic::write(path, |out| {
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        writeln!(out, "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>")?;
        for (time, file) in files {
            writeln!(out, "<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>")?;
        }
        writeln!(out, "</Collection>\n</VTKFile>")
    })
}

/// Writes what opens the files in ParaView, with points as wide as particles are apart at rest.
fn write_script(path: &Path, snapshot: &Snapshot) -> Result<()> {
    let (particles, axes) = (&snapshot.particles, snapshot.grid.dimension);
    let volume: f64 = particles.iter().map(|particle| f64::from(particle.volume0)).sum();
    let radius = 0.5 * (volume / particles.len().max(1) as f64).powf(1.0 / f64::from(axes));
    let text = include_str!("paraview.py").replace("DIMENSION", &axes.to_string());
    atomic::write(path, |out| out.write_all(text.replace("RADIUS", &format!("{radius:?}")).as_bytes()))
}

/// What `vtkGhostType` says of cells that are not shown. [vtkDataSetAttributes.h, HIDDENCELL]
const HIDDEN: u8 = 32;
/// Bytes of a block that is compressed on its own.
const BLOCK: usize = 1 << 17;
/// Bytes that a block may grow by which does not compress.
const SPARE: usize = 1 << 10;

/// A VTK XML file in the making: the head, and the compressed arrays that follow it.
struct Appended {
    head: String,
    blocks: Vec<Vec<u8>>,
    offset: u64,
}

/// A number type by its VTK name.
trait Element: Pod {
    const TYPE: &'static str;
}

impl Element for f32 {
    const TYPE: &'static str = "Float32";
}

impl Element for f64 {
    const TYPE: &'static str = "Float64";
}

impl Element for i32 {
    const TYPE: &'static str = "Int32";
}

impl Element for u32 {
    const TYPE: &'static str = "UInt32";
}

impl Element for u8 {
    const TYPE: &'static str = "UInt8";
}

impl Appended {
    fn new(data_set: &str) -> Self {
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{data_set}\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n"
        );
        Self { head, blocks: Vec::new(), offset: 0 }
    }

    /// The physical time, under the name ParaView looks for, units and symbols of the arrays, and further lists of names.
    fn field_data(&mut self, snapshot: &Snapshot, place: Place, lists: &[(&str, &[String])]) {
        let time = snapshot.time;
        let _ = writeln!(
            self.head,
            "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time:?}</DataArray>"
        );
        let unit = |own: &quantity::Quantity| format!("{}: {}", own.name, own.unit);
        self.texts("units", &quantity::all(snapshot, place).map(unit).collect::<Vec<_>>());
        let symbol = |own: &quantity::Quantity| format!("{}: {}", own.name, own.symbol);
        self.texts("symbols", &quantity::all(snapshot, place).map(symbol).collect::<Vec<_>>());
        for (name, texts) in lists {
            self.texts(name, texts);
        }
        self.head.push_str("</FieldData>\n");
    }

    /// A list of texts, as the numbers of their letters.
    fn texts(&mut self, name: &str, texts: &[String]) {
        let letters: Vec<String> =
            texts.iter().flat_map(|text| text.bytes().chain([0])).map(|letter| letter.to_string()).collect();
        let _ = writeln!(
            self.head,
            "<Array type=\"String\" Name=\"{name}\" NumberOfTuples=\"{}\" format=\"ascii\">{}</Array>",
            texts.len(),
            letters.join(" ")
        );
    }

    /// All quantities of cells or of particles.
    fn quantities(&mut self, snapshot: &Snapshot, place: Place) {
        let all: Vec<_> = quantity::all(snapshot, place).collect();
        let packed = all.into_par_iter().with_max_len(1).map(|own| match own.of(snapshot) {
            Values::Real(values) => (own, f32::TYPE, compressed(cast_slice(&values))),
            Values::Whole(values) => (own, u32::TYPE, compressed(cast_slice(&values))),
        });
        for (own, kind, blocks) in packed.collect::<Vec<_>>() {
            self.block(own.name, own.components, kind, blocks);
        }
    }

    fn array<T: Element>(&mut self, name: &str, components: usize, values: &[T]) {
        self.block(name, components, T::TYPE, compressed(cast_slice(values)));
    }

    fn block(&mut self, name: &str, components: usize, kind: &str, blocks: Vec<Vec<u8>>) {
        let _ = writeln!(
            self.head,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{}\"/>",
            self.offset
        );
        self.offset += blocks.iter().map(|block| block.len() as u64).sum::<u64>();
        self.blocks.extend(blocks);
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(self.head.as_bytes())?;
        out.write_all(b"<AppendedData encoding=\"raw\">\n_")?;
        for block in &self.blocks {
            out.write_all(block)?;
        }
        out.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }
}

/// Blocks of an array behind their number, their size, that of a last shorter one, and their sizes when compressed.
fn compressed(bytes: &[u8]) -> Vec<Vec<u8>> {
    let deflated = |encoder: &mut Compress, block: &[u8]| {
        encoder.reset();
        let mut out = Vec::with_capacity(block.len() + SPARE);
        loop {
            let rest = &block[encoder.total_in() as usize..];
            match encoder.compress_vec(rest, &mut out, FlushCompress::Finish) {
                Ok(Status::Ok | Status::BufError) => out.reserve(SPARE),
                // it ended: memory takes all
                _ => return out,
            }
        }
    };
    let encoder = || Compress::new(Compression::fast(), true);
    let blocks = bytes.par_chunks(BLOCK).map_init(encoder, deflated);
    let mut all: Vec<Vec<u8>> = blocks.collect();
    let mut head = vec![all.len() as u64, BLOCK as u64, (bytes.len() % BLOCK) as u64];
    head.extend(all.iter().map(|block| block.len() as u64));
    all.insert(0, cast_slice(&head).to_vec());
    all
}
