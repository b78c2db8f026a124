//! What is changed about a scene as it is written: variants, which are named sets of changes that its file holds, `[variants.NAME]`,
//! chosen by `--variant NAME`; and keys.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene::file::source;
use crate::scene::finding::Finding;
use crate::spelling::did_you_mean;

/// The variant that every large scene has for devices without a GPU.
pub const SMALL: &str = "small";

/// The variant of scenes that are too large for a processor whose pictures still show what happens: a quarter of an hour.
pub const GALLERY: &str = "gallery";

/// Whether a variant is another size of a scene, not another experiment.
#[must_use]
pub fn is_size(variant: &str) -> bool {
    [SMALL, GALLERY].contains(&variant)
}

/// Changes to a scene: first its variants, then keys, both in their order. A list of keys is one, too.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Names of the scene's own variants.
    pub variants: Vec<String>,
    /// Keys and values, as `gas.ambient.density=2` or `bodies[0].material=rubber`. Values are TOML; what is no TOML value is taken as a
    /// string.
    pub set: Vec<String>,
    /// Whether meshes and fonts may lie outside of the folder of the scene.
    pub outside: bool,
}

impl Changes {
    /// One of the scene's variants.
    #[must_use]
    pub fn variant(name: impl Into<String>) -> Self {
        Self { variants: vec![name.into()], ..Self::default() }
    }

    /// The same with one more key and its value.
    #[must_use]
    pub fn set(mut self, key: impl Into<String>) -> Self {
        self.set.push(key.into());
        self
    }

    /// Variants and keys as words, for people.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        self.variants.iter().chain(&self.set).cloned().collect()
    }
}

impl From<&Changes> for Changes {
    fn from(changes: &Changes) -> Self {
        changes.clone()
    }
}

impl From<&[String]> for Changes {
    fn from(set: &[String]) -> Self {
        Self { set: set.to_vec(), ..Self::default() }
    }
}

impl From<&Vec<String>> for Changes {
    fn from(set: &Vec<String>) -> Self {
        set.as_slice().into()
    }
}

impl<const N: usize> From<&[String; N]> for Changes {
    fn from(set: &[String; N]) -> Self {
        set.as_slice().into()
    }
}

/// Makes the changes of the variants of these names, one after the other; what could not be made.
pub(crate) fn apply_all(root: &mut DeTable<'_>, names: &[String], text: &str) -> Vec<Finding> {
    let help = "name one of the scene's variants, with keys and entries that exist";
    let wrong = |name: &String| Some(Finding::new("variants", apply(root, name, text).err()?, help));
    names.iter().filter_map(wrong).collect()
}

/// Makes the changes of the variant `name` to the document that holds it. `text` is the file's.
///
/// An entry of a variant changes the key that it names, as `--set` does: `"bodies[0].density" = 3`, `time.until = 1`. A value replaces
/// what was there, an inline table too; dotted keys and headers lead to the keys inside.
fn apply(root: &mut DeTable<'_>, name: &str, text: &str) -> Result<(), String> {
    let empty = DeTable::new();
    let variants = root.get("variants").and_then(|value| value.get_ref().as_table()).unwrap_or(&empty);
    let Some(variant) = variants.get(name).and_then(|value| value.get_ref().as_table()) else {
        let known = variants.keys().map(|key| format!("`{}`", key.get_ref())).collect::<Vec<_>>();
        let known = if known.is_empty() { "no variants".to_owned() } else { known.join(", ") };
        let like = did_you_mean(name, variants.keys().map(|key| &**key.get_ref()));
        return Err(format!("no variant `{name}`; this scene has {known}{like}"));
    };
    let mut changes = Vec::new();
    collect("", variant, text, &mut changes);
    for (path, value) in changes {
        source::set(root, &path, value).map_err(|message| format!("variant `{name}`: {path}: {message}"))?;
    }
    Ok(())
}

/// Paths, as [`source::set`] takes them, and values.
fn collect<'a>(path: &str, table: &DeTable<'a>, text: &str, changes: &mut Vec<(String, Spanned<DeValue<'a>>)>) {
    for (key, value) in table {
        let key = source::key_path(key.get_ref());
        let path = if path.is_empty() { key } else { format!("{path}.{key}") };
        let inline = text.get(value.span()).is_some_and(|written| written.starts_with('{'));
        match value.get_ref() {
            DeValue::Table(inner) if !inline => collect(&path, inner, text, changes),
            _ => changes.push((path, value.clone())),
        }
    }
}
