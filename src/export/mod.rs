//! Files that a run leaves behind: pictures, VTK fields and particles, tables, the report.
//!
//! To add a format: one file here with its [`Exporter`], and one line in [`FORMATS`].

pub mod apng;
pub mod arrays;
pub mod atomic;
pub mod checkpoint;
pub mod container;
pub mod csv;
mod encoder;
pub mod exr;
pub mod forms;
pub mod mesh;
mod npy;
mod ply;
pub mod png;
pub mod report;
pub mod states;
pub mod surface;
mod units;
pub mod usd;
mod usdc;
pub mod vdb;
mod vdb_tree;
pub mod video;
pub mod vtk;

use std::path::{Path, PathBuf};

use crate::quantity::{self, Place};
use crate::render::{Depth, Picture, Stored};
use crate::scene::{Obstacle, Scene};
use crate::snapshot::Snapshot;
use crate::spelling::did_you_mean;
use crate::{Error, Result};

/// Refuses a file that a link, or its path, leads out of a folder that somebody else may have made. A file that is not there passes.
///
/// # Errors
/// [`Error::Usage`] with the file.
pub fn stays_inside(folder: &Path, file: &Path) -> Result<()> {
    match (file.canonicalize(), folder.canonicalize()) {
        (Ok(real), Ok(folder)) if !real.starts_with(&folder) => {
            let text =
                "leads out of the folder of the run, and nothing outside of it is read; --allow-outside reads it";
            Err(Error::Usage(format!("{} {text}", file.display())))
        }
        _ => Ok(()),
    }
}

/// What files say about the scene that they come from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// Title of the scene.
    pub title: String,
    /// [`Scene::hash`].
    pub hash: String,
    /// What states say.
    pub source: container::Source,
    /// Its obstacles.
    pub obstacles: Vec<Obstacle>,
    /// Kelvin for a pressure over density of 1 m^2 s^-2, where the scene says so.
    pub kelvin: Option<f64>,
}

impl Origin {
    /// That of a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let source = container::Source::of(scene);
        let (obstacles, ambient) = (scene.obstacles.clone(), &scene.gas.ambient);
        let kelvin = scene.output.ambient_kelvin.map(|kelvin| kelvin * ambient.density / ambient.pressure);
        Self { title: scene.title.clone(), hash: source.scene_hash.clone(), source, obstacles, kelvin }
    }

    /// The same of a scene that lies at a place, on a device.
    #[must_use]
    pub fn at(mut self, place: &str, device: &str) -> Self {
        (self.source.scene_file, self.source.device) = (place.to_owned(), device.to_owned());
        self
    }
}

/// Everything known about one frame when it is written.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// Frame number, from 0; file names carry it.
    pub index: u32,
    /// Where it comes from.
    pub origin: &'a Origin,
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// Pictures of this frame, one per view and field that the scene asks for.
    pub pictures: &'a [Picture],
    /// The state; present whenever an exporter of the run asks for it.
    pub snapshot: Option<&'a Snapshot>,
    /// What pictures are drawn from; present whenever an exporter of the run asks for it.
    pub stored: Option<&'a Stored>,
}

impl Moment<'_> {
    /// Where a picture comes from: keyword and text.
    #[must_use]
    pub fn provenance(&self, picture: &Picture) -> Vec<(&'static str, String)> {
        let mut text = vec![
            ("Title", self.origin.title.clone()),
            ("Software", concat!("brisance ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("Scene", self.origin.hash.clone()),
            ("Time", format!("{:?}", self.time)),
            ("Step", self.step.to_string()),
            ("Field", if picture.shown.is_empty() { &picture.name } else { &picture.shown }.clone()),
            ("Range", format!("{:?} {:?}", picture.range[0], picture.range[1])),
        ];
        if let Some(shown) = quantity::find(Place::Cell, &picture.shown) {
            text.extend([("Symbol", shown.symbol.to_owned()), ("Unit", shown.unit.to_owned())]);
        }
        if !picture.view.is_empty() {
            text.push(("View", picture.view.clone()));
        }
        text
    }

    /// The pictures with their paths below `frames`, without extension: `NNNN` is the first picture, `FIELD/NNNN` any other; those
    /// of a view lie in a folder of its name.
    pub fn places(&self) -> impl Iterator<Item = (PathBuf, &Picture)> {
        let first = |order: usize| order == 0 || self.pictures[order - 1].view != self.pictures[order].view;
        self.pictures.iter().enumerate().map(move |(order, picture)| {
            let of_view = Path::new(&picture.view);
            let folder = if first(order) { of_view.to_owned() } else { of_view.join(&picture.name) };
            (folder.join(format!("{:04}", self.index)), picture)
        })
    }
}

/// What an exporter wants of every frame: reading the whole state back has a price, and so has depth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Needs {
    /// [`Moment::snapshot`], with its particles at least.
    pub snapshot: bool,
    /// The cells of [`Moment::snapshot`], too.
    pub cells: bool,
    /// [`Moment::stored`].
    pub stored: bool,
    /// [`Origin::obstacles`] with their meshes read.
    pub obstacles: bool,
    /// Pictures with more than 8 bits per channel.
    pub depth: Depth,
}

