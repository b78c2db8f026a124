//! Frames on the disk: views, paths, depth, films, and frames drawn again from stored states.

use std::path::{Path, PathBuf};
use std::process::Command;

use brisance::export::{Exporter, Moment, Origin, exr::ExrExporter, png::PngExporter};
use brisance::render::{Depth, Picture, Renderer};
use brisance::scene::{Camera, Field};

use crate::cli::{brisance, err, fails, run, succeeds, write_small_scene};
use crate::common::{contents_below, files_below, folder_or_skip, read_png};
use crate::synthetic::{State, gpu, scene};

/// The pictures of the synthetic state in full depth.
fn deep(dimension: u32, look: &str) -> Vec<Picture> {
    let gpu = gpu();
    let scene = scene(dimension, 12, [48, 40], look);
    let state = State::new(&gpu, &scene);
    let renderer = Renderer::new(&gpu, &scene, &state.buffers()).unwrap();
    renderer.with_depth(Depth { layers: true, fine: true }).render(0.5).unwrap()
}

/// Writes the pictures of frame 3.
fn write(exporter: &mut dyn Exporter, pictures: &[Picture]) {
    let origin = Origin { title: "Depth \u{2192} files".to_owned(), hash: "cafe".to_owned(), ..Origin::default() };
    let (snapshot, stored) = (None, None);
    exporter.write(&Moment { index: 3, origin: &origin, time: 0.5, step: 9, pictures, snapshot, stored }).unwrap();
}

#[test]
fn pictures_have_their_whole_depth_on_the_disk() {
    let folder = tempfile::tempdir().unwrap();
    for (dimension, look) in [(1, ""), (2, "render.arrows = 4"), (3, "render.exposure = 3\nrender.supersampling = 2")] {
        let pictures = deep(dimension, look);
        write(&mut PngExporter::fine(folder.path()), &pictures);
        write(&mut ExrExporter::new(folder.path()), &pictures);
        let Picture { frame, layers, fine, .. } = &pictures[0];

        let (info, bytes) = read_png(&folder.path().join("frames/0003.png"));
        assert_eq!(info.bit_depth, png::BitDepth::Sixteen);
        let words: Vec<u16> = bytes.chunks_exact(2).map(|word| u16::from_be_bytes([word[0], word[1]])).collect();
        assert_eq!(words, fine.as_flattened());
        let coarse = frame.rgba.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
        // dithering may take the next level
        assert!(
            words.iter().zip(coarse).all(|(word, byte)| (f64::from(*word) / 257.0 - f64::from(*byte)).abs() <= 1.01)
        );

        let image = exr::prelude::read_all_flat_layers_from_file(folder.path().join("frames/0003.exr")).unwrap();
        let layer = &image.layer_data[0];
        let comments = layer.attributes.comments.as_ref().unwrap().to_string();
        assert!(comments.contains("Scene: cafe") && comments.contains("Step: 9"), "{comments}");
        let channel = |name: &str| -> Vec<f32> {
            let found =
                layer.channel_data.list.iter().find(|own| own.name.eq(name)).unwrap_or_else(|| panic!("{name}"));
            found.sample_data.values_as_f32().collect()
        };
        assert_eq!((layer.size.width(), layer.size.height()), (layers.width as usize, layers.height as usize));
        for (k, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
            let own = layers.pixels.iter().map(|pixel| pixel.light[k]);
            let close = |(read, own): (f32, f32)| (read - own).abs() <= 1e-3 * own.abs() + 1e-6;
            assert!(channel(name).into_iter().zip(own).all(close), "{dimension}D: {name}");
        }
        let objects: Vec<u32> = channel("id").into_iter().map(|id| id as u32).collect();
        let bodies = layers.pixels.iter().filter(|pixel| pixel.object > 0);
        assert!(objects.iter().copied().eq(layers.pixels.iter().map(|pixel| pixel.object)));
        // the plot of so small a picture in 2D has hardly a pixel
        assert_eq!(bodies.clone().count() > 10, dimension == 3, "{dimension}D: {}", bodies.clone().count());
        assert!(bodies.clone().all(|pixel| pixel.depth.is_finite()) && channel("Z").len() == objects.len());
        assert_eq!(layer.attributes.world_to_camera.is_some(), dimension > 1);
        let clear = layers.pixels.iter().filter(|pixel| pixel.light[3] < 0.9).count();
        assert_eq!(clear > 100, dimension == 3, "{dimension}D: {clear} pixels let something through");
        let linear: Vec<[f32; 3]> =
            layers.pixels.iter().map(|pixel| [pixel.light[0], pixel.light[1], pixel.light[2]]).collect();
        let most = linear.iter().flatten().fold(0.0_f32, |most, value| most.max(*value));
        assert_eq!(most > 1.5, dimension == 3, "{dimension}D: light above white only where exposure makes it: {most}");
    }
}

