//! The file dialog: folders, scenes, runs and meshes below one that is typed or clicked on.

use std::path::{Path, PathBuf};

use egui::{Align2, Button, Key, RichText, ScrollArea, TextEdit, Ui, Window};

use super::theme;
use crate::scene::is_mesh_file;

/// What a run leaves in its folder, whatever else it writes.
const OF_A_RUN: [&str; 2] = ["run.json", "report.json"];

/// What an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Folder,
    Run,
    Scene,
    Mesh,
}

/// The open dialog.
#[derive(Debug)]
pub(super) struct Browse {
    typed: String,
    folder: PathBuf,
    entries: Vec<(Kind, String)>,
}

impl Browse {
    /// At the folder that the program was started in.
    pub(super) fn new() -> Self {
        Self::at(&std::env::current_dir().unwrap_or_else(|_| PathBuf::from(".")))
    }

    fn at(folder: &Path) -> Self {
        Self { typed: String::new(), folder: folder.to_owned(), entries: entries(folder) }
    }

    /// One frame: what is to be opened, if that was chosen.
    pub(super) fn show(&mut self, root: &Ui) -> Option<PathBuf> {
        let mut chosen = None;
        let window = Window::new("Open a scene, a run or a mesh").collapsible(false).resizable(false);
        window.anchor(Align2::CENTER_TOP, [0.0, 60.0]).show(root.ctx(), |ui| {
            let hint = "path, or name of a shipped scene";
            let field = ui.add(TextEdit::singleline(&mut self.typed).hint_text(hint).desired_width(380.0));
            field.request_focus();
            let enter = ui.input(|input| input.key_pressed(Key::Enter));
            if (ui.button("Open").clicked() || enter) && !self.typed.trim().is_empty() {
                chosen = Some(self.folder_or(Path::new(self.typed.trim())));
            }
            ui.separator();
            ui.horizontal(|ui| {
                let above = self.folder.parent().map(Path::to_owned);
                let up = ui.add_enabled(above.is_some(), Button::new("up"));
                above.filter(|_| up.clicked()).into_iter().for_each(|above| self.go(&above));
                let name = RichText::new(self.folder.display().to_string()).color(theme::FAINT);
                ui.add(egui::Label::new(name).truncate());
            });
            ScrollArea::vertical().max_height(320.0).auto_shrink([false, true]).show(ui, |ui| {
                chosen = chosen.take().or(self.list(ui));
            });
        });
        let chosen = chosen?;
        if chosen.is_dir() && !is_run(&chosen) {
            self.typed.clear();
            self.go(&chosen);
            return None;
        }
        Some(chosen)
    }

    /// Entries to click on; the one that was clicked.
    fn list(&self, ui: &mut Ui) -> Option<PathBuf> {
        if self.entries.is_empty() {
            ui.label(RichText::new("no folders, scenes, runs or meshes here").color(theme::FAINT));
        }
        let mut clicked = None;
        for (kind, name) in &self.entries {
            let text = match kind {
                Kind::Folder => RichText::new(format!("{name}/")).color(theme::FAINT),
                Kind::Run => RichText::new(format!("{name}/  (a run)")),
                Kind::Scene => RichText::new(name),
                Kind::Mesh => RichText::new(format!("{name}  (a mesh)")),
            };
            if ui.add(Button::new(text).frame(false)).clicked() {
                clicked = Some(self.folder.join(name));
            }
        }
        clicked
    }

    /// A path that is typed may begin at the folder that is shown.
    fn folder_or(&self, typed: &Path) -> PathBuf {
        let below = self.folder.join(typed);
        if !typed.exists() && below.exists() { below } else { typed.to_owned() }
    }

    fn go(&mut self, folder: &Path) {
        // so that there is always a way up
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        (self.entries, self.folder) = (entries(&folder), folder);
    }
}

fn is_run(folder: &Path) -> bool {
    OF_A_RUN.iter().any(|name| folder.join(name).is_file())
}

/// Folders, runs, scene and mesh files of a folder, by name; what is hidden is left out, and nothing where it cannot be read.
fn entries(folder: &Path) -> Vec<(Kind, String)> {
    let Ok(all) = std::fs::read_dir(folder) else { return Vec::new() };
    let entry = |path: PathBuf| {
        let name = path.file_name()?.to_str().filter(|name| !name.starts_with('.'))?.to_owned();
        let kind = match path.is_dir() {
            true if is_run(&path) => Kind::Run,
            true => Kind::Folder,
            false if path.extension().is_some_and(|end| end == "toml") => Kind::Scene,
            false if is_mesh_file(&path) => Kind::Mesh,
            false => return None,
        };
        Some((kind, name))
    };
    let mut found: Vec<_> = all.filter_map(|own| entry(own.ok()?.path())).collect();
    found.sort();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_runs_and_scenes_are_listed_and_hidden_ones_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        for name in ["b", "a", ".git", "past"] {
            std::fs::create_dir(place(name)).unwrap();
        }
        for name in ["two.toml", "one.toml", ".hidden.toml", "picture.png", "cup.STL", "past/run.json", "a/deep.toml"] {
            std::fs::write(place(name), "").unwrap();
        }
        let mut browse = Browse::at(folder.path());
        let names: Vec<_> = browse.entries.iter().map(|(kind, name)| (*kind, name.as_str())).collect();
        let (plain, scene) = (Kind::Folder, Kind::Scene);
        assert_eq!(
            names,
            [
                (plain, "a"),
                (plain, "b"),
                (Kind::Run, "past"),
                (scene, "one.toml"),
                (scene, "two.toml"),
                (Kind::Mesh, "cup.STL")
            ]
        );
        assert_eq!(browse.folder_or(Path::new("one.toml")), place("one.toml"));
        assert_eq!(browse.folder_or(Path::new("gas/sod")), PathBuf::from("gas/sod"), "a shipped scene");
        browse.go(&place("a"));
        assert_eq!(browse.entries, [(scene, "deep.toml".to_owned())]);
        browse.go(Path::new("src"));
        assert!(browse.folder.parent().is_some_and(|above| entries(above).contains(&(plain, "src".to_owned()))));
        assert!(entries(&place("nowhere")).is_empty());
    }
}
