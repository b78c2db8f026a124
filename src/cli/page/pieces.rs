//! The pieces of bodies at the end of a run, from `fragments.csv`: the heaviest ones, and how fast their mass is.

use std::fmt::Write as _;

use crate::bodies::SPEEDS;
use crate::export::csv::Sheet;
use crate::math::plain;
use crate::render::{Plot, Style, escape};

/// Pieces with a row on the page.
const SHOWN: usize = 10;

/// Rows of the last frame, heaviest piece first.
fn last(sheet: &Sheet) -> Vec<usize> {
    let frames = sheet.numbers("frame").unwrap_or_default();
    let end = frames.last().copied().unwrap_or_default();
    let mut rows: Vec<usize> = (0..frames.len()).filter(|row| frames[*row] == end).collect();
    rows.sort_by(|one, other| value(sheet, "mass", *other).total_cmp(&value(sheet, "mass", *one)));
    rows
}

fn value(sheet: &Sheet, column: &str, row: usize) -> f64 {
    sheet.numbers(column).and_then(|all| all.get(row)).copied().unwrap_or(f64::NAN)
}

/// The heaviest pieces of the last frame.
pub(super) fn table(sheet: &Sheet) -> String {
    let rows = last(sheet);
    let mut page =
        "<table><thead><tr><th>piece</th><th>came from</th><th>body</th><th>mass [kg]</th><th>centre [m]</th>\
                    <th>velocity [m/s]</th><th>spin [1/s]</th><th>size [m]</th></tr></thead><tbody>"
            .to_owned();
    for &row in rows.iter().take(SHOWN) {
        let text = |column: &str| escape(sheet.texts(column).and_then(|all| all.get(row)).map_or("", String::as_str));
        let vector = |names: [&str; 3]| names.map(|name| plain(value(sheet, name, row))).join(", ");
        let _ = write!(
            page,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            value(sheet, "piece", row),
            text("parent"),
            text("body"),
            plain(value(sheet, "mass", row)),
            vector(["x", "y", "z"]),
            vector(["velocity_x", "velocity_y", "velocity_z"]),
            vector(["spin_x", "spin_y", "spin_z"]),
            vector(["length", "width", "height"]),
        );
    }
    let count = rows.len();
    let _ = writeln!(
        page,
        "</tbody></table>\n<p>The last frame has {count} pieces in <code>fragments.csv</code>; the heaviest are shown.</p>"
    );
    page
}

/// Mass of the pieces of the last frame by the speed of their particles.
pub(super) fn speeds(sheet: &Sheet) -> Plot {
    let rows = last(sheet);
    let fastest = rows.first().map_or(0.0, |row| value(sheet, "fastest", *row));
    let mut steps = Vec::new();
    for part in 1..=SPEEDS {
        let column = format!("mass_at_speed_{part}_of_{SPEEDS}");
        let mass: f64 = rows.iter().map(|row| value(sheet, &column, *row)).sum();
        let end = |part: usize| fastest * part as f64 / SPEEDS as f64;
        steps.extend([[end(part - 1), mass], [end(part), mass]]);
    }
    Plot::new("Speeds of pieces in the last frame", "speed [m/s]", "mass [kg]").with("all pieces", Style::Line, steps)
}
