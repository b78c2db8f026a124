//! Shapes from mesh files: what is inside a closed surface of triangles.
//!
//! The sign of the distance comes from the generalised winding number, which is 1 inside, 0 outside, and degrades gracefully at holes.
//! [Jacobson et al. 2013, Barill et al. 2018]

mod gltf;
mod inspect;
mod read;
mod tree;

use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, OnceLock};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::named::{one, placed_bounds, unplaced};
use super::source::Finding;
use super::{shape, vector};
use tree::Tree;

/// Bytes that a mesh file may have.
const MAX_BYTES: u64 = 512 << 20;
/// Triangles that a mesh may have.
const MAX_TRIANGLES: usize = 4_000_000;

/// A closed surface of triangles from a file, turned, scaled and moved, in this order.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// The file, from the folder of the scene: `.obj`, `.stl`, `.ply`, `.gltf` or `.glb`.
    pub path: String,
    /// Ratio of lengths, positive; 1 when left out.
    #[serde(default = "one")]
    pub scale: f64,
    /// Direction of the axis it is turned about, of any length; z when left out.
    #[serde(default = "shape::along_z", deserialize_with = "vector::point")]
    #[schemars(with = "Vec<f64>")]
    pub axis: [f64; 3],
    /// Angle `[degrees]`, by the right-hand rule; 0 when left out.
    #[serde(default)]
    pub degrees: f64,
    /// Where its origin comes to lie `[m]`.
    #[serde(default, deserialize_with = "vector::point")]
    #[schemars(with = "Vec<f64>")]
    pub offset: [f64; 3],
    /// Accept a surface that is open or crosses itself: inside is where the winding number is above 1/2.
    #[serde(default)]
    pub repair: bool,
    /// The surface, once the scene that names it has been read; nothing before.
    #[serde(skip)]
    tree: OnceLock<Arc<Tree>>,
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        let keys = |mesh: &Mesh| (mesh.path.clone(), mesh.scale, mesh.axis, mesh.degrees, mesh.offset, mesh.repair);
        keys(self) == keys(other)
    }
}

/// Corners and triangles as they stand in a file.
#[derive(Debug, Default)]
struct Surface {
    points: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// Where mesh files may lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeshFolder<'a> {
    /// The folder of the scene.
    pub(super) folder: &'a Path,
    /// Files outside of it may be read, too.
    pub(super) outside: bool,
}

impl MeshFolder<'_> {
    /// The file of a path in a scene or a mesh; `within` is the folder that it is relative to.
    fn file(&self, within: &Path, path: &str) -> Result<PathBuf, (String, String)> {
        let file = within.join(path);
        if self.outside {
            return Ok(file);
        }
        let refused = || {
            let help = "copy the file into the folder of the scene, or allow others with --allow-outside";
            (format!("`{path}` lies outside of the folder of the scene"), help.to_owned())
        };
        let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if !Path::new(path).components().all(inside) {
            return Err(refused());
        }
        // a link may lead elsewhere; a file that is not there is reported where it is read
        match (file.canonicalize(), self.folder.canonicalize()) {
            (Ok(real), Ok(folder)) if !real.starts_with(&folder) => Err(refused()),
            _ => Ok(file),
        }
    }

    /// The bytes of a file.
    fn bytes(&self, within: &Path, path: &str) -> Result<Vec<u8>, (String, String)> {
        let file = self.file(within, path)?;
        let name = file.display();
        let unreadable = |error: std::io::Error| {
            (format!("{name}: {error}"), "paths start at the folder of the scene; check name and rights".to_owned())
        };
        let size = std::fs::metadata(&file).map_err(unreadable)?.len();
        if size > MAX_BYTES {
            let help = format!("give at most {} MiB; simplify the mesh", MAX_BYTES >> 20);
            return Err((format!("{name} has {} MiB", size >> 20), help));
        }
        std::fs::read(&file).map_err(unreadable)
    }
}

impl Mesh {
    /// Reads the surface.
    pub(super) fn resolve(&self, path: &str, place: MeshFolder<'_>) -> Option<Finding> {
        if self.tree.get().is_some() {
            return None;
        }
        let read = read::surface(&self.path, place).and_then(|surface| inspect::sound(surface, self.repair));
        match read {
            Ok(tree) => {
                let _ = self.tree.set(Arc::new(tree));
                None
            }
            Err((message, help)) => Some(Finding::new(format!("{path}.mesh.path"), message, help)),
        }
    }

    pub(super) fn distance(&self, point: [f64; 3]) -> f64 {
        let Some(tree) = self.tree.get() else { return f64::INFINITY };
        let inner = unplaced(point, self.axis, self.degrees, self.offset);
        tree.distance(inner.map(|x| x / self.scale)) * self.scale
    }

    pub(super) fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let Some(tree) = self.tree.get() else { return ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]) };
        placed_bounds(tree.bounds(), self.scale, self.axis, self.degrees, self.offset)
    }
}
