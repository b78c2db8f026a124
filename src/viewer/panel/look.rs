//! What pictures show: field, range, colours, particles.

use egui::{ComboBox, DragValue, Ui};

use super::super::view::View;
use super::{rows, short};
use crate::render::caption;
use crate::scene::{Colormap, Field, RenderMode, RenderSettings};

/// Colour maps with their names.
const COLORMAPS: [(Colormap, &str); 6] = [
    (Colormap::Viridis, "viridis"),
    (Colormap::Inferno, "inferno"),
    (Colormap::Magma, "magma"),
    (Colormap::Plasma, "plasma"),
    (Colormap::Cividis, "cividis"),
    (Colormap::Gray, "gray"),
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

/// Shows the controls.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    rows(ui, "look", |ui| {
        ui.label("field");
        field(ui, &mut view.look.field);
        ui.end_row();
        if view.dimension() > 1 {
            colors(ui, view);
        }
        range(ui, view);
        if view.dimension() == 3 {
            ui.label("volume");
            let mode = &mut view.look.settings.mode;
            ui.horizontal(|ui| {
                ui.selectable_value(mode, RenderMode::Schlieren, "schlieren")
                    .on_hover_text("shades of the density gradient");
                ui.selectable_value(mode, RenderMode::Density, "density")
                    .on_hover_text("density through the colour map");
            });
            ui.end_row();
        }
    });
    if !view.scene.bodies.is_empty() {
        ui.checkbox(&mut view.look.settings.particles, "particles");
    }
    if ui.button("as in the scene file").clicked() {
        view.reset_look();
        view.panel.range = Range::of(&view.look.settings);
    }
}

fn field(ui: &mut Ui, field: &mut Field) {
    ComboBox::from_id_salt("field").selected_text(caption(*field)).width(170.0).show_ui(ui, |ui| {
        for (number, choice) in Field::ALL.into_iter().enumerate() {
            ui.selectable_value(field, choice, caption(choice)).on_hover_text(format!("key {}", number + 1));
        }
    });
}

fn colors(ui: &mut Ui, view: &mut View) {
    ui.label("colours");
    let chosen = &mut view.look.settings.colormap;
    let name = |map: Colormap| COLORMAPS.iter().find(|(own, _)| *own == map).map_or("", |(_, name)| name);
    ComboBox::from_id_salt("colours").selected_text(name(*chosen)).width(170.0).show_ui(ui, |ui| {
        for (map, name) in COLORMAPS {
            ui.selectable_value(chosen, map, name);
        }
    });
    ui.end_row();
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
