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
    /// Pixels along x and y.
    pub(super) size: [usize; 2],
    /// 8 bits per channel, sRGB, dithered in 3D.
    pub(super) pixels: Vec<u32>,
    /// Layers for compositors.
    pub(super) layers: Vec<LayerPixel>,
    /// Linear light behind it, 0 to 1.
    pub(super) toned: Vec<[f32; 4]>,
}

impl Drawn {
    /// The same on so many pixels, linear between the middles of those that are known.
    pub(super) fn on(self, size: [usize; 2]) -> Self {
        if self.size == size {
            return self;
        }
        let places = [0, 1].map(|axis| between(self.size[axis], size[axis]));
        let at = |column: usize, row: usize| self.pixels[row * self.size[0] + column];
        let mut pixels = Vec::with_capacity(size[0] * size[1]);
        for &(row, below, down) in &places[1] {
            let of = |&(column, next, across): &(usize, usize, u32)| {
                let [upper, lower] = [row, below].map(|row| mixed(at(column, row), at(next, row), across));
                mixed(upper, lower, down)
            };
            pixels.extend(places[0].iter().map(of));
        }
        Self { size, pixels, ..Self::default() }
    }
}

/// For each of `to` pixels the two of `from` that it lies between, and how far from the first, in parts of 256.
fn between(from: usize, to: usize) -> Vec<(usize, usize, u32)> {
    let place = |k: usize| (((k as f32 + 0.5) * from as f32 / to as f32) - 0.5).clamp(0.0, from as f32 - 1.0);
    let around = |place: f32| (place as usize, (place as usize + 1).min(from - 1), (256.0 * place.fract()) as u32);
    (0..to).map(|k| around(place(k))).collect()
}

/// Mean of two pixels, channel by channel; `share` is that of the second in parts of 256.
fn mixed(first: u32, second: u32, share: u32) -> u32 {
    const EVERY_OTHER: u32 = 0x00ff_00ff;
    let half = |shift: u32| {
        let sum = ((first >> shift) & EVERY_OTHER) * (256 - share) + ((second >> shift) & EVERY_OTHER) * share;
        ((sum + 0x0080_0080) >> 8) & EVERY_OTHER
    };
    half(0) | (half(8) << 8)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_of_a_coarse_plot_are_mixed_by_their_middles() {
        let drawn = Drawn { size: [2, 1], pixels: vec![0xff00_0000, 0xff08_ff40], ..Drawn::default() };
        assert_eq!(
            Drawn { size: [2, 1], pixels: drawn.pixels.clone(), ..Drawn::default() }.on([2, 1]).pixels,
            drawn.pixels
        );
        let row = [0xff00_0000, 0xff02_4010, 0xff06_bf30, 0xff08_ff40];
        let wide = drawn.on([4, 2]);
        assert_eq!((wide.size, wide.pixels), ([4, 2], [row, row].concat()));
    }
}
