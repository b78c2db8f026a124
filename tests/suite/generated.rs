//! Parts of files that follow from tables in Rust: they stand between two lines, and `scripts/generate` writes them.

use std::path::Path;

use brisance::quantity;
use brisance::render::View;
use brisance::scene::schema;
use brisance::stage::structures;
use brisance::state::{arrays, stages};
use brisance::structure::Shared;

use crate::keys;

/// For each file below `shaders/` that shows structures of Rust: a kernel that takes it, and the structures.
pub(crate) fn shown() -> Vec<(&'static str, &'static str, Vec<Shared>)> {
    [structures::all(), vec![("picture/view.wgsl", "picture/finish.wgsl", vec![View::shared()])]].concat()
}

/// File, table that it follows from, and the text.
fn parts() -> Vec<(String, String, String)> {
    let [fields, wholes] = quantity::pages();
    let tables = [
        ("shaders/shared/state.wgsl", "src/state/arrays.rs", arrays::constants()),
        ("docs/inside/arrays.md", "src/state/arrays.rs", format!("\n{}\n", arrays::table())),
        ("docs/method/overview.md", "src/state/stages.rs", format!("\n{}\n", stages::table())),
        ("docs/inside/quantities.md", "src/quantity.rs", format!("\n{fields}\n")),
        ("docs/inside/quantities.md", "src/quantity/wholes.rs", format!("\n{wholes}\n")),
    ];
    let structures = shown().into_iter().map(|(file, _, shown)| {
        let texts: Vec<&str> = shown.iter().map(|own| own.wgsl.as_str()).collect();
        (format!("shaders/{file}"), shown[0].source.to_owned(), texts.join("\n"))
    });
    let tables = tables.into_iter().map(|(file, source, text)| (file.to_owned(), source.to_owned(), text));
    tables.chain(structures).chain(keys::parts()).collect()
}

/// The text of a file with a part of it written anew.
fn with_part(text: &str, source: &str, part: &str) -> Option<String> {
    let mark = format!("Generated from {source} by scripts/generate");
    let start = text.find(&mark)? + text[text.find(&mark)?..].find('\n')? + 1;
    let end = start + text[start..].find("End of what is generated")?;
    let end = text[..end].rfind('\n')? + 1;
    Some(format!("{}{part}{}", &text[..start], &text[end..]))
}

#[test]
fn what_is_generated_is_up_to_date() {
    let write = std::env::var_os("BRISANCE_GENERATE").is_some();
    let mut failures = Vec::new();
    let mut settle = |name: String, wanted: &dyn Fn(&str) -> String| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(&name);
        let text = std::fs::read_to_string(&path).unwrap();
        let wanted = wanted(&text);
        if text != wanted && write {
            std::fs::write(&path, wanted).unwrap();
        } else if text != wanted {
            failures.push(name);
        }
    };
    settle("docs/scene.schema.json".to_owned(), &|_| schema() + "\n");
    for (name, source, part) in parts() {
        settle(name, &|text| with_part(text, &source, &part).expect("lines around the generated part"));
    }
    assert!(failures.is_empty(), "run scripts/generate: {failures:?} differ from their tables");
}
