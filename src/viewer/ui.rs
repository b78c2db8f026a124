//! The user interface: gallery or scene, the bars around it, messages. Keeps the worker's handle; knows nothing of windows.

mod opening;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use egui::{Align2, Event, Panel as EguiPanel, RichText, Ui as EguiUi};

use super::bars;
use super::browse::Browse;
use super::gallery::Gallery;
use super::help;
use super::keys::{Action, action};
use super::model::{Command, Note, Pace, Phase, Request, Status, Weight};
use super::progress;
use super::theme;
use super::view::View;
use super::watch::Watch;
use super::worker::Worker;
use crate::scene::is_mesh_file;
use opening::Asked;

/// How long a message about something that went well stays.
const FADES: Duration = Duration::from_secs(6);
/// A scene's whole run takes at least so long unless the user is in a hurry \[s\].
const PACE: f64 = 12.0;

/// Everything the user sees.
pub(super) struct Ui {
    worker: Worker,
    gallery: Gallery,
    view: Option<View>,
    /// The scene that is open or being opened, or failed to.
    request: Option<Request>,
    watch: Option<Watch>,
    status: Status,
    /// Whether to run, asked for and not heard yet.
    wish: Option<bool>,
    /// Scenes that the worker is to open and has not answered for; none where nobody waits for it any more.
    asked: VecDeque<Option<Asked>>,
    pace: Pace,
    notes: Vec<(Instant, Note)>,
    help: bool,
    /// What is smaller than the scene that could not be opened.
    offer: Option<Request>,
    path: Option<Browse>,
    quit: bool,
}

impl Ui {
    /// The gallery, or a scene.
    pub(super) fn new(worker: Worker, request: Option<Request>, pace: Option<Pace>) -> Self {
        let mut ui = Self {
            worker,
            gallery: Gallery::new(),
            view: None,
            request: None,
            watch: None,
            status: Status::default(),
            wish: None,
            asked: VecDeque::new(),
            pace: pace.unwrap_or(Pace::Lasting(PACE)),
            notes: Vec::new(),
            help: false,
            offer: None,
            path: None,
            quit: false,
        };
        if let Some(request) = request {
            ui.open(request);
        }
        ui
    }

    /// Steps that the last scene ran, and the seconds that they took.
    pub(super) fn ran(&self) -> (u64, f64) {
        self.status.ran
    }

    /// Whether a scene runs.
    pub(super) fn runs(&self) -> bool {
        self.status.playing
    }

    pub(super) fn wants_to_quit(&self) -> bool {
        self.quit
    }

    /// Title of the window.
    pub(super) fn title(&self) -> String {
        self.view.as_ref().map_or_else(|| "Brisance".to_owned(), |view| format!("{} - Brisance", view.scene.title))
    }

    pub(super) fn forget_textures(&mut self) {
        if let Some(view) = &mut self.view {
            view.forget_texture();
        }
    }

    /// A line for the user.
    pub(super) fn tell(&mut self, text: &str) {
        self.notes.push((Instant::now(), Note { weight: Weight::Fine, text: text.to_owned() }));
    }

    /// Takes what the worker has left.
    pub(super) fn receive(&mut self) {
        let mut outbox = self.worker.take();
        self.status = outbox.status.clone();
        self.keep_wish();
        for note in outbox.notes.drain(..) {
            self.notes.push((Instant::now(), note));
        }
        self.heed(std::mem::take(&mut outbox.answers), outbox.opened.take());
        if let Some(view) = &mut self.view {
            view.receive(outbox);
        }
    }

    /// What was asked for counts until the worker has heard it.
    fn keep_wish(&mut self) {
        match self.wish {
            Some(wish) if wish != self.status.playing && !self.status.finished && self.status.phase == Phase::Ready => {
                self.status.playing = wish;
            }
            _ => self.wish = None,
        }
    }

    fn back(&mut self) {
        if self.help || self.path.is_some() {
            (self.help, self.path) = (false, None);
        } else if self.request.is_some() {
            self.worker.send(Command::Close);
            (self.view, self.request, self.watch) = (None, None, None);
            // what comes of them is closed, too
            self.asked.iter_mut().for_each(|asked| *asked = None);
            self.notes.clear();
        }
    }

