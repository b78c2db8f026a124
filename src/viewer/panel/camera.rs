//! The camera: sides to look from, and its numbers as the lines of a scene file.

use egui::{TextEdit, TextStyle, Ui};

use super::super::camera;
use super::super::view::View;

/// A name, a direction to look along, and which way is up.
type Side = (&'static str, [f64; 3], [f64; 3]);

/// Directions to look along.
const SIDES: [Side; 6] = [
    ("front", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
    ("back", [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
    ("left", [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ("right", [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ("top", [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
    ("below", [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
];

/// Shows the controls.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    let Some(now) = view.camera() else { return };
    if view.dimension() == 3 {
        ui.horizontal_wrapped(|ui| {
            for (name, towards, up) in SIDES {
                if ui.button(name).clicked() {
                    view.set_camera(camera::from_side(&now, towards, up));
                }
            }
        });
        let mut parallel = view.is_parallel();
        if ui.checkbox(&mut parallel, "parallel view").on_hover_text("O").changed() {
            view.set_parallel(parallel);
        }
    }
    if ui.button("fit everything").on_hover_text("F").clicked() {
        view.fit();
    }
    let mut text = camera::as_scene_text(&now);
    if ui.button("copy as scene text").clicked() {
        super::super::clipboard::copy(&text);
    }
    ui.add(TextEdit::multiline(&mut text).font(TextStyle::Monospace).desired_rows(4).desired_width(f32::INFINITY));
}
