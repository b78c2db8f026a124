//! Plots of the tables of a run.

use std::path::Path;

use super::gauges;
use crate::expect::Gauge;
use crate::export::csv::Sheet;
use crate::quantity::{self, BODY, LOAD, PROBE, STEP};
use crate::render::{Plot, Style};

/// Parts of a curve that keep their least and largest value.
const PARTS: usize = 300;
/// Tables of gauges: points in the gas, and what `[[gauges]]` sit on.
const GAUGES: [&str; 2] = ["probes.csv", "gauges.csv"];
/// Plots of bodies with their columns: strain, stress and energy.
const OF_BODIES: [(&str, &str); 6] = [
    ("Plastic strain", "plastic_strain"),
    ("Mean plastic strain", "mean_plastic_strain"),
    ("Elastic strain", "elastic_strain"),
    ("Deviatoric stress", "deviatoric_stress"),
    ("Kinetic energy of bodies", "kinetic_energy"),
    ("Elastic energy of bodies", "elastic_energy"),
];
/// Time axes.
pub(super) const TIME: &str = "time [s]";

/// The tables of a run.
#[derive(Debug, Default)]
pub(super) struct Tables {
    steps: Option<Sheet>,
    probes: Option<Sheet>,
    gauges: Option<Sheet>,
    bodies: Option<Sheet>,
    obstacles: Option<Sheet>,
    pub(super) fragments: Option<Sheet>,
    /// What could not be read.
    pub(super) wrong: Vec<String>,
}

impl Tables {
    /// Those in a folder.
    pub(super) fn read(folder: &Path) -> Self {
        let mut wrong = Vec::new();
        let mut read = |name: &str, texts: &[&str]| {
            Sheet::read(&folder.join(name), texts).unwrap_or_else(|error| {
                wrong.push(error.to_string());
                None
            })
        };
        let steps = read("diagnostics.csv", &[]);
        let [probes, gauges] = GAUGES.map(|name| read(name, &[]));
        let (bodies, obstacles) = (read("bodies.csv", &["body"]), read("obstacles.csv", &["obstacle"]));
        let fragments = read("fragments.csv", &["parent", "body"]);
        Self { steps, probes, gauges, bodies, obstacles, fragments, wrong }
    }

    /// Mass, momentum and energy: parts, and what they come to.
    pub(super) fn budgets(&self, axes: usize) -> Vec<Plot> {
        let Some(steps) = &self.steps else { return Vec::new() };
        let owed =
            [("gas_", "gas"), ("owed_", "gas under bodies"), ("crossed_", "crossed the sides"), ("solid_", "solids")];
        let named = |of: &str| owed.map(|(column, name)| (format!("{column}{of}"), name.to_owned(), 1.0));
        let mut plots = vec![budget(steps, "Mass", "mass [kg]", named("mass").to_vec())];
        for axis in &["x", "y", "z"][..axes] {
            let column = format!("momentum_{axis}");
            let given = (format!("given_{column}"), "given from outside".to_owned(), -1.0);
            let parts = named(&column).into_iter().chain([given]).collect();
            plots.push(budget(steps, &format!("Momentum along {axis}"), "momentum [kg m/s]", parts));
        }
        let energies = [
            ("gas_energy", "gas", 1.0),
            ("owed_energy", "gas under bodies", 1.0),
            ("crossed_energy", "crossed the sides", 1.0),
            ("solid_kinetic_energy", "solids, kinetic", 1.0),
            ("solid_elastic_energy", "solids, elastic", 1.0),
            ("solid_ghost_energy", "solids, ghost", 1.0),
            ("solid_plastic_heat", "plastic heat", 1.0),
            ("solid_fracture_energy", "cracks", 1.0),
            ("given_energy", "given from outside", -1.0),
        ];
        let parts = energies.map(|(column, name, sign)| (column.to_owned(), name.to_owned(), sign)).to_vec();
        plots.push(budget(steps, "Energy", "energy [J]", parts));
        plots
    }

    /// Largest and least values over time, and what the solver did.
    pub(super) fn extremes(&self) -> Vec<Plot> {
        let Some(steps) = &self.steps else { return Vec::new() };
        let plot = |title: &str, unit: &str, columns: &[(&str, &str)]| {
            let columns = columns.iter().filter_map(|(column, name)| Some((name, steps.numbers(column)?)));
            let times = steps.numbers("time").unwrap_or_default();
            columns.fold(Plot::new(title, TIME, unit), |plot, (name, values)| {
                plot.with(*name, Style::Line, thin(times, values))
            })
        };
        vec![
            plot(
                "Pressure",
                &quantity::label(PROBE, "pressure"),
                &[("max_pressure", "largest"), ("min_pressure", "least")],
            ),
            plot(
                "Density",
                &quantity::label(PROBE, "density"),
                &[("max_density", "largest"), ("min_density", "least")],
            ),
            plot("Speed", "largest speed [m/s]", &[("max_gas_speed", "gas"), ("max_solid_speed", "solids")]),
            plot("Step", &quantity::label(STEP, "dt"), &[("dt", "step")]),
            plot("Solver", "per step", &[("pcg_iterations", "PCG iterations"), ("substeps", "elastic sub-steps")]),
        ]
    }

