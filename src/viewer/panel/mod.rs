//! The panel beside the picture: look, blast, parameters, plots, stages, camera, scene.

pub(super) mod add;
mod body;
mod camera;
mod curve;
mod extras;
mod look;
mod parameters;
pub(super) mod plots;

use std::sync::Arc;

use egui::{Align, CollapsingHeader, DragValue, Grid, RichText, ScrollArea, Slider, Ui};

use super::adding::AIR;
use super::model::{Command, Source, Status};
use super::theme;
use super::view::View;
use crate::math::plain;
use crate::scene::Scene;
pub(super) use body::Picked;
use parameters::Parameters;

/// Energy of a kilogram of TNT \[J\].
const TNT: f64 = 4.294e6;
/// Energy of the first blast, in energies that the ambient gas of its ball holds.
const BLAST: f64 = 20.0;

/// What the panel remembers.
#[derive(Debug)]
pub(super) struct Panel {
    /// Whether it can be seen.
    pub(super) open: bool,
    /// Whether plain clicks detonate.
    pub(super) detonates: bool,
    /// Numbers of the next blast.
    pub(super) blast: Numbers,
    parameters: Parameters,
    range: look::Range,
    measures: bool,
    /// The body that was picked.
    pub(super) body: Picked,
    /// The body that clicks add.
    pub(super) adding: add::Adding,
    /// A probe was set, and its curve is to be seen.
    pub(super) probe_is_new: bool,
}

/// What a click sets off: a mass of TNT \[kg\], or an energy \[J\] within a radius \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Numbers {
    energy: f64,
    radius: f64,
    mass: f64,
    /// Whether it is the mass that counts.
    by_mass: bool,
    /// Energy and mass at first.
    first: [f64; 2],
}

impl Numbers {
    /// A blast that is worth looking at.
    fn of(scene: &Scene) -> Self {
        let domain = &scene.domain;
        let smallest = domain.size[..domain.axes()].iter().copied().fold(f64::INFINITY, f64::min);
        let radius = (0.06 * smallest).max(1.6 * domain.spacing());
        let pi = std::f64::consts::PI;
        let volume = [2.0 * radius, pi * radius * radius, 4.0 / 3.0 * pi * radius.powi(3)][domain.axes() - 1];
        let energy = BLAST * scene.gas.ambient.pressure / (scene.gas.gamma - 1.0) * volume;
        // Two digits are enough to begin with.
        let digit = 10.0_f64.powf(energy.log10().floor() - 1.0);
        let energy = (energy / digit).round() * digit;
        let mass = energy / TNT;
        Self { energy, radius, mass, by_mass: !scene.charges.is_empty(), first: [energy, mass] }
    }

    /// What a click sets off.
    pub(super) fn source(&self) -> Source {
        if self.by_mass { Source::Tnt(self.mass) } else { Source::Energy(self.energy, self.radius) }
    }
}

impl Panel {
    pub(super) fn new(scene: &Scene) -> Self {
        Self {
            open: true,
            detonates: false,
            blast: Numbers::of(scene),
            parameters: Parameters::of(scene),
            range: look::Range::of(&scene.render),
            measures: false,
            body: Picked::default(),
            adding: add::Adding::of(scene),
            probe_is_new: false,
        }
    }

    /// Takes over what stays when a scene starts again.
    pub(super) fn keep(&mut self, old: Self) {
        (self.open, self.measures) = (old.open, old.measures);
        self.adding.keep(old.adding);
    }

    /// Whether the stages of steps are measured.
    pub(super) fn measures(&self) -> bool {
        self.measures
    }
}

/// Shows the panel.
pub(super) fn show(ui: &mut Ui, view: &mut View, status: &Status) {
    ui.add_space(4.0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        section(ui, "Look", true, |ui| look::show(ui, view));
        if view.dimension() == 3 {
            section(ui, "Volume", false, |ui| look::volume(ui, view));
        }
        if view.opened.particles > 0 && view.dimension() > 1 {
            section(ui, "Bodies", false, |ui| extras::bodies(ui, view));
            section(ui, "Body", true, |ui| body::show(ui, view));
        }
        if view.dimension() > 1 {
            let is_new = std::mem::take(&mut view.panel.adding.is_new);
            section_to_see(ui, "Add a body", (true, is_new), |ui| add::show(ui, view));
            section(ui, "Planes and lines", false, |ui| extras::planes_and_lines(ui, view));
        }
        if view.dimension() == 3 {
            section(ui, "Light", false, |ui| extras::light(ui, view));
        }
        section(ui, "Detonate", true, |ui| detonate(ui, view));
        section(ui, "Plots", true, |ui| plots::show(ui, view));
        section(ui, "Parameters", false, |ui| parameters::show(ui, view));
        section(ui, "Times", false, |ui| times(ui, view, status));
        if view.dimension() > 1 {
            section(ui, "Camera", false, |ui| camera::show(ui, view));
            section(ui, "Words", false, |ui| extras::overlays(ui, view));
        }
        section(ui, "Scene", false, |ui| about(ui, view));
    });
}

