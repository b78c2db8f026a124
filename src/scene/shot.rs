//! The views of a scene: what is drawn of every frame, each with its own camera and look.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::{Expect, Field, Output, RenderSettings, Scene, Surface};
use crate::{Error, Result};

/// One view: what is drawn of every frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Its name; empty for the scene's own look.
    pub name: String,
    /// Fields shown, one picture each.
    pub fields: Vec<Field>,
    /// The look.
    pub settings: RenderSettings,
}

/// The keys of `[render.views.NAME]`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "View")]
pub struct ShotKeys {
    /// Fields shown, one picture each; those of `output.fields` when left out.
    #[schemars(default)]
    fields: Vec<Field>,
    /// What the view changes.
    #[serde(flatten)]
    settings: RenderSettings,
}

/// Start and factor of the hash FNV-1a of 128 bits [RFC 9923].
const FNV_OFFSET: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const FNV_PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

/// Keys that say where the camera is: the one of a view replaces the other of the scene.
const CAMERAS: [&str; 2] = ["camera", "path"];

impl Scene {
    /// Whether a run keeps maps of what has been so far: the scene asks for them, or for a picture of one.
    #[must_use]
    pub fn keeps_maps(&self) -> bool {
        let shown = || self.shots().is_ok_and(|shots| shots.iter().any(|shot| shot.fields.iter().any(|f| f.is_map())));
        self.output.maps || self.output.fields.iter().any(|field| field.is_map()) || shown()
    }

    /// The scene's own look, then its further views by name.
    ///
    /// # Errors
    /// [`Error::Scene`] if the settings of a view are wrong; a scene that was read has been checked.
    pub fn shots(&self) -> Result<Vec<Shot>> {
        let own = Shot { name: String::new(), fields: self.output.fields.clone(), settings: self.own_look() };
        let mut shots = vec![own];
        for name in self.render.views.keys() {
            let found = self.shot(name);
            shots.push(found.map_err(|(key, message)| Error::Scene(format!("render.views.{name}.{key}: {message}")))?);
        }
        Ok(shots)
    }

    /// The scene's own look without the views.
    #[must_use]
    pub fn own_look(&self) -> RenderSettings {
        RenderSettings { views: BTreeMap::new(), ..self.render.clone() }
    }

    /// Time between two frames \[s\]: steps end there.
    #[must_use]
    pub fn frame_interval(&self) -> f64 {
        self.time.until / f64::from(self.time.frames.max(1))
    }

    /// Time of a frame \[s\].
    #[must_use]
    pub fn frame_time(&self, index: u32) -> f64 {
        self.time.until * f64::from(index) / f64::from(self.time.frames.max(1))
    }

    /// A number for everything that decides what the scene does, as 32 hexadecimal digits: not its pictures, its files, its
    /// expectations and its end. Mesh files count by their path. FNV-1a of 128 bits over the scene with all defaults, as JSON.
    #[must_use]
    pub fn hash(&self) -> String {
        // the same text for all looks, which a default of today must not change
        let render = RenderSettings { surface: Surface::Spheres, ..RenderSettings::default() };
        let mut same = Scene {
            render,
            output: Output::default(),
            expect: Expect::default(),
            variants: BTreeMap::new(),
            ..self.clone()
        };
        // frames end steps, so that their distance counts; up to the rounding of a longer run's
        (same.time.until, same.time.frames) = (f64::from(self.frame_interval() as f32), 1);
        let text = serde_json::to_vec(&same).expect("a scene is data");
        let hash = text.iter().fold(FNV_OFFSET, |hash, byte| (hash ^ u128::from(*byte)).wrapping_mul(FNV_PRIME));
        format!("{hash:032x}")
    }

    /// One of the further views; on failure the key below the view, and what is wrong with it.
    pub(super) fn shot(&self, name: &str) -> std::result::Result<Shot, (String, String)> {
        let nowhere = |error: &dyn std::fmt::Display| (String::new(), error.to_string());
        let mut changes = self.render.views.get(name).cloned().unwrap_or_default();
        let fields = match changes.remove("fields") {
            Some(fields) => located(fields).map_err(|(key, message)| (format!("fields{key}"), message))?,
            None => self.output.fields.clone(),
        };
        super::look::apply_to_view(&mut changes, self.domain.dimension);
        if changes.contains_key("views") {
            return Err(("views".to_owned(), "a view has no views of its own".to_owned()));
        }
        if changes.contains_key("font") {
            return Err(("font".to_owned(), "one font serves all views: give it as render.font".to_owned()));
        }
        let mut merged = Table::try_from(self.own_look()).map_err(|error| nowhere(&error))?;
        if CAMERAS.iter().any(|key| changes.contains_key(*key)) {
            for key in CAMERAS {
                merged.remove(key);
            }
        }
        merge(&mut merged, changes);
        let settings = RenderSettings { font: self.render.font.clone(), ..located(Value::Table(merged))? };
        Ok(Shot { name: name.to_owned(), fields, settings })
    }
}