#[test]
fn depth_costs_nothing_where_it_is_not_wanted() {
    let gpu = gpu();
    let scene = scene(3, 12, [48, 40], "");
    let state = State::new(&gpu, &scene);
    let plain = Renderer::new(&gpu, &scene, &state.buffers()).unwrap().render(0.5).unwrap();
    assert!(plain[0].layers.pixels.is_empty() && plain[0].fine.is_empty());
    assert_eq!(plain[0].frame, deep(3, "")[0].frame, "and changes no pixel");
}

/// Depths, objects and velocities lead through the matrices of the header back to the particles.
#[test]
fn layers_lead_back_to_the_particles() {
    let picture = &deep(3, "")[0];
    let layers = &picture.layers;
    let [to_camera, to_picture] = layers.camera.unwrap().map(|columns| glam::Mat4::from_cols_array(&columns));
    let (back, projection) = (to_camera.inverse(), to_picture * to_camera.inverse());
    let half = glam::Vec2::new(1.0 / projection.x_axis.x, 1.0 / projection.y_axis.y);
    let mut seen = [0; 2];
    for (i, pixel) in layers.pixels.iter().enumerate().filter(|(_, pixel)| pixel.object > 0) {
        let (column, row) = (i as u32 % layers.width, i as u32 / layers.width);
        let place = glam::Vec2::new(column as f32 + 0.5, row as f32 + 0.5)
            / glam::UVec2::new(layers.width, layers.height).as_vec2();
        let ndc = glam::Vec2::new(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y);
        let point = back.transform_point3((pixel.depth * half * ndc).extend(-pixel.depth));
        let middle = glam::Vec3::from(crate::synthetic::BLOB);
        let radius = point.distance(middle);
        assert!((radius - 0.28).abs() < 0.08, "{point}: {radius} from the middle");
        assert!((pixel.velocity[0] - 0.1 - 0.1 * point.x).abs() < 0.01, "{pixel:?} at {point}");
        if (point.x - middle.x).abs() > 0.05 {
            assert_eq!(pixel.object, 1 + u32::from(point.x > middle.x), "{point}");
            seen[usize::from(point.x > middle.x)] += 1;
        }
    }
    assert!(seen[0] > 20 && seen[1] > 20, "{seen:?}");
}

/// Compositors get the plot alone, from the states of a run.
#[test]
fn states_are_converted_for_compositors() {
    let Some(folder) = folder_or_skip() else { return };
    let out = states_of_a_shell(folder.path());
    let run = out.to_str().unwrap();
    succeeds(&["convert", run, "--to", "exr,npz", "--frame", "1"]);
    let image = exr::prelude::read_all_flat_layers_from_file(out.join("frames/0001.exr")).unwrap();
    let names: Vec<String> = image.layer_data[0].channel_data.list.iter().map(|own| own.name.to_string()).collect();
    assert_eq!(names, ["A", "B", "G", "R", "Z", "id", "velocity.X", "velocity.Y", "velocity.Z"]);
    assert!(out.join("arrays/0001.npz").exists() && !out.join("frames/0001.png").exists());
    let told = fails(2, &["convert", run, "--to", "exr,gif"]);
    assert!(told.contains("no export format `gif`; a run is converted to exr, vtk") && !told.contains("png"), "{told}");
    assert!(fails(2, &["convert", run, "--to", "png"]).contains("no formats to convert to"));
}

