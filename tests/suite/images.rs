//! Pictures of the synthetic state against stored ones, and what each part of a look must change.

use std::path::{Path, PathBuf};

use brisance::export;
use brisance::render::{Frame, Picture, Renderer};
use brisance::scene::Field;
use brisance::simulation::Simulation;

use crate::synthetic::{State, brightness, every_cell, gpu, pixel, render, scene};

use crate::common::read_png;

/// Mean difference of a channel that drivers may make, of 255.
const MEAN_ERROR: f64 = 1.0;

const BLOCK: &str = "\n[[obstacles]]\nname = \"ball\"\nshape.sphere = { center = [0.8, 0.25, 0.3], radius = 0.15 }";

/// Name, dimension, field and look of each stored picture.
const PICTURES: [(&str, u32, Field, &str); 8] = [
    ("plane", 2, Field::Density, "render.contours = 4\nrender.arrows = 8\nrender.particle_color = \"plastic_strain\""),
    ("plane_schlieren", 2, Field::Schlieren, "render.overlays = { title = false, color_bar = false }"),
    ("volume", 3, Field::Density, ""),
    ("volume_density", 3, Field::Density, "render.mode = \"density\"\nrender.colormap = \"magma\""),
    (
        "explosion",
        3,
        Field::Density,
        "render.emission = { ambient_kelvin = 750.0 }\nrender.tone = \"aces\"\nrender.ground = true\nrender.supersampling = 2\n\
         render.surface = \"smooth\"\nrender.opacity = [[0, 0], [1, 0.2]]",
    ),
    (
        "slices",
        3,
        Field::Pressure,
        "render.slices = [{ point = [0.5, 0.5, 0.5], normal = [0, 1, 0] }, { point = [0.4, 0, 0], normal = [1, 0, 0.2] }]\n\
         render.volume = false\nrender.contours = [2.0, 4.0]\nrender.colormap = \"red_blue\"\n\
         render.particle_color = \"speed\"\n\
         render.camera = { eye = [2, -2, 1.6], target = [0.5, 0.5, 0.5], height = 1.7 }",
    ),
    ("shadowgraph", 3, Field::Density, "render.mode = \"shadowgraph\"\nrender.particles = false"),
    ("line_of_sight", 3, Field::Density, "render.mode = \"line_of_sight\""),
];

fn draw(dimension: u32, field: Field, look: &str) -> Picture {
    let gpu = gpu();
    let block = if dimension == 3 { BLOCK } else { "" };
    let scene = scene(dimension, 20, [160, 120], &format!("{look}{block}"));
    let state = State::new(&gpu, &scene);
    Renderer::new(&gpu, &scene, &state.buffers()).unwrap().draw(&scene.render, field, 0.0125).unwrap()
}

fn stored(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/images").join(format!("{name}.png"))
}

/// Colours without alpha.
fn colors(frame: &Frame) -> Vec<u8> {
    frame.rgba.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect()
}

/// Mean difference of the channels; the picture and its difference, four times as strong, go to the target folder.
fn error(name: &str, frame: &Frame, expected: &[u8]) -> f64 {
    let found = colors(frame);
    assert_eq!(found.len(), expected.len(), "{name}: size of the stored picture");
    let differences: Vec<u8> = found.iter().zip(expected).map(|(a, b)| a.abs_diff(*b)).collect();
    let strong = differences.chunks_exact(3).flat_map(|own| [own[0], own[1], own[2], 63].map(|v| v.saturating_mul(4)));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("images");
    std::fs::create_dir_all(&folder).unwrap();
    export::png::write(&folder.join(format!("{name}.png")), frame, &[]).unwrap();
    let difference = Frame { rgba: strong.collect(), ..frame.clone() };
    export::png::write(&folder.join(format!("{name}_difference.png")), &difference, &[]).unwrap();
    differences.iter().map(|own| f64::from(*own)).sum::<f64>() / differences.len() as f64
}