/// Puts changes into a table: tables key by key, everything else as a whole.
fn merge(into: &mut Table, changes: Table) {
    for (key, value) in changes {
        match (into.get_mut(&key), value) {
            (Some(Value::Table(inner)), Value::Table(changed)) => merge(inner, changed),
            (_, value) => {
                into.insert(key, value);
            }
        }
    }
}

/// Reads a value; on failure the key, and what is wrong with it.
fn located<T: for<'de> Deserialize<'de>>(value: Value) -> std::result::Result<T, (String, String)> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = match error.path().to_string().as_str() {
            "." => String::new(),
            path => path.to_owned(),
        };
        let message = error.inner().message().trim().to_owned();
        (path, message)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "title = \"views\"\ndomain = { dimension = 3, cells = [8, 8, 8], size = [1, 1, 1] }\n\
                         gas.ambient = { density = 1.0, pressure = 1.0 }\ntime = { until = 1.0, frames = 1 }\n\
                         render.light.strength = 2\nrender.camera = { eye = [3, 0, 0], target = [0, 0, 0], height = 2.0 }\n";

    fn scene(more: &str) -> Result<Scene> {
        Scene::parse(&format!("{SCENE}{more}"), "views.toml", &[])
    }

    #[test]
    fn a_view_changes_what_it_names() {
        let text = "[render.views.top]\nfields = [\"pressure\"]\nsize = [64, 32]\nlight.ambient = 0.5\n\
                    [render.views.turning]\npath.orbit = 10";
        let shots = scene(text).unwrap().shots().unwrap();
        let [own, top, turning] = &shots[..] else { panic!("{} shots", shots.len()) };
        assert_eq!((own.name.as_str(), own.fields.as_slice()), ("", &[Field::Density][..]));
        assert_eq!((top.name.as_str(), top.fields.as_slice()), ("top", &[Field::Pressure][..]));
        assert_eq!((top.settings.size, top.settings.camera), ([64, 32], own.settings.camera));
        assert_eq!((top.settings.light.strength, top.settings.light.ambient), (2.0, 0.5));
        assert_eq!(own.settings.light.ambient, 0.35);
        assert!(turning.settings.camera.is_none() && turning.settings.path.is_some());
        assert!(shots.iter().all(|shot| shot.settings.views.is_empty()));
    }

    #[test]
    fn the_hash_names_what_the_scene_does() {
        let plain = scene("").unwrap();
        assert_eq!(plain.hash(), scene("render.size = [64, 64]\noutput.vtk = true").unwrap().hash());
        assert_ne!(plain.hash(), scene("gravity = [0.0, 0.0, -1.0]").unwrap().hash());
        assert_eq!(plain.hash().len(), 32);
        let why = "a new key is left out of the text of scenes that lack it, or runs of before are not drawn again";
        assert_eq!(plain.hash(), "99b929db285258d672430d515a640d39", "{why}");
        // what the report says is read back to the last bit
        let again: Scene = serde_json::from_str(&serde_json::to_string(&plain).unwrap()).unwrap();
        assert_eq!((again.hash(), &again), (plain.hash(), &plain));
    }

    #[test]
    fn mistakes_in_views_are_found_where_they_stand() {
        for (text, parts) in [
            ("[render.views.top]\nsize = [64, 8]", ["render.views.top.size", "8 is out of range"]),
            ("[render.views.top]\nsise = [64, 8]", ["render.views.top.sise", "unknown field `sise`"]),
            ("[render.views.top]\nlight.strength = \"much\"", ["render.views.top.light.strength", "much"]),
            ("[render.views.top]\nfields = [\"heat\"]", ["render.views.top.fields", "heat"]),
            ("[render.views.density]\nfields = [\"density\"]", ["render.views.density", "name of a field"]),
            ("[render.views.\"a/b\"]\nexposure = 1", ["render.views", "a/b"]),
            ("[render.views.top]\npath.keys = [{ time = 0, target = [0, 0, 0] }]", ["path.keys[0]", "eye"]),
        ] {
            let error = scene(text).unwrap_err().to_string();
            assert!(parts.iter().all(|part| error.contains(part)) && error.contains("views.toml:"), "{text}\n{error}");
        }
    }
}