#[test]
fn a_path_moves_the_camera_of_its_view_only() {
    let gpu = gpu();
    let look = "render.views.turning.path.orbit = 90\nrender.views.flying.path.keys = [\
                { time = 0, azimuth = -60, elevation = 20, distance = 3, target = [0.5, 0.5, 0.5] },\
                { time = 1, azimuth = 30, elevation = 20, distance = 3, target = [0.5, 0.5, 0.5] }]\n\
                [render.views.still]\nfields = [\"pressure\", \"density\"]\nsize = [40, 32]";
    let scene = scene(3, 12, [48, 40], look);
    let state = State::new(&gpu, &scene);
    let mut renderer = Renderer::new(&gpu, &scene, &state.buffers()).unwrap();
    let at = |renderer: &mut Renderer, time: f64| {
        let pictures = renderer.render(time).unwrap();
        let names: Vec<_> = pictures.iter().map(|own| (own.view.clone(), own.name.clone())).collect();
        let names: Vec<_> = names.iter().map(|(view, name)| (view.as_str(), name.as_str())).collect();
        let expected = [
            ("", "density"),
            ("flying", "density"),
            ("still", "pressure"),
            ("still", "density"),
            ("turning", "density"),
        ];
        assert_eq!(names, expected);
        assert_eq!(pictures[2].frame.width, 40);
        pictures
    };
    let no_words = |pictures: &[Picture], k: usize| -> Vec<u8> {
        // below the time stamp
        pictures[k].frame.rgba[4 * 48 * 20..].to_vec()
    };
    let (first, later) = (at(&mut renderer, 0.0), at(&mut renderer, 1.0));
    for (k, moves) in [(0, false), (1, true), (4, true)] {
        assert_eq!(no_words(&first, k) != no_words(&later, k), moves, "picture {k}");
    }
    // a quarter turn of the first place of the keys is the last one
    let turned = scene.shots().unwrap()[1].settings.path.clone().unwrap();
    let base = Camera { eye: [0.0; 3], target: [1.0; 3], up: [0.0, 0.0, 1.0], fov_degrees: 40.0, height: None };
    let look = brisance::scene::RenderSettings { camera: Some(turned.at(1.0, &base)), path: None, ..scene.own_look() };
    let same = renderer.draw(&look, Field::Density, 1.0).unwrap();
    assert_eq!(same.frame, later[1].frame);
}

/// The folder of a run of [`write_shell`] that left its states alone.
fn states_of_a_shell(folder: &Path) -> PathBuf {
    let (scene, out) = (folder.join("shell.toml"), folder.join("run"));
    write_shell(&scene);
    let [scene, run] = [&scene, &out].map(|path| path.to_str().unwrap());
    succeeds(&["run", scene, "--no-frames", "--export", "states", "--out", run]);
    out
}

/// A small shell in space with two views and a moving camera.
fn write_shell(path: &Path) {
    let text = r#"
title = "Shell"
domain = { dimension = 3, cells = [12, 12, 12], size = [1.0, 1.0, 1.0] }
time = { until = 0.02, frames = 2 }
materials.rubber.neo_hookean = { young_modulus = 100.0, poisson_ratio = 0.3 }
[gas]
ambient = { density = 1.0, pressure = 1.0 }
regions = [{ shape = { sphere = { center = [0.4, 0.5, 0.5], radius = 0.2 } }, density = 2.0, pressure = 6.0 }]
[[bodies]]
name = "block"
shape = { box = { center = [0.75, 0.5, 0.5], size = [0.2, 0.5, 0.5] } }
material = "rubber"
density = 5.0
[render]
size = [96, 64]
emission = { ambient_kelvin = 900.0 }
tone = "aces"
particle_color = "deviatoric_stress"
path.orbit = 300.0
[render.views.top]
fields = ["pressure", "vorticity"]
camera = { eye = [0.5, 0.5, 4.0], target = [0.5, 0.5, 0.5], up = [0.0, 1.0, 0.0] }
[expect]
"#;
    std::fs::write(path, text).unwrap();
}

#[test]
fn frames_drawn_again_are_the_same_to_the_byte() {
    let Some(folder) = folder_or_skip() else { return };
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    let (small, shell) = (folder.path().join("small.toml"), folder.path().join("shell.toml"));
    write_small_scene(&small);
    write_shell(&shell);
    for (name, count) in [(text(&small), 6), (text(&shell), 9), ("sod".to_owned(), 3)] {
        let out = folder.path().join("run");
        succeeds(&["run", &name, "--frames", "2", "--no-expect", "--export", "states", "--out", &text(&out)]);
        let printed = succeeds(&["render", &text(&out)]);
        assert!(printed.starts_with("3 frames in "), "{printed}");
        let (first, again) = (contents_below(&out.join("frames")), contents_below(&out.join("again/frames")));
        assert_eq!(first.len(), count, "{name}");
        for ((path, bytes), (same, drawn)) in first.iter().zip(&again) {
            assert_eq!(path, same);
            assert!(bytes == drawn, "{name}: {} differs", path.display());
        }
        assert_eq!(first.len(), again.len());
        std::fs::remove_dir_all(&out).unwrap();
    }
}

