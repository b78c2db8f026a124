//! frames/NNNN.exr: the linear light of the pictures before the tone map, with where they come from in the comments.

use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use ::exr::prelude::{Encoding, Image, Layer, LayerAttributes, SpecificChannels, Text, Vec2, WritableImage};

use crate::Result;
use crate::export::{Exporter, Moment, Needs, atomic};
use crate::render::{Depth, Picture};

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
        Needs { depth: Depth { linear: true, fine: false }, ..Needs::default() }
    }
}

/// A file of 32-bit floating point numbers with the primaries of sRGB, which are those of EXR where nothing else is said. One line of
/// the comments per entry of the text: attributes of their own would come in an order that changes from run to run.
fn encoded(picture: &Picture, text: &[(&str, String)]) -> io::Result<Vec<u8>> {
    let comments: Vec<String> = text.iter().map(|(keyword, content)| format!("{keyword}: {content}")).collect();
    let software = concat!("brisance ", env!("CARGO_PKG_VERSION"));
    let attributes = LayerAttributes {
        software_name: Some(Text::from(software)),
        // Whatever the title holds, in UTF-8.
        comments: Some(Text::from_bytes_unchecked(comments.join("\n").bytes().collect())),
        ..LayerAttributes::default()
    };
    let size = [picture.frame.width as usize, picture.frame.height as usize];
    let pixel = |place: Vec2<usize>| {
        let [red, green, blue] = picture.linear[place.x() + size[0] * place.y()];
        (red, green, blue)
    };
    let channels = SpecificChannels::rgb(pixel);
    let layer = Layer::new((size[0], size[1]), attributes, Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).map_err(io::Error::other)?;
    Ok(bytes.into_inner())
}
