//! The body that was picked: shown or hidden, its colour, how heavy, stiff and strong it is.

use egui::{ComboBox, RichText, Slider, Ui};

use super::super::model::Command;
use super::super::theme;
use super::super::view::View;
use super::look::WIDTH;
use super::rows;
use crate::render::body_colors;
use crate::scene::{Color, Scene};

/// What sliders change, with what they say.
const SLIDERS: [(Number, &str, &str); 3] = [
    (Number::Density, "density", "of this body; it keeps its velocity"),
    (Number::Stiffness, "stiffness", "Young's modulus of its material: of all bodies of that material"),
    (Number::Yield, "yield", "yield stress of its material: of all bodies of that material"),
];
/// Least and largest factor.
const FACTORS: std::ops::RangeInclusive<f64> = 0.1..=10.0;

/// A number of a body or of its material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    Density,
    Stiffness,
    Yield,
}

impl Number {
    /// Its value in a scene; none where the material has none.
    fn of(self, scene: &Scene, body: usize) -> Option<f64> {
        let body = &scene.bodies[body];
        let material = scene.materials.get(&body.material)?;
        match self {
            Self::Density => scene.density_of(body),
            Self::Stiffness => material.parameter("young_modulus"),
            Self::Yield => material.parameter("yield_stress").or_else(|| material.parameter("cohesion")),
        }
        .filter(|value| *value > 0.0)
    }

    /// A scene with so many times the value that it has in the file. What the ghost pressure bears stays the same part of the stiffness.
    fn times(self, now: &Scene, file: &Scene, body: usize, factor: f64) -> Scene {
        let mut scene = now.clone();
        let of_file = &file.bodies[body];
        if self == Self::Density {
            scene.bodies[body].density = file.density_of(of_file).map(|density| factor * density);
            return scene;
        }
        let names: &[&str] =
            if self == Self::Stiffness { &["young_modulus", "ghost_modulus"] } else { &["yield_stress", "cohesion"] };
        if let (Some(own), Some(given)) =
            (scene.materials.get_mut(&of_file.material), file.materials.get(&of_file.material))
        {
            for name in names {
                *own = given.parameter(name).map_or_else(|| own.clone(), |value| own.with(name, factor * value));
            }
        }
        scene
    }
}

/// The body that was picked, and the slider that is dragged with its factor.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::viewer) struct Picked {
    pub(in crate::viewer) body: Option<usize>,
    draft: Option<(Number, f64)>,
}

impl Picked {
    pub(in crate::viewer) fn of(body: Option<usize>) -> Self {
        Self { body, draft: None }
    }

    /// The scene has the numbers that were asked for.
    pub(in crate::viewer) fn settle(&mut self) {
        self.draft = None;
    }
}

/// Shows the controls.
pub(super) fn show(ui: &mut Ui, view: &mut View) {
    let name = |body: Option<usize>| body.map_or("none: click on one", |body| &view.scene.bodies[body].name);
    let mut picked = view.panel.body.body;
    ComboBox::from_id_salt("picked body").selected_text(name(picked)).width(WIDTH).show_ui(ui, |ui| {
        for body in 0..view.scene.bodies.len() {
            ui.selectable_value(&mut picked, Some(body), name(Some(body)));
        }
    });
    if picked != view.panel.body.body {
        view.panel.body = Picked::of(picked);
    }
    let Some(body) = picked else { return };
    ui.horizontal(|ui| {
        let mut shown = !view.hidden.contains(&body);
        if ui.checkbox(&mut shown, "shown").changed() {
            view.hidden.retain(|other| *other != body);
            view.hidden.extend((!shown).then_some(body));
            view.commands.push(Command::Hide(view.hidden.clone()));
        }
        let before = body_colors(&view.scene)[body];
        let mut color = before;
        ui.color_edit_button_srgb(&mut color).on_hover_text("colour");
        if color != before {
            let mut scene = (*view.scene).clone();
            scene.bodies[body].color = Some(Color(color));
            view.commands.push(Command::Change(Box::new(scene)));
        }
    });
    rows(ui, "numbers of a body", |ui| {
        for (number, text, meaning) in SLIDERS {
            slider(ui, view, body, (number, text, meaning));
        }
    });
    ui.label(RichText::new("Factors over the scene file, from the next step on.").small().color(theme::FAINT));
}