#[test]
fn frames_drawn_again_have_another_look() {
    let Some(folder) = folder_or_skip() else { return };
    let out = states_of_a_shell(folder.path());
    let run = out.to_str().unwrap();
    assert!(!out.join("frames").exists());
    let camera = "{ eye = [0.5, -3.0, 0.5], target = [0.5, 0.5, 0.5] }";
    let look = ["--camera", camera, "--size", "80x60", "--set", "render.colormap=inferno", "--field", "pressure"];
    succeeds(&[&["render", run, "--view", "main", "--frame", "1"], &look[..]].concat());
    assert_eq!(files_below(&out.join("again")), [Path::new("frames/0001.png")]);
    let (info, _) = read_png(&out.join("again/frames/0001.png"));
    assert_eq!((info.width, info.height), (80, 60));
    assert!(info.uncompressed_latin1_text.iter().any(|chunk| chunk.keyword == "Field" && chunk.text == "pressure"));

    for (options, parts) in [
        (&["--view", "side"][..], ["no view `side`", "main, top"]),
        (&["--set", "gas.gamma=1.3"], ["render.* and output.fields", "brisance run"]),
        (&["--size", "80"], ["--size 80", "width x height"]),
        (&["--frame", "7"], ["no state of frame 7", "3 states"]),
        (&["--export", "vtk"], ["--export vtk", "png, png16, exr"]),
    ] {
        let message = fails(2, &[&["render", run], options].concat());
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    assert!(fails(3, &["render", run, "--field", "heat"]).contains("unknown variant `heat`"));
    assert!(fails(2, &["render", folder.path().to_str().unwrap()]).contains("no report.json"));
    std::fs::write(out.join("states/0002.npz"), "short").unwrap();
    assert!(fails(6, &["render", run]).contains("0002.npz"));
    std::fs::remove_dir_all(out.join("states")).unwrap();
    assert!(fails(2, &["render", run]).contains("--export fields"));
}

/// Whether a program answers.
fn installed(program: &str) -> bool {
    Command::new(program).arg("-version").output().is_ok_and(|output| output.status.success())
}

/// Whether a film says which colours it has, and begins with its index, so that it plays while it is still loaded. [ITU-R BT.709-6]
fn has_its_colours(film: &Path) {
    let tags = "stream=color_range,color_space,color_transfer,color_primaries";
    let asked = ["-v", "error", "-show_entries", tags, "-of", "csv=p=0", film.to_str().unwrap()];
    let probed = Command::new("ffprobe").args(asked).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&probed.stdout).trim(), "tv,bt709,bt709,bt709", "{}", film.display());
    let bytes = std::fs::read(film).unwrap();
    let at = |kind: &[u8]| bytes.windows(4).position(|window| window == kind);
    assert!(at(b"moov").unwrap() < at(b"mdat").unwrap(), "{}: the index stands at the end", film.display());
}

#[test]
fn a_film_is_made_where_there_is_ffmpeg() {
    let Some(folder) = folder_or_skip() else { return };
    let scene = folder.path().join("shell.toml");
    write_shell(&scene);
    let (out, film) = (folder.path().join("run"), folder.path().join("films/film.mp4"));
    let arguments = ["run", scene.to_str().unwrap(), "--set", "render.size=[95, 63]", "--frames", "3", "--video"];
    let arguments = [&arguments[..], &[film.to_str().unwrap(), "--out", out.to_str().unwrap()]].concat();

    let output = brisance(&arguments).env("PATH", "/nowhere").output().unwrap();
    assert_eq!(output.status.code(), Some(9), "{}", err(&output));
    assert!(err(&output).contains("ffmpeg is not installed") && !film.exists(), "{}", err(&output));
    assert!(out.join("frames/0003.png").is_file() && out.join("frames/top/vorticity/0003.png").is_file());

    if !(installed("ffmpeg") && installed("ffprobe")) {
        eprintln!("skipped: no ffmpeg and ffprobe");
        return;
    }
    let output = run(&[&arguments[..], &["--force"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(err(&output).contains("film in "), "{}", err(&output));
    for name in ["film.mp4", "film_top.mp4"] {
        let probed = Command::new("ffprobe")
            .args(["-v", "error", "-count_frames", "-show_entries", "stream=width,height,nb_read_frames,r_frame_rate"])
            .args(["-of", "csv=p=0"])
            .arg(film.with_file_name(name))
            .output()
            .unwrap();
        assert_eq!(String::from_utf8_lossy(&probed.stdout).trim(), "96,64,25/1,4", "{name}: {}", err(&probed));
        has_its_colours(&film.with_file_name(name));
    }
    assert_eq!(std::fs::read_dir(film.parent().unwrap()).unwrap().count(), 2, "no drafts stay");
}
