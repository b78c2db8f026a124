//! A run of pictures as one moving picture: APNG, which every browser shows.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use ::png::{BitDepth, ColorType, Compression, Decoder, Encoder, EncodingError, Transformations};

use crate::render::Frame;
use crate::{Error, Result};

/// Reads a picture that [`super::png::write`] has written.
///
/// # Errors
/// [`Error::Io`] if there is none.
pub fn read(path: &Path) -> Result<Frame> {
    let wrong = |error: ::png::DecodingError| Error::io(path, std::io::Error::other(error));
    let file = File::open(path).map_err(|source| Error::io(path, source))?;
    let mut decoder = Decoder::new(BufReader::new(file));
    decoder.set_transformations(Transformations::ALPHA | Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(wrong)?;
    let mut rgba = vec![0; reader.output_buffer_size().unwrap_or(0)];
    let info = reader.next_frame(&mut rgba).map_err(wrong)?;
    rgba.truncate(info.buffer_size());
    Ok(Frame { width: info.width, height: info.height, rgba, ..Frame::default() })
}

/// These pictures one after another, `delay` milliseconds each, over and over.
///
/// # Errors
/// A picture differs in size from the first.
pub fn moving(frames: &[Frame], delay: u16) -> std::result::Result<Vec<u8>, EncodingError> {
    let Some(first) = frames.first() else { return Ok(Vec::new()) };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, first.width, first.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_animated(u32::try_from(frames.len()).unwrap_or(u32::MAX), 0)?;
    encoder.set_frame_delay(delay, 1000)?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
        let rgb: Vec<u8> = frame.rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        writer.write_image_data(&rgb)?;
    }
    writer.finish()?;
    Ok(bytes)
}

/// A picture of at most `width` pixels per row; each of its pixels is the mean of a block.
#[must_use]
pub fn shrunk(frame: &Frame, width: u32) -> Frame {
    let block = frame.width.div_ceil(width.max(1)).max(1);
    let (wide, high) = ((frame.width / block).max(1), (frame.height / block).max(1));
    let (block, wide) = (block as usize, wide as usize);
    let mut rgba = Vec::with_capacity(4 * wide * high as usize);
    // rows of the picture above each other, as many as a block has; a picture may be lower than a block
    for rows in frame.rgba.chunks(4 * block * frame.width as usize).take(high as usize) {
        let pixels = (block * rows.len() / (4 * frame.width as usize)) as u32;
        let mut sums = vec![[0u32; 4]; wide];
        for row in rows.chunks_exact(4 * frame.width as usize) {
            for (sum, own) in sums.iter_mut().zip(row.chunks_exact(4 * block)) {
                for pixel in own.as_chunks::<4>().0 {
                    *sum = std::array::from_fn(|k| sum[k] + u32::from(pixel[k]));
                }
            }
        }
        rgba.extend(sums.into_iter().flatten().map(|total| (total / pixels) as u8));
    }
    let wide = wide as u32;
    Frame { width: wide, height: high, rgba, ..Frame::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_move_and_shrink() {
        let filled = |shade: u8| Frame::filled(10, 6, [shade, 0, 255 - shade]);
        let frames = [10, 20, 250].map(|shade| shrunk(&filled(shade), 5));
        let bytes = moving(&frames, 80).unwrap_or_else(|error| panic!("{error}"));
        let mut reader = Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap_or_else(|e| panic!("{e}"));
        let info = reader.info();
        assert_eq!((info.width, info.height), (5, 3));
        assert_eq!(info.animation_control.map(|control| (control.num_frames, control.num_plays)), Some((3, 0)));
        let mut pixels = vec![0; 45];
        let shades = [10, 20, 250].map(|_| {
            reader.next_frame(&mut pixels).unwrap_or_else(|error| panic!("{error}"));
            pixels[0]
        });
        assert_eq!(shades, [10, 20, 250]);
        assert!(moving(&[frames[0].clone(), filled(10)], 80).is_err());
        let low = shrunk(&Frame::filled(40, 2, [7, 8, 9]), 10);
        assert_eq!((low.width, low.height, &low.rgba[..3]), (10, 1, &[7, 8, 9][..]));
    }
}
