//! Curves over time: energies, extremes, the solver, probes.

use egui::{Color32, ComboBox, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints};

use super::super::history::Point;
use super::super::view::View;

/// Colours of the curves, legible on dark ground.
const COLORS: [Color32; 6] = [
    Color32::from_rgb(242, 140, 60),
    Color32::from_rgb(110, 190, 245),
    Color32::from_rgb(150, 215, 130),
    Color32::from_rgb(225, 150, 205),
    Color32::from_rgb(240, 215, 110),
    Color32::from_rgb(190, 190, 200),
];

/// A value of a step.
type Value = fn(&Point) -> f64;

/// What one plot shows: name, and its curves.
const PLOTS: [(&str, &[(&str, Value)]); 6] = [
    (
        "energy [J]",
        &[
            ("gas", |point| point.energy[0]),
            ("motion", |point| point.energy[1]),
            ("in solids", |point| point.energy[2]),
        ],
    ),
    ("largest pressure [Pa]", &[("pressure", |point| point.pressure)]),
    ("largest speed [m/s]", &[("gas", |point| point.speed[0]), ("solids", |point| point.speed[1])]),
    ("length of a step [s]", &[("dt", |point| point.dt)]),
    ("solver", &[("iterations", |point| point.iterations), ("sub-steps", |point| point.substeps)]),
    ("mass of the gas [kg]", &[("mass", |point| point.mass)]),
];
/// Name of the plot of the probes.
const PROBES: &str = "pressure at probes [Pa]";

/// Shows two plots, each of a choice.
pub(super) fn show(ui: &mut Ui, view: &View) {
    let chosen = ui.scope_id().with("chosen");
    let mut choices: [usize; 2] = ui.data(|data| data.get_temp(chosen)).unwrap_or([1, 4]);
    for (place, choice) in choices.iter_mut().enumerate() {
        plot(ui, view, place, choice);
    }
    ui.data_mut(|data| data.insert_temp(chosen, choices));
}

fn plot(ui: &mut Ui, view: &View, place: usize, choice: &mut usize) {
    let probes = !view.scene.probes.is_empty();
    let name = |index: usize| PLOTS.get(index).map_or(PROBES, |(name, _)| name);
    ComboBox::from_id_salt(("plot", place)).selected_text(name(*choice)).width(210.0).show_ui(ui, |ui| {
        for index in 0..PLOTS.len() + usize::from(probes) {
            ui.selectable_value(choice, index, name(index));
        }
    });
    let solids = !view.scene.bodies.is_empty();
    let curves: Vec<(String, Vec<[f64; 2]>)> = match PLOTS.get(*choice) {
        Some((_, curves)) => {
            let shown = curves.iter().enumerate().filter(|(index, _)| solids || *index == 0).map(|(_, curve)| curve);
            shown.map(|(name, value)| ((*name).to_owned(), view.history.curve(value))).collect()
        }
        None => {
            let probes = view.scene.probes.iter().enumerate();
            let curve = |index: usize| view.history.curve(|point| point.probes.get(index).copied().unwrap_or(f64::NAN));
            probes.map(|(index, probe)| (probe.name.clone(), curve(index))).collect()
        }
    };
    let plot = Plot::new(("curves", place)).height(116.0).allow_drag(false).allow_zoom(false).allow_scroll(false);
    let plot = if curves.len() > 1 { plot.legend(Legend::default()) } else { plot };
    plot.show(ui, |plot| {
        for ((name, points), color) in curves.into_iter().zip(COLORS.into_iter().cycle()) {
            plot.line(Line::new(name, PlotPoints::from(points)).color(color).width(1.5));
        }
    });
}
