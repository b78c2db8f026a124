//! Every WGSL file resolves and validates for one, two and three dimensions; no device needed.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use brisance::gpu::{Compiled, Folder, SOURCES, Shader};
use wgpu::naga;

use crate::common::{files_below, is_kind, report, slashed};

/// Shaders of the pictures; all others belong to the step.
const PICTURES: [&str; 18] = [
    "picture/arrows.wgsl",
    "picture/bend.wgsl",
    "picture/bricks.wgsl",
    "picture/dust.wgsl",
    "picture/field.wgsl",
    "picture/finish.wgsl",
    "picture/glow.wgsl",
    "picture/layers.wgsl",
    "picture/light.wgsl",
    "picture/lone.wgsl",
    "picture/near.wgsl",
    "picture/optics.wgsl",
    "picture/points.wgsl",
    "picture/skin.wgsl",
    "picture/slice.wgsl",
    "picture/solids.wgsl",
    "picture/trace_skin.wgsl",
    "picture/volume.wgsl",
];

/// The text injected before a shader's source.
pub(crate) fn constants(shader: &str) -> String {
    if PICTURES.contains(&shader) {
        return brisance::render::shader_constants();
    }
    brisance::state::constants::source_for(shader)
}

/// The folder the embedded table must equal.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders")
}

/// All shader files on disk: path below `shaders/`, text.
pub(crate) fn files() -> BTreeMap<String, String> {
    let paths = files_below(&folder()).into_iter().filter(|path| is_kind(path, "wgsl"));
    paths.map(|path| (slashed(&path), std::fs::read_to_string(folder().join(path)).unwrap())).collect()
}

/// Files with entry points.
pub(crate) fn stages() -> Vec<String> {
    files().into_iter().filter(|(_, text)| text.contains("\n@compute")).map(|(name, _)| name).collect()
}

#[test]
fn the_embedded_table_equals_the_folder() {
    let on_disk = files();
    let embedded: BTreeMap<String, String> =
        SOURCES.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
    let missing: Vec<_> = on_disk.keys().filter(|name| !embedded.contains_key(*name)).collect();
    assert!(missing.is_empty(), "add to src/gpu/sources.rs: {missing:?}");
    assert_eq!(embedded.keys().collect::<Vec<_>>(), on_disk.keys().collect::<Vec<_>>());
    let names: Vec<_> = SOURCES.iter().map(|(name, _)| *name).collect();
    assert!(names.is_sorted(), "keep src/gpu/sources.rs in alphabetical order");
}

/// DirectX 12 tells it zeros in indirect dispatches.
#[test]
fn no_kernel_asks_for_the_number_of_workgroups() {
    let asks = |text: &str| words(text).contains("num_workgroups");
    let failures: Vec<_> = files().into_iter().filter(|(_, text)| asks(text)).map(|(name, _)| name).collect();
    report(&failures);
}

/// Sets the overrides of one entry point as a kernel would: DIM, and 1 where there is no default.
fn specialise(compiled: &Compiled, entry: &str, dimension: u32) -> Result<(), String> {
    let mut values = HashMap::<String, f64>::new();
    for (_, declared) in compiled.module.overrides.iter() {
        let name = declared.name.clone().unwrap_or_default();
        if name == "DIM" {
            values.insert(name, f64::from(dimension));
        } else if declared.init.is_none() {
            values.insert(name, 1.0);
        }
    }
    let values = values.into_iter().collect();
    let point = Some((naga::ShaderStage::Compute, entry));
    naga::back::pipeline_constants::process_overrides(&compiled.module, &compiled.uses, point, &values)
        .map(|_| ())
        .map_err(|error| error.to_string())
}

#[test]
fn every_stage_validates_in_every_dimension() {
    let mut failures = Vec::new();
    for name in stages() {
        for dimension in 1..=3 {
            let compiled = Shader::load(&name, &constants(&name), &Folder::Disk(folder())).and_then(Shader::compile);
            let compiled = match compiled {
                Ok(compiled) => compiled,
                Err(error) => {
                    failures.push(format!("DIM {dimension}: {error}"));
                    continue;
                }
            };
            for entry in compiled.entry_points() {
                let wrong = [
                    compiled.bindings(entry).err().map(|error| error.to_string()),
                    compiled.threads_per_group(entry).err().map(|error| error.to_string()),
                    specialise(&compiled, entry, dimension).err(),
                ];
                failures
                    .extend(wrong.into_iter().flatten().map(|text| format!("DIM {dimension}: {name} {entry}: {text}")));
            }
            if compiled.entry_points().next().is_none() {
                failures.push(format!("{name}: no entry point; shared code belongs to shaders/shared"));
            }
        }
    }
    report(&failures);
}

/// Identifiers of a text without its comments.
fn words(text: &str) -> BTreeSet<&str> {
    text.lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .filter(|line| !line.starts_with('#'))
        .flat_map(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_'))
        .filter(|word| !word.is_empty())
        .collect()
}

/// Names a file declares at module scope.
fn declared(text: &str) -> BTreeSet<&str> {
    let mut names = BTreeSet::new();
    for line in text.lines() {
        let keyword = ["fn ", "struct ", "const ", "override ", "alias ", "var<", "@group"];
        if keyword.iter().any(|keyword| line.starts_with(keyword)) {
            // `var<storage, read_write> name: type`: the name follows the address space, elsewhere the keyword.
            let rest = line.split_once('>').filter(|_| line.contains("var<")).map_or(line, |(_, rest)| rest);
            let mut parts = rest.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|part| !part.is_empty());
            let name = if line.contains("var<") { parts.next() } else { parts.nth(1) };
            names.extend(name);
        }
    }
    names
}

/// Files of a shader that its own text and the injected one never need: neither directly nor through a file they need.
fn unused(shader: &Shader, files: &BTreeMap<String, String>, injected: &str) -> Vec<String> {
    let mut needed = words(injected);
    let mut waiting: Vec<&String> = shader.files().iter().collect();
    let mut next = waiting.iter().position(|name| **name == shader.name);
    while let Some(at) = next {
        needed.extend(words(&files[waiting.swap_remove(at)]));
        next = waiting.iter().position(|name| !declared(&files[*name]).is_disjoint(&needed));
    }
    waiting.into_iter().cloned().collect()
}

#[test]
fn every_included_file_is_used() {
    let files = files();
    let mut failures = Vec::new();
    let mut included = BTreeSet::new();
    for name in stages() {
        let injected = constants(&name);
        match Shader::load(&name, &injected, &Folder::Disk(folder())) {
            Err(error) => failures.push(error.to_string()),
            Ok(shader) => {
                let dead = unused(&shader, &files, &injected);
                failures.extend(dead.iter().map(|file| format!("{name}: nothing of {file} is used")));
                included.extend(shader.files().iter().cloned());
            }
        }
    }
    let orphans = files.keys().filter(|name| !included.contains(*name));
    failures.extend(orphans.map(|name| format!("nothing includes {name}")));
    report(&failures);
}
