//! Files that a run leaves behind: pictures, VTK fields and particles, tables, the report.
//!
//! To add a format: one file here with its [`Exporter`], and one line in [`FORMATS`].

pub mod apng;
pub mod atomic;
pub mod csv;
pub mod png;
pub mod report;
pub mod vtk;

use std::path::Path;

use crate::render::Picture;
use crate::snapshot::Snapshot;
use crate::{Error, Result};

/// Everything known about one frame when it is written.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// Frame number, from 0; file names carry it.
    pub index: u32,
    /// Title of the scene.
    pub title: &'a str,
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// Pictures of this frame, one per field that the scene asks for.
    pub pictures: &'a [Picture],
    /// The state; present whenever an exporter of the run asks for it.
    pub snapshot: Option<&'a Snapshot>,
}

/// A file format that receives every frame of a run.
pub trait Exporter {
    /// Writes one frame. On return all files of this format are complete and agree with each other.
    fn write(&mut self, moment: &Moment) -> Result<()>;

    /// Whether [`Moment::snapshot`] must be present: reading the whole state back has a price.
    fn needs_snapshot(&self) -> bool {
        false
    }
}

/// One line of the format list.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// Keyword of `--export`.
    pub name: &'static str,
    /// What it writes, for `brisance list`.
    pub description: &'static str,
    /// Makes the exporter for one output folder.
    pub open: fn(&Path) -> Box<dyn Exporter>,
}

/// All formats, by keyword.
pub const FORMATS: &[Format] = &[
    Format {
        name: "png",
        description: "frames/NNNN.png, with time, step, field and range as text chunks",
        open: |folder| Box::new(png::PngExporter::new(folder)),
    },
    Format {
        name: "vtk",
        description: "fields/NNNN.vti, particles/NNNN.vtp and .pvd time series for ParaView and VTK",
        open: |folder| Box::new(vtk::VtkExporter::new(folder)),
    },
];

/// Makes the exporters named on the command line.
pub fn open(names: &[String], folder: &Path) -> Result<Vec<Box<dyn Exporter>>> {
    names.iter().map(|name| find(name).map(|format| (format.open)(folder))).collect()
}

fn find(name: &str) -> Result<&'static Format> {
    FORMATS.iter().find(|format| format.name == name).ok_or_else(|| {
        let known: Vec<_> = FORMATS.iter().map(|format| format.name).collect();
        Error::Usage(format!("no export format `{name}`; there are: {}", known.join(", ")))
    })
}
