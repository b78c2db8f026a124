//! Embeds the shipped scenes and models, so that `brisance run sod` works wherever the binary lies. Adding one is adding one file.

#![allow(clippy::disallowed_macros)]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

fn main() {
    let mut text = table("scenes", "EMBEDDED", "/// Path below `scenes/` and text of every shipped scene.");
    text += &table("assets/models", "MODELS", "/// Path below `assets/models/` and text of every shipped shape.");
    let target = PathBuf::from(std::env::var("OUT_DIR").expect("cargo sets it")).join("scenes.rs");
    std::fs::write(target, text).expect("cargo's output folder can be written");
}

/// A constant with path and text of every TOML file below a folder.
fn table(folder: &str, constant: &str, head: &str) -> String {
    println!("cargo::rerun-if-changed={folder}");
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets it")).join(folder);
    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let mut table = format!("{head}\npub(crate) const {constant}: &[(&str, &str)] = &[\n");
    for file in &files {
        let name = file.strip_prefix(&root).expect("collected below it").to_string_lossy().replace('\\', "/");
        // Writing to a String cannot fail.
        let _ = writeln!(table, "    ({name:?}, include_str!({:?})),", file.display().to_string());
    }
    table.push_str("];\n");
    table
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    println!("cargo::rerun-if-changed={}", folder.display());
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            files.push(path);
        }
    }
}
