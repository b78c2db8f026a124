//! The bars above and below the picture: title and device, transport and clock.

use egui::{Align, Layout, ProgressBar, RichText, Sense, Ui};

use super::keys::Action;
use super::model::{Pace, Phase, Request, Status};
use super::theme;
use super::view::View;
use crate::math::plain;

/// Least width of a button.
const BUTTON: f32 = 58.0;

/// Choices of the pace: what the whole run takes at least \[s\].
const PACES: [f64; 5] = [3.0, 6.0, 12.0, 30.0, 120.0];

/// Title, device, help; what was asked for.
pub(super) fn top(ui: &mut Ui, view: Option<&View>, request: Option<&Request>) -> Vec<Action> {
    let mut asked = Vec::new();
    ui.horizontal(|ui| {
        if ui.button("< Gallery").on_hover_text("Esc").clicked() {
            asked.push(Action::Back);
        }
        let title = view.map_or_else(|| request.map_or("", |request| &request.name), |view| &view.scene.title);
        ui.label(RichText::new(title).strong());
        let changes = request.map(|request| request.changes.words().join(", ")).unwrap_or_default();
        ui.label(RichText::new(changes).color(theme::FAINT));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for (text, key, action) in [("Help", "H", Action::Help), ("Panel", "P", Action::Panel)] {
                if ui.button(text).on_hover_text(key).clicked() {
                    asked.push(action);
                }
            }
            if let Some(view) = view {
                ui.add(egui::Label::new(RichText::new(about(view)).small().color(theme::FAINT)).truncate());
            }
        });
    });
    asked
}

/// Cells, particles, device.
fn about(view: &View) -> String {
    let domain = &view.scene.domain;
    let cells = domain.cells.map(|n| n.to_string())[..domain.axes()].join(" x ");
    let particles = match view.opened.particles {
        0 => String::new(),
        count => format!(", {count} particles"),
    };
    let software = if view.opened.software { " (software: slower than a GPU)" } else { "" };
    format!("{cells} cells{particles} on {}{software}", view.opened.device)
}

/// Buttons, clock, pace; what was asked for.
pub(super) fn bottom(ui: &mut Ui, view: Option<&mut View>, status: &Status) -> Vec<Action> {
    let mut asked = Vec::new();
    ui.add_space(3.0);
    ui.horizontal(|ui| {
        let play = if status.playing { "Pause" } else { "Play" };
        let record = if status.recorded.is_some() { "Stop" } else { "Record" };
        let buttons = [
            (play, "Space", Action::Play),
            ("Go on", "G: simulates from here", Action::GoOn),
            ("Step", "Right", Action::Step(1)),
            ("Restart", "R", Action::Restart),
            ("Fit", "F", Action::Fit),
            ("Save picture", "S", Action::Screenshot),
            (record, "V", Action::Record),
        ];
        let ready = status.phase == Phase::Ready;
        for (text, key, action) in buttons.into_iter().filter(|(_, _, action)| *action != Action::GoOn || status.replay)
        {
            let enabled = ready || action == Action::Restart;
            // What changes its word keeps its size.
            let button = egui::Button::new(text).min_size(egui::vec2(BUTTON, 0.0));
            if ui.add_enabled(enabled, button).on_hover_text(key).clicked() {
                asked.push(action);
            }
        }
        if let Some(view) = view {
            pace(ui, view);
            asked.extend(clock(ui, view, status));
        }
    });
    ui.add_space(1.0);
    asked
}

/// How fast simulated time may pass.
fn pace(ui: &mut Ui, view: &mut View) {
    let name = |pace: Pace| match pace {
        Pace::Fastest => "full speed".to_owned(),
        Pace::Lasting(seconds) => format!("run in {} s", plain(seconds)),
    };
    let before = view.pace;
    let mut now = before;
    egui::ComboBox::from_id_salt("pace").selected_text(name(now)).width(104.0).show_ui(ui, |ui| {
        ui.selectable_value(&mut now, Pace::Fastest, name(Pace::Fastest));
        for seconds in PACES {
            ui.selectable_value(&mut now, Pace::Lasting(seconds), name(Pace::Lasting(seconds)));
        }
    });
    if now != before {
        view.set_pace(now);
    }
}