#[test]
fn pictures_are_those_stored() {
    let mut failures = Vec::new();
    for (name, dimension, field, look) in PICTURES {
        let error = error(name, &draw(dimension, field, look).frame, &read_png(&stored(name)).1);
        if error > MEAN_ERROR {
            failures.push(format!("{name}: mean error {error:.2} of 255, at most {MEAN_ERROR}"));
        }
    }
    assert!(failures.is_empty(), "{}; look into target/tmp/images", failures.join("; "));
}

#[test]
#[ignore = "writes the stored pictures anew: cargo test -- --ignored store_the_pictures, then look at tests/images"]
fn store_the_pictures() {
    for (name, dimension, field, look) in PICTURES {
        export::png::write(&stored(name), &draw(dimension, field, look).frame, &[]).unwrap();
    }
}

/// Mean brightness of a part of a picture, three channels together.
fn mean(picture: &Picture, columns: std::ops::Range<u32>, rows: std::ops::Range<u32>) -> f64 {
    let places = columns.flat_map(|x| rows.clone().map(move |y| (x, y)));
    let values: Vec<i32> = places.map(|(x, y)| brightness(pixel(picture, x, y))).collect();
    f64::from(values.iter().sum::<i32>()) / values.len() as f64
}

/// From straight above, so that the floor fills the picture.
const ABOVE: &str = "render.camera = { eye = [0.5, 0.5, 4], target = [0.5, 0.5, 0], up = [0, 1, 0], height = 1.4 }\n\
                     render.ground = true\nrender.volume = false\nrender.overlays = { color_bar = false }\n";

#[test]
fn bodies_cast_shadows_on_the_floor() {
    let lit = draw(3, Field::Density, &format!("{ABOVE}render.light = {{ direction = [-1, 0, 1], shadows = false }}"));
    let shaded = draw(3, Field::Density, &format!("{ABOVE}render.light = {{ direction = [-1, 0, 1] }}"));
    // The shell stands half a length above the floor: its shadow lies that much to the right of it, beyond x = 0.75.
    let (columns, rows) = (105..120, 45..58);
    let [before, after] = [&lit, &shaded].map(|picture| mean(picture, columns.clone(), rows.clone()));
    assert!(after < 0.75 * before, "brightness {before} without shadows, {after} with them");
    // Towards the light nothing is in the way.
    let [before, after] = [&lit, &shaded].map(|picture| mean(picture, 20..30, 45..58));
    assert!((after / before - 1.0).abs() < 0.02, "{before} {after}");
}

#[test]
fn hot_gas_shines_and_transparent_gas_is_not_there() {
    let plain = "render.particles = false\nrender.overlays = { edges = false, color_bar = false }\nrender.opacity = [[0, 0], [1, 0]]\n";
    let nothing = draw(3, Field::Density, &format!("{plain}render.volume = false"));
    assert_eq!(draw(3, Field::Density, plain).frame, nothing.frame, "gas without opacity is not seen");
    let shining = draw(3, Field::Density, &format!("{plain}render.emission = {{ ambient_kelvin = 1200.0 }}"));
    let [dark, bright] = [&nothing, &shining].map(|picture| mean(picture, 60..100, 45..75));
    assert!(bright > dark + 60.0, "{dark} {bright}");
    let cold = draw(3, Field::Density, &format!("{plain}render.emission = {{ ambient_kelvin = 200.0 }}"));
    assert_eq!(cold.frame, nothing.frame, "cold gas does not shine");
}

