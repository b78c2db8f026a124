//! Cameras of glTF 2.0: how they see, and where their node stands at a time, as the channels of animations move it and those above it.

use std::borrow::Cow;

use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::accessor::DataType;
use gltf::animation::{Channel, Interpolation, Property};
use gltf::camera::Projection;
use gltf::{Accessor, Gltf, Node};

use super::gltf::{DEEPEST, buffers, elements, valid};
use super::read::{Problem, damaged};
use super::{MAX_BYTES, MeshFolder};
use crate::scene::finding::Finding;
use crate::spelling::did_you_mean;

/// Key frames of a channel at most.
const MOST_KEYS: usize = 1_000_000;

/// A camera of a file.
#[derive(Debug)]
pub(crate) struct FileCamera {
    /// Vertical opening angle \[degrees\], or the height of what parallel rays see, in the file's lengths.
    pub(crate) sight: Sight,
    /// From the outermost node to the camera's own.
    chain: Vec<Place>,
    /// Times of its first and last key frame \[s\]; none of a camera that stands still.
    pub(crate) span: Option<[f64; 2]>,
}

/// How a camera sees.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sight {
    Pinhole { fov_degrees: f64 },
    Parallel { height: f64 },
}

/// A node's place, and what moves it.
#[derive(Debug)]
struct Place {
    matrix: DMat4,
    parts: [DVec4; 3],
    tracks: [Option<Track>; 3],
}

/// A channel of an animation.
#[derive(Debug)]
struct Track {
    times: Vec<f64>,
    /// One value a time, or three for cubic splines: tangent before it, value, tangent behind it. [glTF 2.0, appendix C]
    values: Vec<DVec4>,
    interpolation: Interpolation,
}

/// Reads a camera of a `.gltf` or `.glb`: that of the node of a name, or the only one. A finding is about `path` or `node`.
pub(crate) fn camera(path: &str, wanted: Option<&str>, place: MeshFolder<'_>) -> Result<FileCamera, Finding> {
    let of_path = |(message, help): Problem| Finding::new("path", message, help);
    let end = path.to_lowercase();
    if !end.ends_with(".glb") && !end.ends_with(".gltf") {
        let help = "give a file that ends in .gltf or .glb";
        return Err(Finding::new("path", format!("`{path}` has no cameras"), help));
    }
    let bytes = place.bytes(place.folder, path, MAX_BYTES).map_err(of_path)?;
    let again = |message: &str| {
        Finding::new("path", damaged(path, message).0, "write the file again, with cameras and animations")
    };
    let file = valid(&bytes).map_err(|message| again(&message))?;
    let buffers = buffers(&file, path, place).map_err(of_path)?;
    let node = chosen(&file, path, wanted)?;
    let camera = node.camera().ok_or_else(|| again("its camera is missing"))?;
    let sight = match camera.projection() {
        Projection::Perspective(lens) => Sight::Pinhole { fov_degrees: f64::from(lens.yfov()).to_degrees() },
        Projection::Orthographic(lens) => Sight::Parallel { height: 2.0 * f64::from(lens.ymag()) },
    };
    let chain = chain(&file, &node, &buffers).map_err(|message| again(&message))?;
    let times = chain.iter().flat_map(|place| place.tracks.iter().flatten()).flat_map(|track| track.times.iter());
    let span = times.fold(None, |span: Option<[f64; 2]>, &time| match span {
        None => Some([time, time]),
        Some([first, last]) => Some([time.min(first), time.max(last)]),
    });
    Ok(FileCamera { sight, chain, span })
}

/// The node of a camera.
fn chosen<'f>(file: &'f Gltf, path: &str, wanted: Option<&str>) -> Result<Node<'f>, Finding> {
    let nodes: Vec<Node<'f>> = file.document.nodes().filter(|node| node.camera().is_some()).collect();
    let names: Vec<&str> = nodes.iter().filter_map(Node::name).collect();
    let some = names.iter().take(20).copied().collect::<Vec<_>>().join(", ");
    let found = match wanted {
        Some(wanted) => nodes.iter().find(|node| node.name() == Some(wanted)),
        None if nodes.len() > 1 => {
            let help = format!("name one with `node`: {some}");
            return Err(Finding::new("path", format!("`{path}` has {} cameras", nodes.len()), help));
        }
        None => nodes.first(),
    };
    found.cloned().ok_or_else(|| match wanted {
        Some(wanted) if !nodes.is_empty() => {
            let like = did_you_mean(wanted, names.iter().copied());
            let message = format!("`{path}` has no camera at a node `{wanted}`{like}");
            Finding::new("node", message, format!("it has {some}"))
        }
        _ => Finding::new("path", format!("`{path}` has no camera"), "write the file again, with its cameras"),
    })
}

/// The nodes from the outermost one to that of the camera.
fn chain(file: &Gltf, node: &Node<'_>, buffers: &[Cow<'_, [u8]>]) -> Result<Vec<Place>, String> {
    let mut parents = vec![None; file.document.nodes().len()];
    for parent in file.document.nodes() {
        parent.children().for_each(|child| parents[child.index()] = Some(parent.index()));
    }
    let mut indices = vec![node.index()];
    while let Some(parent) = indices.last().and_then(|index| parents[*index]) {
        if indices.len() >= DEEPEST {
            return Err(format!("more than {DEEPEST} nodes below each other"));
        }
        indices.push(parent);
    }
    let placed = |index: &usize| {
        let node = file.document.nodes().nth(*index).ok_or("a node is missing")?;
        let single = |x: f32| f64::from(x);
        let (shift, turn, scale) = node.transform().decomposed();
        let [a, b, c] = shift.map(single);
        let [d, e, f] = scale.map(single);
        let mut tracks = [None, None, None];
        for channel in file.document.animations().flat_map(|animation| animation.channels()) {
            let kind = match channel.target().property() {
                Property::Translation => 0,
                Property::Rotation => 1,
                Property::Scale => 2,
                Property::MorphTargetWeights => continue,
            };
            if channel.target().node().index() == *index && tracks[kind].is_none() {
                tracks[kind] = Some(track(&channel, kind, buffers)?);
            }
        }
        let matrix = glam::Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        let parts = [DVec4::new(a, b, c, 0.0), DVec4::from(turn.map(single)), DVec4::new(d, e, f, 0.0)];
        Ok(Place { matrix, parts, tracks })
    };
    indices.iter().rev().map(placed).collect()
}

