//! Parameters that may change while a scene runs.

use egui::{DragValue, RichText, Ui};

use super::super::model::Command;
use super::super::theme;
use super::super::view::View;
use super::{positive, rows, short};
use crate::scene::{Boundary, Scene};

/// The numbers as the user sets them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parameters {
    gravity: [f64; 3],
    cfl: f64,
    tolerance: f64,
    /// Speed of what flows in, relative to the scene file.
    inflow: f64,
    has_inflow: bool,
}

impl Parameters {
    pub(super) fn of(scene: &Scene) -> Self {
        let flows = |side: &&Boundary| side.rules().into_iter().any(|rule| scaled(rule, 2.0) != *rule);
        Self {
            gravity: scene.gravity,
            cfl: scene.time.cfl,
            tolerance: scene.numerics.tolerance,
            inflow: 1.0,
            has_inflow: scene.boundary.sides().iter().any(flows),
        }
    }

    /// The scene as it is now with these numbers; `original` is the one of the file.
    fn applied(&self, now: &Scene, original: &Scene) -> Scene {
        let mut scene = now.clone();
        scene.boundary = original.boundary.clone();
        scene.gravity = self.gravity;
        scene.time.cfl = self.cfl;
        scene.numerics.tolerance = self.tolerance;
        let sides = &mut scene.boundary;
        for side in
            [&mut sides.x_min, &mut sides.x_max, &mut sides.y_min, &mut sides.y_max, &mut sides.z_min, &mut sides.z_max]
        {
            *side = scaled(side, self.inflow);
        }
        scene
    }
}

/// A side with the velocity beyond it times a factor.
fn scaled(side: &Boundary, factor: f64) -> Boundary {
    let times = |velocity: &mut [f64; 3]| *velocity = velocity.map(|component| factor * component);
    let mut side = side.clone();
    match &mut side {
        Boundary::Inlet(state) | Boundary::FarField(state) => times(&mut state.velocity),
        Boundary::SubsonicInlet(inflow) => times(&mut inflow.velocity),
        Boundary::TimedInlet(inlet) => inlet.table.iter_mut().for_each(|state| times(&mut state.velocity)),
        Boundary::Patched(patched) => {
            *patched.base = scaled(&patched.base, factor);
            for patch in &mut patched.patches {
                patch.rule = scaled(&patch.rule, factor);
            }
        }
        Boundary::Wall
        | Boundary::Periodic
        | Boundary::Outlet
        | Boundary::TotalInlet(_)
        | Boundary::PressureOutlet(_)
        | Boundary::AttenuatedOutlet(_) => {}
    }
    side
}

/// Shows the numbers; changes go to the running scene.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    let axes = view.scene.domain.axes();
    let before = view.panel.parameters.clone();
    let now = &mut view.panel.parameters;
    rows(ui, "parameters", |ui| {
        ui.label("gravity");
        ui.horizontal(|ui| {
            for component in &mut now.gravity[..axes] {
                ui.add(DragValue::new(component).speed(0.1).custom_formatter(short));
            }
            ui.label("m/s\u{b2}");
        });
        ui.end_row();
        if now.has_inflow {
            ui.label("inflow");
            let factor = DragValue::new(&mut now.inflow).speed(0.01).range(0.0..=10.0).suffix(" x");
            ui.add(factor).on_hover_text("velocity beyond open sides, relative to the scene file");
            ui.end_row();
        }
        ui.label("CFL");
        ui.add(DragValue::new(&mut now.cfl).speed(0.005).range(0.01..=1.0));
        ui.end_row();
        ui.label("tolerance");
        ui.add(positive(&mut now.tolerance, "").range(1e-9..=0.5));
        ui.end_row();
    });
    if ui.button("as in the scene file").clicked() {
        view.panel.parameters = Parameters::of(&view.opened.scene);
    }
    ui.label(RichText::new("They act from the next step on; the file stays as it is.").small().color(theme::FAINT));
    if view.panel.parameters != before {
        let scene = view.panel.parameters.applied(&view.scene, &view.opened.scene);
        view.commands.push(Command::Change(Box::new(scene)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inflow_scales_every_velocity_beyond_a_side() {
        let text = "title = \"inflow\"\ndomain = { dimension = 2, cells = [8, 8], size = [1.0, 1.0] }\n\
                    gas.ambient = { density = 1.0, pressure = 1.0 }\ntime.until = 1.0\n\
                    [boundary]\nx_max = \"outlet\"\n[boundary.x_min.patched]\nbase = \"wall\"\n\
                    [[boundary.x_min.patched.patches]]\nshape = { box = { center = [0.0, 0.5], size = [0.1, 0.5] } }\n\
                    rule.inlet = { density = 1.0, velocity = [2.0, 0.0], pressure = 1.0 }";
        let scene = Scene::parse(text, "inflow.toml", &[]).unwrap();
        let mut parameters = Parameters::of(&scene);
        assert!(parameters.has_inflow);
        assert_eq!(parameters.applied(&scene, &scene), scene);
        parameters.inflow = 1.5;
        let Boundary::Patched(patched) = parameters.applied(&scene, &scene).boundary.x_min else { panic!("patched") };
        let Boundary::Inlet(state) = &patched.patches[0].rule else { panic!("an inlet") };
        assert_eq!(state.velocity, [3.0, 0.0, 0.0]);
        let closed = Scene::parse(&text[..text.find("[boundary]").unwrap()], "closed.toml", &[]).unwrap();
        assert!(!Parameters::of(&closed).has_inflow);
    }
}