#[test]
fn soot_is_dark_casts_a_shadow_and_shines_where_it_is_hot() {
    let seen = "gas.species.smoke = { gamma = 1.4 }\nrender.camera = { eye = [0.5, 0.5, 4], target = [0.5, 0.5, 0], up = [0, 1, 0], height = 1.4 }\n\
                render.ground = true\nrender.particles = false\nrender.overlays = { color_bar = false }\n\
                render.light = { direction = [-1, 0, 1] }\nrender.opacity = [[0, 0], [1, 0]]\n";
    let [clear, smoke, hot] = [
        "",
        "render.soot = { extinction = 20 }",
        "render.soot = { extinction = 20 }\nrender.emission = { ambient_kelvin = 1200 }",
    ]
    .map(|more| draw(3, Field::Density, &format!("{seen}{more}")));
    // the blob is seen from above; its shadow on the floor lies half a length to the right of it
    let places = [(66..80, 44..58), (100..120, 44..58)];
    let [[blob, floor], [dark, shaded], [bright, _]] =
        [&clear, &smoke, &hot].map(|picture| places.clone().map(|(columns, rows)| mean(picture, columns, rows)));
    assert!(dark < 0.95 * blob, "{blob} without smoke, {dark} with it");
    assert!(shaded < 0.5 * floor, "shadow: {shaded} of {floor}");
    assert!(bright > dark + 60.0, "{dark} cold, {bright} hot");
}

/// Brightness of the floor below the shell, seen from above, where only hot gas shines: behind the shell and below its gap.
fn floor_in_glow(shadows: bool) -> [f64; 2] {
    let light = format!("render.light = {{ strength = 0, ambient = 0, shadows = {shadows} }}\n");
    let below = "render.camera = { eye = [0.5, 0.5, 4], target = [0.5, 0.5, 0], up = [0, 1, 0], height = 1.4 }\n\
                 render.ground = true\nrender.overlays = { color_bar = false }\nrender.opacity = [[0, 0], [1, 0]]\n\
                 render.emission = { ambient_kelvin = 600.0, strength = 20.0 }\nrender.range = [0, 1]\n";
    let picture = draw(3, Field::Density, &format!("{below}{light}"));
    error(&format!("floor_in_glow_{shadows}"), &picture.frame, &colors(&picture.frame));
    [mean(&picture, 20..40, 20..60), mean(&picture, 100..118, 90..108)]
}

#[test]
fn bodies_stand_in_the_light_of_hot_gas() {
    let ([hidden, seen], [open, plain]) = (floor_in_glow(true), floor_in_glow(false));
    assert!(hidden < 0.6 * open && seen > 0.7 * plain, "behind {hidden} of {open}, below the gap {seen} of {plain}");
}

/// A shadowgraph across a gas whose density depends on x alone, so much of it from top to bottom \[m\]: brightness along a row
/// through the middle.
fn shadowgraph_of(height: f64, density: impl Fn(f64) -> f64) -> Vec<i32> {
    let gpu = gpu();
    let look = format!(
        "render.mode = \"shadowgraph\"\nrender.particles = false\n\
         render.overlays = {{ edges = false, title = false, time = false, scale_bar = false }}\n\
         render.camera = {{ eye = [0.5, -4, 0.5], target = [0.5, 0.5, 0.5], height = {height} }}"
    );
    let scene = scene(3, 24, [192, 192], &look);
    let state = State::new(&gpu, &scene);
    let ring = state.grid.padding().map(|n| n as i32);
    let mut flow = vec![[1.0, 0.0, 0.0, 0.0]; state.grid.slots()];
    let mut kinds = vec![2_u32; state.grid.slots()];
    for (slot, cell) in every_cell(&state.grid, ring) {
        flow[slot][0] = density(f64::from(state.grid.centre(cell)[0])) as f32;
        kinds[slot] = if (0..3).all(|axis| (0..24).contains(&cell[axis])) { 0 } else { 2 };
    }
    state.conserved.write(&gpu, 0, &flow);
    state.cells.write(&gpu, 0, &kinds);
    let picture =
        Renderer::new(&gpu, &scene, &state.buffers()).unwrap().draw(&scene.render, Field::Density, 0.0).unwrap();
    (50..142).map(|x| pixel(&picture, x, 96)[1]).collect()
}