fn section(ui: &mut Ui, name: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    section_to_see(ui, name, (open, false), content);
}

/// A section that is open at first, or that opens and comes into sight where it is to be seen.
fn section_to_see(ui: &mut Ui, name: &str, (open, seen): (bool, bool), content: impl FnOnce(&mut Ui)) {
    let header = CollapsingHeader::new(RichText::new(name).strong()).default_open(open).open(seen.then_some(true));
    let shown = header.show_unindented(ui, |ui| {
        content(ui);
        ui.add_space(4.0);
    });
    if seen {
        shown.header_response.scroll_to_me(Some(Align::TOP));
        ui.ctx().request_repaint();
    }
}

/// A label before a widget, in columns.
fn rows(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui)) {
    Grid::new(name).num_columns(2).spacing([10.0, 6.0]).min_col_width(78.0).show(ui, content);
}

/// A positive number of any size.
fn positive<'a>(value: &'a mut f64, unit: &str) -> DragValue<'a> {
    let speed = 0.01 * value.abs().max(1e-12);
    DragValue::new(value).speed(speed).range(1e-30..=1e30).suffix(format!(" {unit}")).custom_formatter(short)
}

/// A number as everywhere.
fn short(value: f64, _: std::ops::RangeInclusive<usize>) -> String {
    plain(value)
}

/// What energies and masses are per, by dimension.
const PER: [&str; 3] = ["/m\u{b2}", "/m", ""];

/// What goes off, with three digits.
pub(super) fn amount(source: Source, axes: usize) -> String {
    let (value, unit) = match source {
        Source::Energy(energy, _) => (energy, "J"),
        Source::Tnt(mass) => (mass, "kg"),
    };
    let digit = 10.0_f64.powf(value.abs().max(1e-300).log10().floor() - 2.0);
    let of = if unit == "kg" { " of TNT" } else { "" };
    format!("{} {unit}{}{of}", plain((value / digit).round() * digit), PER[axes - 1])
}

fn detonate(ui: &mut Ui, view: &mut View) {
    let per = PER[view.scene.domain.axes() - 1];
    if view.dimension() == 1 {
        ui.label(RichText::new("needs a picture of a plane or of space").color(theme::FAINT));
        return;
    }
    let (blast, air) = (&mut view.panel.blast, AIR.contains(&view.scene.gas.ambient.pressure));
    if air {
        ui.checkbox(&mut blast.by_mass, "TNT by mass").on_hover_text("for scenes in kg, m and s");
    }
    rows(ui, "blast", |ui| {
        let [energy, mass] = blast.first;
        if blast.by_mass {
            ui.label("TNT");
            amount_of(ui, &mut blast.mass, mass, &format!("kg{per}"));
            ui.end_row();
            return;
        }
        ui.label("energy");
        amount_of(ui, &mut blast.energy, energy, &format!("J{per}"));
        ui.end_row();
        ui.label("radius");
        ui.add(positive(&mut blast.radius, "m"));
        ui.end_row();
    });
    ui.checkbox(&mut view.panel.detonates, "a click detonates").on_hover_text("Ctrl+click always does");
}

/// What sliders of a blast reach, over what it is at first.
const REACH: [f64; 2] = [1e-2, 1e3];

/// A slider from a hundredth to a thousand times the first value, and the number, which may be typed and lie beyond.
fn amount_of(ui: &mut Ui, value: &mut f64, first: f64, unit: &str) {
    ui.horizontal(|ui| {
        let mut share = *value / first;
        let slider = Slider::new(&mut share, REACH[0]..=REACH[1]).logarithmic(true).show_value(false);
        if ui.add(slider.clamping(egui::SliderClamping::Never)).changed() {
            // three digits are enough
            let digit = 10.0_f64.powf((share * first).log10().floor() - 2.0);
            *value = (share * first / digit).round() * digit;
        }
        ui.add(positive(value, unit));
    });
}

