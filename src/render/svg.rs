//! Plots as SVG: dark lines on white, told apart by shade, dash and mark, so that they survive a printer.

use std::fmt::Write as _;

use super::html::escape;
use super::ticks;

/// Width and height of a plot, in its own units.
const SIZE: [f64; 2] = [718.0, 400.0];
/// Room beside the axes: left, top, right, bottom.
const MARGIN: [f64; 4] = [88.0, 34.0, 220.0, 48.0];
/// Values that differ by less of themselves are shown as equal: their labels would need more digits than there is room for.
const NARROWEST: f64 = 1e-3;
/// Colours in turn; dark enough for paper. [Okabe and Ito 2008]
const COLORS: [&str; 8] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#444444", "#7b3294"];

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line in the next colour.
    Line,
    /// A thin black line: the reference.
    Reference,
    /// Marks in the next colour.
    Marks,
    /// A line with marks: one value per run.
    Both,
    /// A dashed grey line: a slope or limit to compare with.
    Guide,
}

#[derive(Clone, Debug, PartialEq)]
struct Series {
    name: String,
    points: Vec<[f64; 2]>,
    style: Style,
}

/// One plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Heading.
    pub title: String,
    labels: [String; 2],
    logarithmic: bool,
    series: Vec<Series>,
}

impl Plot {
    /// An empty plot with linear axes.
    pub fn new(title: impl Into<String>, x: impl Into<String>, y: impl Into<String>) -> Self {
        Plot { title: title.into(), labels: [x.into(), y.into()], logarithmic: false, series: Vec::new() }
    }

    /// Makes both axes logarithmic; points that are not positive are left out.
    #[must_use]
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// Adds a series.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, style: Style, points: Vec<[f64; 2]>) -> Self {
        self.series.push(Series { name: name.into(), points, style });
        self
    }

    /// Place of a value on an axis before scaling; not finite where it has none.
    fn scaled(&self, value: f64) -> f64 {
        if self.logarithmic { value.log10() } else { value }
    }

    /// Range of an axis with a margin.
    fn range(&self, axis: usize) -> [f64; 2] {
        let values = self.series.iter().flat_map(|series| &series.points).map(|point| self.scaled(point[axis]));
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return [0.0, 1.0];
        }
        let share = if axis == 0 && !self.logarithmic { 0.0 } else { 0.05 };
        let largest = low.abs().max(high.abs());
        let narrow = !self.logarithmic && high - low < NARROWEST * largest;
        let margin = match low == high {
            true => 0.5 * largest.max(1e-6),
            false if narrow => 0.5 * NARROWEST * largest,
            false => share * (high - low),
        };
        [low - margin, high + margin]
    }

    /// Values and labels of an axis.
    fn ticks(&self, [low, high]: [f64; 2], wanted: usize) -> Vec<(f64, String)> {
        if !self.logarithmic {
            return ticks([low, high], wanted);
        }
        let factors: &[f64] = if high - low > 2.5 { &[1.0] } else { &[1.0, 2.0, 4.0, 8.0] };
        let decades = low.floor() as i32..=high.ceil() as i32;
        let values = decades.flat_map(|decade| factors.iter().map(move |factor| factor * 10_f64.powi(decade)));
        let label = |value: f64| {
            if (1e-3..1e5).contains(&value) { format!("{}", (value * 1e6).round() / 1e6) } else { format!("{value:e}") }
        };
        let within = values.map(|value| (value.log10(), label(value)));
        within.filter(|(at, _)| (low..=high).contains(at)).collect()
    }

    /// The plot as an SVG element.
    #[must_use]
    pub fn svg(&self) -> String {
        let frame = Frame { ranges: [self.range(0), self.range(1)] };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" font-family=\"sans-serif\" \
             font-size=\"12\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            SIZE[0], SIZE[1]
        );
        let (left, right, top, bottom) =
            (frame.pixel(0, 0.0), frame.pixel(0, 1.0), frame.pixel(1, 1.0), frame.pixel(1, 0.0));
        // Writing to a String cannot fail.
        let _ = writeln!(svg, "<text x=\"{left}\" y=\"20\" font-weight=\"bold\">{}</text>", escape(&self.title));
        for (value, label) in self.ticks(frame.ranges[0], 6) {
            let x = frame.place(0, value);
            let _ = writeln!(svg, "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"#ddd\"/>");
            let _ =
                writeln!(svg, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>", bottom + 16.0);
        }
        for (value, label) in self.ticks(frame.ranges[1], 6) {
            let y = frame.place(1, value);
            let _ = writeln!(svg, "<path d=\"M{left} {y:.1}H{right}\" stroke=\"#ddd\"/>");
            let _ =
                writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>", left - 6.0, y + 4.0);
        }
        let [x_label, y_label] = self.labels.each_ref().map(|label| escape(label));
        let (middle, height) = (0.5 * (left + right), 0.5 * (top + bottom));
        let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{x_label}</text>", bottom + 36.0);
        let _ = writeln!(
            svg,
            "<text transform=\"translate(16 {height}) rotate(-90)\" text-anchor=\"middle\">{y_label}</text>"
        );
        self.draw_series(&frame, &mut svg);
        let (width, tall) = (right - left, bottom - top);
        let _ = writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{tall}\" fill=\"none\" stroke=\"#333\"/></svg>"
        );
        svg
    }

    fn draw_series(&self, frame: &Frame, svg: &mut String) {
        let mut next = 0;
        for (index, series) in self.series.iter().enumerate() {
            let (color, width, dash) = match series.style {
                Style::Reference => ("#000", 1.0, ""),
                Style::Guide => ("#888", 1.2, "6 4"),
                _ => (COLORS[next % COLORS.len()], 1.8, ["", "7 3", "2 3"][next / COLORS.len() % 3]),
            };
            next += usize::from(!matches!(series.style, Style::Reference | Style::Guide));
            let place = |point: &[f64; 2]| [0, 1].map(|axis| frame.place(axis, self.scaled(point[axis])));
            let points: Vec<[f64; 2]> =
                series.points.iter().map(place).filter(|point| point.iter().all(|part| part.is_finite())).collect();
            if series.style != Style::Marks {
                draw_line(svg, &points, color, width, dash);
            }
            let marked = matches!(series.style, Style::Marks | Style::Both);
            for point in points.iter().filter(|_| marked) {
                draw_mark(svg, *point, color, next);
            }
            let y = frame.pixel(1, 1.0) + 10.0 + 16.0 * index as f64;
            let x = frame.pixel(0, 1.0) + 10.0;
            if series.style != Style::Marks {
                draw_line(svg, &[[x, y], [x + 22.0, y]], color, width, dash);
            }
            if marked {
                draw_mark(svg, [x + 11.0, y], color, next);
            }
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{}\" font-size=\"11\">{}</text>",
                x + 28.0,
                y + 4.0,
                escape(&series.name)
            );
        }
    }
}

