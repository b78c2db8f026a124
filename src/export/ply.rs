//! Surfaces as PLY: corners with numbers of their own, triangles with the number of their piece. [Turk 1994; crate `ply-rs-bw`]

use std::path::Path;

use ply_rs_bw::ply::{
    ElementDef, Encoding, Ply, Property, PropertyAccess, PropertyAccessResult, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;

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

/// A corner or a triangle.
enum Element {
    Corner { numbers: [f32; 3 + CORNER.len()], piece: u32, body: u32 },
    Triangle { corners: [u32; 3], piece: u32 },
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Element::Triangle { corners: [0; 3], piece: 0 }
    }

    fn set_property(&mut self, _: &str, _: Property) -> PropertyAccessResult {
        PropertyAccessResult::Ignored
    }

    fn get_float(&self, name: &str) -> Option<f32> {
        let Element::Corner { numbers, .. } = self else { return None };
        names().position(|own| own == name).map(|place| numbers[place])
    }

    fn get_uint(&self, name: &str) -> Option<u32> {
        match (self, name) {
            (Element::Corner { piece, .. } | Element::Triangle { piece, .. }, "piece") => Some(*piece),
            (Element::Corner { body, .. }, "body") => Some(*body),
            _ => None,
        }
    }

    fn get_list_uint(&self, _: &str) -> Option<&[u32]> {
        match self {
            Element::Triangle { corners, .. } => Some(corners),
            Element::Corner { .. } => None,
        }
    }
}

fn names() -> impl Iterator<Item = &'static str> {
    ["x", "y", "z"].into_iter().chain(CORNER)
}

/// Writes parts one after another.
///
/// # Errors
/// [`crate::Error::Io`].
pub(super) fn write(path: &Path, comments: &[String], parts: &[Part]) -> Result<()> {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for Part { surface, corners: numbers, piece, body } in parts {
        let first = corners.len() as u32;
        corners.extend(surface.points.iter().enumerate().map(|(k, [x, y, z])| {
            let [u, v, w, strain, damage] = numbers.get(k).copied().unwrap_or_default();
            Element::Corner { numbers: [*x, *y, *z, u, v, w, strain, damage], piece: *piece, body: *body }
        }));
        let three = |three: &[u32; 3]| Element::Triangle { corners: three.map(|k| first + k), piece: *piece };
        triangles.extend(surface.triangles.iter().map(three));
    }
    let mut ply = Ply::<Element>::new();
    ply.header.encoding = Encoding::BinaryLittleEndian;
    ply.header.comments = comments.to_vec();
    let whole = |name: &str| PropertyDef::new(name.to_owned(), PropertyType::Scalar(ScalarType::UInt));
    let real = |name: &str| PropertyDef::new(name.to_owned(), PropertyType::Scalar(ScalarType::Float));
    let list = PropertyType::List(ScalarType::UChar, ScalarType::UInt);
    let of_corners: Vec<PropertyDef> = names().map(real).chain([whole("piece"), whole("body")]).collect();
    let of_triangles = vec![PropertyDef::new("vertex_indices".to_owned(), list), whole("piece")];
    for (name, properties, elements) in [("vertex", of_corners, corners), ("face", of_triangles, triangles)] {
        let mut definition = ElementDef::new(name.to_owned());
        definition.count = elements.len();
        definition.properties = properties.into_iter().map(|property| (property.name.clone(), property)).collect();
        ply.header.elements.insert(name.to_owned(), definition);
        ply.payload.insert(name.to_owned(), elements);
    }
    atomic::write(path, |mut out| Writer::new().write_ply_unchecked(&mut out, &ply).map(|_| ()))
}
