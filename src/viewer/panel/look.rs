//! What pictures show of the gas: field, range, colours, volume.

use egui::{ComboBox, DragValue, Slider, Ui};

use super::super::view::View;
use super::{curve, rows, short};
use crate::render::{caption, symbol};
use crate::scene::{Colormap, Emission, Field, RenderMode, RenderSettings, ToneMap};

/// Colour maps with their names.
pub(super) const COLORMAPS: [(Colormap, &str); 7] = [
    (Colormap::Viridis, "viridis"),
    (Colormap::Inferno, "inferno"),
    (Colormap::Magma, "magma"),
    (Colormap::Plasma, "plasma"),
    (Colormap::Cividis, "cividis"),
    (Colormap::Gray, "gray"),
    (Colormap::RedBlue, "blue and red"),
];

/// Ways to see a volume, with their names.
const MODES: [(RenderMode, &str); 4] = [
    (RenderMode::Schlieren, "gradient of density"),
    (RenderMode::Density, "density"),
    (RenderMode::LineOfSight, "schlieren camera"),
    (RenderMode::Shadowgraph, "shadowgraph"),
];

/// Where the ends of the colour bar come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Range {
    /// The values of each picture.
    Automatic,
    /// The values of one picture, kept.
    Frozen,
    /// Typed in.
    Typed,
}

impl Range {
    pub(super) fn of(settings: &RenderSettings) -> Self {
        if settings.range.is_some() { Self::Typed } else { Self::Automatic }
    }
}

/// Width of a choice.
pub(super) const WIDTH: f32 = 172.0;

/// One of a list.
pub(super) fn choice<T: Copy + PartialEq>(ui: &mut Ui, id: &str, value: &mut T, choices: &[(T, &str)]) {
    let name = choices.iter().find(|(own, _)| own == value).map_or("", |(_, name)| name);
    ComboBox::from_id_salt(id).selected_text(name).width(WIDTH).show_ui(ui, |ui| {
        for (own, name) in choices {
            ui.selectable_value(value, *own, *name);
        }
    });
}

/// Shows the controls.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    rows(ui, "look", |ui| {
        ui.label("field");
        field(ui, &mut view.look.field);
        ui.end_row();
        if view.dimension() > 1 {
            ui.label("colours");
            if view.dimension() == 2 && view.look.field == Field::Schlieren {
                ui.label("dark where density changes").on_hover_text("gradients in a plane have greys of their own");
            } else {
                choice(ui, "colours", &mut view.look.settings.colormap, &COLORMAPS);
            }
            ui.end_row();
        }
        range(ui, view);
    });
    if ui.button("as in the scene file").clicked() {
        view.reset_look();
        view.panel.range = Range::of(&view.look.settings);
    }
}

fn field(ui: &mut Ui, field: &mut Field) {
    ComboBox::from_id_salt("field").selected_text(caption(*field)).width(WIDTH).show_ui(ui, |ui| {
        for (number, own) in Field::ALL.into_iter().enumerate() {
            ui.selectable_value(field, own, caption(own)).on_hover_text(format!("{}; key {}", symbol(own), number + 1));
        }
    });
}

fn range(ui: &mut Ui, view: &mut View) {
    ui.label("range");
    let before = view.panel.range;
    let now = &mut view.panel.range;
    ui.horizontal(|ui| {
        ui.selectable_value(now, Range::Automatic, "auto").on_hover_text("the values of each picture");
        ui.selectable_value(now, Range::Frozen, "frozen").on_hover_text("the values of this picture, kept");
        ui.selectable_value(now, Range::Typed, "typed");
    });
    ui.end_row();
    let shown = view.shown.as_ref().map(|shown| shown.picture.range);
    let now = view.panel.range;
    if now != before {
        view.look.settings.range = if now == Range::Automatic { None } else { view.look.settings.range.or(shown) };
    }
    ui.label("");
    let mut values = view.look.settings.range.or(shown).unwrap_or([0.0, 1.0]);
    let speed = 0.005 * (values[1] - values[0]).abs().max(1e-12);
    ui.horizontal(|ui| {
        for value in &mut values {
            let number = DragValue::new(value).speed(speed).custom_formatter(short);
            ui.add_enabled(now == Range::Typed, number);
        }
    });
    if now == Range::Typed {
        view.look.settings.range = Some(values);
    }
    ui.end_row();
}

/// How a volume is seen: mode, opacity, light of hot gas.
pub(super) fn volume(ui: &mut Ui, view: &mut View) {
    let table = view.shown.as_ref().map(|shown| shown.look.settings.colormap);
    let settings = &mut view.look.settings;
    rows(ui, "volume", |ui| {
        ui.label("seen as");
        choice(ui, "mode", &mut settings.mode, &MODES);
        ui.end_row();
    });
    ui.checkbox(&mut settings.volume, "draw the gas");
    let mut own = !settings.opacity.is_empty();
    if ui.checkbox(&mut own, "opacity by a curve").on_hover_text("else by the distance from the ambient gas").changed()
    {
        settings.opacity = if own { vec![[0.0, 0.0], [0.3, 0.05], [1.0, 1.0]] } else { Vec::new() };
    }
    if own {
        curve::show(ui, &mut settings.opacity, table.unwrap_or_default());
    }
    let mut deep = settings.optical_depth.is_some();
    ui.horizontal(|ui| {
        if ui.checkbox(&mut deep, "optical depth").changed() {
            settings.optical_depth = deep.then_some(14.0);
        }
        if let Some(depth) = &mut settings.optical_depth {
            ui.add(Slider::new(depth, 0.1..=1000.0).logarithmic(true));
        }
    });
    let mut glows = settings.emission.is_some();
    if ui.checkbox(&mut glows, "hot gas shines").changed() {
        settings.emission = glows.then(Emission::default);
        settings.tone = if glows { ToneMap::Aces } else { ToneMap::None };
    }
    if let Some(emission) = &mut settings.emission {
        rows(ui, "emission", |ui| {
            ui.label("ambient");
            ui.add(DragValue::new(&mut emission.ambient_kelvin).speed(5.0).range(1.0..=1e5).suffix(" K"));
            ui.end_row();
            ui.label("strength");
            ui.add(DragValue::new(&mut emission.strength).speed(0.02).range(0.0..=1e3));
            ui.end_row();
            ui.label("depth");
            ui.add(DragValue::new(&mut emission.optical_depth).speed(0.2).range(0.01..=1e4));
            ui.end_row();
        });
    }
}
