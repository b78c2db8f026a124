//! Mesh files of all formats, and files that are wrong.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use super::{BASE, owned};
use crate::scene::{Changes, Scene};

pub(super) type Surface = (Vec<[f64; 3]>, Vec<[usize; 3]>);

/// A ball of radius 0.3 from an octahedron whose triangles are divided `times` times.
pub(super) fn ball(times: u32) -> Surface {
    let mut triangles: Vec<[[f64; 3]; 3]> = Vec::new();
    for k in 0..8 {
        let sign = |d: u32| if k >> d & 1 == 1 { -1.0 } else { 1.0 };
        let [a, b, c] = [[sign(0), 0.0, 0.0], [0.0, sign(1), 0.0], [0.0, 0.0, sign(2)]];
        triangles.push(if sign(0) * sign(1) * sign(2) > 0.0 { [a, b, c] } else { [a, c, b] });
    }
    for _ in 0..times {
        let middle = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|d| 0.5 * (a[d] + b[d]));
        let parts = |[a, b, c]: [[f64; 3]; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(parts).collect();
    }
    let onto = |p: [f64; 3]| {
        let norm = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| f64::from((0.3 * x / norm) as f32))
    };
    let points: Vec<[f64; 3]> = triangles.iter().flatten().map(|p| onto(*p)).collect();
    (points, (0..triangles.len()).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
}

pub(super) fn obj((points, triangles): &Surface) -> Vec<u8> {
    // a material library that must not be opened
    let mut text = "mtllib ../../secret.mtl\n".to_owned();
    for [x, y, z] in points {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for t in triangles {
        let _ = writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    text.into_bytes()
}

pub(super) fn ply((points, triangles): &Surface) -> Vec<u8> {
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        points.len(),
        triangles.len()
    );
    for [x, y, z] in points {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    for t in triangles {
        let _ = writeln!(text, "3 {} {} {}", t[0], t[1], t[2]);
    }
    text.into_bytes()
}

fn floats(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    values.into_iter().flat_map(|x| (x as f32).to_le_bytes()).collect()
}

pub(super) fn stl((points, triangles): &Surface) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for t in triangles {
        bytes.extend(floats([0.0; 3]));
        bytes.extend(floats(t.iter().flat_map(|k| points[*k])));
        bytes.extend([0, 0]);
    }
    bytes
}

/// A glTF whose buffer is the file `ball.bin`; a node moves the ball by (0.5, 0.5, 0.5). `claimed`: points it says it has.
pub(super) fn gltf((points, triangles): &Surface, claimed: usize, uri: &str) -> (String, Vec<u8>) {
    let mut bytes = floats(points.iter().copied().flatten());
    let start = bytes.len();
    bytes.extend(triangles.iter().flatten().flat_map(|k| (*k as u32).to_le_bytes()));
    let (length, rest, indices) = (bytes.len(), bytes.len() - start, 3 * triangles.len());
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0, "name": "ball", "translation": [0.5, 0.5, -0.5]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "buffers": [{{"byteLength": {length}, "uri": "{uri}"}}],
        "bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": {start}}}, {{"buffer": 0, "byteOffset": {start}, "byteLength": {rest}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {claimed}, "type": "VEC3", "min": [-1,-1,-1], "max": [1,1,1]}},
        {{"bufferView": 1, "componentType": 5125, "count": {indices}, "type": "SCALAR"}}]}}"#
    );
    (text, bytes)
}

/// A scene with a body from a mesh file in `folder`.
pub(super) fn load(folder: &Path, mesh: &str, changes: impl Into<Changes>) -> Result<Scene, String> {
    let base = BASE.replace("dimension = 2", "dimension = 3").replace("[20, 10]", "[32, 32, 32]");
    let base = base.replace("[2.0, 1.0]", "[1.0, 1.0, 1.0]");
    let body =
        format!("[[bodies]]\nname = \"b\"\nmaterial = \"rubber\"\ndensity = 2.0\nshape = {{ mesh = {{ {mesh} }} }}\n");
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("{base}{body}")).expect("a folder of our own");
    Scene::load(&path, changes).map_err(|error| error.to_string())
}

pub(super) fn volume(scene: &Scene) -> f64 {
    scene.seed_particles().iter().map(|seed| seed.volume).sum()
}

