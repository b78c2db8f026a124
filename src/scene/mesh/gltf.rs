//! glTF 2.0: the triangles of the default scene, with the placements of its nodes. Buffers are read here, with every range checked.

use std::path::Path;

use glam::{DMat4, DVec3, Mat4};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Semantic};

use super::read::{Problem, damaged};
use super::{MeshFolder, Surface};

/// Nodes below nodes at most.
const DEEPEST: usize = 64;

/// Reads a `.gltf` or `.glb`.
pub(super) fn read(bytes: &[u8], path: &str, place: MeshFolder<'_>) -> Result<Surface, Problem> {
    let file = Gltf::from_slice(bytes).map_err(|error| damaged(path, &error.to_string()))?;
    let within = place.folder.join(path).parent().map_or_else(|| place.folder.to_owned(), Path::to_owned);
    let mut buffers = Vec::new();
    for buffer in file.document.buffers() {
        buffers.push(match buffer.source() {
            Source::Bin => file.blob.clone().ok_or_else(|| damaged(path, "its binary part is missing"))?,
            Source::Uri(uri) => match uri.split_once(";base64,") {
                Some((head, text)) if head.starts_with("data:") => {
                    base64(text).ok_or_else(|| damaged(path, "its buffer is no base64"))?
                }
                _ => place.bytes(&within, uri)?,
            },
        });
    }
    let mut surface = Surface::default();
    let scene = file.document.default_scene().or_else(|| file.document.scenes().next());
    for node in scene.iter().flat_map(gltf::Scene::nodes) {
        add(&node, DMat4::IDENTITY, &buffers, &mut surface, DEEPEST).map_err(|message| damaged(path, &message))?;
    }
    Ok(surface)
}

/// Adds the triangles of a node and of those below it.
fn add(node: &Node<'_>, parent: DMat4, buffers: &[Vec<u8>], to: &mut Surface, depth: usize) -> Result<(), String> {
    if depth == 0 {
        return Err(format!("more than {DEEPEST} nodes below each other"));
    }
    let own = parent * Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
    for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
        if primitive.mode() != Mode::Triangles {
            return Err("it has lines, points or strips; write triangles".to_owned());
        }
        let first = to.points.len() as u32;
        let positions = primitive.get(&Semantic::Positions).ok_or("a part has no positions")?;
        if (positions.data_type(), positions.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err("positions are not three floats".to_owned());
        }
        let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let points = elements(&positions, buffers)?;
        to.points.extend(points.iter().map(|b| {
            let point = DVec3::new(number(b), number(&b[4..]), number(&b[8..]));
            own.transform_point3(point).to_array()
        }));
        let indices: Vec<u32> = match primitive.indices() {
            None => (0..points.len() as u32).collect(),
            Some(accessor) => {
                elements(&accessor, buffers)?.into_iter().map(index).collect::<Option<_>>().ok_or("odd indices")?
            }
        };
        let flipped = own.determinant() < 0.0;
        to.triangles.extend(indices.chunks_exact(3).map(|t| {
            let [a, b, c] = [t[0], t[1], t[2]].map(|k| k.saturating_add(first));
            if flipped { [a, c, b] } else { [a, b, c] }
        }));
    }
    node.children().try_for_each(|child| add(&child, own, buffers, to, depth - 1))
}

fn index(bytes: &[u8]) -> Option<u32> {
    match *bytes {
        [a] => Some(u32::from(a)),
        [a, b] => Some(u32::from(u16::from_le_bytes([a, b]))),
        [a, b, c, d] => Some(u32::from_le_bytes([a, b, c, d])),
        _ => None,
    }
}

/// The bytes of each element of an accessor.
fn elements<'b>(accessor: &Accessor<'_>, buffers: &'b [Vec<u8>]) -> Result<Vec<&'b [u8]>, String> {
    let view = accessor.view().filter(|_| accessor.sparse().is_none()).ok_or("sparse data is not supported")?;
    let buffer = buffers.get(view.buffer().index()).ok_or("a buffer is missing")?;
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size);
    let element = |k: usize| {
        let start = k.checked_mul(stride)?.checked_add(accessor.offset())?;
        let end = start.checked_add(size).filter(|end| *end <= view.length())?;
        buffer.get(view.offset().checked_add(start)?..view.offset().checked_add(end)?)
    };
    if accessor.count() > buffer.len() {
        return Err("a buffer is too short".to_owned());
    }
    (0..accessor.count()).map(element).collect::<Option<_>>().ok_or_else(|| "a buffer is too short".to_owned())
}

/// Bytes of base64 text. [RFC 4648]
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut word, mut bits) = (0u32, 0);
    for letter in text.bytes().filter(|letter| *letter != b'=') {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        word = word << 6 | u32::from(value);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            bytes.push((word >> bits) as u8);
        }
    }
    Some(bytes)
}
