//! Text, rectangles and lines on a finished frame.

use super::frame::Frame;
use super::letters::Lettering;
use super::paper::Paper;
use crate::scene::RenderSettings;

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The point is the left end.
    Left,
    /// The point is the middle.
    Middle,
    /// The point is the right end.
    Right,
}

/// A rectangle in pixels, from its top left corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub(crate) x: i32,
    pub(crate) y: i32,
    pub(crate) width: i32,
    pub(crate) height: i32,
}

impl Rectangle {
    pub(crate) fn right(&self) -> i32 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> i32 {
        self.y + self.height
    }
}

/// Draws on a frame.
pub(crate) struct Canvas<'a> {
    pub(crate) frame: &'a mut Frame,
    pub(crate) lettering: Lettering,
    pub(crate) paper: Paper,
}

impl<'a> Canvas<'a> {
    pub(crate) fn new(frame: &'a mut Frame, look: &RenderSettings) -> Self {
        Self { frame, lettering: Lettering::of(look), paper: Paper::of(look) }
    }

    /// Mixes `color` over a pixel; outside of the frame nothing happens.
    pub(crate) fn blend(&mut self, x: i32, y: i32, color: [u8; 3], coverage: f32) {
        if x < 0 || y < 0 || x >= self.frame.width as i32 || y >= self.frame.height as i32 {
            return;
        }
        let first = 4 * (y as usize * self.frame.width as usize + x as usize);
        for (old, new) in self.frame.rgba[first..first + 3].iter_mut().zip(color) {
            let mixed = f32::from(*old) + (f32::from(new) - f32::from(*old)) * coverage.clamp(0.0, 1.0);
            *old = (mixed + 0.5) as u8;
        }
    }

    /// Fills a rectangle.
    pub(crate) fn fill(&mut self, area: Rectangle, color: [u8; 3], coverage: f32) {
        if coverage < 1.0 {
            for y in area.y..area.bottom() {
                (area.x..area.right()).for_each(|x| self.blend(x, y, color, coverage));
            }
            return;
        }
        let [wide, high] = [self.frame.width, self.frame.height].map(|n| n as i32);
        let (left, right) = (area.x.clamp(0, wide), area.right().clamp(0, wide));
        for y in area.y.max(0)..area.bottom().min(high) {
            let [from, to] = [left, right.max(left)].map(|x| 4 * (y as usize * wide as usize + x as usize));
            self.frame.rgba[from..to].chunks_exact_mut(4).for_each(|pixel| pixel[..3].copy_from_slice(&color));
        }
    }

    /// Draws a frame of unit width just outside a rectangle.
    pub(crate) fn outline(&mut self, area: Rectangle, color: [u8; 3]) {
        let unit = self.lettering.unit();
        let (x, y, width) = (area.x - unit, area.y - unit, area.width + 2 * unit);
        self.fill(Rectangle { x, y, width, height: unit }, color, 1.0);
        self.fill(Rectangle { x, y: area.bottom(), width, height: unit }, color, 1.0);
        self.fill(Rectangle { x, y: area.y, width: unit, height: area.height }, color, 1.0);
        self.fill(Rectangle { x: area.right(), y: area.y, width: unit, height: area.height }, color, 1.0);
    }

    /// Writes one line of text; `y` is the middle of the line. Text that is too long loses its end.
    pub(crate) fn text(&mut self, x: i32, y: i32, anchor: Anchor, text: &str, color: [u8; 3]) {
        let lettering = self.lettering.clone();
        let text = lettering.cut(text, self.frame.width as i32 - lettering.advance());
        let width = lettering.width(&text);
        let left = match anchor {
            Anchor::Left => x,
            Anchor::Middle => x - width / 2,
            Anchor::Right => x - width,
        };
        lettering.draw(&text, [left, y], |[x, y], share| self.blend(x, y, color, share));
    }