/// A factor that acts when its slider is let go.
fn slider(ui: &mut Ui, view: &mut View, body: usize, (number, text, meaning): (Number, &str, &str)) {
    let file = &view.opened.scene;
    let (Some(given), Some(now)) = (number.of(file, body), number.of(&view.scene, body)) else { return };
    let draft = view.panel.body.draft.filter(|(other, _)| *other == number).map(|(_, factor)| factor);
    let mut factor = draft.unwrap_or(now / given);
    ui.label(text).on_hover_text(meaning);
    let slider = Slider::new(&mut factor, FACTORS).logarithmic(true).max_decimals(2).suffix(" x");
    let response = ui.add(slider).on_hover_text(meaning);
    ui.end_row();
    if response.changed() {
        view.panel.body.draft = Some((number, factor));
    }
    if response.drag_stopped() || (response.changed() && !response.dragged()) {
        let scene = number.times(&view.scene, file, body, factor);
        view.commands.push(Command::Change(Box::new(scene)));
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::super::model::{Look, Opened, Pace, Request};
    use super::super::super::session::Session;
    use super::super::tests::drag;
    use super::*;
    use crate::gpu::{Gpu, GpuOptions};
    use crate::scene::Field;

    #[test]
    fn factors_are_over_the_scene_file() {
        let scene = Scene::find("playground_2d", &[]).unwrap();
        let body = |name: &str| scene.bodies.iter().position(|body| body.name == name).unwrap();
        let (ring, clay, sand) = (body("ring"), body("clay"), body("sand"));
        let twice = Number::Stiffness.times(&scene, &scene, ring, 2.0);
        assert_eq!(Number::Stiffness.of(&twice, ring), Some(300.0));
        assert_eq!(Number::Stiffness.of(&twice, body("ball")), Some(300.0), "of the same rubber");
        assert_eq!(Number::Stiffness.times(&twice, &scene, ring, 1.0), scene);
        assert_eq!((Number::Yield.of(&scene, ring), Number::Yield.of(&scene, sand)), (None, None));
        assert_eq!(Number::Yield.of(&Number::Yield.times(&twice, &scene, clay, 0.5), clay), Some(1.5));
        let heavy = Number::Density.times(&twice, &scene, clay, 3.0);
        assert_eq!((Number::Density.of(&heavy, clay), Number::Density.of(&heavy, ring)), (Some(30.0), Some(5.0)));
        assert!(heavy.checked().is_ok() && Number::Stiffness.of(&heavy, ring) == Some(300.0));
    }

    /// A block of clay that flies apart and flows.
    const CLAY: &str = "title = \"Clay\"\n\
        domain = { dimension = 2, cells = [16, 16], size = [1.0, 1.0] }\n\
        gas.ambient = { density = 1.0, pressure = 1.0 }\n\
        time = { until = 0.1, frames = 1, fixed_step = 1.0e-3 }\n\
        [materials.clay]\nvon_mises = { young_modulus = 200.0, poisson_ratio = 0.3, yield_stress = 3.0 }\n\
        [[bodies]]\nname = \"block\"\nshape.box = { center = [0.5, 0.5], size = [0.4, 0.2] }\nmaterial = \"clay\"\n\
        density = 10.0\nvelocity = [0.5, 0.0]\nspin = 8.0\n";

    fn view(scene: &Scene) -> View {
        let look = Look { field: Field::Density, settings: scene.own_look() };
        let (request, scene) = (Request::of("clay"), Arc::new(scene.clone()));
        let opened = Opened { request, scene, particles: 1, look, fitted: None, device: String::new(), software: true };
        View::new(opened, Pace::Fastest)
    }

    /// From the slider to the state: what is let go changes what the next steps compute, into what a scene of such numbers computes.
    #[test]
    fn a_slider_changes_what_is_computed() {
        let scene = Scene::parse(CLAY, "clay.toml", &[]).unwrap();
        let mut moved = Vec::new();
        for (number, text, meaning) in SLIDERS {
            let mut view = view(&scene);
            assert!(drag(|ui| {
                slider(ui, &mut view, 0, (number, text, meaning));
                !view.commands.is_empty()
            }));
            let [Command::Change(to)] = &view.commands[..] else { panic!("{text}: {:?}", view.commands) };
            let factor = number.of(to, 0).unwrap() / number.of(&scene, 0).unwrap();
            assert!(factor > 1.5 && factor < 10.0, "{text}: {factor}");
            let others = SLIDERS.iter().filter(|(other, ..)| *other != number);
            others.for_each(|(other, ..)| assert_eq!(other.of(to, 0), other.of(&scene, 0), "{text}"));
            moved.push((text, to.clone()));
        }
        if std::env::var("BRISANCE_SKIP_GPU").is_ok_and(|value| value == "1") {
            return;
        }
        let gpu = Gpu::new(&GpuOptions::default()).unwrap();
        // velocities of the particles after some steps
        let after = |from: &Scene, to: &Scene| {
            let (mut session, mut records) = (Session::open(&gpu, from.clone()).unwrap(), Vec::new());
            session.change(to.clone(), &mut records).unwrap();
            while records.len() < 40 {
                session.advance(40, &mut records).unwrap();
            }
            let particles = session.simulation().snapshot().unwrap().particles;
            particles.iter().flat_map(|particle| particle.velocity).collect::<Vec<f32>>()
        };
        let away = |one: &[f32], other: &[f32]| one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        let plain = after(&scene, &scene);
        for (text, to) in moved {
            let (live, start) = (after(&scene, &to), after(&to, &to));
            assert!(away(&live, &start) < 1e-3, "{text}: {} from a scene of such numbers", away(&live, &start));
            assert!(away(&live, &plain) > 0.01, "{text}: {} from the scene before", away(&live, &plain));
        }
    }
}
