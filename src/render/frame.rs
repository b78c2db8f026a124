//! Finished pictures in memory.

use super::layers::{LayerPixel, Layers};
use super::paper::Paper;
use crate::scene::{Look, RenderSettings};

/// A picture: 8 bits per channel, sRGB, rows from the top.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Frame {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, alpha of each pixel; alpha is 255.
    pub rgba: Vec<u8>,
    /// Pixels per inch, if it is meant for paper.
    pub per_inch: Option<u32>,
}

/// What a picture holds beside its 8 bits per channel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Depth {
    /// Layers for compositors.
    pub layers: bool,
    /// 16 bits per channel.
    pub fine: bool,
}

/// A picture with what it shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Picture {
    /// Name of the view, empty for the scene's own.
    pub view: String,
    /// Name of the field.
    pub name: String,
    /// Name of the quantity that it shows of the gas: the field, or what the mode of the picture makes of it; empty in 1D.
    pub shown: String,
    /// Values at the two ends of the colour bar, in that quantity's unit.
    pub range: [f64; 2],
    /// The pixels.
    pub frame: Frame,
    /// Linear light, depth and objects of the plot alone; empty unless asked for.
    pub layers: Layers,
    /// The pixels with 16 bits per channel, sRGB; empty unless asked for.
    pub fine: Vec<[u16; 3]>,
}

/// Light of the pixels of a plot, rows from the top; what was not asked for is empty.
#[derive(Debug, Default)]
pub(super) struct Drawn {
    /// 8 bits per channel, sRGB, dithered in 3D.
    pub(super) pixels: Vec<u32>,
    /// Layers for compositors.
    pub(super) layers: Vec<LayerPixel>,
    /// Linear light behind it, 0 to 1.
    pub(super) toned: Vec<[f32; 4]>,
}

/// Pixels per inch of pictures for paper.
const PRINT_PER_INCH: u32 = 300;

impl Frame {
    /// A frame of a look's size with nothing on it.
    pub(super) fn blank(look: &RenderSettings) -> Self {
        let per_inch = (look.look == Look::Print).then_some(PRINT_PER_INCH);
        Self { per_inch, ..Self::filled(look.size[0], look.size[1], Paper::of(look).ground) }
    }

    /// A frame of one colour.
    #[must_use]
    pub fn filled(width: u32, height: u32, color: [u8; 3]) -> Self {
        let pixel = [color[0], color[1], color[2], 255];
        Self { width, height, rgba: pixel.repeat(width as usize * height as usize), per_inch: None }
    }
}
