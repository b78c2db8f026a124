//! A body to add: what it is, and whether clicks add it.

use egui::{ComboBox, Label, RichText, Ui};

use super::super::adding::{Addition, Form, MeshFile};
use super::super::theme;
use super::super::view::View;
use super::look::WIDTH;
use super::{positive, rows};
use crate::scene::Scene;

/// What a mesh is.
const MESHES: &str = "what a file .obj, .ply, .stl or .glb encloses; drop one on the window, or choose one";
/// What the cells are for.
const CELLS: &str = "as many cells lie across it; what is thinner than a cell or two is lost";
/// What is mended.
const REPAIR: &str = "the next file may be open or cross itself: inside is where its winding number is above 1/2";

/// The next body, and whether a click adds it.
#[derive(Debug)]
pub(in crate::viewer) struct Adding {
    pub(in crate::viewer) next: Addition,
    pub(in crate::viewer) armed: bool,
    /// The scene is to start again without what was added.
    pub(in crate::viewer) clear: bool,
    /// A mesh file is to be chosen.
    pub(in crate::viewer) browse: bool,
    /// Whether meshes that are open or cross themselves are taken.
    pub(in crate::viewer) repair: bool,
    /// A mesh has come, and the form is to be seen.
    pub(super) is_new: bool,
}

impl Adding {
    pub(super) fn of(scene: &Scene) -> Self {
        let (armed, clear, browse, repair, is_new) = (false, false, false, false, false);
        Self { next: Addition::of(scene), armed, clear, browse, repair, is_new }
    }

    /// Has a mesh as the next body, which the next click adds.
    pub(in crate::viewer) fn take(&mut self, mesh: MeshFile, scene: &Scene) {
        self.next.take(mesh, scene);
        (self.armed, self.is_new) = (true, true);
    }

    /// Takes over what stays when the scene starts again.
    pub(super) fn keep(&mut self, old: Self) {
        (self.armed, self.repair) = (old.armed, old.repair);
    }
}

/// Shows the controls.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    let (scene, adding) = (&view.scene, &mut view.panel.adding);
    let next = &mut adding.next;
    rows(ui, "a body to add", |ui| {
        ui.label("form");
        ui.horizontal(|ui| {
            let names = if scene.domain.axes() == 3 { ["ball", "cube"] } else { ["disc", "square"] };
            for (form, name) in [Form::Ball, Form::Box].into_iter().zip(names) {
                ui.selectable_value(&mut next.form, form, name);
            }
            if ui.selectable_label(next.form == Form::Mesh, "mesh").on_hover_text(MESHES).clicked() {
                adding.browse = next.mesh.is_none();
                next.form = if next.mesh.is_some() { Form::Mesh } else { next.form };
            }
        });
        ui.end_row();
        if let (Form::Mesh, Some(mesh)) = (next.form, &next.mesh) {
            ui.label("file");
            ui.horizontal(|ui| {
                adding.browse |= ui.button("other ...").on_hover_text(MESHES).clicked();
                let about = format!("{}: {} triangles", mesh.name, mesh.triangles);
                ui.add(Label::new(RichText::new(&mesh.name)).truncate()).on_hover_text(about);
            });
            ui.end_row();
        }
        ui.label("size");
        ui.add(positive(&mut next.size, "m")).on_hover_text("diameter or edge; of a mesh the largest extent");
        ui.end_row();
        if let (Form::Mesh, Some(mesh)) = (next.form, &next.mesh) {
            let edges = mesh.edges(next.size, &scene.domain);
            let cells = |edge: &f64| format!("{:.1}", edge / scene.domain.spacing());
            ui.label("cells");
            ui.label(edges.iter().map(cells).collect::<Vec<_>>().join(" x ")).on_hover_text(CELLS);
            ui.end_row();
        }
        ui.label("material");
        ComboBox::from_id_salt("material of the next body").selected_text(&next.material).width(WIDTH).show_ui(
            ui,
            |ui| {
                for name in Addition::materials(scene) {
                    ui.selectable_value(&mut next.material, name.clone(), name);
                }
            },
        );
        ui.end_row();
    });
    ui.checkbox(&mut adding.repair, "repair meshes").on_hover_text(REPAIR);
    ui.checkbox(&mut adding.armed, "a click adds it").on_hover_text("at rest, where there is room");
    let text = "What there is goes on. The gas in its place goes. Left takes it back; R starts with it.";
    ui.label(RichText::new(text).small().color(theme::FAINT));
    let added = view.opened.request.added.of(&view.scene).bodies;
    if !added.is_empty() {
        adding.clear = ui.button("start without what was added").clicked();
    }
}
