//! Shapes from mesh files: what is inside a closed surface of triangles.
//!
//! The sign of the distance comes from the generalised winding number, which is 1 inside, 0 outside, and degrades gracefully at holes.
//! [Jacobson et al. 2013, Barill et al. 2018]

mod camera;
#[cfg(test)]
mod corpus;
#[cfg(feature = "viewer")]
mod given;
mod gltf;
mod inspect;
mod read;
mod stl;
mod tree;

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, OnceLock};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::input;
use crate::scene::finding::Finding;
use crate::scene::geometry::named::{one, placed_bounds, unplaced};
use crate::scene::{shape, vector};
pub(crate) use camera::{FileCamera, Sight, camera};
#[cfg(feature = "viewer")]
pub(crate) use given::is_mesh_file;
use tree::Tree;

/// Bytes that a mesh file may have.
const MAX_BYTES: u64 = 512 << 20;
/// Triangles that a mesh may have.
const MAX_TRIANGLES: usize = 4_000_000;

/// A closed surface of triangles from a file, turned, scaled and moved, in this order.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// The file.
    pub path: String,
    /// Ratio of lengths.
    #[serde(default = "one")]
    pub scale: f64,
    /// Axis that it is turned about.
    #[serde(default = "shape::along_z", with = "vector::Point")]
    pub axis: [f64; 3],
    /// Angle, by the right-hand rule `[degrees]`.
    #[serde(default)]
    pub degrees: f64,
    /// Where its origin comes to lie `[m]`.
    #[serde(default, with = "vector::Point")]
    pub offset: [f64; 3],
    /// Direction that is up in the file; y in glTF, and others are taken as they are, when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<Up>,
    /// Only this node of a glTF.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node: Option<String>,
    /// Take a surface that is open or crosses itself.
    #[serde(default)]
    pub repair: bool,
    /// The surface, once the scene that names it has been read; nothing before.
    #[serde(skip)]
    tree: OnceLock<Arc<Tree>>,
}

/// A direction that is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Up {
    /// y, as in glTF and in most films.
    Y,
    /// z, as in most engineering.
    Z,
}

impl Up {
    /// The direction that is up in a scene of so many axes.
    pub(crate) fn of_scene(dimension: u32) -> Self {
        if dimension == 3 { Up::Z } else { Up::Y }
    }

    /// A quarter turn about x, where two directions differ.
    pub(crate) fn turned(self, to: Up, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match (self, to) {
            (Up::Y, Up::Z) => [x, -z, y],
            (Up::Z, Up::Y) => [x, z, -y],
            _ => [x, y, z],
        }
    }
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        let file = |mesh: &Mesh| (mesh.path.clone(), mesh.up, mesh.node.clone(), mesh.repair);
        let place = |mesh: &Mesh| (mesh.scale, mesh.axis, mesh.degrees, mesh.offset);
        file(self) == file(other) && place(self) == place(other)
    }
}

/// Corners and triangles as they stand in a file.
#[derive(Debug, Default)]
struct Surface {
    points: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Adds a triangle with corners of its own.
    fn add_triangle(&mut self, corners: [[f64; 3]; 3]) -> Result<(), String> {
        let first = self.points.len() as u32;
        self.points.extend(corners);
        self.add_polygon(&[first, first + 1, first + 2])
    }

    /// Adds a polygon, as triangles around its first corner.
    fn add_polygon(&mut self, corners: &[u32]) -> Result<(), String> {
        if self.triangles.len() + corners.len() > MAX_TRIANGLES + 2 {
            return Err(format!("more than {MAX_TRIANGLES} triangles; simplify the mesh"));
        }
        self.triangles.extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
        Ok(())
    }
}

/// What a surface was read from: path, node, whether y is up, whether it may be open.
type Key = (String, Option<String>, Option<bool>, bool);

/// Surfaces that were read, by what they were read from: many bodies may share one.
#[derive(Debug, Default)]
pub(crate) struct Surfaces {
    ready: BTreeMap<Key, Arc<Tree>>,
    triangles: usize,
}

/// Where mesh files may lie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshFolder<'a> {
    /// The folder of the scene.
    pub(crate) folder: &'a Path,
    /// Files outside of it may be read, too.
    pub(crate) outside: bool,
    /// Axes of the scene.
    pub(crate) dimension: u32,
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
            let what = if Path::new(path).is_absolute() { "is no path from" } else { "lies outside of" };
            (format!("`{path}` {what} the folder of the scene"), help.to_owned())
        };
        let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if !Path::new(path).components().all(inside) {
            return Err(refused());
        }
        // a link may lead elsewhere; a file that is not there is reported where it is read
        let own = if self.folder.as_os_str().is_empty() { Path::new(".") } else { self.folder };
        match (file.canonicalize(), own.canonicalize()) {
            (Ok(real), Ok(folder)) if real.starts_with(&folder) => Ok(file),
            (Ok(_), _) => Err(refused()),
            (Err(_), _) => Ok(file),
        }
    }

    /// The bytes of a file.
    pub(crate) fn bytes(&self, within: &Path, path: &str, most: u64) -> Result<Vec<u8>, (String, String)> {
        let file = self.file(within, path)?;
        let name = file.display();
        let unreadable = |error: std::io::Error| {
            (format!("{name}: {error}"), "paths start at the folder of the scene; check name and rights".to_owned())
        };
        input::bytes(&file, most).map_err(unreadable)
    }
}

impl Mesh {
    /// Reads the surface, if none of `ready` is the same.
    pub(crate) fn resolve(&self, path: &str, place: MeshFolder<'_>, surfaces: &mut Surfaces) -> Option<Finding> {
        if self.tree.get().is_some() {
            return None;
        }
        let key = (self.path.clone(), self.node.clone(), self.up.map(|up| up == Up::Y), self.repair);
        let read = match surfaces.ready.get(&key) {
            Some(tree) => Ok(Arc::clone(tree)),
            None => self.read(place).map(Arc::new),
        };
        match read {
            Ok(tree) => {
                if surfaces.ready.insert(key, Arc::clone(&tree)).is_none() {
                    surfaces.triangles += tree.triangles().len();
                }
                let _ = self.tree.set(tree);
                (surfaces.triangles > MAX_TRIANGLES).then(|| {
                    let message = format!("{} triangles in all meshes", surfaces.triangles);
                    Finding::new(path, message, format!("give at most {MAX_TRIANGLES}; simplify the meshes"))
                })
            }
            Err((message, help)) => Some(Finding::new(format!("{path}.mesh.path"), message, help)),
        }
    }

    fn read(&self, place: MeshFolder<'_>) -> Result<Tree, (String, String)> {
        let (mut surface, up) = read::surface(&self.path, self.node.as_deref(), place)?;
        if let Some(up) = self.up.or(up) {
            let to = Up::of_scene(place.dimension);
            surface.points.iter_mut().for_each(|point| *point = up.turned(to, *point));
        }
        inspect::sound(surface, self.repair)
    }

    /// Triangles of the surface.
    pub(crate) fn triangle_count(&self) -> usize {
        self.tree.get().map_or(0, |tree| tree.triangles().len())
    }

    pub(crate) fn distance(&self, point: [f64; 3]) -> f64 {
        let Some(tree) = self.tree.get() else { return f64::INFINITY };
        let inner = unplaced(point, self.axis, self.degrees, self.offset);
        tree.distance(inner.map(|x| x / self.scale)) * self.scale
    }

    pub(crate) fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let Some(tree) = self.tree.get() else { return ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]) };
        placed_bounds(tree.bounds(), self.scale, self.axis, self.degrees, self.offset)
    }
}
