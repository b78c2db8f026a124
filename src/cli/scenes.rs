//! The scene that the command line names.

use super::args::SceneOptions;
use crate::Result;
use crate::scene::{Changes, Scene, scene_file};

/// Reads the scene that the options name, in the variants asked for, with `further` keys, at the resolution asked for.
///
/// # Errors
/// [`crate::Error::Scene`] if there is none of that name or it is wrong.
pub(super) fn load(options: &SceneOptions, further: &[String]) -> Result<Scene> {
    let scene = Scene::find(&options.scene, changes(options, further))?;
    match options.resolution {
        Some(cells) => scene.with_resolution(cells),
        None => Ok(scene),
    }
}

/// Everything that the options and `further` change about a scene.
pub(super) fn changes(options: &SceneOptions, further: &[String]) -> Changes {
    let set = options.set.iter().chain(further).cloned().collect();
    Changes { variants: options.variant.clone(), set, outside: options.allow_outside }
}

/// Where a scene lies: the whole path of a file, or the name of a shipped scene.
pub(super) fn place(name: &str) -> String {
    let whole = scene_file(name).and_then(|path| std::fs::canonicalize(path).ok());
    whole.map_or_else(|| name.to_owned(), |path| path.display().to_string())
}
