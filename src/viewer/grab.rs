//! Bodies that are pushed and thrown: Shift and the left button hold one, the pointer leads it.

use egui::{Color32, Event, PointerButton, Pos2, Rect, Response, Stroke, Ui};

use super::model::Command;
use super::theme;

/// What the button holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Held {
    #[default]
    Nothing,
    /// The worker is asked what lies there.
    Asked,
    Body,
    /// No body lay there: the drag means the camera.
    NoBody,
}

/// A button that holds a body, and where it was led to last.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Grab(Held, [f64; 2]);

impl Grab {
    /// Whether a drag means a body and not the camera.
    pub(super) fn holds(self) -> bool {
        matches!(self.0, Held::Asked | Held::Body)
    }

    /// The worker says whether there was a body.
    pub(super) fn answer(&mut self, found: Option<bool>) {
        if let (Some(found), Held::Asked) = (found, self.0) {
            self.0 = if found { Held::Body } else { Held::NoBody };
        }
    }

    /// Hears the mouse over a picture; `may` where another button or key does not mean something else.
    pub(super) fn hear(&mut self, ui: &Ui, response: &Response, place: Rect, may: bool) -> Vec<Command> {
        let (pressed, released, down, pointer) = ui.input(|input| {
            let mouse = &input.pointer;
            (mouse.primary_pressed(), mouse.primary_released(), mouse.primary_down(), mouse.latest_pos())
        });
        let Some(pointer) = pointer else { return Vec::new() };
        let share = (pointer - place.min) / place.size();
        let at = [share.x, share.y].map(|part| f64::from(part.clamp(0.0, 1.0)));
        let mut commands = Vec::new();

        if pressed_with_shift(ui) && may && response.contains_pointer() {
            *self = Self(Held::Asked, at);
            commands.push(Command::Hold(at));
        }
        if self.holds() && at != self.1 {
            self.1 = at;
            commands.push(Command::Lead(at));
        }
        if released || !(down || pressed) {
            if self.holds() {
                commands.push(Command::LetGo);
            }
            self.0 = Held::Nothing;
        }
        if self.holds() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
        }
        commands
    }

    /// Draws an arrow from where the body is held to the pointer.
    pub(super) fn paint(self, ui: &Ui, place: Rect, held: Option<[f64; 2]>) {
        let (Held::Body, Some(held)) = (self.0, held) else { return };
        let on = |at: [f64; 2]| place.min + place.size() * egui::vec2(at[0] as f32, at[1] as f32);
        let (from, to) = (on(held), on(self.1));
        for (width, color) in [(5.0, Color32::from_black_alpha(140)), (2.5, theme::ACCENT)] {
            arrow(ui, from, to, Stroke::new(width, color));
        }
    }
}

/// Whether Shift was held where the left button went down in this frame; it may be up again by now.
fn pressed_with_shift(ui: &Ui) -> bool {
    ui.input(|input| {
        let with_shift = |event: &Event| match event {
            Event::PointerButton { pressed, button, modifiers, .. } => {
                *pressed && *button == PointerButton::Primary && modifiers.shift
            }
            _ => false,
        };
        input.events.iter().any(with_shift)
    })
}

/// An arrow with a dot at its foot.
fn arrow(ui: &Ui, from: Pos2, to: Pos2, stroke: Stroke) {
    let painter = ui.painter();
    painter.circle_filled(from, 2.0 * stroke.width.min(3.0), stroke.color);
    let way = to - from;
    if way.length() > 8.0 {
        let head = way.normalized() * way.length().min(14.0);
        painter.line_segment([from, to], stroke);
        for side in [-1.0_f32, 1.0] {
            let (sine, cosine) = (side * 2.6).sin_cos();
            let turned = egui::vec2(cosine * head.x - sine * head.y, sine * head.x + cosine * head.y);
            painter.line_segment([to, to + turned], stroke);
        }
    }
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, RawInput, Sense, vec2};

    use super::*;

    /// What a frame with these events asks for.
    fn frame(context: &egui::Context, grab: &mut Grab, events: Vec<Event>) -> Vec<Command> {
        let place = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 200.0));
        let mut asked = Vec::new();
        let input = RawInput { events, screen_rect: Some(place), ..RawInput::default() };
        let draw = |ui: &mut Ui| {
            let response = ui.interact(place, ui.scope_id().with("picture"), Sense::click_and_drag());
            asked = grab.hear(ui, &response, place, true);
            grab.paint(ui, place, Some([0.1, 0.1]));
        };
        context.run_ui(input, draw).textures_delta.clear();
        asked
    }

    #[test]
    fn shift_and_the_button_hold_lead_and_let_go() {
        let (context, mut grab) = (egui::Context::default(), Grab::default());
        let button = |x: f32, pressed: bool, modifiers| Event::PointerButton {
            pos: Pos2::new(x, 100.0),
            button: PointerButton::Primary,
            pressed,
            modifiers,
        };
        let moved = |x: f32| Event::PointerMoved(Pos2::new(x, 100.0));
        let shift = Modifiers::SHIFT;
        frame(&context, &mut grab, vec![moved(100.0)]);
        let plain = frame(&context, &mut grab, vec![button(100.0, true, Modifiers::NONE)]);
        assert!(plain.is_empty() && !grab.holds(), "{plain:?}");
        frame(&context, &mut grab, vec![button(100.0, false, Modifiers::NONE)]);
        let held = frame(&context, &mut grab, vec![button(100.0, true, shift)]);
        assert!(matches!(held[..], [Command::Hold([0.25, 0.5])]) && grab.holds(), "{held:?}");
        grab.answer(Some(true));
        let led = frame(&context, &mut grab, vec![moved(200.0)]);
        assert!(matches!(led[..], [Command::Lead([0.5, 0.5])]), "without Shift, too: {led:?}");
        let gone = frame(&context, &mut grab, vec![button(200.0, false, shift)]);
        assert!(matches!(gone[..], [Command::LetGo]) && !grab.holds(), "{gone:?}");
        frame(&context, &mut grab, vec![button(200.0, true, shift)]);
        grab.answer(Some(false));
        let drag = frame(&context, &mut grab, vec![moved(300.0)]);
        assert!(drag.is_empty() && !grab.holds(), "no body there: the camera moves: {drag:?}");
    }
}
