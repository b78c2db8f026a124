//! Mesh files: Wavefront OBJ and PLY; STL and glTF have files of their own.
//!
//! OBJ and STL are read here and in `stl`, since of the 47 such files in `tests/meshes` the crates tobj 4.0 and stl_io 0.11 read nine
//! wrongly or not at all: several solids, capitals, normals that are no numbers, lines that go on, comments behind corners.

use std::io::Cursor;
use std::path::Path;

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

use super::{MAX_BYTES, MAX_TRIANGLES, MeshFolder, Surface, Up, gltf, stl};

/// What is wrong, and what to do.
pub(super) type Problem = (String, String);

/// Reads a file by its extension; the second is the direction that its format calls up, if it does.
pub(super) fn surface(path: &str, node: Option<&str>, place: MeshFolder<'_>) -> Result<(Surface, Option<Up>), Problem> {
    let end = Path::new(path).extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
    let read = match end.as_str() {
        "obj" => obj,
        "stl" => stl::read,
        "ply" => ply,
        "gltf" | "glb" => {
            let surface = gltf::read(&place.bytes(place.folder, path, MAX_BYTES)?, path, node, place)?;
            return Ok((surface, Some(Up::Y)));
        }
        _ => {
            let help = "give a file that ends in .obj, .stl, .ply, .gltf or .glb";
            return Err((format!("`{path}` is no mesh file"), help.to_owned()));
        }
    };
    if node.is_some() {
        let help = "leave `node` out, or write the mesh as .glb";
        return Err((format!("`{path}` has no named nodes"), help.to_owned()));
    }
    let surface = read(&place.bytes(place.folder, path, MAX_BYTES)?).map_err(|message| damaged(path, &message))?;
    Ok((surface, None))
}

/// A file that does not hold what its name says.
pub(super) fn damaged(path: &str, message: &str) -> Problem {
    (format!("`{path}` cannot be read: {message}"), "write the mesh again, as triangles".to_owned())
}

/// Only corners and faces count; materials lie in other files, which nobody asked for.
fn obj(bytes: &[u8]) -> Result<Surface, String> {
    let text = String::from_utf8_lossy(bytes).replace("\\\r\n", " ").replace("\\\n", " ");
    let mut surface = Surface::default();
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => surface.points.push(three_numbers(&mut words).ok_or_else(|| unreadable(line))?),
            Some("f") => {
                let count = surface.points.len();
                let corners = words.map(|word| obj_corner(word, count)).collect::<Option<Vec<u32>>>();
                surface.add_polygon(&corners.ok_or_else(|| unreadable(line))?)?;
            }
            _ => {}
        }
    }
    Ok(surface)
}

/// The first number of `5/2/7`, from 1; -1 is the last corner so far.
fn obj_corner(word: &str, count: usize) -> Option<u32> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = if number < 0 { i64::try_from(count).ok()?.checked_add(number)? } else { number.checked_sub(1)? };
    u32::try_from(index).ok()
}

/// The next three words as numbers.
pub(super) fn three_numbers<'w>(words: &mut impl Iterator<Item = &'w str>) -> Option<[f64; 3]> {
    let mut next = || words.next()?.parse().ok();
    Some([next()?, next()?, next()?])
}

/// A line that says something else than its first word.
pub(super) fn unreadable(line: &str) -> String {
    format!("`{}` makes no sense", line.trim().chars().take(60).collect::<String>())
}

fn ply(bytes: &[u8]) -> Result<Surface, String> {
    ply_counts(bytes)?;
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
        surface.add_polygon(&corners.ok_or("a face has no `vertex_indices`")?)?;
    }
    Ok(surface)
}

/// Elements that the head promises: each must have properties, and room in the file.
fn ply_counts(bytes: &[u8]) -> Result<(), String> {
    let mut promised: Vec<(String, u64, u64)> = Vec::new();
    for line in bytes.split(|byte| *byte == b'\n').take(1000) {
        let line = String::from_utf8_lossy(line);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            ["element", name, count] => {
                promised.push((name.to_owned(), count.parse().map_err(|_| unreadable(&line))?, 0));
            }
            ["property", ..] => promised.iter_mut().next_back().into_iter().for_each(|element| element.2 += 1),
            ["end_header"] => break,
            _ => {}
        }
    }
    for (name, count, properties) in promised {
        if properties == 0 && count > 0 {
            return Err(format!("its head promises {count} elements `{name}` without properties"));
        }
        if count.saturating_mul(properties) > bytes.len() as u64 {
            return Err(format!("its head promises {count} elements `{name}`, more than the file has room for"));
        }
        if count > MAX_TRIANGLES as u64 {
            return Err(format!("{count} elements `{name}`; give at most {MAX_TRIANGLES}, simplify the mesh"));
        }
    }
    Ok(())
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