    /// One frame.
    pub(super) fn show(&mut self, root: &mut EguiUi) {
        self.receive();
        self.reload_if_saved();
        if self.watch.is_some() {
            root.ctx().request_repaint_after(Watch::period());
        }
        self.dropped(root);
        if self.request.is_none() {
            let chosen = egui::CentralPanel::default().show(root, |ui| self.gallery.show(ui)).inner;
            if let Some(request) = chosen {
                self.open(request);
            }
        } else {
            self.scene(root);
        }
        // After the mouse: what is saved is what was just turned.
        self.keyboard(root);
        self.messages(root);
        self.ask_for_path(root);
        if self.help {
            help::show(root.ctx(), &mut self.help);
        }
        if self.view.as_ref().is_some_and(|view| view.panel.adding.clear) {
            self.restart();
        }
        if self.view.as_mut().is_some_and(|view| std::mem::take(&mut view.panel.adding.browse)) {
            self.path = Some(Browse::new());
        }
        // what is asked of a scene that another one may take the place of waits until that is known
        let waits = self.is_opening();
        if let Some(view) = self.view.as_mut().filter(|_| !waits) {
            self.pace = view.pace;
            for command in view.commands.drain(..) {
                match command {
                    Command::Play(wish) => self.wish = Some(wish),
                    Command::Steps(_) => self.wish = Some(false),
                    _ => {}
                }
                self.worker.send(command);
            }
        }
    }

    fn scene(&mut self, root: &mut EguiUi) {
        let asked =
            EguiPanel::top("top").show(root, |ui| bars::top(ui, self.view.as_ref(), self.request.as_ref())).inner;
        let below =
            EguiPanel::bottom("bottom").show(root, |ui| bars::bottom(ui, self.view.as_mut(), &self.status)).inner;
        if let Some(view) = self.view.as_mut().filter(|view| view.panel.open) {
            let panel = EguiPanel::right("panel").default_size(312.0).size_range(240.0..=520.0);
            panel.show(root, |ui| super::panel::show(ui, view, &self.status));
        }
        let background = egui::Frame::new().fill(theme::BACKGROUND);
        let (opening, mut asked_for) = (self.is_opening(), None);
        egui::CentralPanel::no_frame().frame(background).show(root, |ui| match &mut self.view {
            Some(view) => view.show(ui),
            None if opening => waiting(ui),
            None => {
                ui.add_space(0.7 * ui.available_height());
                let small = self.offer.as_ref();
                ui.vertical_centered(|ui| {
                    asked_for = small.filter(|_| ui.button("open its small size").clicked()).cloned();
                });
            }
        });
        if let Some(small) = asked_for {
            self.open(small);
        }
        if opening && self.view.is_some() {
            let place = egui::Area::new(egui::Id::unique("opening")).anchor(Align2::CENTER_CENTER, [0.0; 2]);
            place.show(root.ctx(), |ui| egui::Frame::popup(ui.style()).show(ui, waiting));
        }
        for action in asked.into_iter().chain(below) {
            self.act(action);
        }
    }

    fn act(&mut self, action: Action) {
        match action {
            Action::Help => self.help = !self.help,
            Action::Back => self.back(),
            Action::Restart => self.restart(),
            Action::Open => self.path = Some(Browse::new()),
            Action::Quit => self.quit = true,
            _ => {
                if let Some(view) = &mut self.view {
                    view.act(action, &self.status);
                }
            }
        }
    }

    fn keyboard(&mut self, root: &EguiUi) {
        if root.ctx().egui_wants_keyboard_input() {
            return;
        }
        let pressed = root.input(|input| {
            let keys = input.events.iter().filter_map(|event| match event {
                Event::Key { key, pressed: true, modifiers, .. } => action(*key, *modifiers),
                _ => None,
            });
            keys.collect::<Vec<_>>()
        });
        if !pressed.is_empty() {
            root.ctx().request_repaint();
        }
        for action in pressed {
            self.act(action);
        }
    }