/// The second derivative of the line-of-sight integral: nothing for an even slope, the same everywhere for a parabola.
#[test]
fn a_shadowgraph_is_a_second_derivative() {
    // half of grey, squared, in sRGB
    let middle = 137;
    let even = shadowgraph_of(1.2, |x| 2.0 + x);
    assert!(even.iter().all(|value| (value - middle).abs() <= 2), "{even:?}");
    for (sign, brighter) in [(4.0, false), (-4.0, true)] {
        // a cell is 16 pixels wide, and the sides are out of sight
        let bent = shadowgraph_of(0.5, |x| 3.0 + sign * (x - 0.5) * (x - 0.5));
        let mean = bent.iter().sum::<i32>() / bent.len() as i32;
        assert!(if brighter { mean > middle + 15 } else { mean < middle - 15 }, "{sign}: {bent:?}");
        assert!(bent.iter().all(|value| (value - mean).abs() <= 3), "{sign}: {bent:?}");
    }
}

#[test]
fn a_slice_shows_the_value_of_its_plane() {
    let look = "render.slices = [{ point = [0, 0.55, 0], normal = [0, 1, 0] }]\nrender.volume = false\nrender.particles = false\n\
                render.overlays = { edges = false, color_bar = false }\nrender.colormap = \"gray\"\nrender.range = [0, 8]\n\
                render.camera = { eye = [0.5, -3, 0.5], target = [0.5, 0.5, 0.5], height = 1.0 }";
    let picture = draw(3, Field::Pressure, look);
    // In the middle of the blob the density is 4, so that p = 4^1.4; gray is the fraction of the range, in sRGB.
    let (inside, far) = (pixel(&picture, 62, 60), pixel(&picture, 30, 20));
    let expected = [4.0_f64.powf(1.4), 1.0].map(|pressure| (pressure / 8.0 * 255.0).round() as i32);
    for (found, expected) in [(inside, expected[0]), (far, expected[1])] {
        assert!((found[1] - expected).abs() <= 4, "{found:?}, expected {expected}");
    }
}

#[test]
fn large_pictures_are_drawn_in_bands_without_seams() {
    let gpu = gpu();
    let scene = scene(3, 12, [2048, 1100], "render.overlays = { color_bar = false, title = false, time = false }");
    let state = State::new(&gpu, &scene);
    let mut renderer = Renderer::new(&gpu, &scene, &state.buffers()).unwrap();
    let whole = renderer.draw(&scene.render, Field::Density, 0.0).unwrap();
    // The same picture in one band: half as large, so that one pixel stands for four.
    let mut look = scene.render.clone();
    look.size = [1024, 550];
    let half = renderer.draw(&look, Field::Density, 0.0).unwrap();
    for y in [500, 510, 511, 512, 513, 530, 545] {
        let far = (0..1024).map(|x| (brightness(pixel(&half, x, y)) - brightness(pixel(&whole, 2 * x, 2 * y))).abs());
        let mean = f64::from(far.sum::<i32>()) / 1024.0;
        assert!(mean < 12.0, "row {y}: mean difference {mean} of 765");
    }
}

#[test]
#[ignore = "measures: cargo test --release -- --ignored --nocapture time_of_a_large_picture"]
fn time_of_a_large_picture() {
    let gpu = gpu();
    let scene = scene(3, 128, [1920, 1080], "");
    let state = State::new(&gpu, &scene);
    let mut buffers = state.buffers();
    let particles = buffers.particles.as_mut().unwrap();
    particles.count = particles.count.min(200_000);
    let mut renderer = Renderer::new(&gpu, &scene, &buffers).unwrap();
    for _ in 0..4 {
        let start = std::time::Instant::now();
        renderer.draw(&scene.render, Field::Density, 0.0).unwrap();
        println!("{:.2} s per picture on {}", start.elapsed().as_secs_f64(), gpu.info.name);
    }
}

