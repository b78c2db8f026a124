//! Mesh files: Wavefront OBJ, STL, PLY; glTF has a file of its own.

use std::io::Cursor;
use std::path::Path;

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

use super::{MeshFolder, Surface, gltf};

/// What is wrong, and what to do.
pub(super) type Problem = (String, String);

/// Reads a file by its extension.
pub(super) fn surface(path: &str, place: MeshFolder<'_>) -> Result<Surface, Problem> {
    let end = Path::new(path).extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
    let read = match end.as_str() {
        "obj" => obj,
        "stl" => stl,
        "ply" => ply,
        "gltf" | "glb" => return gltf::read(&place.bytes(place.folder, path)?, path, place),
        _ => {
            let help = "give a file that ends in .obj, .stl, .ply, .gltf or .glb";
            return Err((format!("`{path}` is no mesh file"), help.to_owned()));
        }
    };
    read(&place.bytes(place.folder, path)?).map_err(|message| damaged(path, &message))
}

/// A file that does not hold what its name says.
pub(super) fn damaged(path: &str, message: &str) -> Problem {
    (format!("`{path}` cannot be read: {message}"), "write the mesh again, as triangles".to_owned())
}

fn obj(bytes: &[u8]) -> Result<Surface, String> {
    let options = tobj::LoadOptions { triangulate: true, single_index: false, ..tobj::LoadOptions::default() };
    // materials lie in other files, which nobody asked for
    let refuse = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) =
        tobj::load_obj_buf(&mut Cursor::new(bytes), &options, refuse).map_err(|error| error.to_string())?;
    let mut surface = Surface::default();
    for model in models {
        let first = surface.points.len() as u32;
        let points = model.mesh.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]].map(f64::from));
        surface.points.extend(points);
        let triangles = model.mesh.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|k| k.saturating_add(first)));
        surface.triangles.extend(triangles);
    }
    Ok(surface)
}

fn stl(bytes: &[u8]) -> Result<Surface, String> {
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let point = |vertex: &stl_io::Vertex| [vertex[0], vertex[1], vertex[2]].map(f64::from);
    let triangles = mesh.faces.iter().map(|face| face.vertices.map(|k| u32::try_from(k).unwrap_or(u32::MAX)));
    Ok(Surface { points: mesh.vertices.iter().map(point).collect(), triangles: triangles.collect() })
}

fn ply(bytes: &[u8]) -> Result<Surface, String> {
    let parsed =
        Parser::<DefaultElement>::new().read_ply(&mut Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let list = |name: &str| parsed.payload.get(name).ok_or_else(|| format!("it has no element `{name}`"));
    let mut surface = Surface::default();
    for vertex in list("vertex")? {
        let entry = |name: &str| vertex.get(name).and_then(number).ok_or_else(|| format!("a vertex has no `{name}`"));
        surface.points.push([entry("x")?, entry("y")?, entry("z")?]);
    }
    for face in list("face")? {
        let corners = face.get("vertex_indices").or_else(|| face.get("vertex_index")).and_then(indices);
        let corners = corners.ok_or("a face has no `vertex_indices`")?;
        surface.triangles.extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
    }
    Ok(surface)
}

fn number(property: &Property) -> Option<f64> {
    match property {
        Property::Float(x) => Some(f64::from(*x)),
        Property::Double(x) => Some(*x),
        Property::Char(x) => Some(f64::from(*x)),
        Property::UChar(x) => Some(f64::from(*x)),
        Property::Short(x) => Some(f64::from(*x)),
        Property::UShort(x) => Some(f64::from(*x)),
        Property::Int(x) => Some(f64::from(*x)),
        Property::UInt(x) => Some(f64::from(*x)),
        _ => None,
    }
}

/// Indices of a face; negative ones become an index that no mesh has.
fn indices(property: &Property) -> Option<Vec<u32>> {
    fn all<T: Copy + TryInto<u32>>(list: &[T]) -> Vec<u32> {
        list.iter().map(|k| (*k).try_into().unwrap_or(u32::MAX)).collect()
    }
    match property {
        Property::ListChar(list) => Some(all(list)),
        Property::ListUChar(list) => Some(all(list)),
        Property::ListShort(list) => Some(all(list)),
        Property::ListUShort(list) => Some(all(list)),
        Property::ListInt(list) => Some(all(list)),
        Property::ListUInt(list) => Some(all(list)),
        _ => None,
    }
}
