//! Title, time, colour bar and axes around a picture, and where on the frame everything goes.

use glam::Vec3;

use super::canvas::{Anchor, Canvas, Lettering, Rectangle};
use super::colormap::lookup;
use super::ticks::ticks;

/// Behind everything.
pub(crate) const BACKGROUND: [u8; 3] = [14, 17, 22];
/// Letters.
pub(crate) const INK: [u8; 3] = [222, 226, 232];
/// Frames and ticks.
pub(crate) const FAINT: [u8; 3] = [118, 126, 138];

/// Where the parts of a picture with a colour bar are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    /// The field.
    pub(crate) plot: Rectangle,
    /// The colour bar without its labels.
    pub(crate) bar: Rectangle,
}

/// Letters that the labels of a colour bar may take.
const LABEL_LETTERS: i32 = 8;

impl Layout {
    /// For a plot of the given width over height; `None` lets the plot take the whole frame, under the bar.
    pub(crate) fn new(width: u32, height: u32, aspect: Option<f32>) -> Self {
        let letters = Lettering::for_size(width, height);
        let (width, height) = (width as i32, height as i32);
        let (line, advance) = (letters.line(), letters.advance());
        let bar_width = 2 * advance;
        let right = bar_width + (LABEL_LETTERS + 2) * advance;
        let (top, bottom) = (15 * line / 4, line);
        let area =
            Rectangle { x: 2 * advance, y: top, width: width - 3 * advance - right, height: height - top - bottom };
        let Some(aspect) = aspect else {
            let plot = Rectangle { x: 0, y: 0, width, height };
            let bar_height = area.height * 6 / 10;
            let bar =
                Rectangle { x: width - right, y: (height - bar_height) / 2, width: bar_width, height: bar_height };
            return Self { plot, bar };
        };
        let plot_width = ((area.height as f32 * aspect) as i32).min(area.width).max(1);
        let plot_height = ((plot_width as f32 / aspect) as i32).clamp(1, area.height.max(1));
        let plot = Rectangle {
            // On very small frames the margins give way.
            x: (area.x + (area.width - plot_width) / 2).clamp(0, width - plot_width),
            y: (area.y + (area.height - plot_height) / 2).clamp(0, height - plot_height),
            width: plot_width,
            height: plot_height,
        };
        let bar_height = plot_height.max(area.height / 2);
        let bar = Rectangle {
            x: plot.right() + advance,
            y: area.y + (area.height - bar_height) / 2,
            width: bar_width,
            height: bar_height,
        };
        Self { plot, bar }
    }
}

/// Title on the left, time on the right.
pub(crate) fn header(canvas: &mut Canvas, title: &str, time: f64) {
    let (line, advance) = (canvas.lettering.line(), canvas.lettering.advance());
    let right = canvas.frame.width as i32 - advance;
    let stamp = format!("t = {} s", significant(time));
    let room = (right - 4 * advance - canvas.lettering.width(&stamp)) / advance;
    let title: String = title.chars().take(room.max(0) as usize).collect();
    canvas.text(2 * advance, line, Anchor::Left, &title, INK);
    canvas.text(right, line, Anchor::Right, &stamp, INK);
}

/// Four significant digits, with an exponent for very small and very large numbers.
pub(crate) fn significant(value: f64) -> String {
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    if (-3.0..5.0).contains(&exponent) {
        format!("{value:.*}", (3.0 - exponent) as usize)
    } else {
        format!("{value:.3e}")
    }
}

/// The colours from low (below) to high (above), with round values beside them and the caption above.
/// `contrast` is the power that turns a fraction of the range into a place in the table.
pub(crate) fn color_bar(
    canvas: &mut Canvas,
    bar: Rectangle,
    table: &[Vec3],
    range: [f64; 2],
    contrast: f32,
    caption: &str,
) {
    for row in 0..bar.height {
        let fraction = (row as f32 + 0.5) / bar.height as f32;
        let strip = Rectangle { x: bar.x, y: bar.bottom() - 1 - row, width: bar.width, height: 1 };
        canvas.fill(strip, lookup(table, fraction.powf(contrast)), 1.0);
    }
    canvas.outline(bar, FAINT);
    let (line, advance, unit) = (canvas.lettering.line(), canvas.lettering.advance(), canvas.lettering.unit());
    let wanted = (bar.height / (3 * line)).clamp(2, 8) as usize;
    for (value, label) in ticks(range, wanted) {
        let fraction = (value - range[0]) / (range[1] - range[0]);
        let y = bar.bottom() - (fraction * f64::from(bar.height)).round() as i32;
        canvas.fill(Rectangle { x: bar.right(), y, width: advance / 2, height: unit }, FAINT, 1.0);
        canvas.text(bar.right() + advance, y, Anchor::Left, &label, INK);
    }
    let room = canvas.frame.width as i32 - advance - canvas.lettering.width(caption);
    canvas.text(bar.x.min(room), bar.y - 5 * line / 4, Anchor::Left, caption, INK);
}
