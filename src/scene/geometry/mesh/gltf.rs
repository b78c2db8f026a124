//! glTF 2.0: the triangles of the default scene, with the placements of its nodes. Buffers are read here, with every range checked.

use std::borrow::Cow;
use std::path::Path;

use glam::{DMat4, DVec3, Mat4};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::{Source, View};
use gltf::mesh::Mode;
use gltf::{Accessor, Document, Gltf, Node, Primitive, Semantic};

use super::read::{Problem, damaged};
use super::{MAX_BYTES, MAX_TRIANGLES, MeshFolder, Surface};
use crate::spelling::did_you_mean;

/// Nodes below nodes at most.
pub(super) const DEEPEST: usize = 64;
/// Nodes at most, each counted as often as others use it.
const MOST_NODES: usize = 100_000;
/// Buffers at most.
const MOST_BUFFERS: usize = 1000;

/// Reads a `.gltf` or `.glb`: all of it, or one node by its name.
pub(super) fn read(bytes: &[u8], path: &str, wanted: Option<&str>, place: MeshFolder<'_>) -> Result<Surface, Problem> {
    let file = valid(bytes).map_err(|message| damaged(path, &message))?;
    let buffers = buffers(&file, path, place)?;
    let scene = file.document.default_scene().or_else(|| file.document.scenes().next());
    let mut adding = Adding { buffers, wanted, names: Vec::new(), visits: 0, surface: Surface::default() };
    for node in scene.iter().flat_map(gltf::Scene::nodes) {
        adding.node(&node, DMat4::IDENTITY, DEEPEST, wanted.is_none()).map_err(|message| damaged(path, &message))?;
    }
    let Adding { names, surface, .. } = adding;
    match wanted.filter(|wanted| !names.iter().any(|name| name == wanted)) {
        None => Ok(surface),
        Some(wanted) => {
            let like = did_you_mean(wanted, names.iter().map(String::as_str));
            let some = names.iter().take(20).cloned().collect::<Vec<_>>().join(", ");
            Err((format!("`{path}` has no node `{wanted}`{like}"), format!("it has {some}")))
        }
    }
}

/// The file as the standard wants it. The check of `gltf` reads the accessors of positions before it knows that they are there.
pub(super) fn valid(bytes: &[u8]) -> Result<Gltf, String> {
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(|error| error.to_string())?;
    let root = document.into_json();
    let parts = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if let Some(accessor) = parts.flat_map(|part| part.attributes.values()).find(|a| a.value() >= root.accessors.len())
    {
        return Err(format!("a part uses accessor {accessor} of {}", root.accessors.len()));
    }
    let document = Document::from_json(root).map_err(|error| error.to_string())?;
    Ok(Gltf { document, blob })
}

/// The bytes of all buffers; those of other files count, too, and all together are limited.
pub(super) fn buffers<'b>(file: &'b Gltf, path: &str, place: MeshFolder<'_>) -> Result<Vec<Cow<'b, [u8]>>, Problem> {
    let within = place.folder.join(path).parent().map_or_else(|| place.folder.to_owned(), Path::to_owned);
    let count = file.document.buffers().len();
    if count > MOST_BUFFERS {
        return Err(damaged(path, &format!("{count} buffers; at most {MOST_BUFFERS} are read")));
    }
    let promised = file.document.buffers().fold(0u64, |sum, buffer| sum.saturating_add(buffer.length() as u64));
    let mut left = MAX_BYTES;
    if promised > left {
        return Err(damaged(path, &format!("its buffers have {promised} bytes, at most {MAX_BYTES} are read")));
    }
    let mut buffers = Vec::new();
    for buffer in file.document.buffers() {
        let bytes: Cow<'b, [u8]> = match buffer.source() {
            Source::Bin => {
                Cow::Borrowed(file.blob.as_deref().ok_or_else(|| damaged(path, "its binary part is missing"))?)
            }
            Source::Uri(uri) => match uri.split_once(";base64,") {
                Some((head, text)) if head.starts_with("data:") => {
                    Cow::Owned(base64(text).ok_or_else(|| damaged(path, "its buffer is no base64"))?)
                }
                _ => Cow::Owned(place.bytes(&within, uri, left)?),
            },
        };
        if let Cow::Owned(own) = &bytes {
            left = left.saturating_sub(own.len() as u64);
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Triangles on their way from nodes to the surface.
struct Adding<'b> {
    buffers: Vec<Cow<'b, [u8]>>,
    /// The node that is wanted alone.
    wanted: Option<&'b str>,
    names: Vec<String>,
    visits: usize,
    surface: Surface,
}

impl Adding<'_> {
    /// Adds the triangles of a node and of those below it, if it is wanted or lies below one that is.
    fn node(&mut self, node: &Node<'_>, parent: DMat4, depth: usize, wanted: bool) -> Result<(), String> {
        if depth == 0 {
            return Err(format!("more than {DEEPEST} nodes below each other"));
        }
        self.visits += 1;
        if self.visits > MOST_NODES {
            return Err(format!("more than {MOST_NODES} nodes, each counted as often as others use it"));
        }
        let own = parent * Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        let wanted = wanted || node.name().is_some_and(|name| self.wanted == Some(name));
        self.names.extend(node.name().map(str::to_owned));
        if wanted {
            node.mesh().iter().flat_map(gltf::Mesh::primitives).try_for_each(|part| self.primitive(&part, own))?;
        }
        node.children().try_for_each(|child| self.node(&child, own, depth - 1, wanted))
    }

    fn primitive(&mut self, primitive: &Primitive<'_>, own: DMat4) -> Result<(), String> {
        let mode = primitive.mode();
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            return Ok(());
        }
        let to = &mut self.surface;
        let first = to.points.len() as u32;
        let positions = primitive.get(&Semantic::Positions).ok_or("a part has no positions")?;
        if (positions.data_type(), positions.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err("positions are not three floats".to_owned());
        }
        let count = primitive.indices().map_or(positions.count(), |indices| indices.count());
        let triangles = if mode == Mode::Triangles { count / 3 } else { count };
        if to.points.len().saturating_add(positions.count()) > 3 * MAX_TRIANGLES
            || to.triangles.len().saturating_add(triangles) > MAX_TRIANGLES
        {
            return Err(format!("more than {MAX_TRIANGLES} triangles, each counted as often as nodes use it"));
        }
        let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let points = elements(&positions, &self.buffers)?;
        to.points.extend(points.iter().map(|b| {
            let point = DVec3::new(number(b), number(&b[4..]), number(&b[8..]));
            own.transform_point3(point).to_array()
        }));
        let indices: Vec<u32> = match primitive.indices() {
            None => (0..points.len() as u32).collect(),
            Some(accessor) => elements(&accessor, &self.buffers)?
                .into_iter()
                .map(index)
                .collect::<Option<_>>()
                .ok_or("odd indices")?,
        };
        let flipped = own.determinant() < 0.0;
        to.triangles.extend(triples(&indices, mode).map(|t| {
            let [a, b, c] = t.map(|k| k.saturating_add(first));
            if flipped { [a, c, b] } else { [a, b, c] }
        }));
        Ok(())
    }
}

