//! VTK XML files: gas as image data (.vti), particles as poly data (.vtp), time series (.pvd).
//!
//! Arrays are appended raw, little endian, with 64-bit byte counts: the layout VTK and ParaView read without conversion.
//! [VTK file formats, docs.vtk.org]

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use bytemuck::{Pod, cast_slice};

use crate::Result;
use crate::export::{Exporter, Moment, Needs, atomic};
use crate::snapshot::{ParticleSample, Snapshot, kind};

/// Writes `fields/NNNN.vti`, `particles/NNNN.vtp`, and `fields.pvd`, `particles.pvd` that give each file its time.
#[derive(Debug)]
pub struct VtkExporter {
    folder: PathBuf,
    fields: Vec<(f64, String)>,
    particles: Vec<(f64, String)>,
}

impl VtkExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), fields: Vec::new(), particles: Vec::new() }
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
            write_particles(&self.folder.join(&name), snapshot)?;
            self.particles.push((moment.time, name));
            write_series(&self.folder.join("particles.pvd"), &self.particles)?;
        }
        Ok(())
    }

    fn needs(&self) -> Needs {
        Needs { snapshot: true, ..Needs::default() }
    }
}

/// Writes the gas as cell data. Inactive axes have no extent and lie at the origin, as the particles do.
///
/// Gas values of cells without gas are NaN, which viewers leave blank; `kind` says what those cells are.
pub fn write_fields(path: &Path, snapshot: &Snapshot) -> Result<()> {
    let grid = &snapshot.grid;
    let active = |axis: usize| (axis as u32) < grid.dimension;
    let extent: Vec<_> = (0..3).map(|axis| format!("0 {}", if active(axis) { grid.cells[axis] } else { 0 })).collect();
    let extent = extent.join(" ");
    let origin = grid.origin.map(|coordinate| format!("{coordinate:?}"));
    let spacing = grid.spacing;

    let mut file = Appended::new("ImageData");
    let _ = writeln!(
        file.head,
        "<ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{spacing:?} {spacing:?} {spacing:?}\">",
        origin.join(" ")
    );
    file.time_value(snapshot.time);
    let _ = writeln!(file.head, "<Piece Extent=\"{extent}\">\n<CellData Scalars=\"density\" Vectors=\"velocity\">");
    file.array("density", gas_only(snapshot, &snapshot.density, f32::NAN));
    file.array("pressure", gas_only(snapshot, &snapshot.pressure, f32::NAN));
    file.array("velocity", gas_only(snapshot, &snapshot.velocity, [f32::NAN; 3]));
    file.array("energy", gas_only(snapshot, &snapshot.energy, f32::NAN));
    let gamma = -snapshot.gamma as f32;
    let entropy: Vec<f32> =
        snapshot.pressure.iter().zip(&snapshot.density).map(|(p, rho)| p * rho.powf(gamma)).collect();
    file.array("entropy", gas_only(snapshot, &entropy, f32::NAN));
    file.array("owed", snapshot.owed.clone());
    file.array("kind", snapshot.kind.clone());
    file.head.push_str("</CellData>\n</Piece>\n</ImageData>\n");
    atomic::write(path, |out| file.write(out))
}

fn gas_only<T: Copy>(snapshot: &Snapshot, values: &[T], blank: T) -> Vec<T> {
    values.iter().zip(&snapshot.kind).map(|(&value, &cell)| if cell == kind::GAS { value } else { blank }).collect()
}

/// Writes the particles as points, with one poly-vertex cell that holds them all.
pub fn write_particles(path: &Path, snapshot: &Snapshot) -> Result<()> {
    let particles = &snapshot.particles;
    let mut file = Appended::new("PolyData");
    file.head.push_str("<PolyData>\n");
    file.time_value(snapshot.time);
    let vertices = usize::from(!particles.is_empty());
    let _ = writeln!(
        file.head,
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{vertices}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">",
        particles.len()
    );
    file.head.push_str("<PointData Scalars=\"plastic_strain\" Vectors=\"velocity\">\n");
    file.array("velocity", gather(particles, |particle| particle.velocity));
    file.array("mass", gather(particles, |particle| particle.mass));
    file.array("volume", gather(particles, |particle| particle.volume0 * particle.volume_ratio()));
    file.array("ghost_pressure", gather(particles, |particle| particle.ghost_pressure));
    file.array("plastic_strain", gather(particles, |particle| particle.plastic_strain));
    file.array("damage", gather(particles, |particle| particle.damage));
    file.array("J", gather(particles, ParticleSample::volume_ratio));
    file.array("body", gather(particles, |particle| particle.body as i32));
    file.array("material", gather(particles, |particle| particle.material as i32));
    file.head.push_str("</PointData>\n<Points>\n");
    file.array("Points", gather(particles, |particle| particle.position));
    file.head.push_str("</Points>\n<Verts>\n");
    file.array("connectivity", (0..particles.len() as i32).collect::<Vec<_>>());
    file.array("offsets", vec![particles.len() as i32; vertices]);
    file.head.push_str("</Verts>\n</Piece>\n</PolyData>\n");
    atomic::write(path, |out| file.write(out))
}

fn gather<T>(particles: &[ParticleSample], value: impl Fn(&ParticleSample) -> T) -> Vec<T> {
    particles.iter().map(value).collect()
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

/// A VTK XML file in the making: the head, and the raw arrays that follow it.
struct Appended {
    head: String,
    blocks: Vec<Vec<u8>>,
    offset: u64,
}

/// A number type by its VTK name, as scalar or vector.
trait Element: Pod {
    const TYPE: &'static str;
    const COMPONENTS: usize = 1;
}

impl Element for f32 {
    const TYPE: &'static str = "Float32";
}

impl Element for [f32; 3] {
    const TYPE: &'static str = "Float32";
    const COMPONENTS: usize = 3;
}

impl Element for i32 {
    const TYPE: &'static str = "Int32";
}

impl Element for u8 {
    const TYPE: &'static str = "UInt8";
}

impl Appended {
    fn new(data_set: &str) -> Self {
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{data_set}\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\">\n"
        );
        Self { head, blocks: Vec::new(), offset: 0 }
    }

    /// The physical time, under the name ParaView looks for.
    fn time_value(&mut self, time: f64) {
        let _ = writeln!(
            self.head,
            "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time:?}</DataArray></FieldData>"
        );
    }

    fn array<T: Element>(&mut self, name: &str, values: Vec<T>) {
        let _ = writeln!(
            self.head,
            "<DataArray type=\"{}\" Name=\"{name}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>",
            T::TYPE,
            T::COMPONENTS,
            self.offset
        );
        let bytes: Vec<u8> = cast_slice(&values).to_vec();
        self.offset += (size_of::<u64>() + bytes.len()) as u64;
        self.blocks.push(bytes);
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(self.head.as_bytes())?;
        out.write_all(b"<AppendedData encoding=\"raw\">\n_")?;
        for block in &self.blocks {
            out.write_all(&(block.len() as u64).to_ne_bytes())?;
            out.write_all(block)?;
        }
        out.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }
}
