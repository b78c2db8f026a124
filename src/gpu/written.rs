//! Kernels as other compilers get them: final text, entry point, overrides. `scripts/tint` reads them.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use serde_json::json;

use super::reflect::{Access, Binding, Compiled};
use crate::error::{Error, Result};

/// Writes a kernel into a folder: the text of its shader under a name of its own, and one file that says how to specialise it. Kernels that
/// are there are left alone, so that several programs may write into one folder.
pub(super) fn write(folder: &Path, compiled: &Compiled, entry: &str, overrides: &[(&str, f64)]) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|source| Error::io(folder, source))?;
    let stem = compiled.shader.name.trim_end_matches(".wgsl").replace('/', "_");
    let text = format!("{stem}-{:016x}.wgsl", hash(&compiled.shader.text));
    let mut values: Vec<(&str, f64)> = overrides.to_vec();
    values.sort_by(|a, b| a.0.cmp(b.0));
    let bindings = compiled.bindings(entry)?.into_iter().map(|Binding { name, index, access, min_bytes }| {
        let access = match access {
            Access::Uniform => "uniform",
            Access::Read => "read-only-storage",
            Access::ReadWrite => "storage",
        };
        json!({ "binding": index, "name": name, "type": access, "min_bytes": min_bytes })
    });
    let overrides = values.iter().map(|(name, value)| ((*name).to_owned(), json!(value)));
    let kernel = json!({ "text": text, "shader": compiled.shader.name, "entry": entry,
        "overrides": overrides.collect::<serde_json::Map<_, _>>(), "bindings": bindings.collect::<Vec<_>>() });
    let kernel = format!("{kernel:#}\n");
    put(folder, &text, &compiled.shader.text)?;
    put(folder, &format!("{stem}-{entry}-{:016x}.json", hash(&kernel)), &kernel)
}

fn hash(text: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    hasher.finish()
}

/// Complete at every moment.
fn put(folder: &Path, name: &str, text: &str) -> Result<()> {
    let path = folder.join(name);
    if path.exists() {
        return Ok(());
    }
    let failed = |source| Error::io(&path, source);
    let file = tempfile::NamedTempFile::new_in(folder).map_err(failed)?;
    std::fs::write(file.path(), text).map_err(failed)?;
    file.persist(&path).map_err(|error| failed(error.error))?;
    Ok(())
}
