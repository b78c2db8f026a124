//! Rooms of shaders: who includes what, and how much it takes to read a kernel.

use std::collections::BTreeSet;

use brisance::gpu::{Folder, Shader};

use crate::shaders::{constants, files, stages};

/// Files of `shaders/shared` at most.
const MOST_SHARED: usize = 12;
/// Files to read for `gas_advection` at most: its stage in Rust, its kernels, and all that they include.
const MOST_READ: usize = 8;

/// The first folder of a path.
fn room(name: &str) -> &str {
    name.split('/').next().unwrap_or_default()
}

/// The shader itself and all that it includes.
fn read_for(kernel: &str) -> Vec<String> {
    Shader::load(kernel, &constants(kernel), &Folder::Embedded).unwrap().files().to_vec()
}

fn includes(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("#include \"")?.strip_suffix('"'))
}

#[test]
fn files_include_their_own_room_what_is_shared_and_laws() {
    let mut failures = Vec::new();
    for (name, text) in files() {
        let own = room(&name);
        let wrong = includes(&text).filter(|file| ![own, "shared", "materials"].contains(&room(file)));
        failures.extend(wrong.map(|file| format!("{name} includes {file}")));
    }
    assert!(failures.is_empty(), "move what two rooms need to shared: {}", failures.join(", "));
}

#[test]
fn shared_files_are_few_and_each_serves_several_rooms() {
    let kernels: Vec<_> = stages().iter().map(|kernel| (room(kernel).to_owned(), read_for(kernel))).collect();
    let shared: Vec<_> = files().into_keys().filter(|name| room(name) == "shared").collect();
    assert!(shared.len() <= MOST_SHARED, "{} files in shaders/shared", shared.len());
    for name in shared {
        let rooms: BTreeSet<_> =
            kernels.iter().filter(|(_, files)| files.contains(&name)).map(|(room, _)| room).collect();
        assert!(rooms.len() > 1, "{name} serves {rooms:?}: it belongs there");
    }
}

/// Bindings that a file names as needed.
fn needed(text: &str) -> Vec<&str> {
    let list = text.lines().filter_map(|line| line.split_once("Needs the binding")?.1.strip_suffix('.'));
    let words = list.flat_map(|list| list.trim_start_matches('s').split([' ', ',']));
    words.filter(|word| !word.is_empty() && *word != "and").collect()
}

#[test]
fn a_shared_file_stands_alone_with_the_bindings_that_it_names() {
    for (name, text) in files().into_iter().filter(|(name, _)| room(name) == "shared") {
        let kernel = stages().into_iter().find(|kernel| read_for(kernel).contains(&name)).unwrap();
        let declared = |binding: &&str| {
            let mark = format!("> {binding}: ");
            files()[&kernel]
                .lines()
                .find(|line| line.contains(&mark))
                .unwrap_or_else(|| panic!("{kernel}: {binding}"))
                .to_owned()
        };
        let bindings: Vec<_> = needed(&text).iter().map(declared).collect();
        let alone = format!("#include \"{name}\"\n{}\n", bindings.join("\n"));
        let given = Folder::Given(vec![("alone.wgsl".to_owned(), alone)]);
        let compiled = Shader::load("alone.wgsl", &constants(&kernel), &given).and_then(Shader::compile);
        assert!(compiled.is_ok(), "{name} needs more than it names: {}", compiled.unwrap_err());
    }
}

#[test]
fn gas_advection_is_read_in_eight_files() {
    let kernel = "gas/gas_advection.wgsl";
    let files = [vec!["src/stage/gas/gas_advection.rs".to_owned()], read_for(kernel)].concat();
    assert!(files.len() <= MOST_READ, "{files:?}");
    let most = stages().into_iter().map(|kernel| (read_for(&kernel).len(), kernel)).max();
    eprintln!("gas_advection: {} files, {files:?}; most of a kernel: {most:?}", files.len());
}