/// What is written is larger or smaller as asked; for print it is black on white, and files say how large they are on paper.
#[test]
fn print_is_black_on_white_and_letters_have_the_size_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for dimension in 1..=3 {
        let draw = |keys: &str| render(dimension, 12, [640, 400], keys).swap_remove(0);
        let dark = |picture: &Picture| {
            let header = (0..640).flat_map(|x| (0..24).map(move |y| (x, y)));
            header.filter(|&(x, y)| brightness(pixel(picture, x, y)) < 450).count()
        };
        let [plain, large] =
            ["", "\nrender.text_size = 1.6"].map(|more| draw(&format!("render.look = \"print\"{more}")));
        assert_eq!([pixel(&plain, 0, 0), pixel(&plain, 639, 399)], [[255; 3]; 2], "{dimension}D");
        assert!(dark(&plain) > 20 && dark(&large) > dark(&plain), "{dimension}D: {} {}", dark(&plain), dark(&large));
        assert!(brightness(pixel(&draw(""), 0, 0)) < 120, "{dimension}D");

        let path = folder.path().join(format!("{dimension}.png"));
        plain.save(&path).unwrap();
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let reader = png::Decoder::new(file).read_info().unwrap();
        let size = reader.info().pixel_dims.unwrap();
        assert_eq!((size.xppu, size.yppu, size.unit), (11811, 11811, png::Unit::Meter), "300 pixels per inch");
    }
}

/// Light that differs from that of most pixels around, where a ball looks at the camera: holes, and gas that shines through.
#[test]
fn a_thin_shell_around_hot_gas_has_no_holes_and_no_specks() {
    let gpu = gpu();
    let more = "render.surface = \"smooth\"\nrender.overlays = { title = false, time = false, edges = false }\n\
                render.emission = { ambient_kelvin = 360.0 }\nrender.tone = \"aces\"\nrender.colormap = \"gray\"\n\
                render.camera = { eye = [3.0, 0.4, 0.6], target = [0.5, 0.5, 0.5], height = 0.7 }\n\
                materials.tin.von_mises = { young_modulus = 1e3, poisson_ratio = 0.3, yield_stress = 30 }\n\
                [[gas.regions]]\nshape.sphere = { center = [0.5, 0.5, 0.5], radius = 0.25 }\ndensity = 4\npressure = 40\n\
                [[bodies]]\nname = \"shell\"\nmaterial = \"tin\"\ndensity = 10\n[[bodies.shape.difference]]\n\
                shell = { thickness = 0.05, shape.sphere = { center = [0.5, 0.5, 0.5], radius = 0.25 } }\n\
                [[bodies.shape.difference]]\n\
                torus = { center = [0.5, 0.5, 0.5], axis = [0, 0, 1], major = 0.25, minor = 0.024 }\n";
    let scene = scene(3, 24, [320, 320], more);
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    let picture = Renderer::of(&simulation, &scene).unwrap().draw(&scene.render, Field::Schlieren, 0.0).unwrap();
    let light = |x: i32, y: i32| brightness(pixel(&picture, x as u32, y as u32));
    let mut odd = Vec::new();
    for (x, y) in (70..250).flat_map(|x| (70..250).map(move |y| (x, y))) {
        if (x - 160_i32).pow(2) + (y - 160_i32).pow(2) > 85 * 85 {
            continue;
        }
        let mut around: Vec<i32> = (-3..=3).flat_map(|i| (-3..=3).map(move |j| light(x + i, y + j))).collect();
        around.sort_unstable();
        if (light(x, y) - around[24]).abs() > 90 {
            odd.push((x, y));
        }
    }
    export::png::write(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("thin_shell.png"), &picture.frame, &[]).unwrap();
    assert!(odd.len() < 5, "{} pixels: {odd:?}", odd.len());
}
