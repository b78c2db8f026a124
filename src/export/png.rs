//! frames/NNNN.png: the pictures, with where they come from as text chunks.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use ::png::{
    BitDepth, ColorType, Compression, Decoder, Encoder, EncodingError, PixelDimensions, SrgbRenderingIntent, Unit,
};

use crate::export::{Exporter, Moment, Needs, atomic};
use crate::render::{Depth, Frame, Picture};
use crate::{Error, Result};

/// An inch \[m\].
const METRES_PER_INCH: f64 = 0.0254;

/// Writes the pictures of a frame to `frames/NNNN.png`, `frames/FIELD/NNNN.png` and `frames/VIEW/...`, see [`Moment::places`].
#[derive(Debug)]
pub struct PngExporter {
    folder: PathBuf,
    fine: bool,
}

impl PngExporter {
    /// For one output folder, 8 bits per channel.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.join("frames"), fine: false }
    }

    /// For one output folder, 16 bits per channel.
    #[must_use]
    pub fn fine(folder: &Path) -> Self {
        Self { fine: true, ..Self::new(folder) }
    }
}

impl Exporter for PngExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        for (place, picture) in moment.places() {
            let path = self.folder.join(place).with_extension("png");
            let text = moment.provenance(picture);
            if self.fine { write_fine(&path, picture, &text)? } else { write(&path, &picture.frame, &text)? }
        }
        Ok(())
    }

    fn needs(&self) -> Needs {
        Needs { depth: Depth { fine: self.fine, layers: false }, ..Needs::default() }
    }
}

impl Picture {
    /// Writes it as a PNG of 8 bits per channel; the file is complete or not there.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        write(path.as_ref(), &self.frame, &[])
    }
}

/// Writes one picture with text chunks; what latin-1 cannot hold goes into international chunks.
pub fn write(path: &Path, frame: &Frame, text: &[(&str, String)]) -> Result<()> {
    // Every pixel is opaque: three bytes say it all.
    let rgb: Vec<u8> = frame.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    atomic::write(path, |out| encode(out, frame, (BitDepth::Eight, &rgb), text).map_err(told))
}

/// Reads a picture that [`write()`] wrote.
///
/// # Errors
/// [`Error::Io`] if it cannot be read or has other pixels.
pub fn read(path: &Path) -> Result<Frame> {
    let file = File::open(path).map_err(|source| Error::io(path, source))?;
    let failed = |error: &dyn std::fmt::Display| Error::io(path, io::Error::other(error.to_string()));
    let mut reader = Decoder::new(io::BufReader::new(file)).read_info().map_err(|error| failed(&error))?;
    let mut rgb = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let info = reader.next_frame(&mut rgb).map_err(|error| failed(&error))?;
    if (info.color_type, info.bit_depth) != (ColorType::Rgb, BitDepth::Eight) {
        return Err(failed(&"no picture with 8 bits per channel"));
    }
    let rgba = rgb.chunks_exact(3).flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect();
    Ok(Frame { width: info.width, height: info.height, rgba, ..Frame::default() })
}

/// The same with 16 bits per channel.
fn write_fine(path: &Path, picture: &Picture, text: &[(&str, String)]) -> Result<()> {
    let words: Vec<u8> = picture.fine.iter().flatten().flat_map(|value| value.to_be_bytes()).collect();
    atomic::write(path, |out| encode(out, &picture.frame, (BitDepth::Sixteen, &words), text).map_err(told))
}

/// What the system says, as it says it.
fn told(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

fn encode(
    out: &mut dyn Write,
    frame: &Frame,
    (depth, pixels): (BitDepth, &[u8]),
    text: &[(&str, String)],
) -> std::result::Result<(), EncodingError> {
    let mut encoder = Encoder::new(out, frame.width, frame.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(depth);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Fast);
    if let Some(per_inch) = frame.per_inch {
        let per_metre = (f64::from(per_inch) / METRES_PER_INCH).round() as u32;
        encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    }
    for (keyword, content) in text {
        let (keyword, content) = ((*keyword).to_owned(), content.clone());
        if content.chars().all(|letter| u32::from(letter) < 256) {
            encoder.add_text_chunk(keyword, content)?;
        } else {
            encoder.add_itxt_chunk(keyword, content)?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()
}