    /// Pressure of each gauge over time, with what was measured.
    pub(super) fn gauges(&self) -> Vec<(String, Option<Gauge>, Plot)> {
        let labels = [quantity::label(PROBE, "pressure"), quantity::label(LOAD, "pressure")];
        let sheets = [&self.probes, &self.gauges].into_iter().zip(&labels);
        sheets
            .filter_map(|(sheet, label)| Some((sheet.as_ref()?, label)))
            .flat_map(|(sheet, label)| {
                pressures(sheet).map(move |own| (sheet.numbers("time").unwrap_or_default(), label, own))
            })
            .map(|(times, label, (name, pressure))| {
                let gauge = Gauge::of(times, &pressure);
                let title = format!("Gauge {name}");
                let mut plot =
                    Plot::new(title, TIME, label.as_str()).with("pressure", Style::Line, thin(times, &pressure));
                if let Some((gauge, arrival)) = gauge.and_then(|gauge| Some((gauge, gauge.arrival?))) {
                    let line = |time: f64| vec![[time, gauge.first], [time, gauge.peak]];
                    plot = plot.with("arrival", Style::Guide, line(arrival));
                    if let Some(phase) = gauge.positive_phase {
                        plot = plot.with("end of positive phase", Style::Guide, line(arrival + phase));
                    }
                }
                (name, gauge, plot)
            })
            .collect()
    }

    /// Forces, and what points of bodies do.
    pub(super) fn forces_and_points(&self, axes: usize) -> Vec<Plot> {
        self.gauges.as_ref().map_or_else(Vec::new, |sheet| gauges::plots(sheet, axes))
    }

    /// Paths, speed, strain, energy and loads of bodies, and loads of obstacles.
    pub(super) fn bodies(&self, axes: usize) -> Vec<Plot> {
        let mut plots = Vec::new();
        if let Some(bodies) = &self.bodies {
            let path = |rows: &Rows| rows.pair("x", "y");
            if ["x", "y"].iter().any(|column| bodies.numbers(column).is_some_and(spreads)) {
                plots.push(each(bodies, "body", ("Paths of bodies", "x [m]", "y [m]"), path));
            }
            let heads = [("x", "x [m]"), ("y", "y [m]"), ("z", "z [m]")];
            for (column, label) in &heads[..axes] {
                if bodies.numbers(column).is_some_and(spreads) {
                    let title = format!("Place of bodies along {column}");
                    plots.push(each(bodies, "body", (&title, TIME, label), |rows| rows.pair("time", column)));
                }
            }
            let speed = |rows: &Rows| rows.size("velocity");
            plots.push(each(bodies, "body", ("Speed of bodies", TIME, &quantity::label(BODY, "velocity")), speed));
            for (title, column) in OF_BODIES {
                let label = quantity::label(BODY, column);
                plots.push(each(bodies, "body", (title, TIME, &label), |rows| rows.pair("time", column)));
            }
            plots.push(each(bodies, "body", ("Pieces", TIME, &quantity::label(BODY, "pieces")), |rows| {
                rows.pair("time", "pieces")
            }));
            if bodies.numbers("gas_force_x").is_some() {
                for axis in &["x", "y", "z"][..axes] {
                    let (title, column) = (format!("Force of the gas along {axis}"), format!("gas_force_{axis}"));
                    let label = quantity::label(LOAD, "force");
                    plots.push(each(bodies, "body", (&title, TIME, &label), |rows| rows.pair("time", &column)));
                }
            }
        }
        if let Some(obstacles) = &self.obstacles {
            for axis in &["x", "y", "z"][..axes] {
                let (title, column) = (format!("Force on obstacles along {axis}"), format!("force_{axis}"));
                let label = quantity::label(LOAD, "force");
                plots.push(each(obstacles, "obstacle", (&title, TIME, &label), |rows| rows.pair("time", &column)));
            }
            let pressure = |rows: &Rows| rows.pair("time", "pressure");
            let label = quantity::label(LOAD, "pressure");
            plots.push(each(obstacles, "obstacle", ("Pressure on obstacles", TIME, &label), pressure));
        }
        plots
    }
}

