//! The help overlay: keys and mouse.

use egui::{Align2, Context, Grid, RichText, Ui, Window};

use super::keys::{HELP, MOUSE};
use super::theme;

/// Shows it.
pub(super) fn show(context: &Context, open: &mut bool) {
    let window = Window::new("Keys and mouse").open(open).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_CENTER, [0.0; 2]).show(context, |ui| {
        ui.horizontal_top(|ui| {
            table(ui, "keys", &HELP);
            ui.add_space(12.0);
            table(ui, "mouse", &MOUSE);
        });
    });
}

fn table(ui: &mut Ui, name: &str, rows: &[(&str, &str)]) {
    Grid::new(name).num_columns(2).spacing([14.0, 6.0]).show(ui, |ui| {
        for (key, meaning) in rows {
            ui.label(RichText::new(*key).strong().color(theme::ACCENT));
            ui.label(meaning.replace("; ", "\n"));
            ui.end_row();
        }
    });
}
