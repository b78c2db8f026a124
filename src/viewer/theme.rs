//! How the user interface looks: the colours of the pictures' own frame.

use egui::{Color32, CornerRadius, FontId, Stroke, TextStyle, Vec2, Visuals};

/// Behind everything, as in the pictures.
pub(super) const BACKGROUND: Color32 = Color32::from_rgb(14, 17, 22);
/// Panels.
const PANEL: Color32 = Color32::from_rgb(21, 25, 32);
/// Fields to type into, plots.
const DEEP: Color32 = Color32::from_rgb(10, 12, 16);
/// Buttons.
const BUTTON: Color32 = Color32::from_rgb(36, 42, 53);
/// Letters.
const INK: Color32 = Color32::from_rgb(222, 226, 232);
/// Less important letters.
pub(super) const FAINT: Color32 = Color32::from_rgb(138, 146, 160);
/// What is chosen or under way.
pub(super) const ACCENT: Color32 = Color32::from_rgb(242, 140, 60);
/// What went wrong.
pub(super) const WRONG: Color32 = Color32::from_rgb(240, 110, 100);

/// Sets colours, spacing and sizes of letters.
pub(super) fn apply(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    let mut visuals = Visuals::dark();
    visuals.panel_fill = PANEL;
    visuals.window_fill = PANEL;
    visuals.extreme_bg_color = DEEP;
    visuals.faint_bg_color = Color32::from_rgb(26, 31, 39);
    visuals.selection.bg_fill = Color32::from_rgb(120, 66, 24);
    visuals.selection.stroke = Stroke::new(1.0, Color32::WHITE);
    visuals.hyperlink_color = ACCENT;
    visuals.window_stroke = Stroke::new(1.0, BUTTON);
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.fg_stroke.color = INK;
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, Color32::from_rgb(40, 46, 57));
    widgets.inactive.fg_stroke.color = INK;
    widgets.inactive.weak_bg_fill = BUTTON;
    widgets.inactive.bg_fill = BUTTON;
    for widget in [&mut widgets.noninteractive, &mut widgets.inactive, &mut widgets.hovered, &mut widgets.active] {
        widget.corner_radius = CornerRadius::same(4);
    }
    context.set_visuals(visuals);
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = Vec2::new(8.0, 6.0);
        style.spacing.button_padding = Vec2::new(8.0, 3.0);
        style.spacing.slider_width = 130.0;
        style.interaction.selectable_labels = false;
        let sizes =
            [(TextStyle::Heading, 19.0), (TextStyle::Body, 13.5), (TextStyle::Button, 13.5), (TextStyle::Small, 11.5)];
        for (text, size) in sizes {
            style.text_styles.insert(text, FontId::proportional(size));
        }
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(12.5));
    });
}

/// A text beside the pointer.
pub(super) fn tag(ui: &egui::Ui, pointer: egui::Pos2, text: &str) {
    let visuals = ui.visuals();
    let text = ui.painter().layout_no_wrap(text.to_owned(), FontId::proportional(14.0), visuals.strong_text_color());
    let border = Vec2::new(8.0, 5.0);
    let room = ui.clip_rect().shrink2(border);
    let corner = (pointer + Vec2::new(18.0, 16.0)).min(room.max - text.size()).max(room.min);
    let around = egui::Rect::from_min_size(corner, text.size()).expand2(border);
    let stroke = visuals.window_stroke;
    ui.painter().rect(around, 4.0, visuals.window_fill, stroke, egui::StrokeKind::Inside);
    ui.painter().galley(corner, text, visuals.strong_text_color());
}
