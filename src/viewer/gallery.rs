//! The start page: the shipped scenes, in groups, with title and first lines; and a field for any other file.

use std::sync::{Arc, OnceLock};

use egui::{RichText, ScrollArea, Ui, Vec2};

use super::model::Request;
use super::theme;
use crate::gpu::Gpu;
use crate::scene::{Changes, SMALL, Shipped, is_size, shipped};

/// Groups in the order of the page, with what they are; other folders follow.
const GROUPS: [(&str, &str); 5] = [
    ("demos", "Demos"),
    ("paper", "Scenes of the paper"),
    ("coupled", "Gas and solids"),
    ("gas", "Gas"),
    ("validation", "Validation"),
];
/// Least size of a card.
const CARD: Vec2 = Vec2::new(272.0, 108.0);
/// Room between cards.
const GAP: f32 = 10.0;

/// One scene of the page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    /// Folder below `scenes/`.
    group: String,
    /// Name, as the command line takes it.
    name: String,
    title: String,
    /// Dimension and cells.
    size: String,
    /// Its variants.
    variants: Vec<String>,
    /// The first lines of the file.
    about: String,
}

impl Entry {
    /// The scene, at its small size if that is wished for and there is one, in one of its variants.
    fn request(&self, small: bool, variant: Option<&str>) -> Request {
        let small = Some(SMALL).filter(|_| small && self.variants.iter().any(|name| name == SMALL));
        let variants = small.into_iter().chain(variant).map(str::to_owned).collect();
        Request { changes: Changes { variants, ..Changes::default() }, ..Request::of(&format!("{}.toml", self.name)) }
    }
}

/// Reads what a card shows; the scene itself is checked when it is opened.
fn entry(scene: &Shipped) -> Entry {
    let table = scene.text.parse::<toml::Table>().unwrap_or_default();
    let text = |key: &str| table.get(key).and_then(toml::Value::as_str).unwrap_or(&scene.name).to_owned();
    let cells = table.get("domain").and_then(|domain| domain.get("cells")).and_then(toml::Value::as_array);
    let cells: Vec<String> = cells.into_iter().flatten().map(toml::Value::to_string).collect();
    let variants = table.get("variants").and_then(toml::Value::as_table);
    let comment = scene.text.lines().take_while(|line| line.starts_with('#')).filter(|line| !line.starts_with("#:"));
    let lines = comment.map(|line| line.trim_start_matches('#').trim());
    let about = lines.take_while(|line| !line.starts_with("Reference")).collect::<Vec<_>>().join(" ").trim().to_owned();
    Entry {
        group: scene.path.split('/').next().filter(|_| scene.path.contains('/')).unwrap_or("").to_owned(),
        name: scene.path.trim_end_matches(".toml").to_owned(),
        title: text("title"),
        size: format!("{}D, {} cells", cells.len(), cells.join(" x ")),
        variants: variants.into_iter().flat_map(toml::Table::keys).cloned().collect(),
        about,
    }
}

/// The page.
#[derive(Debug)]
pub(super) struct Gallery {
    entries: Vec<Entry>,
    wanted: String,
    path: String,
    /// Whether large scenes open in their small size: as chosen, or else on devices that are slow.
    small: Option<bool>,
    slow: Arc<OnceLock<bool>>,
}

impl Gallery {
    pub(super) fn new() -> Self {
        let entries = shipped().iter().map(entry).collect();
        let slow = Arc::new(OnceLock::new());
        let found = Arc::clone(&slow);
        // Drivers may take long to answer.
        std::thread::spawn(move || found.set(Gpu::adapters().iter().all(|adapter| adapter.kind == "software")));
        Self { entries, wanted: String::new(), path: String::new(), small: None, slow }
    }

    fn is_small(&self) -> bool {
        self.small.unwrap_or_else(|| self.slow.get().copied().unwrap_or(false))
    }

