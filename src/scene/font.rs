//! `render.font`: a font file for letters that the fonts of the program lack.

use std::sync::OnceLock;

use ab_glyph::FontArc;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finding::Finding;
use super::geometry::mesh::MeshFolder;

/// Bytes that a font may have: those of East Asia have 20 MiB.
const MOST_BYTES: u64 = 64 << 20;

/// A font file, from the folder of the scene: TrueType or OpenType, `.ttf` or `.otf`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(from = "String", into = "String")]
#[schemars(with = "String")]
pub struct Font {
    path: String,
    /// Its letters, once the scene that names it has been read; nothing before.
    outlines: OnceLock<FontArc>,
}

impl From<String> for Font {
    fn from(path: String) -> Self {
        Self { path, outlines: OnceLock::new() }
    }
}

impl From<Font> for String {
    fn from(font: Font) -> Self {
        font.path
    }
}

impl PartialEq for Font {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Font {
    /// Its letters, if it has been read.
    pub(crate) fn outlines(&self) -> Option<FontArc> {
        self.outlines.get().cloned()
    }

    /// Reads the file.
    pub(super) fn resolve(&self, place: MeshFolder<'_>) -> Option<Finding> {
        let read = place.bytes(place.folder, &self.path, MOST_BYTES).and_then(|bytes| {
            let help = "give a TrueType or OpenType font, .ttf or .otf, not a collection";
            FontArc::try_from_vec(bytes).map_err(|_| (format!("`{}` is no font", self.path), help.to_owned()))
        });
        match read {
            Ok(font) => {
                let _ = self.outlines.set(font);
                None
            }
            Err((message, help)) => Some(Finding::new("render.font", message, help)),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::Error;
    use crate::scene::Scene;

    const SCENE: &str = "title = \"letters\"\ndomain = { dimension = 1, cells = [8], size = [1.0] }\n\
                         gas.ambient = { density = 1, pressure = 1 }\ntime.until = 1\n";

    fn load(folder: &Path, render: &str) -> Result<Scene, Error> {
        let file = folder.join("scene.toml");
        Scene::parse(&format!("{SCENE}{render}"), &file.display().to_string(), &[])
    }

    #[test]
    fn a_font_is_read_from_the_folder_of_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("own.ttf"), epaint_default_fonts::HACK_REGULAR).unwrap();
        std::fs::write(folder.path().join("text.ttf"), "no font").unwrap();
        let scene = load(folder.path(), "render.font = \"own.ttf\"\nrender.views.near = {}").unwrap();
        let shots = scene.shots().unwrap();
        assert!(shots.len() == 2 && shots.iter().all(|shot| shot.settings.font.as_ref().unwrap().outlines().is_some()));
        let wrong = [
            ("render.font = \"text.ttf\"", "`text.ttf` is no font"),
            ("render.font = \"none.ttf\"", "none.ttf: "),
            ("render.font = \"../own.ttf\"", "lies outside of the folder of the scene"),
            ("render.views.near.font = \"own.ttf\"", "one font serves all views"),
        ];
        for (render, expected) in wrong {
            let text = load(folder.path(), render).unwrap_err().to_string();
            assert!(text.contains(expected) && text.contains("font"), "{text}");
        }
    }
}