fn times(ui: &mut Ui, view: &mut View, status: &Status) {
    rows(ui, "times", |ui| {
        for (name, seconds) in [("step", status.step_seconds), ("picture", status.picture_seconds)] {
            ui.label(name);
            ui.monospace(format!("{:9.2} ms", 1e3 * seconds));
            ui.end_row();
        }
    });
    if ui.checkbox(&mut view.panel.measures, "measure the stages now and then").changed() {
        view.commands.push(Command::Measure(view.panel.measures));
    }
    if !view.panel.measures {
        return;
    }
    if view.stages.is_empty() {
        ui.label(RichText::new("nothing yet: run the scene; some devices have no timestamps").color(theme::FAINT));
    }
    let total: f64 = view.stages.iter().map(|(_, time)| time).sum();
    rows(ui, "stages", |ui| {
        for (stage, time) in &view.stages {
            ui.label(RichText::new(stage).small());
            ui.monospace(format!("{time:9.2} ms {:3.0} %", 100.0 * time / total.max(1e-9)));
            ui.end_row();
        }
    });
}

fn about(ui: &mut Ui, view: &mut View) {
    let scene = Arc::clone(&view.scene);
    ui.label(RichText::new(&scene.title).strong());
    if !scene.description.is_empty() {
        ui.label(&scene.description);
    }
    let from = view
        .opened
        .request
        .file()
        .map_or_else(|| "shipped with the program".to_owned(), |file| file.display().to_string());
    if ui.button("save as scene").on_hover_text("a file with what is set here: look, camera, parameters").clicked() {
        view.commands.push(Command::SaveScene);
    }
    rows(ui, "about", |ui| {
        let lines = [
            ("file", from),
            ("cells", scene.domain.cell_count().to_string()),
            ("particles", view.opened.particles.to_string()),
            ("bodies", scene.bodies.len().to_string()),
            ("end", format!("{} s", scene.time.until)),
            ("device", view.opened.device.clone()),
        ];
        for (name, value) in lines {
            ui.label(RichText::new(name).color(theme::FAINT));
            ui.add(egui::Label::new(value).wrap());
            ui.end_row();
        }
    });
}

#[cfg(test)]
mod tests {
    use egui::{Event, Modifiers, PointerButton, Pos2, RawInput};

    use super::*;

    /// Drags whatever of some controls can be dragged, from row to row, until they say that something came of it.
    pub(super) fn drag(mut show: impl FnMut(&mut Ui) -> bool) -> bool {
        let context = egui::Context::default();
        let mut frame = |events: Vec<Event>| {
            let mut done = false;
            // nothing is drawn here
            context.run_ui(RawInput { events, ..RawInput::default() }, |ui| done |= show(ui)).textures_delta.clear();
            done
        };
        frame(Vec::new());
        (0..20u8).map(|row| 4.0 * f32::from(row)).any(|y| {
            let [from, to] = [64.0, 80.0].map(|x| Pos2::new(x, y));
            let press = |pos, pressed| {
                let (button, modifiers) = (PointerButton::Primary, Modifiers::default());
                Event::PointerButton { pos, button, pressed, modifiers }
            };
            let hand = [Event::PointerMoved(from), press(from, true), Event::PointerMoved(to), press(to, false)];
            hand.map(|event| frame(vec![event])).contains(&true)
        })
    }

    #[test]
    fn the_slider_of_the_charge_is_what_goes_off() {
        let scene = Scene::find("playground_2d", &[]).unwrap();
        for by_mass in [false, true] {
            let mut blast = Numbers { by_mass, ..Numbers::of(&scene) };
            let (before, [energy, mass]) = (blast.source(), blast.first);
            assert!(drag(|ui| {
                if by_mass {
                    amount_of(ui, &mut blast.mass, mass, "kg");
                } else {
                    amount_of(ui, &mut blast.energy, energy, "J");
                }
                blast.source() != before
            }));
            match (blast.source(), before) {
                (Source::Energy(now, radius), Source::Energy(was, same)) => assert!(now > 2.0 * was && radius == same),
                (Source::Tnt(now), Source::Tnt(was)) => assert!(now > 2.0 * was),
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn numbers_are_short() {
        let short = |value: f64| short(value, 0..=3);
        assert_eq!((short(0.5), short(1234.5), short(0.0)), ("0.5".into(), "1234.5".into(), "0".into()));
        assert_eq!((short(1.5e6), short(2e-5)), ("1.5e6".into(), "2e-5".into()));
        assert_eq!(short(100.0), "100");
    }

    #[test]
    fn the_first_blast_suits_every_scene() {
        for shipped in crate::scene::shipped() {
            let scene = Scene::find(&shipped.path, &[]).unwrap();
            let numbers = Numbers::of(&scene);
            assert!(numbers.energy > 0.0 && numbers.energy.is_finite(), "{}: {numbers:?}", shipped.name);
            assert!(numbers.radius > scene.domain.spacing(), "{}: {numbers:?}", shipped.name);
        }
    }
}
