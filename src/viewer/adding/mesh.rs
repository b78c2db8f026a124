//! A mesh file as the shape of a body: how large it is to be, and where it comes to lie.

use std::path::{Path, PathBuf};

use crate::scene::{Body, Domain, Mesh, Scene, Shape};
use crate::{Error, Result};

/// Largest part of an edge of the domain that a mesh takes at first.
const SHARE: f64 = 0.3;
/// Letters that a body has of the name of its file.
const LETTERS: usize = 40;

/// A mesh that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    mesh: Mesh,
    /// Name of the file without its ending.
    pub name: String,
    /// Triangles of its surface.
    pub triangles: usize,
}

impl MeshFile {
    /// Reads a file for a scene; with `repair` also a surface that is open or crosses itself.
    ///
    /// # Errors
    /// [`Error::Scene`] with what a scene that names the file would be told; [`Error::Usage`] for a scene along a line.
    pub fn read(file: &Path, scene: &Scene, repair: bool) -> Result<Self> {
        if scene.domain.dimension < 2 {
            let text = "a mesh becomes a body of a scene in a plane or in space, and this one is along a line";
            return Err(Error::Usage(format!("{}: {text}", file.display())));
        }
        let file = std::path::absolute(file).map_err(|source| Error::io(file, source))?;
        let mesh = Mesh::of_file(&file, scene.domain.dimension, repair)?;
        let plain = |c: &char| !c.is_control() && ![',', '"', '='].contains(c);
        let name: String =
            file.file_stem().unwrap_or_default().to_string_lossy().chars().filter(plain).take(LETTERS).collect();
        let name = if name.trim().is_empty() { "mesh".to_owned() } else { name };
        Ok(Self { triangles: mesh.triangle_count(), mesh, name })
    }

    /// Lengths along the axes of a domain, over the largest of them.
    fn proportions(&self, axes: usize) -> [f64; 3] {
        let (low, high) = self.mesh.bounds();
        let edges: [f64; 3] = std::array::from_fn(|axis| high[axis] - low[axis]);
        let largest = edges[..axes].iter().copied().fold(0.0, f64::max);
        edges.map(|edge| edge / largest)
    }

    /// The largest length that suits a domain \[m\].
    pub(super) fn size_in(&self, domain: &Domain) -> f64 {
        let parts = self.proportions(domain.axes());
        (0..domain.axes()).map(|axis| SHARE * domain.size[axis] / parts[axis].max(1e-9)).fold(f64::INFINITY, f64::min)
    }

    /// Lengths along the axes of a domain \[m\], where the largest is `size`.
    pub fn edges(&self, size: f64, domain: &Domain) -> Vec<f64> {
        self.proportions(domain.axes())[..domain.axes()].iter().map(|part| part * size).collect()
    }

    /// Half of the longest way through it \[m\].
    pub(super) fn reach(&self, size: f64) -> f64 {
        0.5 * size * self.proportions(3).iter().map(|part| part * part).sum::<f64>().sqrt()
    }

    /// With the middle of the box around it at a point \[m\], and with its largest length along so many axes.
    pub(super) fn placed(&self, point: [f64; 3], size: f64, axes: usize) -> Shape {
        let (low, high) = self.mesh.bounds();
        let largest = (0..axes).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        let mut mesh = self.mesh.clone();
        mesh.scale = size / largest;
        mesh.offset = std::array::from_fn(|axis| point[axis] - mesh.scale * 0.5 * (low[axis] + high[axis]));
        Shape::Mesh(mesh)
    }
}

/// Names the mesh files of bodies that were added as a scene in a folder may: by a path below it. Others are copied there; those that were.
///
/// # Errors
/// [`Error::Io`] if a file cannot be copied.
pub(in crate::viewer) fn bring_along(bodies: &mut [Body], folder: &Path) -> Result<Vec<PathBuf>> {
    let mut copied = Vec::new();
    for body in bodies {
        let Shape::Mesh(mesh) = &mut body.shape else { continue };
        let file = PathBuf::from(&mesh.path);
        if file.is_absolute() {
            let own = match below(folder, &file) {
                Some(own) => own,
                None => copy(folder, &file, &mut copied)?,
            };
            // with the same signs on every system
            mesh.path = own.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
        }
    }
    Ok(copied)
}

/// The path of a file from a folder on, if it lies below it.
fn below(folder: &Path, file: &Path) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (folder, file) = (folder.canonicalize().ok()?, file.canonicalize().ok()?);
    file.strip_prefix(folder).ok().map(Path::to_owned)
}

