//! Meshes that no scene names: their files are given by hand.

use std::path::Path;
use std::sync::OnceLock;

use super::{Mesh, MeshFolder, Surfaces};
use crate::scene::finding::Finding;
use crate::scene::shape;
use crate::{Error, Result};

/// How names of mesh files end that are one file each.
const ENDINGS: [&str; 4] = ["obj", "ply", "stl", "glb"];

/// Whether a file is by its name a mesh that is one file.
pub(crate) fn is_mesh_file(path: &Path) -> bool {
    path.extension().is_some_and(|end| ENDINGS.iter().any(|own| end.eq_ignore_ascii_case(own)))
}

impl Mesh {
    /// The surface of a file as it stands, for a scene of so many axes; with `repair` also an open one.
    ///
    /// # Errors
    /// [`Error::Scene`] with what a scene that names the file would be told.
    pub(crate) fn of_file(file: &Path, dimension: u32, repair: bool) -> Result<Self> {
        let path = file.to_string_lossy().into_owned();
        let (axis, tree) = (shape::along_z(), OnceLock::new());
        let mesh = Self { path, scale: 1.0, axis, degrees: 0.0, offset: [0.0; 3], up: None, node: None, repair, tree };
        let place = MeshFolder { folder: Path::new(""), outside: true, dimension };
        match mesh.resolve("", place, &mut Surfaces::default()) {
            None => Ok(mesh),
            Some(Finding { message, help, .. }) => {
                Err(Error::Scene(format!("error: {message}\n  --> {}\n  = {help}", file.display())))
            }
        }
    }
}
