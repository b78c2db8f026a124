//! Plots of `gauges.csv`: forces on walls, obstacles and bodies, and what points of bodies do.

use super::curves::{TIME, thin};
use crate::export::csv::Sheet;
use crate::quantity::{LOAD, POINT, label};
use crate::render::{Plot, Style};

/// Components of a vector and of a symmetric tensor, as far as a scene of so many axes has them.
const VECTOR: [&str; 3] = ["x", "y", "z"];
const TENSOR: [[&str; 6]; 3] =
    [["xx", "", "", "", "", ""], ["xx", "yy", "xy", "", "", ""], ["xx", "yy", "zz", "xy", "yz", "zx"]];

/// The plots of each gauge, in the order of the columns.
pub(super) fn plots(sheet: &Sheet, axes: usize) -> Vec<Plot> {
    let mut all = Vec::new();
    for column in sheet.names() {
        if let Some(name) = column.strip_suffix("_force_x") {
            all.push(curves(sheet, name, ("force", "Force on", &label(LOAD, "force")), &VECTOR[..axes]));
        }
        if let Some(name) = column.strip_suffix("_displacement_x") {
            let tensor: Vec<&str> = TENSOR[axes - 1].into_iter().filter(|part| !part.is_empty()).collect();
            let shown: [(_, _, &[&str]); 4] = [
                ("displacement", "Displacement of", &VECTOR[..axes]),
                ("velocity", "Velocity of", &VECTOR[..axes]),
                ("elastic_strain", "Elastic strain of", &tensor),
                ("stress", "Stress of", &tensor),
            ];
            all.extend(shown.map(|(own, title, parts)| curves(sheet, name, (own, title, &label(POINT, own)), parts)));
        }
    }
    all
}

/// A plot with a curve for each component.
fn curves(sheet: &Sheet, name: &str, (quantity, title, unit): (&str, &str, &str), parts: &[&str]) -> Plot {
    let times = sheet.numbers("time").unwrap_or_default();
    parts.iter().fold(Plot::new(format!("{title} {name}"), TIME, unit), |plot, part| {
        let values = sheet.numbers(&format!("{name}_{quantity}_{part}")).unwrap_or_default();
        plot.with(*part, Style::Line, thin(times, values))
    })
}
