//! Finding scenes: files, standard input, and the shipped ones by name.

use std::path::Path;

use crate::scene::{Changes, Scene};
use crate::{Error, Result, input, spelling};

/// The name of the scene that comes on standard input.
pub const STANDARD_INPUT: &str = "-";

/// A shipped scene.
#[derive(Clone, Debug)]
pub struct Shipped {
    /// Name without folder and extension.
    pub name: String,
    /// Path below `scenes/`.
    pub path: String,
    /// Its text.
    pub text: String,
}

impl Shipped {
    fn new(path: &str, text: &str) -> Self {
        Self { name: stem(path), path: path.to_owned(), text: text.to_owned() }
    }

    /// Whether a user means this one: `sod`, `gas/sod` or `scenes/gas/sod.toml`.
    fn is_called(&self, name: &str) -> bool {
        let name = name.strip_prefix("scenes/").unwrap_or(name);
        name == self.name || name == self.path || Some(name) == self.path.strip_suffix(".toml")
    }
}

/// File name without folder and extension.
#[must_use]
pub fn stem(path: &str) -> String {
    if path == STANDARD_INPUT {
        return "standard_input".to_owned();
    }
    Path::new(path).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// The shipped scenes, which the program carries: the same wherever one stands.
#[must_use]
pub fn shipped() -> Vec<Shipped> {
    let mut found: Vec<Shipped> = crate::scene::EMBEDDED.iter().map(|(path, text)| Shipped::new(path, text)).collect();
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// The shipped scene that a user means.
///
/// # Errors
/// [`Error::Scene`] with the names most like it.
pub fn shipped_named(name: &str) -> Result<Shipped> {
    let mut all = shipped();
    if let Some(place) = all.iter().position(|scene| scene.is_called(name)) {
        return Ok(all.swap_remove(place));
    }
    let folder = Path::new(name);
    if folder.join("report.json").is_file() {
        return Err(Error::Scene(format!(
            "`{name}` is the folder of a run: `brisance render {name}` draws its frames again, `brisance view SCENE` runs its scene anew"
        )));
    }
    if folder.is_dir() {
        return Err(Error::Scene(format!(
            "`{name}` is a folder; name a scene file, or a shipped scene (`brisance list`)"
        )));
    }
    let like = spelling::did_you_mean(&stem(name), all.iter().map(|scene| scene.name.as_str()));
    let count = all.len();
    Err(Error::Scene(format!(
        "no file `{name}` and no shipped scene of that name{like} (`brisance list` prints all {count})"
    )))
}

/// The file that a user means: the bare name of a shipped scene means that scene, whatever lies in the folder that one stands in.
#[must_use]
pub fn scene_file(name: &str) -> Option<&Path> {
    let path = Path::new(name);
    let bare = || shipped().iter().any(|scene| scene.name == name);
    (path.exists() && !path.is_dir() && !bare()).then_some(path)
}

impl Scene {
    /// Reads a scene file, the shipped scene of that name, or for `-` standard input, and makes changes as [`Scene::load`] does.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is none of that name or it is wrong.
    pub fn find(name: &str, changes: impl Into<Changes>) -> Result<Scene> {
        let changes = changes.into();
        if name == STANDARD_INPUT {
            let text = input::standard(input::MOST_SCENE);
            let text = text.map_err(|source| Error::Scene(format!("standard input: {source}")))?;
            return Scene::written(&text, "standard input", &changes);
        }
        if let Some(path) = scene_file(name) {
            return Scene::load(path, changes);
        }
        let scene = shipped_named(name)?;
        Scene::parse(&scene.text, &format!("scenes/{}", scene.path), changes)
    }
}