fn draw_line(svg: &mut String, points: &[[f64; 2]], color: &str, width: f64, dash: &str) {
    let text: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" stroke-dasharray=\"{dash}\"/>",
        text.join(" ")
    );
}

/// Circle, square, diamond or triangle in turn.
fn draw_mark(svg: &mut String, [x, y]: [f64; 2], color: &str, kind: usize) {
    let shape = match kind % 4 {
        1 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.4\""),
        2 => format!("<rect x=\"{:.1}\" y=\"{:.1}\" width=\"4.4\" height=\"4.4\"", x - 2.2, y - 2.2),
        3 => format!("<path d=\"M{x:.1} {:.1}l3 3l-3 3l-3 -3z\"", y - 3.0),
        _ => format!("<path d=\"M{x:.1} {:.1}l3 5h-6z\"", y - 3.0),
    };
    let _ = writeln!(svg, "{shape} fill=\"{color}\"/>");
}

/// The axes.
struct Frame {
    ranges: [[f64; 2]; 2],
}

impl Frame {
    /// Place of a fraction of an axis.
    fn pixel(&self, axis: usize, fraction: f64) -> f64 {
        let inner = SIZE[axis] - MARGIN[axis] - MARGIN[axis + 2];
        if axis == 0 { MARGIN[0] + fraction * inner } else { MARGIN[1] + (1.0 - fraction) * inner }
    }

    /// Place of a scaled value.
    fn place(&self, axis: usize, value: f64) -> f64 {
        let [low, high] = self.ranges[axis];
        self.pixel(axis, (value - low) / (high - low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_fit_beside_the_axes() {
        let noise = |middle: f64, spread: f64| (0..9).map(move |k| [middle + spread * f64::from(k % 3), f64::from(k)]);
        for (middle, spread) in [(0.5, 1e-9), (0.5, 0.0), (-3e7, 1.0), (1e-12, 1e-20), (0.0, 2e-9), (2.0, 0.4)] {
            let plot = Plot::new("", "", "").with("", Style::Line, noise(middle, spread).collect());
            let labels: Vec<String> = plot.ticks(plot.range(0), 6).into_iter().map(|(_, label)| label).collect();
            let (mut apart, [low, high]) = (labels.clone(), plot.range(0));
            apart.dedup();
            assert!(labels.len() > 1 && labels == apart, "{middle} {spread}: {labels:?}");
            assert!(labels.iter().all(|label| label.chars().count() <= 12), "{middle} {spread}: {labels:?}");
            assert!(low <= middle && middle + 2.0 * spread <= high);
        }
    }
}