    /// A scene or mesh file that was dropped on the window.
    fn dropped(&mut self, root: &EguiUi) {
        let (hovers, dropped) = root.input(|input| {
            let dropped = input.raw.dropped_files.first().map(|file| file.path().to_owned());
            let is_mesh = |file: &egui::HoveredFile| file.path.as_deref().is_some_and(is_mesh_file);
            (input.raw.hovered_files.first().map(is_mesh), dropped)
        });
        if let Some(is_mesh) = hovers {
            let text = if is_mesh { "add this mesh" } else { "open this scene" };
            let place = egui::Area::new(egui::Id::unique("drop")).anchor(Align2::CENTER_CENTER, [0.0; 2]);
            place.show(root.ctx(), |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| ui.label(RichText::new(text).size(20.0)));
            });
        }
        if let Some(path) = dropped {
            self.open_path(&path);
        }
    }

    fn ask_for_path(&mut self, root: &EguiUi) {
        let Some(browse) = &mut self.path else { return };
        if let Some(path) = browse.show(root) {
            self.path = None;
            self.open_path(&path);
        } else if root.input(|input| input.key_pressed(egui::Key::Escape)) {
            self.path = None;
        }
    }

    /// Messages over the picture; those about mistakes stay until they are dismissed.
    fn messages(&mut self, root: &EguiUi) {
        let now = Instant::now();
        self.notes.retain(|(since, note)| note.weight == Weight::Wrong || now - *since < FADES);
        if self.notes.iter().any(|(_, note)| note.weight == Weight::Fine) {
            root.ctx().request_repaint_after(FADES);
        }
        let mut dismissed = None;
        let area = egui::Area::new(egui::Id::unique("messages")).anchor(Align2::LEFT_TOP, [12.0, 62.0]);
        area.show(root.ctx(), |ui| {
            for (index, (_, note)) in self.notes.iter().enumerate() {
                if message(ui, note) {
                    dismissed = Some(index);
                }
            }
        });
        if let Some(index) = dismissed {
            self.notes.remove(index);
        }
    }
}

/// One message; whether it was dismissed.
fn message(ui: &mut EguiUi, note: &Note) -> bool {
    let mut dismissed = false;
    let wrong = note.weight == Weight::Wrong;
    let color = if wrong { theme::WRONG } else { theme::FAINT };
    let frame = egui::Frame::popup(ui.style()).stroke(egui::Stroke::new(1.0, color));
    frame.show(ui, |ui| {
        ui.set_max_width(720.0);
        ui.horizontal_top(|ui| {
            if wrong {
                let scroll = egui::ScrollArea::both().min_scrolled_height(320.0).max_height(320.0).max_width(660.0);
                scroll.show(ui, |ui| mistake(ui, note.text.trim_end()));
                dismissed = ui.button("x").clicked();
            } else {
                ui.label(RichText::new(note.text.trim_end()));
            }
        });
    });
    dismissed
}

/// A mistake line by line: what it says folds, a line of a file stays as it is, above the marks that point into it.
fn mistake(ui: &mut EguiUi, text: &str) {
    ui.set_max_width(650.0);
    ui.spacing_mut().item_spacing.y = 0.0;
    for line in text.lines() {
        let wrap = if is_of_file(line) { egui::TextWrapMode::Extend } else { egui::TextWrapMode::Wrap };
        ui.add(egui::Label::new(RichText::new(line).monospace()).selectable(true).wrap_mode(wrap));
    }
}

/// Whether a line of a message shows a line of a file, or points into one: its number stands before a bar.
fn is_of_file(line: &str) -> bool {
    line.trim_start().trim_start_matches(|c: char| c.is_ascii_digit()).trim_start().starts_with('|')
}

/// In place of a picture.
fn waiting(ui: &mut EguiUi) {
    ui.ctx().request_repaint_after(Duration::from_millis(200));
    ui.centered_and_justified(|ui| ui.label(RichText::new(progress::text()).color(theme::FAINT)));
}
