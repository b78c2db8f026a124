//! Finding scenes: files, and the shipped ones by name.

use std::path::Path;

use super::Scene;
use crate::{Error, Result};

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
    Path::new(path).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// The shipped scenes: those in the folder `scenes` where there is one, otherwise those that the program carries.
#[must_use]
pub fn shipped() -> Vec<Shipped> {
    let mut found = Vec::new();
    collect(Path::new("scenes"), &mut found);
    if found.is_empty() {
        found = super::EMBEDDED.iter().map(|(path, text)| Shipped::new(path, text)).collect();
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

fn collect(folder: &Path, found: &mut Vec<Shipped>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            collect(&path, found);
        } else if let (true, Ok(text)) =
            (path.extension().is_some_and(|end| end == "toml"), std::fs::read_to_string(&path))
        {
            let below = path.strip_prefix("scenes").unwrap_or(&path);
            found.push(Shipped::new(&below.to_string_lossy().replace('\\', "/"), &text));
        }
    }
}

impl Scene {
    /// Reads a scene file, or the shipped scene of that name, and applies overrides as [`Scene::load`] does.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is none of that name or it is wrong.
    pub fn find(name: &str, overrides: &[String]) -> Result<Scene> {
        if Path::new(name).is_file() {
            return Scene::load(name, overrides);
        }
        let shipped = shipped();
        match shipped.iter().find(|scene| scene.is_called(name)) {
            Some(scene) => Scene::parse(&scene.text, &format!("scenes/{}", scene.path), overrides),
            None => Err(unknown(name, &shipped)),
        }
    }
}

fn unknown(name: &str, shipped: &[Shipped]) -> Error {
    let names: Vec<&str> = shipped.iter().map(|scene| scene.name.as_str()).collect();
    Error::Scene(format!("no file `{name}` and no shipped scene of that name; there are: {}", names.join(", ")))
}