fn track(channel: &Channel<'_>, kind: usize, buffers: &[Cow<'_, [u8]>]) -> Result<Track, String> {
    let sampler = channel.sampler();
    let width = if kind == 1 { 4 } else { 3 };
    let times: Vec<f64> = numbers(&sampler.input(), 1, buffers)?.iter().map(|value| value.x).collect();
    let values = numbers(&sampler.output(), width, buffers)?;
    let interpolation = sampler.interpolation();
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if times.is_empty() || values.len() != each * times.len() {
        return Err(format!("an animation has {} values for {} times", values.len(), times.len()));
    }
    if !times.windows(2).all(|pair| pair[0] < pair[1]) || !values.iter().all(|value| value.is_finite()) {
        return Err("times of an animation do not rise, or a value is not finite".to_owned());
    }
    Ok(Track { times, values, interpolation })
}

/// The elements of an accessor as numbers; whole ones stand for -1 to 1. [glTF 2.0, 3.11]
fn numbers(accessor: &Accessor<'_>, width: usize, buffers: &[Cow<'_, [u8]>]) -> Result<Vec<DVec4>, String> {
    let kind = accessor.data_type();
    if accessor.dimensions().multiplicity() != width || accessor.count() > MOST_KEYS {
        return Err(format!("a channel of an animation has not {width} numbers a key, or more than {MOST_KEYS} keys"));
    }
    let number = |b: &[u8]| match kind {
        DataType::F32 => Some(f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
        DataType::I8 => Some((f64::from(b[0] as i8) / 127.0).max(-1.0)),
        DataType::U8 => Some(f64::from(b[0]) / 255.0),
        DataType::I16 => Some((f64::from(i16::from_le_bytes([b[0], b[1]])) / 32767.0).max(-1.0)),
        DataType::U16 => Some(f64::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0),
        DataType::U32 => None,
    };
    let vector = |bytes: &[u8]| {
        let mut parts = [0.0; 4];
        for (part, bytes) in parts.iter_mut().zip(bytes.chunks_exact(kind.size()).take(width)) {
            *part = number(bytes)?;
        }
        Some(DVec4::from(parts))
    };
    elements(accessor, buffers)?
        .into_iter()
        .map(vector)
        .collect::<Option<_>>()
        .ok_or_else(|| "a channel of an animation has no floats".to_owned())
}

impl Track {
    /// The value at a time; before the first key and behind the last it rests.
    fn at(&self, time: f64, is_turn: bool) -> DVec4 {
        let cubic = self.interpolation == Interpolation::CubicSpline;
        let value = |k: usize| if cubic { self.values[3 * k + 1] } else { self.values[k] };
        let next = self.times.partition_point(|key| *key <= time);
        if next == 0 || next == self.times.len() {
            return value(next.saturating_sub(1));
        }
        let (k, width) = (next - 1, self.times[next] - self.times[next - 1]);
        let s = (time - self.times[k]) / width;
        match self.interpolation {
            Interpolation::Step => value(k),
            Interpolation::Linear if is_turn => {
                let [from, to] = [value(k), value(next)].map(|q| DQuat::from_vec4(q).normalize());
                from.slerp(to, s).into()
            }
            Interpolation::Linear => value(k).lerp(value(next), s),
            Interpolation::CubicSpline => {
                let (square, cube) = (s * s, s * s * s);
                (2.0 * cube - 3.0 * square + 1.0) * value(k)
                    + width * (cube - 2.0 * square + s) * self.values[3 * k + 2]
                    + (3.0 * square - 2.0 * cube) * value(next)
                    + width * (cube - square) * self.values[3 * next]
            }
        }
    }
}

impl Place {
    fn at(&self, time: f64) -> DMat4 {
        if self.tracks.iter().all(Option::is_none) {
            return self.matrix;
        }
        let [shift, turn, scale] = std::array::from_fn(|kind| {
            self.tracks[kind].as_ref().map_or(self.parts[kind], |track| track.at(time, kind == 1))
        });
        let turn = DQuat::from_vec4(turn).normalize();
        DMat4::from_scale_rotation_translation(scale.truncate(), turn, shift.truncate())
    }
}

impl FileCamera {
    /// Place of the eye, direction of the view and direction that is up at a time \[s\] of the file, along the file's axes.
    /// A camera of glTF looks along its -z and has y up. [glTF 2.0, 3.10]
    pub(crate) fn at(&self, time: f64) -> [DVec3; 3] {
        let world = self.chain.iter().fold(DMat4::IDENTITY, |above, place| above * place.at(time));
        let direction = |own: DVec3| world.transform_vector3(own).normalize_or(own);
        [world.transform_point3(DVec3::ZERO), direction(DVec3::NEG_Z), direction(DVec3::Y)]
    }
}
