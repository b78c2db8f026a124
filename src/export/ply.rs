//! Surfaces as PLY: corners with numbers of their own, the piece and the body among them. Triangles are corners alone, which all readers
//! know. [Turk 1994; crate `ply-rs-bw`]

use std::path::Path;

use ply_rs_bw::ply::{DefaultElement, ElementDef, Encoding, Header, PropertyDef, PropertyType, ScalarType};
use ply_rs_bw::writer::Writer;
use rayon::prelude::*;

use super::surface::Surface;
use crate::Result;
use crate::export::atomic;

/// Numbers of each corner beside its place.
pub(super) const CORNER: [&str; 5] = ["vx", "vy", "vz", "plastic_strain", "damage"];

/// A part of a file: its surface, the numbers of each corner in the order of [`CORNER`], its piece and its body.
#[derive(Debug, Default)]
pub(super) struct Part {
    pub(super) surface: Surface,
    pub(super) corners: Vec<[f32; CORNER.len()]>,
    pub(super) piece: u32,
    pub(super) body: u32,
}

/// Bytes of what a corner has beside its place, and of a triangle.
const BESIDE_BYTES: usize = 4 * (CORNER.len() + 2);
const TRIANGLE_BYTES: usize = 1 + 4 * 3;

impl Part {
    /// The corners as bytes, in the order of the head: their places by `place_bytes` from those of the surface.
    fn corner_bytes<const N: usize>(&self, place_bytes: impl Fn([f32; 3]) -> [u8; N] + Sync) -> Vec<u8> {
        let size = N + BESIDE_BYTES;
        let mut bytes = vec![0; size * self.surface.points.len()];
        let own = [self.piece.to_le_bytes(), self.body.to_le_bytes()];
        bytes.par_chunks_exact_mut(size).zip(&self.surface.points).enumerate().for_each(|(k, (into, place))| {
            let (front, beside) = into.split_at_mut(N);
            front.copy_from_slice(&place_bytes(*place));
            let numbers = self.corners.get(k).copied().unwrap_or_default();
            let words = numbers.iter().map(|number| number.to_le_bytes()).chain(own);
            beside.chunks_exact_mut(4).zip(words).for_each(|(into, word)| into.copy_from_slice(&word));
        });
        bytes
    }

    /// The triangles as bytes; the corners before those of the part are so many.
    fn triangle_bytes(&self, first: u32) -> Vec<u8> {
        let mut bytes = vec![0; TRIANGLE_BYTES * self.surface.triangles.len()];
        bytes.par_chunks_exact_mut(TRIANGLE_BYTES).zip(&self.surface.triangles).for_each(|(into, three)| {
            into[0] = 3;
            let words = three.map(|corner| (first + corner).to_le_bytes());
            into[1..].copy_from_slice(words.as_flattened());
        });
        bytes
    }
}

/// Writes parts one after another, whose coordinates have their zero at `frame`: as doubles where that is not the zero of the scene.
///
/// # Errors
/// [`crate::Error::Io`].
pub(super) fn write(path: &Path, comments: &[String], frame: [f64; 3], parts: &[Part]) -> Result<()> {
    let far = frame != [0.0; 3];
    let count = |of: fn(&Part) -> usize| parts.iter().map(of).sum::<usize>();
    let (corners, triangles) = (count(|part| part.surface.points.len()), count(|part| part.surface.triangles.len()));
    let mut header = Header::new();
    header.encoding = Encoding::BinaryLittleEndian;
    header.comments = comments.to_vec();
    let whole = |name: &str| PropertyDef::new(name.to_owned(), PropertyType::Scalar(ScalarType::UInt));
    let real = |name: &str| PropertyDef::new(name.to_owned(), PropertyType::Scalar(ScalarType::Float));
    let list = PropertyType::List(ScalarType::UChar, ScalarType::UInt);
    let scalar = if far { ScalarType::Double } else { ScalarType::Float };
    let places = ["x", "y", "z"].map(|name| PropertyDef::new(name.to_owned(), PropertyType::Scalar(scalar.clone())));
    let of_corners: Vec<PropertyDef> =
        places.into_iter().chain(CORNER.map(real)).chain([whole("piece"), whole("body")]).collect();
    let of_triangles = vec![PropertyDef::new("vertex_indices".to_owned(), list)];
    for (name, properties, count) in [("vertex", of_corners, corners), ("face", of_triangles, triangles)] {
        let mut definition = ElementDef::new(name.to_owned());
        definition.count = count;
        definition.properties = properties.into_iter().map(|property| (property.name.clone(), property)).collect();
        header.elements.insert(name.to_owned(), definition);
    }
    atomic::write(path, |mut out| {
        Writer::<DefaultElement>::new().write_header(&mut out, &header)?;
        let single = |place: [f32; 3]| -> [u8; 12] { bytemuck::cast(place.map(f32::to_le_bytes)) };
        let double = |place: [f32; 3]| -> [u8; 24] {
            let sum: [f64; 3] = std::array::from_fn(|axis| frame[axis] + f64::from(place[axis]));
            bytemuck::cast(sum.map(f64::to_le_bytes))
        };
        parts.iter().try_for_each(|part| match far {
            true => out.write_all(&part.corner_bytes(double)),
            false => out.write_all(&part.corner_bytes(single)),
        })?;
        let mut first = 0;
        parts.iter().try_for_each(|part| {
            let bytes = part.triangle_bytes(first);
            first += part.surface.points.len() as u32;
            out.write_all(&bytes)
        })
    })
}