impl Needs {
    /// What several exporters want together.
    #[must_use]
    pub fn of(exporters: &[Box<dyn Exporter>]) -> Self {
        exporters.iter().map(|exporter| exporter.needs()).fold(Self::default(), |a, b| Self {
            snapshot: a.snapshot || b.snapshot,
            cells: a.cells || b.cells,
            stored: a.stored || b.stored,
            obstacles: a.obstacles || b.obstacles,
            depth: Depth { layers: a.depth.layers || b.depth.layers, fine: a.depth.fine || b.depth.fine },
        })
    }
}

/// A file format that receives every frame of a run.
pub trait Exporter {
    /// Writes one frame. On return all files of this format are complete and agree with each other.
    fn write(&mut self, moment: &Moment) -> Result<()>;

    /// What must be present in every [`Moment`] beside the pictures.
    fn needs(&self) -> Needs {
        Needs::default()
    }

    /// Called once before the first frame of a run that goes on: the first `frames` frames are there, and when each was.
    ///
    /// # Errors
    /// [`Error::Io`] if a file that is needed cannot be read.
    fn go_on(&mut self, frames: u32, time: &dyn Fn(u32) -> f64) -> Result<()> {
        let _ = (frames, time);
        Ok(())
    }

    /// Called once behind the last frame; what there is to tell the user, and what was not made.
    fn finish(&mut self) -> Vec<std::result::Result<String, String>> {
        Vec::new()
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
        description: "frames/NNNN.png, with scene, time, step, field and range as text chunks",
        open: |folder| Box::new(png::PngExporter::new(folder)),
    },
    Format {
        name: "png16",
        description: "the same with 16 bits per channel",
        open: |folder| Box::new(png::PngExporter::fine(folder)),
    },
    Format {
        name: "exr",
        description: "frames/NNNN.exr for compositors: linear light with alpha, depth, objects, velocities; no letters",
        open: |folder| Box::new(exr::ExrExporter::new(folder)),
    },
    Format {
        name: "fields",
        description: "states/NNNN.npz, the light form of a state, from which `brisance render` draws again and numpy reads",
        open: |folder| Box::new(states::StateExporter::new(folder)),
    },
    Format {
        name: "vtk",
        description: "fields/NNNN.vti, particles/NNNN.vtp, .pvd time series and open_in_paraview.py for ParaView and VTK",
        open: |folder| Box::new(vtk::VtkExporter::new(folder)),
    },
    Format {
        name: "vdb",
        description: "vdb/NNNN.vdb: density, pressure, temperature, velocity, schlieren, soot, flames, dust as sparse volumes for Blender and Houdini",
        open: |folder| Box::new(vdb::VdbExporter::new(folder)),
    },
    Format {
        name: "usd",
        description: "stage.usda with camera, volumes (vdb/NNNN.vdb) and bodies as points, usd/NNNN.usdc",
        open: |folder| Box::new(usd::UsdExporter::new(folder)),
    },
    Format {
        name: "mesh",
        description: "mesh/NNNN.ply: closed surfaces of the pieces of bodies; mesh/NNNN.csv: the pieces; mesh/obstacles.ply; in 3D",
        open: |folder| Box::new(mesh::MeshExporter::new(folder)),
    },
    Format {
        name: "npz",
        description: "arrays/NNNN.npz: all quantities of cells and particles for numpy",
        open: |folder| Box::new(arrays::ArrayExporter::new(folder)),
    },
];

/// Makes the exporters named on the command line; the volumes of `usd` are the files of `vdb`, which are written once.
pub fn open(names: &[String], folder: &Path) -> Result<Vec<Box<dyn Exporter>>> {
    let mut all: Vec<&Format> = names.iter().map(|name| find(name)).collect::<Result<_>>()?;
    if all.iter().any(|format| format.name == "usd") {
        all.retain(|format| format.name != "vdb");
    }
    Ok(all.into_iter().map(|format| (format.open)(folder)).collect())
}

/// The keyword of a format by another name of it: the files of `fields` lie in `states`, as the scene's key says.
#[must_use]
pub fn keyword(name: &str) -> &str {
    if name == "states" { "fields" } else { name }
}

fn find(name: &str) -> Result<&'static Format> {
    FORMATS.iter().find(|format| format.name == keyword(name)).ok_or_else(|| {
        let known: Vec<_> = FORMATS.iter().map(|format| format.name).collect();
        let like = did_you_mean(name, known.iter().copied());
        Error::Usage(format!("no export format `{name}`; there are: {}{like}", known.join(", ")))
    })
}
