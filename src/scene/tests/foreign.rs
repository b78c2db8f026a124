//! Mesh files as other programs write them.

use super::meshes::{ball, gltf, load, refused, stl, volume};
use super::{BASE, owned};
use crate::scene::{Changes, Scene};

/// Corners of a box from the origin, and its twelve triangles.
fn cuboid(size: [f64; 3], at: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
    let corner =
        |k: usize| -> [f64; 3] { std::array::from_fn(|d| at[d] + if k >> d & 1 == 1 { size[d] } else { 0.0 }) };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).map(|t| t.map(corner)).collect()
}

fn ascii(solids: &[Vec<[[f64; 3]; 3]>]) -> String {
    let facet = |t: &[[f64; 3]; 3]| {
        let corners: String = t.iter().map(|[x, y, z]| format!("      vertex {x} {y} {z}\n")).collect();
        format!("  facet normal 0 0 0\n    outer loop\n{corners}    endloop\n  endfacet\n")
    };
    let solid = |triangles: &Vec<[[f64; 3]; 3]>| {
        format!("solid part\n{}endsolid part\n", triangles.iter().map(facet).collect::<String>())
    };
    solids.iter().map(solid).collect()
}

#[test]
fn all_solids_of_a_file_count() {
    let folder = tempfile::tempdir().unwrap();
    let two = [cuboid([0.25; 3], [0.125; 3]), cuboid([0.25; 3], [0.5; 3])];
    std::fs::write(folder.path().join("two.stl"), ascii(&two)).unwrap();
    let scene = load(folder.path(), "path = \"two.stl\"", &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!((volume(&scene) / (2.0 * 0.25f64.powi(3)) - 1.0).abs() < 1e-6, "{}", volume(&scene));
    // a binary file may begin with the same word
    let surface = ball(2);
    let mut bytes = stl(&surface);
    bytes[..5].copy_from_slice(b"solid");
    std::fs::write(folder.path().join("b.stl"), bytes).unwrap();
    load(folder.path(), "path = \"b.stl\", offset = [0.5, 0.5, 0.5]", &[]).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn obj_with_empty_materials_and_continued_lines() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "mtllib\nusemtl\no\ng\n".to_owned();
    for t in cuboid([0.5; 3], [0.25; 3]) {
        for [x, y, z] in t {
            text.push_str(&format!("v {x} \\\n {y} {z}\n"));
        }
        text.push_str("usemtl \nf -3 \\\r\n -2 -1\n");
    }
    std::fs::write(folder.path().join("a.obj"), text).unwrap();
    let scene = load(folder.path(), "path = \"a.obj\"", &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!((volume(&scene) / 0.125 - 1.0).abs() < 1e-6, "{}", volume(&scene));
}

#[test]
fn corners_that_rounding_parted_are_joined_and_holes_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut triangles = cuboid([0.5; 3], [0.25; 3]);
    for (k, triangle) in triangles.iter_mut().enumerate() {
        triangle[0][0] += 1e-9 * k as f64;
    }
    std::fs::write(folder.path().join("parted.stl"), ascii(&[triangles.clone()])).unwrap();
    load(folder.path(), "path = \"parted.stl\"", &[]).unwrap_or_else(|error| panic!("{error}"));
    triangles.pop();
    std::fs::write(folder.path().join("hole.stl"), ascii(&[triangles.clone()])).unwrap();
    refused(folder.path(), "path = \"hole.stl\"", &["3 edges", "such as the one from", "repair"]);
    triangles[3][1][2] += 1e-3;
    std::fs::write(folder.path().join("gap.stl"), ascii(&[triangles])).unwrap();
    refused(folder.path(), "path = \"gap.stl\"", &["the surface is open"]);
}

#[test]
fn what_is_up_in_the_file_is_up_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    // a tower along y, as in glTF
    let tower: Vec<[[f64; 3]; 3]> = cuboid([0.2, 0.8, 0.1], [0.0; 3]);
    let points: Vec<[f64; 3]> = tower.iter().flatten().copied().collect();
    let faces = (0..tower.len()).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let (text, buffer) = gltf(&(points.clone(), faces), points.len(), "t.bin");
    std::fs::write(folder.path().join("t.gltf"), text).unwrap();
    std::fs::write(folder.path().join("t.bin"), buffer).unwrap();
    std::fs::write(folder.path().join("t.stl"), ascii(&[tower])).unwrap();
    let extent = |mesh: &str, axis: usize| {
        let scene = load(folder.path(), mesh, &[]).unwrap_or_else(|error| panic!("{error}"));
        let (low, high) = scene.bodies[0].shape.bounds();
        high[axis] - low[axis]
    };
    let down = "offset = [0.0, 0.0, -0.5]";
    assert!((extent(&format!("path = \"t.gltf\", {down}"), 2) - 0.8).abs() < 1e-6);
    assert!((extent("path = \"t.stl\", offset = [0.1, 0.1, 0.1]", 1) - 0.8).abs() < 1e-6);
    assert!((extent("path = \"t.stl\", up = \"y\", offset = [0.1, 0.5, 0.1]", 2) - 0.8).abs() < 1e-6);
    assert!((extent(&format!("path = \"t.gltf\", node = \"ball\", {down}"), 2) - 0.8).abs() < 1e-6);
    refused(
        folder.path(),
        &format!("path = \"t.gltf\", node = \"bal\", {down}"),
        &["no node `bal`", "did you mean `ball`"],
    );
    refused(folder.path(), "path = \"t.stl\", node = \"a\"", &["no named nodes"]);
    refused(folder.path(), "path = \"t.stl\", scale = 1000, offset = [100, 100, 100]", &["scale = 0.001"]);
}