#[test]
fn a_ball_has_its_volume_in_every_format() {
    let folder = tempfile::tempdir().expect("room for files");
    let surface = ball(4);
    let (text, buffer) = gltf(&surface, surface.0.len(), "ball.bin");
    let files = [
        ("a.obj", obj(&surface)),
        ("a.PLY", ply(&surface)),
        ("a.stl", stl(&surface)),
        ("a.gltf", text.into_bytes()),
        ("ball.bin", buffer),
    ];
    for (name, bytes) in &files {
        std::fs::write(folder.path().join(name), bytes).expect("a folder of our own");
    }
    let exact = 4.0 / 3.0 * PI * 0.027;
    for (name, _) in &files[..4] {
        let offset = if *name == "a.gltf" { "" } else { ", offset = [0.5, 0.5, 0.5]" };
        let scene =
            load(folder.path(), &format!("path = \"{name}\"{offset}"), &[]).unwrap_or_else(|error| panic!("{error}"));
        // 2048 triangles hold half a percent less than the ball
        assert!((volume(&scene) / exact - 0.995).abs() < 4e-3, "{name}: {}", volume(&scene) / exact);
        let shape = &scene.bodies[0].shape;
        assert!((shape.distance([0.5, 0.5, 0.9]) - 0.1).abs() < 2e-3 && (shape.distance([0.5; 3]) + 0.3).abs() < 3e-3);
    }
    let placed = "path = \"a.obj\", scale = 0.5, degrees = 30, offset = [0.4, 0.5, 0.6]";
    let scene = load(folder.path(), placed, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!((volume(&scene) / exact * 8.0 - 0.995).abs() < 1e-2, "{}", volume(&scene));
    assert!((scene.bodies[0].shape.distance([0.4, 0.5, 0.6]) + 0.15).abs() < 2e-3);
}

/// The report of a mesh that must be refused.
pub(super) fn refused(folder: &Path, mesh: &str, words: &[&str]) {
    let report = load(folder, mesh, &[]).map(|_| ()).expect_err(mesh);
    for word in words {
        assert!(report.contains(word), "no `{word}` in\n{report}");
    }
}

#[test]
fn surfaces_that_are_wrong() {
    let folder = tempfile::tempdir().expect("room for files");
    let write = |name: &str, bytes: Vec<u8>| std::fs::write(folder.path().join(name), bytes).expect("our own folder");
    let (points, triangles) = ball(2);
    write("open.stl", stl(&(points.clone(), triangles[1..].to_vec())));
    refused(folder.path(), "path = \"open.stl\"", &["bodies[0].shape.mesh.path", "open", "3 edges", "repair"]);
    // the winding number closes the hole
    let placed = "path = \"open.stl\", offset = [0.5, 0.5, 0.5], repair = true";
    let scene = load(folder.path(), placed, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!((volume(&scene) / (4.0 / 3.0 * PI * 0.027) - 0.92).abs() < 0.03, "{}", volume(&scene));
    // two balls that cross
    let (mut both, mut faces) = (points.clone(), triangles.clone());
    both.extend(points.iter().map(|[x, y, z]| [x + 0.2, *y, *z]));
    faces.extend(triangles.iter().map(|t| t.map(|k| k + points.len())));
    write("crossing.obj", obj(&(both, faces)));
    refused(folder.path(), "path = \"crossing.obj\"", &["crosses itself"]);
    let mut spoilt = points.clone();
    spoilt[7][1] = f64::NAN;
    write("nan.stl", stl(&(spoilt, triangles.clone())));
    refused(folder.path(), "path = \"nan.stl\"", &["corner", "not finite"]);
    write("flat.ply", ply(&(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2], [0, 2, 1]])));
    refused(folder.path(), "path = \"flat.ply\"", &["flat"]);
    write("range.ply", ply(&(points.clone(), vec![[0, 1, 99_999]])));
    refused(folder.path(), "path = \"range.ply\"", &["corner that is not there"]);
    write("empty.obj", b"v 0 0 0\n".to_vec());
    refused(folder.path(), "path = \"empty.obj\"", &["no triangles"]);
    // facing inwards everywhere is as good as outwards
    let turned = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    write("inwards.obj", obj(&(points, turned)));
    load(folder.path(), "path = \"inwards.obj\", offset = [0.5, 0.5, 0.5]", &[])
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn files_that_are_damaged_or_elsewhere() {
    let root = tempfile::tempdir().expect("room for files");
    let folder = root.path().join("scene");
    std::fs::create_dir(&folder).expect("our own folder");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).expect("our own folder");
    let surface = ball(1);
    for (name, bytes) in [("a.obj", obj(&surface)), ("a.ply", ply(&surface)), ("a.stl", stl(&surface))] {
        write(name, &bytes[..bytes.len() * 2 / 3]);
        refused(&folder, &format!("path = \"{name}\""), &["mesh.path"]);
        write(name, b"\x00\xff\x01 nothing of the kind");
        refused(&folder, &format!("path = \"{name}\""), &["mesh.path"]);
    }
    let (text, buffer) = gltf(&surface, 1_000_000, "ball.bin");
    write("a.gltf", text.as_bytes());
    write("ball.bin", &buffer);
    refused(&folder, "path = \"a.gltf\"", &["too short"]);
    write("a.gltf", gltf(&surface, surface.0.len(), "../ball.bin").0.as_bytes());
    std::fs::write(root.path().join("ball.bin"), &buffer).expect("our own folder");
    refused(&folder, "path = \"a.gltf\"", &["`../ball.bin` lies outside", "--allow-outside"]);
    load(&folder, "path = \"a.gltf\"", Changes { outside: true, ..Changes::default() })
        .unwrap_or_else(|error| panic!("{error}"));
    write("a.glb", b"glTF\x02\x00\x00\x00\xff\xff\xff\x7f");
    refused(&folder, "path = \"a.glb\"", &["cannot be read"]);
    refused(&folder, "path = \"../a.obj\"", &["lies outside", "--allow-outside"]);
    refused(&folder, "path = \"/etc/passwd.obj\"", &["is no path from the folder of the scene"]);
    refused(&folder, "path = \"missing.obj\"", &["missing.obj"]);
    refused(&folder, "path = \"a.step\"", &["no mesh file", ".glb"]);
}

