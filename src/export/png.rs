//! frames/NNNN.png: the pictures, with where they come from as text chunks.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use ::png::{BitDepth, ColorType, Compression, Encoder, EncodingError, SrgbRenderingIntent};

use crate::Result;
use crate::export::{Exporter, Moment, atomic};
use crate::render::Frame;

/// Writes the first picture of a frame to `frames/NNNN.png` and further ones to `frames/<field>/NNNN.png`.
#[derive(Debug)]
pub struct PngExporter {
    folder: PathBuf,
}

impl PngExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.join("frames") }
    }
}

impl Exporter for PngExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        for (order, picture) in moment.pictures.iter().enumerate() {
            let folder =
                if order == 0 { Cow::Borrowed(&self.folder) } else { Cow::Owned(self.folder.join(&picture.name)) };
            let text = [
                ("Title", moment.title.to_owned()),
                ("Software", concat!("brisance ", env!("CARGO_PKG_VERSION")).to_owned()),
                ("Time", format!("{:?}", moment.time)),
                ("Step", moment.step.to_string()),
                ("Field", picture.name.clone()),
                ("Range", format!("{:?} {:?}", picture.range[0], picture.range[1])),
            ];
            write(&folder.join(format!("{:04}.png", moment.index)), &picture.frame, &text)?;
        }
        Ok(())
    }
}

/// Writes one picture with text chunks; what latin-1 cannot hold goes into international chunks.
pub fn write(path: &Path, frame: &Frame, text: &[(&str, String)]) -> Result<()> {
    atomic::write(path, |out| encode(out, frame, text).map_err(io::Error::other))
}

fn encode(out: &mut dyn Write, frame: &Frame, text: &[(&str, String)]) -> std::result::Result<(), EncodingError> {
    let mut encoder = Encoder::new(out, frame.width, frame.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Fast);
    for (keyword, content) in text {
        let (keyword, content) = ((*keyword).to_owned(), content.clone());
        if content.chars().all(|letter| u32::from(letter) < 256) {
            encoder.add_text_chunk(keyword, content)?;
        } else {
            encoder.add_itxt_chunk(keyword, content)?;
        }
    }
    let mut writer = encoder.write_header()?;
    // Every pixel is opaque: three bytes say it all.
    let rgb: Vec<u8> = frame.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    writer.write_image_data(&rgb)?;
    writer.finish()
}
