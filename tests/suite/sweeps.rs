//! One file says which slot a thread has, and phases of a step are no strings.

use std::path::Path;

use brisance::state::Phase;

use crate::shaders::files;

/// Who writes the lists of slots.
const WRITER: &str = "interface/interface_mark.wgsl";
/// Who reads them.
const READER: &str = "shared/domain.wgsl";

/// Lines of shaders without comments.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.lines().map(|line| line.split("//").next().unwrap_or_default())
}

#[test]
fn one_shader_says_which_slot_a_thread_has() {
    let mut failures = Vec::new();
    let mut readers = 0;
    for (name, text) in files().iter().filter(|(name, _)| *name != WRITER && *name != "shared/state.wgsl") {
        let by_hand = |line: &str| {
            line.contains("LISTED_SLOTS") || line.contains("part(LENGTHS, 0u)") || line.contains("override SWEEP")
        };
        match lines(text).filter(|line| by_hand(line)).count() {
            0 => {}
            _ if name == READER => readers += 1,
            count => failures.push(format!("shaders/{name}: {count} lines; call swept_slot()")),
        }
    }
    assert!(failures.is_empty() && readers == 1, "{readers} readers of the lists\n{}", failures.join("\n"));
}

#[test]
fn phases_are_no_strings() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let declared = |name: &str| files().iter().any(|(_, text)| text.contains(&format!("override {name}:")));
    let names: Vec<_> = Phase::NAMES.iter().map(|name| name.to_uppercase()).filter(|name| !declared(name)).collect();
    assert!(names.len() > 10, "{names:?}");
    let mut folders = vec![root.join("stage"), root.join("simulation")];
    let mut texts = vec![root.join("simulation.rs")];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() { &mut folders } else { &mut texts }.push(path);
        }
    }
    for path in texts {
        let text = std::fs::read_to_string(&path).unwrap();
        let found = names.iter().find(|name| text.contains(&format!("\"{name}\"")));
        assert!(found.is_none() && !text.contains("phase: &str"), "{}: {found:?}", path.display());
    }
}
