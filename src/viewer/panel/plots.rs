//! Curves over time: energies, extremes, the solver, probes.

use egui::{Color32, ComboBox, Ui};
use egui_plot::{Line, Plot, PlotPoints};

use super::super::history::Point;
use super::super::view::View;

/// Colours of the curves, legible on dark ground.
pub(in crate::viewer) const COLORS: [Color32; 6] = [
    Color32::from_rgb(242, 140, 60),
    Color32::from_rgb(110, 190, 245),
    Color32::from_rgb(150, 215, 130),
    Color32::from_rgb(225, 150, 205),
    Color32::from_rgb(240, 215, 110),
    Color32::from_rgb(190, 190, 200),
];

/// A value of a step.
type Value = fn(&Point) -> f64;

/// What one plot shows: name, its curves, and whether it takes a body.
type Shown = (&'static str, &'static [(&'static str, Value)], bool);

const PLOTS: [Shown; 7] = [
    ("largest pressure [Pa]", &[("pressure", |point| point.pressure)], false),
    ("energy of bodies [J]", &[("motion", |point| point.energy[1]), ("strain", |point| point.energy[2])], true),
    ("energy of the gas [J]", &[("gas", |point| point.energy[0])], false),
    ("largest speed [m/s]", &[("gas", |point| point.speed[0]), ("bodies", |point| point.speed[1])], false),
    ("mass of the gas [kg]", &[("mass", |point| point.mass)], false),
    ("inside: length of a step [s]", &[("dt", |point| point.dt)], false),
    ("inside: solver", &[("iterations", |point| point.iterations), ("sub-steps", |point| point.substeps)], false),
];
/// Places of the plots that are shown first, with bodies and without.
const FIRST: [[usize; 2]; 2] = [[0, 1], [0, 3]];
/// Name of the plot of the probes.
const PROBES: &str = "pressure at probes [Pa]";

/// Shows two plots, each of a choice: at first the pressure at the probes, or the largest one, and the energy of the bodies.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    let chosen = ui.scope_id().with("chosen");
    let probes = !view.scene.probes.is_empty();
    let [first, second] = FIRST[usize::from(view.scene.bodies.is_empty())];
    let mut choices: [usize; 2] =
        ui.data(|data| data.get_temp(chosen)).unwrap_or([if probes { PLOTS.len() } else { first }, second]);
    // a new probe is shown, and nothing where the last one has gone
    if probes && std::mem::take(&mut view.panel.probe_is_new) && !choices.contains(&PLOTS.len()) {
        choices[0] = PLOTS.len();
    }
    choices = choices.map(|choice| if choice == PLOTS.len() && !probes { first } else { choice });
    for (place, choice) in choices.iter_mut().enumerate() {
        plot(ui, view, place, choice);
    }
    ui.data_mut(|data| data.insert_temp(chosen, choices));
}

fn plot(ui: &mut Ui, view: &View, place: usize, choice: &mut usize) {
    let probes = !view.scene.probes.is_empty();
    let solids = !view.scene.bodies.is_empty();
    let name = |index: usize| PLOTS.get(index).map_or(PROBES, |(name, ..)| name);
    let offered = |index: &usize| PLOTS.get(*index).map_or(probes, |(_, _, of_bodies)| solids || !of_bodies);
    ComboBox::from_id_salt(("plot", place)).selected_text(name(*choice)).width(210.0).show_ui(ui, |ui| {
        for index in (0..=PLOTS.len()).filter(offered) {
            ui.selectable_value(choice, index, name(index));
        }
    });
    let curves: Vec<(String, Vec<[f64; 2]>)> = match PLOTS.get(*choice) {
        Some((_, curves, of_bodies)) => {
            let shown = curves.iter().take(if solids || *of_bodies { curves.len() } else { 1 });
            shown.map(|(name, value)| ((*name).to_owned(), view.history.curve(value))).collect()
        }
        None => {
            let probes = view.scene.probes.iter().enumerate();
            let curve = |index: usize| view.history.curve(|point| point.probes.get(index).copied().unwrap_or(f64::NAN));
            probes.map(|(index, probe)| (probe.name.clone(), curve(index))).collect()
        }
    };
    let colored = || curves.iter().zip(COLORS.into_iter().cycle());
    // beside the plot, so that no name covers a curve
    if curves.len() > 1 {
        ui.horizontal_wrapped(|ui| {
            for ((name, _), color) in colored() {
                ui.colored_label(color, name);
            }
        });
    }
    let plot = Plot::new(("curves", place)).height(116.0).allow_drag(false).allow_zoom(false).allow_scroll(false);
    plot.show(ui, |plot| {
        for ((name, points), color) in colored() {
            plot.line(Line::new(name.as_str(), PlotPoints::from(points.clone())).color(color).width(1.5));
        }
    });
}
