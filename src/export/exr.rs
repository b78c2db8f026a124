//! frames/NNNN.exr for compositors: linear light before the tone map with alpha, without letters or frame; depth, objects, velocities; the
//! camera in the header, and where the picture comes from in the comments.

use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Text, WritableImage,
};
use half::f16;

use crate::Result;
use crate::export::{Exporter, Moment, Needs, atomic};
use crate::render::{Depth, LayerPixel, Layers, Picture};

/// Writes the pictures of a frame beside those of [`super::png::PngExporter`].
#[derive(Debug)]
pub struct ExrExporter {
    folder: PathBuf,
}

impl ExrExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.join("frames") }
    }
}

impl Exporter for ExrExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        for (place, picture) in moment.places() {
            let path = self.folder.join(place).with_extension("exr");
            let bytes = encoded(picture, &moment.provenance(picture));
            atomic::write(&path, |out| out.write_all(&bytes?))?;
        }
        Ok(())
    }

    fn needs(&self) -> Needs {
        Needs { depth: Depth { layers: true, fine: false }, ..Needs::default() }
    }
}

/// A file with the primaries of sRGB, which are those of EXR where nothing else is said. Light and velocities are halves; depths and
/// objects have 32 bits. One line of the comments per entry of the text: attributes of their own would come in an order that changes
/// from run to run.
fn encoded(picture: &Picture, text: &[(&str, String)]) -> io::Result<Vec<u8>> {
    let comments: Vec<String> = text.iter().map(|(keyword, content)| format!("{keyword}: {content}")).collect();
    let software = concat!("brisance ", env!("CARGO_PKG_VERSION"));
    let Layers { width, height, camera, .. } = &picture.layers;
    let attributes = LayerAttributes {
        software_name: Some(Text::from(software)),
        // Whatever the title holds, in UTF-8.
        comments: Some(Text::from_bytes_unchecked(comments.join("\n").bytes().collect())),
        // EXR lets rows of vectors multiply from the left: columns, one after the other, are its rows
        world_to_camera: camera.map(|[to_camera, _]| to_camera),
        world_to_normalized_device: camera.map(|[_, to_picture]| to_picture),
        ..LayerAttributes::default()
    };
    let size = (*width as usize, *height as usize);
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels(&picture.layers.pixels));
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).map_err(io::Error::other)?;
    Ok(bytes.into_inner())
}

fn channels(pixels: &[LayerPixel]) -> AnyChannels<FlatSamples> {
    let halves = |value: &dyn Fn(&LayerPixel) -> f32| {
        // what is brighter than a half can be would be infinite, and spread in every filter
        let most = f16::MAX.to_f32();
        let half = |pixel: &LayerPixel| f16::from_f32(value(pixel).clamp(-most, most));
        FlatSamples::F16(pixels.iter().map(half).collect())
    };
    let mut list = vec![
        AnyChannel::new("Z", FlatSamples::F32(pixels.iter().map(|pixel| pixel.depth).collect())),
        AnyChannel::new("id", FlatSamples::U32(pixels.iter().map(|pixel| pixel.object).collect())),
    ];
    for (k, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        list.push(AnyChannel::new(name, halves(&|pixel| pixel.light[k])));
    }
    for (k, name) in ["velocity.X", "velocity.Y", "velocity.Z"].into_iter().enumerate() {
        list.push(AnyChannel::new(name, halves(&|pixel| pixel.velocity[k])));
    }
    AnyChannels::sort(list.into_iter().collect())
}