/// Probes and gauges of a run with what they have measured, from `probes.csv` and `gauges.csv`.
pub(in crate::cli) fn gauges(folder: &Path) -> Vec<(String, Gauge)> {
    let read = |name: &str| Sheet::read(&folder.join(name), &[]).ok().flatten();
    let all = GAUGES.into_iter().filter_map(read).flat_map(|sheet| {
        let times = sheet.numbers("time").unwrap_or_default();
        pressures(&sheet).filter_map(|(name, pressure)| Some((name, Gauge::of(times, &pressure)?))).collect::<Vec<_>>()
    });
    all.collect()
}

/// The pressures of a table by names: what probes saw in gas, elsewhere no number; the mean over what a gauge sits on.
fn pressures(sheet: &Sheet) -> impl Iterator<Item = (String, Vec<f64>)> {
    sheet.names().iter().filter_map(|column| {
        let name = column.strip_suffix("_pressure")?;
        let all = sheet.numbers(column)?;
        let Some(kind) = sheet.numbers(&format!("{name}_kind")) else { return Some((name.to_owned(), all.to_vec())) };
        let gas = |(pressure, kind): (&f64, &f64)| if *kind == 0.0 { *pressure } else { f64::NAN };
        Some((name.to_owned(), all.iter().zip(kind).map(gas).collect()))
    })
}

/// Whether values differ by more than rounding.
fn spreads(values: &[f64]) -> bool {
    let ends = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    ends[1] - ends[0] > 1e-5 * ends[0].abs().max(ends[1].abs())
}

/// A plot of parts and their sum.
fn budget(steps: &Sheet, title: &str, label: &str, parts: Vec<(String, String, f64)>) -> Plot {
    let times = steps.numbers("time").unwrap_or_default();
    let mut plot = Plot::new(title, TIME, label);
    let mut sum = vec![0.0; times.len()];
    for (column, name, sign) in parts {
        let Some(values) = steps.numbers(&column) else { continue };
        sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += sign * value);
        if values.iter().any(|value| *value != 0.0) {
            plot = plot.with(name, Style::Line, thin(times, values));
        }
    }
    plot.with("together", Style::Reference, thin(times, &sum))
}

/// Rows of one body or obstacle.
struct Rows<'a> {
    sheet: &'a Sheet,
    own: Vec<usize>,
}

impl Rows<'_> {
    fn column(&self, name: &str) -> Vec<f64> {
        let all = self.sheet.numbers(name).unwrap_or_default();
        self.own.iter().map(|row| all.get(*row).copied().unwrap_or(f64::NAN)).collect()
    }

    fn pair(&self, x: &str, y: &str) -> Vec<[f64; 2]> {
        let both = (self.column(x), self.column(y));
        if x == "time" { thin(&both.0, &both.1) } else { both.0.into_iter().zip(both.1).map(|(x, y)| [x, y]).collect() }
    }

    /// Length of a vector over time.
    fn size(&self, vector: &str) -> Vec<[f64; 2]> {
        let parts = ["x", "y", "z"].map(|axis| self.column(&format!("{vector}_{axis}")));
        let length = |k: usize| parts.iter().map(|part| part[k] * part[k]).sum::<f64>().sqrt();
        self.column("time").into_iter().enumerate().map(|(k, time)| [time, length(k)]).collect()
    }
}

/// A plot with a curve for each name in a column of a table.
fn each(
    sheet: &Sheet,
    column: &str,
    (title, x, y): (&str, &str, &str),
    points: impl Fn(&Rows) -> Vec<[f64; 2]>,
) -> Plot {
    let names = sheet.texts(column).unwrap_or_default();
    let mut seen: Vec<&String> = Vec::new();
    names.iter().for_each(|name| {
        if !seen.contains(&name) {
            seen.push(name)
        }
    });
    seen.into_iter().fold(Plot::new(title, x, y), |plot, name| {
        let own = (0..names.len()).filter(|row| names[*row] == *name).collect();
        plot.with(name, Style::Line, points(&Rows { sheet, own }))
    })
}

/// A curve with as many points as can be seen: of each part the least and the largest value.
pub(super) fn thin(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let all: Vec<[f64; 2]> = times.iter().zip(values).map(|(time, value)| [*time, *value]).collect();
    if all.len() <= 2 * PARTS {
        return all;
    }
    let part = all.len().div_ceil(PARTS);
    all.chunks(part)
        .flat_map(|chunk| {
            let order = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
            let mut both: Vec<[f64; 2]> =
                chunk.iter().min_by(order).into_iter().chain(chunk.iter().max_by(order)).copied().collect();
            both.sort_by(|a, b| a[0].total_cmp(&b[0]));
            both
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thin_curves_keep_their_peaks() {
        let times: Vec<f64> = (0..10_000).map(f64::from).collect();
        let values: Vec<f64> = times.iter().map(|t| if *t == 4321.0 { 7.0 } else { (t / 500.0).sin() }).collect();
        let points = thin(&times, &values);
        assert!(points.len() <= 2 * PARTS && points.contains(&[4321.0, 7.0]));
        assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }
}