#[test]
fn parts_that_use_each_other_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let nodes: Vec<String> = (1..30).map(|k| format!("{{\"children\": [{k}, {k}]}}")).collect();
    let text = format!(
        "{{\"asset\": {{\"version\": \"2.0\"}}, \"scene\": 0, \"scenes\": [{{\"nodes\": [0]}}], \"nodes\": [{}, {{}}]}}",
        nodes.join(", ")
    );
    std::fs::write(folder.path().join("dag.gltf"), text).unwrap();
    refused(folder.path(), "path = \"dag.gltf\"", &["more than 100000 nodes"]);
    let head = "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\n";
    let faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    std::fs::write(folder.path().join("none.ply"), format!("{head}{faces}")).unwrap();
    refused(folder.path(), "path = \"none.ply\"", &["without properties"]);
    std::fs::write(folder.path().join("many.ply"), format!("{head}property float x\n{faces}")).unwrap();
    refused(folder.path(), "path = \"many.ply\"", &["more than the file has room for"]);
}

#[test]
#[cfg(unix)]
fn a_link_out_of_the_folder_is_refused_however_the_scene_is_named() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("scene");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(root.path().join("out.stl"), ascii(&[cuboid([0.5; 3], [0.25; 3])])).unwrap();
    std::os::unix::fs::symlink("../out.stl", folder.join("link.stl")).unwrap();
    refused(&folder, "path = \"link.stl\"", &["lies outside"]);
    std::os::unix::fs::symlink("/dev/zero", folder.join("zero.stl")).unwrap();
    refused(&folder, "path = \"zero.stl\"", &["lies outside"]);
    let text =
        load(&folder, "path = \"zero.stl\"", Changes { outside: true, ..Changes::default() }).map(|_| ()).unwrap_err();
    assert!(text.contains("no regular file"), "{text}");
    // the folder of a file without one is the one that we stand in
    let text = BASE
        .replace("dimension = 2", "dimension = 3")
        .replace("[20, 10]", "[8, 8, 8]")
        .replace("[2.0, 1.0]", "[1.0, 1.0, 1.0]");
    let text = format!("{text}[shapes]\na = {{ mesh = {{ path = \"/etc/hostname\" }} }}\n");
    let told = Scene::parse(&text, "s.toml", &owned(&[])).unwrap_err().to_string();
    assert!(told.contains("no mesh file") || told.contains("lies outside"), "{told}");
}

#[test]
fn a_part_of_a_gltf_whose_positions_are_missing_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let text =
        "{\"asset\": {\"version\": \"2.0\"}, \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}]}";
    std::fs::write(folder.path().join("m.gltf"), text).unwrap();
    refused(folder.path(), "path = \"m.gltf\"", &["m.gltf", "accessor 0 of 0"]);
}
