//! Variants: named sets of changes that a scene file holds, `[variants.NAME]`, chosen by `--variant NAME`.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::source;
use crate::spelling::did_you_mean;

/// The variant that every large scene has for devices without a GPU.
pub const SMALL: &str = "small";
/// The override key that chooses a variant.
pub(super) const KEY: &str = "variant";

/// Makes the changes of the variant `name` to the document that holds it. `text` is the file's.
///
/// An entry of a variant changes the key that it names, as `--set` does: `"bodies[0].density" = 3`, `time.until = 1`. A value replaces
/// what was there, an inline table too; dotted keys and headers lead to the keys inside.
pub(super) fn apply(root: &mut DeTable<'_>, name: &str, text: &str) -> Result<(), String> {
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