/// Millimetres, and y as up, at the place where the body is to stand or elsewhere.
#[test]
fn a_body_that_does_not_fit_is_told_what_would_make_it_fit() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let (positions, triangles) = ball(2);
    let scaled = |by: [f64; 3]| {
        let positions = positions.iter().map(|place| [0, 1, 2].map(|d| place[d] * by[d])).collect();
        obj(&(positions, triangles.clone()))
    };
    std::fs::write(root.path().join("millimetres.obj"), scaled([400.0; 3])).expect("our own folder");
    std::fs::write(root.path().join("lying.obj"), scaled([0.3, 1.3, 0.3])).expect("our own folder");
    let tower = ["domain.cells=[8, 8, 32]", "domain.size=[0.25, 0.25, 1.0]"];
    let turn = "it would fit after a quarter turn about x";
    for (file, offset, overrides, words) in [
        ("millimetres", "[0.5, 0.5, 0.5]", &[][..], ["with `scale = 0.001`, from millimetres; ", ""]),
        ("millimetres", "[5.0, 0.5, 0.5]", &[], ["with `scale = 0.001`, from millimetres", ", at another place; "]),
        ("lying", "[0.125, 0.125, 0.5]", &tower, [turn, "`up` of a mesh; "]),
        ("lying", "[0.125, 0.125, 0.1]", &tower, [turn, "`up` of a mesh, at another place; "]),
    ] {
        let told = load(root.path(), &format!("path = \"{file}.obj\", offset = {offset}"), &owned(overrides));
        let told = told.map(|_| ()).unwrap_err();
        assert!(words.iter().all(|word| told.contains(word)), "{file} {offset}: {told}");
    }
}

/// What a run wrote down names files; whoever sent its folder may have chosen them.
#[test]
fn a_recorded_scene_reads_nothing_outside_of_the_folder_of_its_run() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let [scenes, run] = ["scenes", "run"].map(|name| root.path().join(name));
    for folder in [&scenes, &run] {
        std::fs::create_dir(folder).expect("our own folder");
    }
    std::fs::write(scenes.join("ball.obj"), obj(&ball(2))).expect("our own folder");
    let text = format!(
        "{BASE}[[obstacles]]\nname = \"ball\"\n\
         shape.translate = {{ offset = [0.5, 0.5, 0.5], shape = {{ mesh = {{ path = \"ball.obj\" }} }} }}\n"
    );
    let file = scenes.join("ball.toml").display().to_string();
    let again = |text: &str, outside| Scene::recorded(text, (&run, &file), &["title=again".to_owned()], outside);
    let told = again(&text, false).unwrap_err().to_string();
    assert!(told.contains("nothing outside of the folder of the run") && told.contains("--allow-outside"), "{told}");
    assert_eq!(again(&text, true).unwrap_or_else(|error| panic!("{error}")).title, "again");
    let up = again(&text.replace("ball.obj", "../scenes/ball.obj"), false).unwrap_err().to_string();
    assert!(up.contains("lies outside"), "{up}");
}
