//! Cameras from glTF files: where they stand at each frame, and files that are wrong.

use std::path::Path;

use glam::{DQuat, DVec3};

use super::{BASE, owned};
use crate::scene::{CameraPath, Scene};

/// A .glb of a camera "Shot" below a node "arm" and of a camera "Still". The arm turns about y by a right angle in the second from 0.5 s
/// to 1.5 s, while the camera moves from z = 2 to z = 4 on its arm; "Still" looks along -z from (0, 1, 3) with parallel rays.
fn film(time_count: usize) -> Vec<u8> {
    let half = 0.5f32.sqrt();
    let numbers = [0.5, 1.5, 0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half, 0.0, 0.0, 2.0, 0.0, 0.0, 4.0];
    let binary: Vec<u8> = numbers.iter().flat_map(|x: &f32| x.to_le_bytes()).collect();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 2]}}],
        "nodes": [{{"name": "arm", "children": [1]}}, {{"name": "Shot", "camera": 0, "translation": [0, 0, 2]}},
        {{"name": "Still", "camera": 1, "translation": [0, 1, 3]}}],
        "cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.5235988, "znear": 0.1}}}},
        {{"type": "orthographic", "orthographic": {{"xmag": 2, "ymag": 1, "znear": 0.1, "zfar": 9}}}}],
        "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 0, "path": "rotation"}}}},
        {{"sampler": 1, "target": {{"node": 1, "path": "translation"}}}}],
        "samplers": [{{"input": 0, "output": 1}}, {{"input": 0, "output": 2}}]}}],
        "buffers": [{{"byteLength": {length}}}], "bufferViews": [{{"buffer": 0, "byteLength": {length}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {time_count}, "type": "SCALAR", "min": [0.5], "max": [1.5]}},
        {{"bufferView": 0, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "VEC4"}},
        {{"bufferView": 0, "byteOffset": 40, "componentType": 5126, "count": 2, "type": "VEC3"}}]}}"#,
        length = binary.len()
    );
    let text = format!("{text:<width$}", width = text.len().next_multiple_of(4));
    let chunk = |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], kind, bytes].concat();
    let chunks = [chunk(b"JSON", text.as_bytes()), chunk(b"BIN\0", &binary)].concat();
    [&b"glTF"[..], &2u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

fn load(folder: &Path, render: &str) -> Result<Scene, String> {
    let base = BASE.replace("dimension = 2", "dimension = 3").replace("[20, 10]", "[32, 32, 32]");
    let base = base.replace("[2.0, 1.0]", "[1.0, 1.0, 1.0]");
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("{base}\n{render}\n")).expect("a folder of our own");
    let ends = ["time.until=0.01", "time.frames=4"];
    Scene::load(&path, &owned(&ends)).map_err(|error| error.to_string())
}

/// A right angle in four frames, of a tenth of a second of the run each: the file's y is the scene's z.
#[test]
fn a_camera_moves_as_in_its_file() {
    let folder = tempfile::tempdir().expect("room for files");
    std::fs::write(folder.path().join("film.glb"), film(2)).expect("our own folder");
    let text = "[render.path.file]\npath = \"film.glb\"\nnode = \"Shot\"\nfps = 4\nscale = 0.5\noffset = [1, 2, 3]";
    let scene = load(folder.path(), text).unwrap_or_else(|error| panic!("{error}"));
    let path = scene.render.path.as_ref().expect("a path");
    assert_eq!((path.keys.len(), &path.file), (5, &None));
    for frame in 0..=4 {
        let part = f64::from(frame) / 4.0;
        let camera = path.at(scene.frame_time(frame), &path.keys[0].camera());
        // on its arm it stands at z = 2 + 2 part and is turned about y, which is z here; the file's z is -y here
        let turn = DQuat::from_rotation_z((90.0 * part).to_radians());
        let eye = DVec3::new(1.0, 2.0, 3.0) + 0.5 * (turn * DVec3::new(0.0, -2.0 - 2.0 * part, 0.0));
        assert!(DVec3::from(camera.eye).distance(eye) < 1e-6, "frame {frame}: {:?}, not {eye}", camera.eye);
        let view = (DVec3::from(camera.target) - DVec3::from(camera.eye)).normalize();
        assert!(view.distance(turn * DVec3::Y) < 1e-6 && DVec3::from(camera.up).distance(DVec3::Z) < 1e-6, "{view}");
        assert!((camera.fov_degrees - 30.0).abs() < 1e-5 && camera.height.is_none());
    }
    // what a run writes down needs no file
    let again = Scene::parse(&toml::to_string(&scene).expect("text"), "elsewhere.toml", &[]).expect("a scene");
    assert_eq!(again.render.path, scene.render.path);
}

#[test]
fn a_view_has_a_camera_of_a_file() {
    let folder = tempfile::tempdir().expect("room for files");
    std::fs::write(folder.path().join("film.glb"), film(2)).expect("our own folder");
    let text = "[render.views.still]\npath.file = { path = \"film.glb\", node = \"Still\" }";
    let scene = load(folder.path(), text).unwrap_or_else(|error| panic!("{error}"));
    let shots = scene.shots().expect("views");
    let Some(CameraPath { keys, .. }) = &shots[1].settings.path else { panic!("no path") };
    assert_eq!((keys.len(), keys[0].eye, keys[0].height), (1, Some([0.0, -3.0, 1.0]), Some(2.0)));
}

#[test]
fn files_of_cameras_that_are_wrong() {
    let folder = tempfile::tempdir().expect("room for files");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).expect("our own folder");
    write("film.glb", &film(2));
    write("cut.glb", &film(2)[..900]);
    write("more.glb", &film(9));
    write("uneven.glb", &film(3));
    for (keys, words) in [
        ("path = \"film.glb\"", &["render.path.file", "has 2 cameras", "Shot, Still"][..]),
        ("path = \"film.glb\", node = \"shot\"", &["file.node", "no camera at a node `shot`", "Shot"]),
        ("path = \"none.glb\", node = \"Shot\"", &["render.path.file", "none.glb"]),
        ("path = \"../film.glb\"", &["render.path.file", "outside of the folder"]),
        ("path = \"film.obj\"", &["no cameras", ".gltf or .glb"]),
        ("path = \"cut.glb\", node = \"Shot\"", &["cut.glb", "cannot be read"]),
        ("path = \"more.glb\", node = \"Shot\"", &["more.glb", "cannot be read"]),
        ("path = \"uneven.glb\", node = \"Shot\"", &["uneven.glb", "2 values for 3 times"]),
        ("path = \"film.glb\", node = \"Shot\", fps = 0", &["file.fps", "positive"]),
        ("path = \"film.glb\", node = \"Shot\", scale = -1", &["file.scale", "positive"]),
        ("path = \"film.glb\", node = \"Shot\", fps = 1e9", &["frames of a camera", "at most"]),
        ("path = \"film.glb\", nose = \"Shot\"", &["nose", "node"]),
    ] {
        let report = load(folder.path(), &format!("[render.path]\nfile = {{ {keys} }}")).map(|_| ()).expect_err(keys);
        assert!(words.iter().all(|word| report.contains(word)), "{keys}: no {words:?} in\n{report}");
    }
    let both = "[render.path]\nfile = { path = \"film.glb\", node = \"Shot\" }\nkeys = [{ time = 0, eye = [3, 0, 0], target = [0, 0, 0] }]";
    assert!(load(folder.path(), both).map(|_| ()).expect_err("both").contains("leave out `keys` or `file`"));
}
