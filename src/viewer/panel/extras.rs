//! What else a picture shows: bodies, planes and lines, light, words around it.

use egui::{Slider, Ui};

use super::super::view::View;
use super::look::{COLORMAPS, choice};
use super::rows;
use crate::scene::{Contours, ParticleColor, Slice, Surface, ToneMap};

/// Quantities of the particles with their names.
const PARTICLE_COLORS: [(ParticleColor, &str); 6] = [
    (ParticleColor::Body, "body"),
    (ParticleColor::Speed, "speed"),
    (ParticleColor::DeviatoricStress, "deviatoric stress"),
    (ParticleColor::PlasticStrain, "plastic strain"),
    (ParticleColor::Damage, "damage"),
    (ParticleColor::Temperature, "temperature around"),
];

/// How bodies are drawn.
pub(super) fn bodies(ui: &mut Ui, view: &mut View) {
    let space = view.dimension() == 3;
    let settings = &mut view.look.settings;
    ui.checkbox(&mut settings.particles, "draw the particles");
    rows(ui, "bodies", |ui| {
        ui.label("coloured by");
        choice(ui, "particle color", &mut settings.particle_color, &PARTICLE_COLORS);
        ui.end_row();
        if settings.particle_color != ParticleColor::Body {
            ui.label("colours");
            choice(ui, "particle colours", &mut settings.particle_colormap, &COLORMAPS);
            ui.end_row();
        }
        if space {
            ui.label("surface");
            ui.horizontal(|ui| {
                ui.selectable_value(&mut settings.surface, Surface::Spheres, "balls");
                ui.selectable_value(&mut settings.surface, Surface::Smooth, "smooth");
            });
            ui.end_row();
        }
    });
}

/// Slices through space, contour lines, arrows.
pub(super) fn planes_and_lines(ui: &mut Ui, view: &mut View) {
    let (dimension, domain) = (view.dimension(), view.scene.domain.clone());
    let settings = &mut view.look.settings;
    if dimension == 3 {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let mut normal = [0.0; 3];
            normal[axis] = 1.0;
            let (low, high) = (domain.origin[axis], domain.origin[axis] + domain.size[axis]);
            let index = settings.slices.iter().position(|slice| slice.normal == normal);
            let mut cut = index.is_some();
            ui.horizontal(|ui| {
                if ui.checkbox(&mut cut, format!("slice across {name}")).changed() {
                    match index {
                        Some(index) => drop(settings.slices.remove(index)),
                        None => {
                            let point = std::array::from_fn(|d| domain.origin[d] + 0.5 * domain.size[d]);
                            settings.slices.push(Slice { point, normal });
                        }
                    }
                }
                if let Some(slice) = settings.slices.iter_mut().find(|slice| slice.normal == normal) {
                    ui.add(Slider::new(&mut slice.point[axis], low..=high).show_value(false));
                }
            });
        }
    }
    if let Contours::Count(count) = &mut settings.contours {
        ui.add(Slider::new(count, 0..=32).text("contour lines"));
    }
    if dimension == 2 {
        ui.add(Slider::new(&mut settings.arrows, 0..=60).text("arrows across"));
    }
}

/// Light, shadows, what becomes of light in the picture.
pub(super) fn light(ui: &mut Ui, view: &mut View) {
    let settings = &mut view.look.settings;
    ui.checkbox(&mut settings.light.shadows, "shadows");
    ui.checkbox(&mut settings.ground, "ground");
    let mut film = settings.tone == ToneMap::Aces;
    if ui.checkbox(&mut film, "tones of film").changed() {
        settings.tone = if film { ToneMap::Aces } else { ToneMap::None };
    }
    ui.add(Slider::new(&mut settings.light.strength, 0.0..=5.0).text("light"));
    ui.add(Slider::new(&mut settings.light.ambient, 0.0..=2.0).text("sky"));
    ui.add(Slider::new(&mut settings.exposure, 0.05..=20.0).logarithmic(true).text("exposure"));
    ui.add(Slider::new(&mut settings.supersampling, 1..=4).text("rays per pixel"));
    turn_light(ui, &mut settings.light.direction);
}

/// Direction towards the light as angles around the vertical and above the horizon.
fn turn_light(ui: &mut Ui, direction: &mut [f64; 3]) {
    let [x, y, z] = *direction;
    let flat = x.hypot(y);
    let (mut around, mut above) = (y.atan2(x).to_degrees(), z.atan2(flat).to_degrees());
    let changed = ui.add(Slider::new(&mut around, -180.0..=180.0).text("light from").suffix("\u{b0}")).changed();
    let raised = ui.add(Slider::new(&mut above, 5.0..=89.0).text("above").suffix("\u{b0}")).changed();
    if changed || raised {
        let (around, above) = (around.to_radians(), above.to_radians());
        *direction = [above.cos() * around.cos(), above.cos() * around.sin(), above.sin()];
    }
}

/// Words and lines over the picture.
pub(super) fn overlays(ui: &mut Ui, view: &mut View) {
    let space = view.dimension() == 3;
    let overlays = &mut view.look.settings.overlays;
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut overlays.title, "title");
        ui.checkbox(&mut overlays.time, "time");
        ui.checkbox(&mut overlays.color_bar, "colour bar");
        ui.checkbox(&mut overlays.scale_bar, "scale bar");
        if space {
            ui.checkbox(&mut overlays.edges, "edges");
        }
    });
}
