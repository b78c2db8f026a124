//! What the mouse does to the picture and to what it shows.

use egui::{Event, Pos2, Rect, Response, Ui};

use super::{Command, POINTS_PER_NOTCH, Strike, View, amount, camera, theme};

impl View {
    /// Hears the mouse over the picture.
    pub(super) fn mouse(&mut self, ui: &Ui, response: &Response, place: Rect) {
        let (modifiers, scroll) = ui.input(|input| (input.modifiers, input.smooth_scroll_delta.y));
        let height = f64::from(place.height().max(1.0));
        let struck = modifiers.command || clicked_with_command(ui) || self.panel.detonates;
        self.commands.extend(self.grab.hear(ui, response, place, !struck));
        self.grab.paint(ui, place, self.held);
        if self.dimension() > 1 {
            let adds = self.add(ui, response, place, !struck && !modifiers.shift);
            let may = !struck && !modifiers.shift && !adds;
            self.commands.extend(self.click.hear(ui, response, place, may));
        }
        if response.dragged() && !struck && !self.grab.holds() {
            let delta = response.drag_delta();
            let drag = [f64::from(delta.x) / height, f64::from(delta.y) / height];
            if drag != [0.0; 2] {
                let turns = response.dragged_by(egui::PointerButton::Primary) && !modifiers.shift;
                if turns && self.dimension() == 3 {
                    self.move_camera(|camera| camera::orbit(camera, drag));
                } else {
                    self.move_camera(|camera| camera::pan(camera, drag));
                }
            }
        }
        let Some(pointer) = response.hover_pos() else { return };
        let middle = place.center();
        if response.hovered() && scroll != 0.0 {
            let at = [f64::from(pointer.x - middle.x) / height, f64::from(pointer.y - middle.y) / height];
            let notches = f64::from(scroll / POINTS_PER_NOTCH);
            self.move_camera(|camera| camera::zoom(camera, notches, at));
        }
        if response.double_clicked() && !struck && !self.panel.adding.armed {
            self.fit();
        }
        self.detonate(ui, response, place, struck.then_some(pointer));
        if struck && response.hovered() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
        }
    }

    /// Adds the body of the panel where a click is, if clicks do that; whether they do.
    fn add(&mut self, ui: &Ui, response: &Response, place: Rect, may: bool) -> bool {
        let adds = may && self.panel.adding.armed;
        if adds && response.hovered() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Copy);
        }
        if let (true, true, Some(pointer)) = (adds, response.clicked(), response.interact_pointer_pos()) {
            let share = (pointer - place.min) / place.size();
            let next = Box::new(self.panel.adding.next.clone());
            self.commands.push(Command::Add([f64::from(share.x), f64::from(share.y)], next));
        }
        adds
    }

    /// Charges a blast while the button is held over a place, and sets it off where it is let go.
    fn detonate(&mut self, ui: &Ui, response: &Response, place: Rect, struck: Option<Pos2>) {
        let (pressed, released) = ui.input(|input| (input.pointer.primary_pressed(), input.pointer.primary_released()));
        if pressed && struck.is_some() && response.contains_pointer() {
            self.charge.begin();
        }
        let source = self.panel.blast.source();
        if let (Some(grown), Some(pointer)) = (self.charge.now().filter(|grown| *grown > 1.0), response.hover_pos()) {
            let text = amount(source.times(grown), self.scene.domain.axes());
            theme::tag(ui, pointer, &text);
        }
        if self.charge.now().is_some() {
            ui.ctx().request_repaint();
        }
        // Press and release may come in one frame, and Ctrl may be up by then.
        let grown = if released { self.charge.end() } else { None };
        let clicked = struck.filter(|_| response.clicked()).map(|_| 1.0);
        if let (Some(grown), Some(pointer)) = (grown.or(clicked), response.hover_pos()) {
            let share = (pointer - place.min) / place.size();
            let at = [f64::from(share.x), f64::from(share.y)];
            self.commands.push(Command::Detonate(Strike { at, source: source.times(grown) }));
        }
    }
}

/// Whether Ctrl was held at a click of this frame; it may be up again by now.
fn clicked_with_command(ui: &Ui) -> bool {
    ui.input(|input| {
        let held = |event: &Event| matches!(event, Event::PointerButton { modifiers, .. } if modifiers.command);
        input.events.iter().any(held)
    })
}