/// Time, rate, warnings and the time line; where it was dragged to.
fn clock(ui: &mut Ui, view: &View, status: &Status) -> Option<Action> {
    let until = view.scene.time.until;
    let rate = match status.steps_per_second {
        rate if rate > 0.0 => format!("{rate:.1} steps/s"),
        _ if status.phase == Phase::Failed => "stopped".to_owned(),
        _ if status.replay && status.playing => "playing".to_owned(),
        _ if status.replay => "Space plays, G goes on".to_owned(),
        _ if status.finished => "end; Space goes on".to_owned(),
        _ if status.playing && status.step == 0 => "starting".to_owned(),
        _ if status.playing => "running".to_owned(),
        _ => "paused".to_owned(),
    };
    let recorded = status.recorded.map_or_else(String::new, |count| {
        format!("   recording: {count} {}", if count == 1 { "picture" } else { "pictures" })
    });
    // The letters have one width: what stands before the clock does not move.
    let time = format!("{} s", plain(status.time));
    let text = format!("t = {time:<12}   step {:<6}   {rate:<13}{recorded}", status.step);
    let mut asked = None;
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.label(RichText::new(text).monospace());
        if !status.warnings.is_empty() {
            let mark = RichText::new(warning_mark(status.warnings.len())).strong().color(theme::WRONG);
            ui.label(mark).on_hover_text(status.warnings.join("\n"));
        }
        let width = ui.available_width() - 8.0;
        if width > 40.0 {
            asked = time_line(ui, until, status, width);
        }
    });
    asked
}

/// The time line, with a mark for each state that is kept; where it was dragged to.
fn time_line(ui: &mut Ui, until: f64, status: &Status, width: f32) -> Option<Action> {
    let share = (status.time / until).clamp(0.0, 1.0) as f32;
    let bar = ui.add(ProgressBar::new(share).desired_width(width).desired_height(8.0).fill(theme::ACCENT));
    for time in &status.kept {
        let x = bar.rect.left() + bar.rect.width() * (time / until).clamp(0.0, 1.0) as f32;
        ui.painter().vline(x, bar.rect.y_range(), egui::Stroke::new(1.0, theme::FAINT));
    }
    let place = bar.rect.expand2(egui::vec2(0.0, 4.0));
    let line = ui.interact(place, ui.scope_id().with("time line"), Sense::click_and_drag());
    let line = line.on_hover_text("drag: back to a state that is kept; from there the scene goes on");
    let pointer = line.interact_pointer_pos().filter(|_| line.dragged() || line.clicked())?;
    let share = f64::from((pointer.x - bar.rect.left()) / bar.rect.width().max(1.0));
    Some(Action::Rewind(share.clamp(0.0, 1.0) * until))
}

/// The mark of a run whose result is not to be trusted.
fn warning_mark(count: usize) -> String {
    if count == 1 { "1 warning".to_owned() } else { format!("{count} warnings") }
}

#[cfg(test)]
mod tests {
    use egui::{Event, Modifiers, PointerButton, Pos2, RawInput, Rect, vec2};

    use super::*;

    /// What the time line of a run of two seconds asks for in a frame, and where it lies.
    fn frame(context: &egui::Context, events: Vec<Event>) -> (Option<Action>, Rect) {
        let status = Status { time: 1.5, kept: vec![0.0, 0.5, 1.0], ..Status::default() };
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(600.0, 100.0)));
        let mut seen = (None, Rect::NOTHING);
        let draw = |ui: &mut Ui| {
            let place = Rect::from_min_size(ui.cursor().min, vec2(400.0, 8.0));
            seen = (time_line(ui, 2.0, &status, 400.0), place);
        };
        context.run_ui(RawInput { events, screen_rect, ..RawInput::default() }, draw).textures_delta.clear();
        seen
    }

    #[test]
    fn the_time_line_is_dragged_back() {
        let context = egui::Context::default();
        let (asked, place) = frame(&context, Vec::new());
        assert!(asked.is_none());
        let at = |share: f32| Pos2::new(place.left() + share * place.width(), place.center().y);
        let button = |pos: Pos2, pressed: bool| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        frame(&context, vec![Event::PointerMoved(at(0.75))]);
        frame(&context, vec![button(at(0.75), true)]);
        frame(&context, vec![Event::PointerMoved(at(0.6))]);
        let (asked, _) = frame(&context, vec![Event::PointerMoved(at(0.25))]);
        let Some(Action::Rewind(time)) = asked else { panic!("{asked:?}") };
        assert!((time - 0.5).abs() < 1e-3, "{time}");
        let (asked, _) = frame(&context, vec![Event::PointerMoved(at(-0.5))]);
        assert!(matches!(asked, Some(Action::Rewind(0.0))), "{asked:?}");
        frame(&context, vec![button(at(0.25), false)]);
        assert!(frame(&context, Vec::new()).0.is_none());
    }
}
