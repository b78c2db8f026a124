//! One-dimensional states as line plots: density, velocity and pressure over x, one panel each.

use super::Stamp;
use super::canvas::{Anchor, Canvas, Rectangle};
use super::frame::Frame;
use super::overlay::header;
use super::quantity::caption;
use super::ticks::ticks;
use crate::scene::{Field, RenderSettings};
use crate::snapshot::kind;
use crate::state::Grid;

/// Captions of the three panels; that of velocities has their sign.
fn captions() -> [&'static str; 3] {
    [caption(Field::Density), "velocity [m/s]", caption(Field::Pressure)]
}

/// A one-dimensional state: gas per cell, solids per particle.
pub(crate) struct Line {
    pub(crate) grid: Grid,
    /// Kind of each cell.
    pub(crate) kind: Vec<u8>,
    /// Density, velocity and pressure of the gas in each cell.
    pub(crate) gas: [Vec<f32>; 3],
    /// Position, velocity and colour of each particle.
    pub(crate) particles: Vec<(f32, f32, [u8; 3])>,
    /// The exact solution of a Riemann problem: points (x, value) of the three panels.
    pub(crate) exact: Option<[Vec<[f64; 2]>; 3]>,
}

impl Line {
    /// Least and largest gas value of a panel, widened until it can be drawn.
    pub(crate) fn range(&self, panel: usize) -> [f64; 2] {
        let gas =
            self.gas[panel].iter().zip(&self.kind).filter(|(_, cell)| **cell == kind::GAS).map(|(value, _)| *value);
        let velocity = self.particles.iter().map(|particle| particle.1).filter(|_| panel == 1);
        let exact = self.exact.iter().flat_map(|lines| &lines[panel]).map(|point| point[1]);
        let (low, high) = gas
            .chain(velocity)
            .map(f64::from)
            .chain(exact)
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return [0.0, 1.0];
        }
        let margin = (0.06 * (high - low)).max(1e-3 * low.abs().max(high.abs())).max(1e-6);
        [low - margin, high + margin]
    }
}

/// Draws the three panels.
pub(crate) fn draw(line: &Line, look: &RenderSettings, stamp: &Stamp) -> Frame {
    let size = look.size;
    let mut frame = Frame::blank(look);
    let mut canvas = Canvas::new(&mut frame, look);
    header(&mut canvas, stamp.title, stamp.time);
    let (text, advance) = (canvas.lettering.line(), canvas.lettering.advance());
    let (left, right) = (9 * advance, 3 * advance);
    let (top, bottom) = (2 * text, 5 * text / 2);
    let pitch = (size[1] as i32 - top - bottom) / 3;
    for panel in 0..3 {
        let area = Rectangle {
            x: left,
            y: top + pitch * panel as i32 + text,
            width: (size[0] as i32 - left - right).max(1),
            height: (pitch - text - text / 2).max(1),
        };
        Panel { line, area, range: line.range(panel), index: panel }.draw(&mut canvas);
    }
    let middle = left + (size[0] as i32 - left - right) / 2;
    canvas.text(middle, size[1] as i32 - 3 * text / 4, Anchor::Middle, "x [m]", canvas.paper.ink);
    frame
}

/// One panel and its scales.
struct Panel<'a> {
    line: &'a Line,
    area: Rectangle,
    range: [f64; 2],
    index: usize,
}

