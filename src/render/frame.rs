//! Finished pictures in memory.

/// A picture: 8 bits per channel, sRGB, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, alpha of each pixel; alpha is 255.
    pub rgba: Vec<u8>,
}

/// A picture with what it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Name of the field.
    pub name: String,
    /// Values at the two ends of the colour bar, in the field's unit.
    pub range: [f64; 2],
    /// The pixels.
    pub frame: Frame,
}

impl Frame {
    /// A frame of one colour.
    #[must_use]
    pub fn filled(width: u32, height: u32, color: [u8; 3]) -> Self {
        let pixel = [color[0], color[1], color[2], 255];
        Self { width, height, rgba: pixel.repeat(width as usize * height as usize) }
    }
}
