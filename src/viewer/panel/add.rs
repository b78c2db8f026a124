//! A body to add: what it is, and whether clicks add it.

use egui::{ComboBox, RichText, Ui};

use super::super::adding::{Addition, Form};
use super::super::theme;
use super::super::view::View;
use super::look::WIDTH;
use super::{positive, rows};
use crate::scene::Scene;

/// The next body, and whether a click adds it.
#[derive(Debug)]
pub(in crate::viewer) struct Adding {
    pub(in crate::viewer) next: Addition,
    pub(in crate::viewer) armed: bool,
    /// The scene is to start again without what was added.
    pub(in crate::viewer) clear: bool,
}

impl Adding {
    pub(super) fn of(scene: &Scene) -> Self {
        Self { next: Addition::of(scene), armed: false, clear: false }
    }
}

/// Shows the controls.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    let (scene, adding) = (&view.scene, &mut view.panel.adding);
    let next = &mut adding.next;
    rows(ui, "a body to add", |ui| {
        ui.label("form");
        ui.horizontal(|ui| {
            let names = if scene.domain.axes() == 3 { ["ball", "cube"] } else { ["disc", "square"] };
            for (form, name) in [Form::Ball, Form::Box].into_iter().zip(names) {
                ui.selectable_value(&mut next.form, form, name);
            }
        });
        ui.end_row();
        ui.label("size");
        ui.add(positive(&mut next.size, "m"));
        ui.end_row();
        ui.label("material");
        ComboBox::from_id_salt("material of the next body").selected_text(&next.material).width(WIDTH).show_ui(
            ui,
            |ui| {
                for name in Addition::materials(scene) {
                    ui.selectable_value(&mut next.material, name.clone(), name);
                }
            },
        );
        ui.end_row();
    });
    ui.checkbox(&mut adding.armed, "a click adds it").on_hover_text("at rest, where there is room");
    let text = "What there is goes on. The gas in its place goes. Left takes it back; R starts with it.";
    ui.label(RichText::new(text).small().color(theme::FAINT));
    let added = view.opened.request.added.of(&view.scene).bodies;
    if !added.is_empty() {
        adding.clear = ui.button("start without what was added").clicked();
    }
}
