//! Files of other programs: `tests/meshes`, whose table says what each must hold.

use std::collections::BTreeSet;
use std::path::Path;

use super::{Mesh, MeshFolder, Surfaces};
use crate::scene::geometry::distance::{cross, dot};

/// Bytes that the folder may have.
const MOST_BYTES: u64 = 1_500_000;
/// Files that it has at least.
const LEAST_FILES: usize = 60;

/// Volume that a row's file encloses, as a body has it.
fn enclosed(folder: &Path, file: &str, options: &str) -> Result<f64, String> {
    let mesh: Mesh = toml::from_str(&format!("path = \"{file}\"\n{options}")).map_err(|error| error.to_string())?;
    let place = MeshFolder { folder, outside: false, dimension: 3 };
    if let Some(finding) = mesh.resolve("mesh", place, &mut Surfaces::default()) {
        return Err(format!("{finding:?}"));
    }
    let tree = mesh.tree.get().ok_or("no surface")?;
    let sixth = |[a, b, c]: &[[f64; 3]; 3]| dot(*a, cross(*b, *c)) / 6.0;
    Ok(tree.triangles().iter().map(sixth).sum::<f64>().abs() * mesh.scale.powi(3))
}

#[test]
fn files_of_other_programs_have_their_volumes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
    let table = std::fs::read_to_string(folder.join("SOURCES.md")).unwrap();
    let (mut named, mut wrong) = (BTreeSet::new(), Vec::new());
    for row in table.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`')).collect();
        let [file, volume, _, _, options] = cells[..] else { panic!("{row}") };
        let volume: f64 = volume.parse().unwrap();
        named.insert(file.to_owned());
        match enclosed(&folder, file, options) {
            // seven digits are the least that any of them writes
            Ok(found) if (found / volume - 1.0).abs() < 2e-6 => {}
            Ok(found) => wrong.push(format!("{file}: {found} instead of {volume}")),
            Err(message) => wrong.push(format!("{file}: {message}")),
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), named.len(), wrong.join("\n"));
    let (mut meshes, mut bytes) = (BTreeSet::new(), 0);
    for entry in std::fs::read_dir(&folder).unwrap() {
        let entry = entry.unwrap();
        bytes += entry.metadata().unwrap().len();
        let name = entry.file_name().into_string().unwrap();
        // buffers of a .gltf are no meshes
        if name != "SOURCES.md" && !name.ends_with(".bin") {
            meshes.insert(name);
        }
    }
    assert_eq!(meshes, named, "each file has its row");
    assert!(named.len() >= LEAST_FILES && bytes < MOST_BYTES, "{} files, {bytes} bytes", named.len());
}