    /// Draws a smooth round dot around a point given in pixels, inside `clip`.
    pub(crate) fn dot(&mut self, point: [f32; 2], clip: Rectangle, color: [u8; 3], width: f32) {
        let reach = 0.5 * width + 1.0;
        let [x, y] = point;
        for row in ((y - reach) as i32).max(clip.y)..((y + reach) as i32 + 1).min(clip.bottom()) {
            for column in ((x - reach) as i32).max(clip.x)..((x + reach) as i32 + 1).min(clip.right()) {
                let distance = (column as f32 + 0.5 - x).hypot(row as f32 + 0.5 - y);
                self.blend(column, row, color, reach - 0.5 - distance);
            }
        }
    }

    /// Draws a short smooth line through points given in pixels, inside `clip`: as [`Canvas::curve`], without looking at the
    /// rest of the picture.
    pub(crate) fn stroke(&mut self, points: &[[f32; 2]], clip: Rectangle, color: [u8; 3], width: f32) {
        let reach = width as i32 + 2;
        let bound = |axis: usize, pick: fn(f32, f32) -> f32, start: f32| {
            points.iter().map(|point| point[axis]).fold(start, pick) as i32
        };
        let x = (bound(0, f32::min, f32::INFINITY) - reach).max(clip.x);
        let y = (bound(1, f32::min, f32::INFINITY) - reach).max(clip.y);
        let right = (bound(0, f32::max, f32::NEG_INFINITY) + reach).min(clip.right());
        let bottom = (bound(1, f32::max, f32::NEG_INFINITY) + reach).min(clip.bottom());
        if right > x && bottom > y {
            self.curve(points, Rectangle { x, y, width: right - x, height: bottom - y }, color, width);
        }
    }

    /// Draws a smooth line through points given in pixels, inside `clip`.
    pub(crate) fn curve(&mut self, points: &[[f32; 2]], clip: Rectangle, color: [u8; 3], width: f32) {
        let mut pen = Pen::over(clip);
        for pair in points.windows(2) {
            if pair.iter().flatten().all(|coordinate| coordinate.is_finite()) {
                pen.cover([pair[0], pair[1]], width);
            }
        }
        let rows = pen.coverage.chunks_exact(clip.width.max(1) as usize).zip(&pen.touched);
        for (y, (row, [from, to])) in (clip.y..).zip(rows) {
            let own = row.iter().enumerate().take(*to).skip(*from);
            own.filter(|(_, amount)| **amount > 0.0)
                .for_each(|(x, amount)| self.blend(clip.x + x as i32, y, color, *amount));
        }
    }
}

/// Shares of the pixels of an area that a line covers, and the part of each row that it comes near.
struct Pen {
    clip: Rectangle,
    coverage: Vec<f32>,
    touched: Vec<[usize; 2]>,
}

impl Pen {
    fn over(clip: Rectangle) -> Self {
        let [wide, high] = [clip.width, clip.height].map(|n| n.max(0) as usize);
        Self { clip, coverage: vec![0.0; wide * high], touched: vec![[wide, 0]; high] }
    }

    /// Raises the coverage of the pixels near a segment to their share under a round pen.
    fn cover(&mut self, segment: [[f32; 2]; 2], width: f32) {
        let clip = self.clip;
        let [from, to] = segment.map(|[x, y]| glam::Vec2::new(x - clip.x as f32, y - clip.y as f32));
        let reach = 0.5 * width + 1.0;
        let (low, high) = (from.min(to) - reach, from.max(to) + reach);
        let along = to - from;
        let length_squared = along.length_squared().max(f32::MIN_POSITIVE);
        let [left, right] = [low.x.max(0.0) as usize, high.x.ceil().clamp(0.0, clip.width as f32) as usize];
        for y in (low.y.max(0.0) as i32)..(high.y.ceil().min(clip.height as f32) as i32) {
            let [first, end] = &mut self.touched[y as usize];
            (*first, *end) = ((*first).min(left), (*end).max(right));
            for x in left..right {
                let point = glam::Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let nearest = from + along * ((point - from).dot(along) / length_squared).clamp(0.0, 1.0);
                let amount = (reach - 0.5 - point.distance(nearest)).clamp(0.0, 1.0);
                let pixel = &mut self.coverage[y as usize * clip.width as usize + x];
                *pixel = pixel.max(amount);
            }
        }
    }
}