    /// Shows the page; the scene that was chosen.
    pub(super) fn show(&mut self, ui: &mut Ui) -> Option<Request> {
        let mut chosen = self.head(ui);
        ui.separator();
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let known = GROUPS.iter().map(|(folder, name)| ((*folder).to_owned(), (*name).to_owned()));
            let mut groups: Vec<(String, String)> = known.collect();
            for entry in &self.entries {
                if !groups.iter().any(|(folder, _)| *folder == entry.group) {
                    groups.push((entry.group.clone(), entry.group.clone()));
                }
            }
            for (folder, name) in &groups {
                chosen = self.group(ui, folder, name).or(chosen.take());
            }
            ui.add_space(12.0);
        });
        chosen
    }

    fn head(&mut self, ui: &mut Ui) -> Option<Request> {
        let mut chosen = None;
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            ui.label(RichText::new("Brisance").size(24.0).strong().color(theme::ACCENT));
            ui.label(RichText::new("shock waves, and the solids they bend, tear and shatter").color(theme::FAINT));
        });
        ui.horizontal(|ui| {
            ui.add(egui::TextEdit::singleline(&mut self.wanted).hint_text("search").desired_width(180.0));
            let mut small = self.is_small();
            let hint = "Large scenes open in their variant `small`: minutes on a processor instead of hours. Ticked where there is no GPU.";
            if ui.checkbox(&mut small, "small sizes").on_hover_text(hint).changed() {
                self.small = Some(small);
            }
            ui.add_space(12.0);
            let field = egui::TextEdit::singleline(&mut self.path).hint_text("path of a scene file, or drop one here");
            let field = ui.add(field.desired_width(320.0));
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if (ui.button("Open").clicked() || entered) && !self.path.trim().is_empty() {
                chosen = Some(Request::of(self.path.trim()));
            }
        });
        ui.add_space(2.0);
        chosen
    }

    fn group(&self, ui: &mut Ui, folder: &str, name: &str) -> Option<Request> {
        let wanted = self.wanted.to_lowercase();
        let hit = |entry: &&Entry| {
            let text = format!("{} {} {}", entry.name, entry.title, entry.about).to_lowercase();
            entry.group == folder && text.contains(&wanted)
        };
        let entries: Vec<&Entry> = self.entries.iter().filter(hit).collect();
        if entries.is_empty() {
            return None;
        }
        let mut chosen = None;
        ui.add_space(8.0);
        ui.label(RichText::new(name).size(16.0).strong());
        let columns = (ui.available_width() / (CARD.x + GAP)).floor().max(1.0);
        let size = Vec2::new((ui.available_width() - 12.0) / columns - GAP, CARD.y);
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = Vec2::splat(GAP);
            for entry in entries {
                chosen = card(ui, entry, size, self.is_small()).or(chosen.take());
            }
        });
        chosen
    }
}

/// One scene as a button, with a button for each of its variants; what was chosen.
fn card(ui: &mut Ui, entry: &Entry, size: Vec2, small: bool) -> Option<Request> {
    let (place, response) = ui.allocate_exact_size(size, egui::Sense::click());
    let visuals = ui.style().interact(&response);
    let fill = if response.hovered() { visuals.weak_bg_fill } else { ui.visuals().faint_bg_color };
    ui.painter().rect(place, 6.0, fill, visuals.bg_stroke, egui::StrokeKind::Inside);
    let inner = place.shrink(9.0);
    let mut content =
        ui.new_child(egui::UiBuilder::new().max_rect(inner).layout(egui::Layout::top_down(egui::Align::Min)));
    content.set_clip_rect(inner.intersect(ui.clip_rect()));
    content.spacing_mut().item_spacing.y = 2.0;
    content.add(egui::Label::new(RichText::new(&entry.title).strong()).truncate());
    content.add(egui::Label::new(RichText::new(&entry.size).small().color(theme::ACCENT)).truncate());
    let mut chosen = None;
    if !entry.variants.is_empty() {
        content.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            for name in &entry.variants {
                let hint = format!("{} --variant {name}", entry.name);
                if ui.add(egui::Button::new(RichText::new(name).small()).small()).on_hover_text(hint).clicked() {
                    chosen = Some(entry.request(small && !is_size(name), Some(name)));
                }
            }
        });
    }
    content.add(egui::Label::new(RichText::new(&entry.about).small().color(theme::FAINT)).wrap());
    let clicked = response.clicked();
    response.on_hover_text(format!("{}\n{}", entry.name, entry.about));
    chosen.or_else(|| clicked.then(|| entry.request(small, None)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_scene_has_a_card_that_opens_it() {
        let gallery = Gallery::new();
        assert!(gallery.entries.len() > 20);
        for entry in &gallery.entries {
            assert!(!entry.title.is_empty() && !entry.about.is_empty(), "{entry:?}");
            assert!(!entry.about.contains(":schema"), "{entry:?}");
            assert!(entry.size.starts_with(['1', '2', '3']), "{entry:?}");
            entry.request(false, None).load().unwrap();
        }
    }

    #[test]
    fn a_variant_opens_at_the_size_that_is_wished_for() {
        let gallery = Gallery::new();
        let bullets = gallery.entries.iter().find(|entry| entry.name.ends_with("fig05_bullets_2d")).unwrap();
        let cells = |request: Request| request.load().unwrap().domain.cells;
        assert_eq!(bullets.request(true, Some("light")).changes.variants, ["small", "light"]);
        assert_eq!(bullets.request(false, Some("light")).changes.variants, ["light"]);
        assert!(cells(bullets.request(true, None))[0] < cells(bullets.request(false, None))[0]);
        let sod = gallery.entries.iter().find(|entry| entry.name.ends_with("sod")).unwrap();
        assert_eq!(sod.request(true, None).changes, Changes::default());
    }
}