impl Panel<'_> {
    fn x_range(&self) -> [f64; 2] {
        let low = self.line.grid.low()[0];
        [low, low + f64::from(self.line.grid.extent()[0])]
    }

    fn x_pixel(&self, x: f64) -> f32 {
        let [low, high] = self.x_range();
        self.area.x as f32 + ((x - low) / (high - low)) as f32 * self.area.width as f32
    }

    fn y_pixel(&self, value: f64) -> f32 {
        let fraction = (value - self.range[0]) / (self.range[1] - self.range[0]);
        self.area.bottom() as f32 - fraction as f32 * self.area.height as f32
    }

    fn draw(&self, canvas: &mut Canvas) {
        canvas.fill(self.area, canvas.paper.panel, 1.0);
        self.shade_covered_cells(canvas);
        self.draw_axes(canvas);
        self.draw_exact(canvas);
        self.draw_gas(canvas);
        if self.index == 1 {
            self.draw_particles(canvas);
        }
        canvas.outline(self.area, canvas.paper.faint);
        let y = self.area.y - 2 * canvas.lettering.line() / 3;
        canvas.text(self.area.x, y, Anchor::Left, captions()[self.index], canvas.paper.curves[self.index]);
    }

    /// Bands where a body or an obstacle takes the place of the gas.
    fn shade_covered_cells(&self, canvas: &mut Canvas) {
        let grid = &self.line.grid;
        for (index, &cell) in self.line.kind.iter().enumerate().filter(|(_, cell)| **cell != kind::GAS) {
            let low = grid.low()[0] + index as f64 * f64::from(grid.spacing);
            let (from, to) = (self.x_pixel(low), self.x_pixel(low + f64::from(grid.spacing)));
            let (x, y) = (from.round() as i32, self.area.y);
            let band = Rectangle { x, y, width: (to.round() as i32 - x).max(1), height: self.area.height };
            canvas.fill(band, canvas.paper.bands[usize::from(cell != kind::SOLID)], 1.0);
        }
    }

    fn draw_axes(&self, canvas: &mut Canvas) {
        let (line, advance, unit) = (canvas.lettering.line(), canvas.lettering.advance(), canvas.lettering.unit());
        for (value, label) in ticks(self.range, (self.area.height / (2 * line)).clamp(2, 6) as usize) {
            let y = self.y_pixel(value).round() as i32;
            canvas.fill(
                Rectangle { x: self.area.x, y, width: self.area.width, height: unit },
                canvas.paper.grid_line,
                0.8,
            );
            canvas.text(self.area.x - advance / 2 - unit, y, Anchor::Right, &label, canvas.paper.ink);
        }
        for (value, label) in ticks(self.x_range(), (self.area.width / (10 * advance)).clamp(2, 10) as usize) {
            let x = self.x_pixel(value).round() as i32;
            canvas.fill(
                Rectangle { x, y: self.area.y, width: unit, height: self.area.height },
                canvas.paper.grid_line,
                0.8,
            );
            if self.index == 2 {
                canvas.text(x, self.area.bottom() + line * 2 / 3 + unit, Anchor::Middle, &label, canvas.paper.ink);
            }
        }
    }

    /// One curve per stretch of cells with gas; the cell values are dots where cells are wide.
    fn draw_gas(&self, canvas: &mut Canvas) {
        let values = &self.line.gas[self.index];
        let width = 1.8 * canvas.lettering.unit() as f32;
        let mut points = Vec::with_capacity(values.len());
        for (index, &value) in values.iter().enumerate() {
            let x = self.x_pixel(self.line.grid.in_scene(self.line.grid.centre([index as i32, 0, 0]))[0]);
            let gas = self.line.kind[index] == kind::GAS && value.is_finite();
            // A break in the curve is a point without place.
            points.push(if gas { [x, self.y_pixel(value.into())] } else { [f32::NAN; 2] });
        }
        canvas.curve(&points, self.area, canvas.paper.curves[self.index], width);
        if self.area.width >= 8 * values.len() as i32 {
            for point in points.into_iter().filter(|point| point[0].is_finite()) {
                canvas.dot(point, self.area, canvas.paper.curves[self.index], 2.6 * width);
            }
        }
    }

    /// The exact solution under the curve, with a word beside the caption.
    fn draw_exact(&self, canvas: &mut Canvas) {
        let Some(lines) = &self.line.exact else { return };
        let points: Vec<[f32; 2]> =
            lines[self.index].iter().map(|[x, value]| [self.x_pixel(*x), self.y_pixel(*value)]).collect();
        canvas.curve(&points, self.area, canvas.paper.ink, canvas.lettering.unit() as f32);
        let y = self.area.y - 2 * canvas.lettering.line() / 3;
        canvas.text(self.area.right(), y, Anchor::Right, "exact", canvas.paper.ink);
    }

    fn draw_particles(&self, canvas: &mut Canvas) {
        let width = 3.0 * canvas.lettering.unit() as f32;
        for &(x, velocity, color) in &self.line.particles {
            let x = self.line.grid.in_scene([x, 0.0, 0.0])[0];
            let point = [self.x_pixel(x), self.y_pixel(velocity.into())];
            canvas.dot(point, self.area, color, width);
        }
    }
}
