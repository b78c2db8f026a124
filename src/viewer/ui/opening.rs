//! Scenes that are opened, again or in place of another one: what the worker makes of them.

use std::path::Path;

use super::super::adding::Added;
use super::super::model::{Answer, Command, Look, Opened, Request, Status, Weight};
use super::super::view::View;
use super::super::watch::Watch;
use super::Ui;
use crate::scene::is_mesh_file;

/// A scene that the worker is to open.
pub(super) struct Asked {
    request: Request,
    watch: Option<Watch>,
    /// It is another scene, not the same one again.
    other: bool,
    /// Whether it is to run at once.
    plays: bool,
    /// What is said when it is open.
    told: &'static str,
}

impl Ui {
    /// Whether the worker is to open a scene, and has not said what came of it.
    pub(super) fn is_opening(&self) -> bool {
        self.asked.iter().any(Option::is_some)
    }

    /// Opens a scene, and runs it.
    pub(super) fn open(&mut self, request: Request) {
        self.ask(Asked { request, watch: None, other: true, plays: true, told: "" }, None);
    }

    /// Opens a scene or a run; a mesh is read for the next body of the scene that is open.
    pub(super) fn open_path(&mut self, path: &Path) {
        if is_mesh_file(path) {
            let repair = self.view.as_ref().is_some_and(|view| view.panel.adding.repair);
            self.notes.retain(|(_, note)| note.weight == Weight::Fine);
            self.worker.send(Command::ReadMesh(path.to_owned(), repair));
            return;
        }
        self.open(Request::of(&path.to_string_lossy()));
    }

    /// The scene that is open stays until it is known that the other one is right.
    fn ask(&mut self, asked: Asked, look: Option<Look>) {
        self.notes.clear();
        let watch = || asked.request.file().map(Watch::new);
        if self.view.is_none() {
            (self.request, self.watch, self.status) = (Some(asked.request.clone()), watch(), Status::default());
        }
        self.worker.send(Command::Open(asked.request.clone(), look.map(Box::new)));
        self.asked.push_back(Some(Asked { watch: watch(), ..asked }));
    }

    /// Hears what came of scenes that were to be opened; the last of those that are open is given.
    pub(super) fn heed(&mut self, answers: Vec<Answer>, mut opened: Option<Opened>) {
        let last = answers.iter().rposition(|answer| *answer == Answer::Opened);
        for (index, answer) in answers.into_iter().enumerate() {
            let Some(Some(asked)) = self.asked.pop_front() else { continue };
            match answer {
                Answer::Opened => {
                    (self.watch, self.offer) = (asked.watch, None);
                    self.request = Some(asked.request);
                    if let Some(opened) = opened.take_if(|_| last == Some(index)) {
                        self.begin(opened, asked.plays);
                    }
                    if !asked.told.is_empty() {
                        self.tell(asked.told);
                    }
                }
                Answer::Refused => {}
                Answer::Failed => {
                    self.wish = None;
                    self.view.take_if(|_| asked.other);
                    self.watch = asked.watch;
                    self.offer = asked.request.small();
                    self.request = Some(asked.request);
                }
            }
        }
    }

    fn begin(&mut self, opened: Opened, plays: bool) {
        let panel = self.view.take().map(|view| view.panel);
        let mut view = View::new(opened, self.pace);
        if let Some(panel) = panel {
            view.panel.keep(panel);
        }
        view.commands.push(Command::Measure(view.panel.measures()));
        self.view = Some(view);
        self.worker.send(Command::Pace(self.pace));
        self.wish = Some(plays);
        self.worker.send(Command::Play(plays));
    }

    /// Opens the scene again from its start, with the look that it has in the window.
    pub(super) fn restart(&mut self) {
        let plays = self.status.playing || self.view.is_none();
        self.open_again(plays, "");
    }

    fn open_again(&mut self, plays: bool, told: &'static str) {
        let Some(mut request) = self.request.clone() else { return };
        let look = self.view.as_ref().map(|view| view.look.clone());
        if let Some(view) = &mut self.view {
            let clear = std::mem::take(&mut view.panel.adding.clear);
            request.added = if clear { Added::default() } else { request.added.of(&view.scene) };
        }
        self.ask(Asked { watch: None, request, other: look.is_none(), plays, told }, look);
    }

    /// Reloads a file that was saved.
    pub(super) fn reload_if_saved(&mut self) {
        if self.watch.as_mut().is_some_and(Watch::saved) {
            self.open_again(true, "reloaded: the file was saved");
        }
    }
}