/// The triangles of a list, a strip, whose every second one runs the other way, or a fan. [glTF 2.0, 3.7.2.1]
fn triples(indices: &[u32], mode: Mode) -> impl Iterator<Item = [u32; 3]> + '_ {
    let (step, corners) = (if mode == Mode::Triangles { 3 } else { 1 }, move |k: usize| match mode {
        Mode::TriangleFan => [indices[0], indices[k + 1], indices[k + 2]],
        Mode::TriangleStrip if k % 2 == 1 => [indices[k + 1], indices[k], indices[k + 2]],
        _ => [indices[k], indices[k + 1], indices[k + 2]],
    });
    (0..indices.len().saturating_sub(2)).step_by(step).map(corners)
}

fn index(bytes: &[u8]) -> Option<u32> {
    match *bytes {
        [a] => Some(u32::from(a)),
        [a, b] => Some(u32::from(u16::from_le_bytes([a, b]))),
        [a, b, c, d] => Some(u32::from_le_bytes([a, b, c, d])),
        _ => None,
    }
}

/// An element of an accessor without data.
const NOTHING: [u8; 64] = [0; 64];

/// The bytes of each element of an accessor; those of its sparse part replace others.
pub(super) fn elements<'b>(accessor: &Accessor<'_>, buffers: &'b [Cow<'_, [u8]>]) -> Result<Vec<&'b [u8]>, String> {
    let (size, count) = (accessor.size(), accessor.count());
    let mut all = match accessor.view() {
        Some(view) => in_view(&view, buffers, accessor.offset(), (size, count))?,
        None if accessor.sparse().is_some() && count <= 3 * MAX_TRIANGLES => vec![&NOTHING[..size]; count],
        None => return Err("an accessor has no data".to_owned()),
    };
    if let Some(sparse) = accessor.sparse() {
        let (places, values) = (sparse.indices(), sparse.values());
        let width = places.index_type().size();
        let at = in_view(&places.view(), buffers, places.offset(), (width, sparse.count()))?;
        let new = in_view(&values.view(), buffers, values.offset(), (size, sparse.count()))?;
        for (place, value) in at.into_iter().map(index).zip(new) {
            let own = place.and_then(|place| all.get_mut(place as usize));
            *own.ok_or("sparse data lies outside of its accessor")? = value;
        }
    }
    Ok(all)
}

/// The bytes of so many elements of a size, from an offset in a part of a buffer on.
fn in_view<'b>(
    view: &View<'_>,
    buffers: &'b [Cow<'_, [u8]>],
    offset: usize,
    (size, count): (usize, usize),
) -> Result<Vec<&'b [u8]>, String> {
    let buffer = buffers.get(view.buffer().index()).ok_or("a buffer is missing")?;
    let stride = view.stride().unwrap_or(size);
    let element = |k: usize| {
        let start = k.checked_mul(stride)?.checked_add(offset)?;
        let end = start.checked_add(size).filter(|end| *end <= view.length())?;
        buffer.get(view.offset().checked_add(start)?..view.offset().checked_add(end)?)
    };
    if count > buffer.len() {
        return Err("a buffer is too short".to_owned());
    }
    (0..count).map(element).collect::<Option<_>>().ok_or_else(|| "a buffer is too short".to_owned())
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
