//! Title, time, colour bar and axes around a picture, and where on the frame everything goes.

use glam::Vec3;

use super::canvas::{Anchor, Canvas, Rectangle};
use super::colormap::lookup;
use super::letters::Lettering;
use super::paper::Paper;
use super::ticks::{scientific, ticks};
use crate::scene::RenderSettings;

/// Where the parts of a picture are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    /// The field.
    pub(crate) plot: Rectangle,
    /// The colour bars without their labels, from below: of the gas, of the particles.
    pub(crate) bars: [Option<Rectangle>; 2],
}

/// Letters that the labels of a colour bar may take.
const LABEL_LETTERS: i32 = 8;

impl Layout {
    /// For a plot of the given width over height; `None` lets the plot take the whole frame, under everything else.
    /// `shown` says which colour bars there are.
    pub(crate) fn new(look: &RenderSettings, aspect: Option<f32>, shown: [bool; 2]) -> Self {
        let letters = Lettering::of(look);
        let header = look.overlays.title || look.overlays.time;
        let [width, height] = look.size.map(|pixels| pixels as i32);
        let (line, advance) = (letters.line(), letters.advance());
        let some = shown.contains(&true);
        let bar_width = 2 * advance;
        let right = if some { bar_width + (LABEL_LETTERS + 2) * advance } else { 0 };
        let top = if some {
            15 * line / 4
        } else if header {
            2 * line
        } else {
            line
        };
        let area = Rectangle {
            x: 2 * advance,
            y: top,
            width: width - if some { 3 * advance + right } else { 4 * advance },
            height: height - top - line,
        };
        let Some(aspect) = aspect else {
            let bar_height = area.height * 6 / 10;
            let column =
                Rectangle { x: width - right, y: (height - bar_height) / 2, width: bar_width, height: bar_height };
            return Self { plot: Rectangle { x: 0, y: 0, width, height }, bars: split(column, shown, line) };
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
        let y = area.y + (area.height - bar_height) / 2;
        let column = Rectangle { x: plot.right() + advance, y, width: bar_width, height: bar_height };
        Self { plot, bars: split(column, shown, line) }
    }
}

impl Layout {
    /// Pixels of the plot, or a share of them along each axis.
    pub(crate) fn pixels(&self, share: f64) -> [u32; 2] {
        [self.plot.width, self.plot.height].map(|side| (f64::from(side) * share).round().max(1.0) as u32)
    }
}

/// Shares a column among the colour bars in it, with room for a caption between two.
fn split(column: Rectangle, shown: [bool; 2], line: i32) -> [Option<Rectangle>; 2] {
    if shown != [true, true] {
        return shown.map(|own| own.then_some(column));
    }
    let height = (column.height - 3 * line).max(2) / 2;
    let lower = Rectangle { y: column.bottom() - height, height, ..column };
    [Some(lower), Some(Rectangle { height, ..column })]
}

/// Title on the left, time on the right.
pub(crate) fn header(canvas: &mut Canvas, title: Option<&str>, time: Option<f64>) {
    let (line, advance) = (canvas.lettering.line(), canvas.lettering.advance());
    let right = canvas.frame.width as i32 - advance;
    let stamp = time.map_or_else(String::new, |time| format!("t = {} s", significant(time)));
    let room = right - 4 * advance - canvas.lettering.width(&stamp);
    let title = canvas.lettering.cut(title.unwrap_or_default(), room);
    let ink = canvas.paper.ink;
    canvas.text(2 * advance, line, Anchor::Left, &title, ink);
    canvas.text(right, line, Anchor::Right, &stamp, ink);
}

/// A bar of a round length in the lower left corner of the plot, where a metre has so many pixels everywhere.
pub(crate) fn scale_bar(canvas: &mut Canvas, plot: Rectangle, pixels_per_metre: f64) {
    let longest = 0.25 * f64::from(plot.width) / pixels_per_metre;
    let Paper { ink, ground, .. } = canvas.paper;
    let Some((length, label)) = ticks([0.0, longest], 2).pop().filter(|(length, _)| *length > 0.0) else { return };
    let (line, advance, unit) = (canvas.lettering.line(), canvas.lettering.advance(), canvas.lettering.unit());
    let width = (length * pixels_per_metre).round() as i32;
    let bar = Rectangle { x: plot.x + advance, y: plot.bottom() - line / 2 - 2 * unit, width, height: 2 * unit };
    if bar.y - line < plot.y || width < 2 * advance {
        return;
    }
    let around = Rectangle { x: bar.x - unit, y: bar.y - unit, width: width + 2 * unit, height: 4 * unit };
    canvas.fill(around, ground, 0.6);
    canvas.fill(bar, ink, 1.0);
    let label = format!("{label} m");
    let text = (canvas.lettering.width(&label), bar.y - 2 * unit - line / 2);
    let behind = Rectangle { x: bar.x - unit, y: text.1 - line / 2, width: text.0 + 2 * unit, height: line };
    canvas.fill(behind, ground, 0.6);
    canvas.text(bar.x, text.1, Anchor::Left, &label, ink);
}

/// Velocities at places of a regular pattern, as arrows; the fastest is as long as the places are apart.
pub(crate) fn arrows(canvas: &mut Canvas, plot: Rectangle, count: [u32; 2], velocities: &[[f32; 4]]) {
    let speed = |velocity: &[f32; 4]| velocity[0].hypot(velocity[1]);
    let fastest = velocities.iter().filter(|own| own[3] > 0.0).map(speed).fold(0.0, f32::max);
    let apart = (plot.width as f32 / count[0] as f32).min(plot.height as f32 / count[1] as f32);
    let width = 1.3 * canvas.lettering.unit() as f32;
    for (index, velocity) in velocities.iter().enumerate().filter(|(_, own)| own[3] > 0.0) {
        // Hardly any motion is no arrow.
        if speed(velocity) < 0.02 * fastest || fastest == 0.0 {
            continue;
        }
        let (column, row) = (index as u32 % count[0], index as u32 / count[0]);
        let middle = glam::Vec2::new(
            plot.x as f32 + (column as f32 + 0.5) / count[0] as f32 * plot.width as f32,
            plot.bottom() as f32 - (row as f32 + 0.5) / count[1] as f32 * plot.height as f32,
        );
        let along = glam::Vec2::new(velocity[0], -velocity[1]) / fastest * apart;
        let (tail, tip) = (middle - 0.5 * along, middle + 0.5 * along);
        let side = 0.3 * (along + along.perp());
        let barb = |side: glam::Vec2| (tip - side).to_array();
        let mirrored = 0.3 * (along - along.perp());
        for (color, width) in [(canvas.paper.ground, 2.6 * width), (canvas.paper.ink, width)] {
            canvas.stroke(&[tail.to_array(), tip.to_array()], plot, color, width);
            canvas.stroke(&[barb(side), tip.to_array(), barb(mirrored)], plot, color, width);
        }
    }
}

/// Four significant digits, times a power of ten for very small and very large numbers.
pub(crate) fn significant(value: f64) -> String {
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    if (-3.0..5.0).contains(&exponent) {
        format!("{value:.*}", (3.0 - exponent) as usize)
    } else {
        scientific(value, 3)
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
    let Paper { ink, ground, faint, .. } = canvas.paper;
    for row in 0..bar.height {
        let fraction = (row as f32 + 0.5) / bar.height as f32;
        let strip = Rectangle { x: bar.x, y: bar.bottom() - 1 - row, width: bar.width, height: 1 };
        canvas.fill(strip, lookup(table, fraction.powf(contrast)), 1.0);
    }
    canvas.outline(bar, faint);
    let (line, advance, unit) = (canvas.lettering.line(), canvas.lettering.advance(), canvas.lettering.unit());
    let wanted = (bar.height / (3 * line)).clamp(2, 8) as usize;
    for (value, label) in ticks(range, wanted) {
        let fraction = (value - range[0]) / (range[1] - range[0]);
        let y = bar.bottom() - (fraction * f64::from(bar.height)).round() as i32;
        canvas.fill(Rectangle { x: bar.right(), y, width: advance / 2, height: unit }, faint, 1.0);
        canvas.text(bar.right() + advance, y, Anchor::Left, &label, ink);
    }
    let end = canvas.frame.width as i32 - advance;
    let is_wide = bar.x + canvas.lettering.width(caption) > end && bar.y > 5 * line;
    // What is too wide has its unit in a line of its own, where there is room above the bar.
    let [name, of_unit] = caption.split_once(" [").filter(|_| is_wide).map_or([caption, ""], |(a, b)| [a, b]);
    let unit_line = format!("[{of_unit}");
    let lines = if of_unit.is_empty() { vec![name] } else { vec![unit_line.as_str(), name] };
    for (text, above) in lines.into_iter().zip([5, 9]) {
        let width = canvas.lettering.width(text);
        let (x, y) = (bar.x.min(end - width), bar.y - above * line / 4);
        // It may still reach over the picture, which may be bright.
        let behind = Rectangle { x: x - unit, y: y - line / 2, width: width + 2 * unit, height: line };
        canvas.fill(behind, ground, 0.6);
        canvas.text(x, y, Anchor::Left, text, ink);
    }
}
