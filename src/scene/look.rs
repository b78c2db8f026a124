//! `render.look`: one word for many keys of pictures. What a scene says itself stays; an override of the look decides them all.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table};

/// The key, as overrides name it.
pub(super) const KEY: &str = "render.look";

/// A word for many keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Look {
    /// Fields with scales: the defaults of all keys.
    #[default]
    Lab,
    /// Black on white, PNG files with 300 pixels per inch; in 3D four rays per pixel.
    Print,
    /// Nothing written; in 3D a grey veil of gas, filmic tone, four rays per pixel, a view bent tenfold. `emission`, `ground` and
    /// `backdrop` are added by hand.
    Film,
}

/// What [`Look::Film`] means in 3D.
const FILM: &str = r#"
colormap = "gray"
opacity = [[0.0, 0.0], [0.12, 0.0], [1.0, 0.35]]
tone = "aces"
surface = "smooth"
supersampling = 2
refraction = { exaggeration = 10.0 }
overlays = { title = false, time = false, color_bar = false, scale_bar = false, edges = false }
"#;

/// What it means in 1D and 2D.
const FILM_IN_THE_PLANE: &str = r#"
overlays = { title = false, time = false, color_bar = false, scale_bar = false }
"#;

/// What [`Look::Print`] means in 3D; elsewhere it changes the colours around the picture alone.
const PRINT: &str = r#"
surface = "smooth"
supersampling = 2
overlays = { edges = false }
"#;

fn meaning(look: &str, dimension: i64) -> Option<&'static str> {
    match (look, dimension) {
        ("film", 3) => Some(FILM),
        ("print", 3) => Some(PRINT),
        ("film", _) => Some(FILM_IN_THE_PLANE),
        _ => None,
    }
}

/// Puts what the look of a document means in place of keys of `[render]` that are left out.
pub(super) fn apply(root: &mut DeTable<'_>) {
    let dimension = root
        .get("domain")
        .and_then(|domain| domain.get_ref().as_table()?.get("dimension")?.get_ref().as_integer())
        .and_then(|number| i64::from_str_radix(number.as_str(), number.radix()).ok());
    let Some(DeValue::Table(render)) = root.get_mut("render").map(Spanned::get_mut) else { return };
    let look = render.get("look").and_then(|look| look.get_ref().as_str()).unwrap_or_default();
    let Some(text) = meaning(look, dimension.unwrap_or_default()) else { return };
    if let Ok(meant) = DeTable::parse(text) {
        fill(render, meant.into_inner());
    }
}

/// Takes the keys that looks stand for out of a document whose look is overridden: those of the look take their place.
pub(super) fn forget(root: &mut DeTable<'_>) {
    let Some(DeValue::Table(render)) = root.get_mut("render").map(Spanned::get_mut) else { return };
    for key in FILM.parse::<Table>().unwrap_or_default().keys() {
        render.remove(key.as_str());
    }
}

fn fill<'a>(into: &mut DeTable<'a>, from: DeTable<'a>) {
    for (key, value) in from {
        let place = value.span();
        let name = Spanned::new(place, Cow::Owned(key.get_ref().to_string()));
        match (into.get_mut(&**key.get_ref()).map(Spanned::get_mut), value.into_inner()) {
            (Some(DeValue::Table(inner)), DeValue::Table(more)) => fill(inner, more),
            (Some(_), _) => {}
            (None, value) => {
                into.insert(name, Spanned::new(0..0, value));
            }
        }
    }
}

/// The same for the keys of a view, which change those of the scene.
pub(super) fn apply_to_view(changes: &mut Table, dimension: u32) {
    let look = changes.get("look").and_then(toml::Value::as_str).unwrap_or_default();
    let Some(text) = meaning(look, dimension.into()) else { return };
    for (key, value) in text.parse::<Table>().unwrap_or_default() {
        match (changes.get_mut(&key), value) {
            (Some(toml::Value::Table(inner)), toml::Value::Table(more)) => {
                for (key, value) in more {
                    inner.entry(key).or_insert(value);
                }
            }
            (Some(_), _) => {}
            (None, value) => {
                changes.insert(key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{Colormap, Look, Scene, Surface, ToneMap};

    fn scene(dimension: usize, render: &str) -> Scene {
        let (cells, size) = (vec![8; dimension], vec![1.0; dimension]);
        let text = format!(
            "title = \"look\"\ndomain = {{ dimension = {dimension}, cells = {cells:?}, size = {size:?} }}\n\
             gas.ambient = {{ density = 1, pressure = 1 }}\ntime.until = 1\n{render}"
        );
        Scene::parse(&text, "look.toml", &[]).unwrap()
    }

    #[test]
    fn a_look_fills_what_a_scene_leaves_out() {
        let film = scene(3, "[render]\nlook = \"film\"\ncolormap = \"magma\"\noverlays = { time = true }").render;
        assert_eq!((film.look, film.tone, film.surface), (Look::Film, ToneMap::Aces, Surface::Smooth));
        assert_eq!(film.colormap, Colormap::Magma, "what the scene says stays");
        assert!(film.overlays.time && !film.overlays.title && !film.overlays.edges);
        let plain = scene(3, "").render;
        assert_eq!((plain.look, plain.tone, plain.overlays.title), (Look::Lab, ToneMap::None, true));
        let plane = scene(2, "[render]\nlook = \"film\"").render;
        assert_eq!((plane.colormap, plane.overlays.color_bar), (Colormap::Viridis, false));
    }

    #[test]
    fn a_look_is_written_down_as_its_keys() {
        let film = scene(3, "[render]\nlook = \"film\"\ntone = \"none\"");
        let text = toml::to_string(&film).unwrap();
        assert_eq!(Scene::parse(&text, "again.toml", &[]).unwrap().render, film.render);
    }

    #[test]
    fn an_override_decides_all_keys_of_a_look() {
        let text = toml::to_string(&scene(3, "[render]\nlook = \"film\"\ntone = \"none\"")).unwrap();
        let read = |overrides: &[&str]| {
            let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
            Scene::parse(&text, "run.toml", &overrides).unwrap().render
        };
        let lab = read(&["render.look=lab"]);
        assert_eq!((lab.tone, lab.surface, lab.overlays.title), (ToneMap::None, Surface::Smooth, true));
        let film = read(&["render.look=film", "render.surface=spheres"]);
        assert_eq!((film.tone, film.surface, film.overlays.title), (ToneMap::Aces, Surface::Spheres, false));
    }

    #[test]
    fn a_view_has_a_look_of_its_own() {
        let scene = scene(3, "[render.views.film]\nlook = \"film\"\nsupersampling = 1");
        let shots = scene.shots().unwrap();
        assert_eq!((shots[0].settings.look, shots[0].settings.overlays.title), (Look::Lab, true));
        let film = &shots[1].settings;
        assert_eq!((film.tone, film.supersampling, film.overlays.title), (ToneMap::Aces, 1, false));
    }
}