/// Copies a file into a folder, under a name that is free there or has the same bytes; its name.
fn copy(folder: &Path, file: &Path, copied: &mut Vec<PathBuf>) -> Result<PathBuf> {
    let bytes = std::fs::read(file).map_err(|source| Error::io(file, source))?;
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, end) = (part(file.file_stem()), part(file.extension()));
    for number in 1.. {
        let name = if number == 1 { format!("{stem}.{end}") } else { format!("{stem}_{number}.{end}") };
        let target = folder.join(&name);
        match std::fs::read(&target) {
            Ok(there) if there == bytes => return Ok(name.into()),
            Ok(_) => {}
            Err(_) if target.exists() => {}
            Err(_) => {
                std::fs::write(&target, &bytes).map_err(|source| Error::io(&target, source))?;
                copied.push(target);
                return Ok(name.into());
            }
        }
    }
    Ok(file.to_owned())
}

#[cfg(test)]
pub(in crate::viewer) mod tests {
    use super::*;

    /// A block of 4 x 2 x 1 m beside the origin.
    pub(in crate::viewer) const BLOCK: &str = "v 1 1 1\nv 5 1 1\nv 5 3 1\nv 1 3 1\nv 1 1 2\nv 5 1 2\nv 5 3 2\nv 1 3 2\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

    const SPACE: &str = "title = \"Space\"\ndomain = { dimension = 3, cells = [16, 8, 16], size = [2.0, 1.0, 2.0] }\n\
        gas.ambient = { density = 1.0, pressure = 1.0 }\ntime.until = 1.0\n";

    #[test]
    fn a_mesh_has_the_size_that_is_wished_for_around_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("block, large.obj");
        std::fs::write(&file, BLOCK).unwrap();
        let scene = Scene::parse(SPACE, "space.toml", &[]).unwrap();
        let block = MeshFile::read(&file, &scene, false).unwrap();
        assert_eq!((block.name.as_str(), block.triangles), ("block large", 12));
        let (low, high) = block.placed([0.5, 0.6, 0.7], 0.2, 3).bounds();
        for (axis, (middle, edge)) in [(0.5, 0.2), (0.6, 0.1), (0.7, 0.05)].into_iter().enumerate() {
            assert!((high[axis] - low[axis] - edge).abs() < 1e-12, "{low:?} {high:?}");
            assert!((0.5 * (high[axis] + low[axis]) - middle).abs() < 1e-12, "{low:?} {high:?}");
        }
        assert!((block.reach(0.2) - 0.1 * (1.0_f64 + 0.25 + 0.0625).sqrt()).abs() < 1e-12);
        let domain = &scene.domain;
        let edges = block.edges(block.size_in(domain), domain);
        let parts: Vec<f64> = (0..3).map(|axis| edges[axis] / domain.size[axis]).collect();
        assert!(parts.iter().all(|part| *part < SHARE + 1e-9) && parts.iter().any(|part| *part > SHARE - 1e-9));
    }

    #[test]
    fn files_from_elsewhere_are_copied_once_beside_the_scene() {
        let (home, away) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let scene = Scene::parse(SPACE, "space.toml", &[]).unwrap();
        std::fs::create_dir(home.path().join("parts")).unwrap();
        let files = [away.path().join("block.obj"), home.path().join("parts/own.obj"), away.path().join("block.obj")];
        files.iter().for_each(|file| std::fs::write(file, BLOCK).unwrap());
        std::fs::write(home.path().join("block.obj"), "another one").unwrap();
        let body = |file: &PathBuf| {
            let mesh = MeshFile::read(file, &scene, false).unwrap();
            Body::new("block", mesh.placed([0.5; 3], 0.2, 3), "steel")
        };
        let mut bodies: Vec<Body> = files.iter().map(body).collect();
        let copied = bring_along(&mut bodies, home.path()).unwrap();
        let path = |body: &Body| if let Shape::Mesh(mesh) = &body.shape { mesh.path.clone() } else { String::new() };
        assert_eq!(bodies.iter().map(path).collect::<Vec<_>>(), ["block_2.obj", "parts/own.obj", "block_2.obj"]);
        assert_eq!(copied, [home.path().join("block_2.obj")]);
        assert_eq!(std::fs::read_to_string(&copied[0]).unwrap(), BLOCK);
        std::fs::remove_file(&files[0]).unwrap();
        let mut lost = [body(&files[1])];
        if let Shape::Mesh(mesh) = &mut lost[0].shape {
            mesh.path = files[0].to_string_lossy().into_owned();
        }
        assert!(bring_along(&mut lost, home.path()).unwrap_err().to_string().contains("block.obj"));
    }
}
