//! Pictures of a synthetic state.

use std::collections::HashMap;

use brisance::export::{self, Exporter, Moment, Origin};
use brisance::gpu::readback;
use brisance::render::Renderer;
use brisance::scene::{Camera, Field};
use brisance::simulation::Simulation;

use crate::synthetic::{State, brightness, every_cell, gpu, pixel, render, scene};

use crate::common::read_png;

#[test]
fn slice_has_y_up_and_the_range_of_its_field() {
    let pictures = render(2, 48, [320, 200], "output.fields = [\"density\", \"schlieren\"]\nrender.particles = false");
    assert_eq!(pictures[0].name, "density");
    let [low, high] = pictures[0].range;
    assert!((low - 1.0).abs() < 0.01 && (high - 4.0).abs() < 0.01, "{low} {high}");
    // The blob lies left of the middle and above it: 0.6 of the way up.
    let (columns, rows) = (0..320, 0..200);
    let bright = |x: u32, y: u32| {
        let [red, green, blue] = pixel(&pictures[0], x, y);
        red > 200 && green > 200 && blue < 90
    };
    let seen: Vec<_> =
        columns.flat_map(|x| rows.clone().map(move |y| (x, y))).filter(|&(x, y)| x < 220 && bright(x, y)).collect();
    let mean_y = seen.iter().map(|place| place.1).sum::<u32>() / seen.len() as u32;
    assert!(seen.len() > 200 && mean_y < 100, "{} pixels, mean row {mean_y}", seen.len());
    assert_eq!(pictures[1].range[0], 0.0);
}

#[test]
fn gas_in_the_plane_has_no_steps_between_cells() {
    let fields = "output.fields = [\"density\", \"schlieren\"]\nrender.particles = false\nrender.contours = 0";
    for picture in render(2, 12, [640, 480], fields) {
        // Across the blob, a cell is 35 pixels wide.
        let row: Vec<i32> = (150..300).map(|x| brightness(pixel(&picture, x, 190))).collect();
        let span = row.iter().max().unwrap() - row.iter().min().unwrap();
        let jump = row.windows(2).map(|pair| (pair[1] - pair[0]).abs()).max().unwrap();
        assert!(span > 150 && 6 * jump < span, "{}: a jump of {jump} from pixel to pixel in {span}", picture.name);
    }
}

#[test]
fn a_stretched_body_in_the_plane_is_one_area() {
    let gpu = gpu();
    let body = "materials.rubber.neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }\n\
                [[bodies]]\nname = \"block\"\nmaterial = \"rubber\"\ndensity = 1.0\n\
                shape.box = { center = [0.5, 0.5], size = [0.3, 0.3] }\n";
    let scene = scene(2, 20, [480, 360], &format!("render.overlays = {{ scale_bar = false }}\n{body}"));
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    // Twice as long along x.
    let particles = &simulation.state.particles;
    let mut position = readback::read(&gpu, &particles.position).unwrap();
    position.iter_mut().for_each(|row| row[0] = 0.5 + 2.0 * (row[0] - 0.5));
    particles.position.write(&gpu, 0, &position);
    let mut deformation = readback::read(&gpu, &particles.deformation).unwrap();
    deformation.iter_mut().step_by(3).for_each(|row| row[0] += 1.0);
    particles.deformation.write(&gpu, 0, &deformation);

    let mut renderer = Renderer::of(&simulation, &scene).unwrap();
    let picture = renderer.draw(&scene.render, Field::Density, 0.0).unwrap();
    let offset = |x: u32, y: u32| {
        let at = renderer.ray(&scene.render, 0.0, [f64::from(x) + 0.5, f64::from(y) + 0.5]).origin;
        [(at[0] - 0.5).abs(), (at[1] - 0.5).abs()]
    };
    let places = (0..480).flat_map(|x| (0..360).map(move |y| (x, y)));
    let near = places.filter(|&(x, y)| offset(x, y)[0] < 0.45 && offset(x, y)[1] < 0.4);
    let middle = near.clone().find(|&(x, y)| offset(x, y).iter().all(|d| *d < 3e-3)).unwrap();
    let color = pixel(&picture, middle.0, middle.1);
    let (edge, corner) = (0.015, 0.05);
    let mut seen = [0; 2];
    for (x, y) in near {
        let [dx, dy] = offset(x, y);
        let inside = (dx < 0.3 - edge && dy < 0.15 - corner) || (dx < 0.3 - corner && dy < 0.15 - edge);
        let outside = dx > 0.3 + edge || dy > 0.15 + edge;
        let same = pixel(&picture, x, y).iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 2);
        let wrong = if inside { !same } else { outside && same };
        assert!(!wrong, "pixel {x}, {y}, {dx:.3} {dy:.3} from the middle");
        seen[usize::from(outside)] += u32::from(inside || outside);
    }
    assert!(seen.iter().all(|count| *count > 5000), "{seen:?}");
}

#[test]
fn a_body_of_scattered_particles_has_no_holes() {
    let body = "materials.rubber.neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }\n\
                [[bodies]]\nname = \"block\"\nmaterial = \"rubber\"\ndensity = 1.0\nsampling = \"jittered\"\n\
                shape.box = { center = [0.5, 0.5], size = [0.6, 0.6] }\n";
    let scene = scene(2, 40, [960, 720], &format!("render.overlays = {{ scale_bar = false }}\n{body}"));
    let simulation = Simulation::new(&gpu(), &scene).unwrap();
    let mut renderer = Renderer::of(&simulation, &scene).unwrap();
    let picture = renderer.draw(&scene.render, Field::Density, 0.0).unwrap();
    let within = |&(x, y): &(u32, u32)| {
        let at = renderer.ray(&scene.render, 0.0, [f64::from(x) + 0.5, f64::from(y) + 0.5]).origin;
        (0..2).all(|axis| (at[axis] - 0.5).abs() < 0.27)
    };
    let places: Vec<_> = (0..960).flat_map(|x| (0..720).map(move |y| (x, y))).filter(|place| within(place)).collect();
    let color = pixel(&picture, places[places.len() / 2].0, places[places.len() / 2].1);
    let differs = |&&(x, y): &&(u32, u32)| pixel(&picture, x, y).iter().zip(color).any(|(a, b)| a.abs_diff(b) > 40);
    let holes = places.iter().filter(differs).count();
    println!("{holes} of {} pixels", places.len());
    assert!(places.len() > 50_000, "the body is large: {}", places.len());
    assert_eq!(holes, 0, "pixels within the body that show gas");
}

#[test]
fn particles_alone_in_the_plane_are_seen() {
    let gpu = gpu();
    let body = "materials.rubber.neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }\n\
                [[bodies]]\nname = \"block\"\nmaterial = \"rubber\"\ndensity = 1.0\n\
                shape.box = { center = [0.5, 0.5], size = [0.15, 0.15] }\n";
    let scene = scene(2, 20, [480, 360], &format!("render.overlays = {{ scale_bar = false }}\n{body}"));
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    // Three times as far from each other as neighbours are.
    let particles = &simulation.state.particles;
    let mut position = readback::read(&gpu, &particles.position).unwrap();
    let apart = |x: f32| 0.5 + 3.0 * (x - 0.5);
    position.iter_mut().for_each(|row| [row[0], row[1]] = [apart(row[0]), apart(row[1])]);
    particles.position.write(&gpu, 0, &position);

    let mut renderer = Renderer::of(&simulation, &scene).unwrap();
    let picture = renderer.draw(&scene.render, Field::Density, 0.0).unwrap();
    let origin = |x: f64, y: f64| renderer.ray(&scene.render, 0.0, [x, y]).origin;
    let (first, next) = (origin(0.0, 0.0), origin(1.0, 1.0));
    let place = |axis: usize, x: f32| ((f64::from(x) - first[axis]) / (next[axis] - first[axis])) as u32;
    let gas = pixel(&picture, place(0, 0.02), place(1, 0.02));
    assert_eq!(position.len(), 36);
    for row in position {
        let own = pixel(&picture, place(0, row[0]), place(1, row[1]));
        assert!(own.iter().zip(gas).any(|(a, b)| a.abs_diff(b) > 40), "{row:?}: {own:?} in gas of {gas:?}");
    }
}

#[test]
fn every_field_can_be_drawn() {
    let fields = r#"["density", "pressure", "velocity", "temperature", "schlieren", "mach", "vorticity"]"#;
    for dimension in [2, 3] {
        for picture in render(dimension, 20, [96, 64], &format!("output.fields = {fields}")) {
            assert!(picture.range[0] < picture.range[1], "{} in {dimension}D: {:?}", picture.name, picture.range);
        }
    }
}

/// Density and velocity, or nothing outside the gas.
type Motion<'a> = dyn Fn([i32; 3]) -> Option<[f64; 4]> + 'a;

/// Difference quotient along an axis; one-sided next to cells without gas.
fn slope(motion: &Motion<'_>, cell: [i32; 3], axis: usize, spacing: f64) -> [f64; 4] {
    let at = |step: i32| {
        let mut near = cell;
        near[axis] += step;
        motion(near)
    };
    let here = motion(cell).expect("a gas cell");
    let (low, high) = (at(-1), at(1));
    let steps = f64::from(u32::from(low.is_some()) + u32::from(high.is_some()));
    let (low, high) = (low.unwrap_or(here), high.unwrap_or(here));
    std::array::from_fn(|k| if steps > 0.0 { (high[k] - low[k]) / (steps * spacing) } else { 0.0 })
}

#[test]
fn fields_are_what_they_are_called() {
    let gpu = gpu();
    for dimension in [2_usize, 3] {
        let fields = r#"["density", "pressure", "velocity", "temperature", "schlieren", "mach", "vorticity"]"#;
        let scene = scene(dimension as u32, 20, [96, 64], &format!("output.fields = {fields}"));
        let state = State::new(&gpu, &scene);
        let pictures = Renderer::new(&gpu, &scene, &state.buffers()).unwrap().render(0.0125).unwrap();
        let flow = readback::read(&gpu, &state.conserved).unwrap();
        let energy = readback::read(&gpu, &state.energy).unwrap();
        let kinds = readback::read(&gpu, &state.cells).unwrap();
        let ring: [i32; 3] = state.grid.padding().map(|n| n as i32);
        let slots: HashMap<_, _> = every_cell(&state.grid, ring).map(|(slot, cell)| (cell, slot)).collect();
        let motion = |cell: [i32; 3]| {
            let slot = *slots.get(&cell).filter(|slot| kinds[**slot] == 0)?;
            let [rho, a, b, c] = flow[slot].map(f64::from);
            Some([rho, a / rho, b / rho, c / rho])
        };
        let spacing = f64::from(state.grid.spacing);
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 7];
        for (cell, slot) in &slots {
            let Some([rho, u, v, w]) = motion(*cell) else { continue };
            let speed = (u * u + v * v + w * w).sqrt();
            let pressure = 0.4 * (f64::from(energy[*slot]) - 0.5 * rho * speed * speed);
            let slopes: Vec<_> = (0..dimension).map(|axis| slope(&motion, *cell, axis, spacing)).collect();
            let of = |axis: usize, component: usize| slopes.get(axis).map_or(0.0, |slope| slope[component + 1]);
            let curl = glam::DVec3::new(of(1, 2) - of(2, 1), of(2, 0) - of(0, 2), of(0, 1) - of(1, 0));
            let steepness = slopes.iter().map(|slope| slope[0] * slope[0]).sum::<f64>().sqrt();
            let mach = speed / (1.4 * pressure / rho).sqrt();
            let all = [rho, pressure, speed, pressure / rho, steepness, mach, curl.length()];
            for (range, value) in ranges.iter_mut().zip(all) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
        // in space the default mode shows density by its gradient
        ranges[0] = if dimension == 3 { ranges[4] } else { ranges[0] };
        for (picture, [low, high]) in pictures.iter().zip(ranges) {
            let off = [picture.range[0] - low, picture.range[1] - high];
            let rest = picture.range[0] == 0.0 && low >= 0.0;
            let fits = (off[0].abs() < 1e-4 * high || rest) && off[1].abs() < 1e-4 * high;
            assert!(fits, "{} in {dimension}D: {:?}, expected {low} .. {high}", picture.name, picture.range);
        }
    }
}

#[test]
fn smallest_frames_do_not_overflow() {
    for size in [[16, 16], [16, 300], [300, 16]] {
        for dimension in 1..=3 {
            render(dimension, 8, size, "");
        }
    }
}

#[test]
fn given_range_is_kept() {
    let pictures = render(2, 16, [64, 64], "render.range = [0.5, 7.5]");
    assert_eq!(pictures[0].range, [0.5, 7.5]);
}

#[test]
fn a_look_may_change_from_picture_to_picture() {
    let gpu = gpu();
    let scene = scene(3, 16, [96, 64], "");
    let state = State::new(&gpu, &scene);
    let mut renderer = Renderer::new(&gpu, &scene, &state.buffers()).unwrap();
    let first = renderer.render(0.0125).unwrap();
    let mut look = scene.render.clone();
    look.size = [48, 80];
    look.particles = false;
    let eye = [0.5, -2.0, 0.6];
    look.camera = Some(Camera { eye, target: [0.5; 3], up: [0.0, 0.0, 1.0], fov_degrees: 35.0, height: None });
    let other = renderer.draw(&look, Field::Pressure, 0.0125).unwrap();
    assert_eq!((other.frame.width, other.frame.height, other.name.as_str()), (48, 80, "pressure"));
    assert_eq!(other.range, renderer.automatic_range(&look, Field::Pressure).unwrap());
    assert_ne!(renderer.draw(&look, Field::Velocity, 0.0125).unwrap().frame, other.frame);
    let again = renderer.draw(&scene.render, Field::Density, 0.0125).unwrap();
    assert_eq!(again, first[0], "what was drawn in between leaves no trace");
    let ray = renderer.ray(&look, 0.0, [24.0, 40.0]);
    assert_eq!(ray.origin, eye.map(|x: f64| f64::from(x as f32)));
    assert!(ray.direction[1] > 0.99, "{ray:?}");
    assert_eq!(renderer.camera(&look, 0.0), look.camera.unwrap());
}

#[test]
fn a_pixel_of_the_plane_is_the_point_it_shows() {
    let gpu = gpu();
    let scene = scene(2, 48, [320, 200], "");
    let state = State::new(&gpu, &scene);
    let renderer = Renderer::new(&gpu, &scene, &state.buffers()).unwrap();
    let mut look = scene.render.clone();
    look.size = [640, 400];
    let along = |x: f64| renderer.ray(&look, 0.0, [x, 200.0]).origin[0];
    // the picture of the unit square is as high as the frame but for the margins
    let pixels = (1.0 / (along(301.0) - along(300.0))).round();
    assert!((300.0..400.0).contains(&pixels), "{pixels} pixels per unit length");
    assert!((along(300.0) - along(200.0) - 100.0 / pixels).abs() < 1e-3);
    assert!(renderer.ray(&look, 0.0, [320.0, 100.0]).origin[1] > renderer.ray(&look, 0.0, [320.0, 300.0]).origin[1]);
}

#[test]
fn volume_shows_the_particles_in_front() {
    let with = render(3, 24, [192, 108], "");
    let without = render(3, 24, [192, 108], "render.particles = false");
    let changed =
        |x: u32, y: u32| (brightness(pixel(&with[0], x, y)) - brightness(pixel(&without[0], x, y))).abs() > 40;
    let count = (0..192).flat_map(|x| (0..108).map(move |y| (x, y))).filter(|&(x, y)| changed(x, y)).count();
    assert!(count > 300, "{count} pixels show particles");
}

#[test]
fn volume_shows_the_gas() {
    let no_particles = "render.particles = false";
    let gas = &render(3, 24, [160, 120], no_particles)[0];
    // all of it far below the range: air
    let air = &render(3, 24, [160, 120], &format!("{no_particles}\nrender.range = [1e4, 2e4]"))[0];
    let far = |x, y| {
        let (a, b) = (pixel(gas, x, y), pixel(air, x, y));
        (0..3).map(|k| (a[k] - b[k]).abs()).sum::<i32>() > 30
    };
    let middle = (60..100).flat_map(|x| (40..80).map(move |y| (x, y))).filter(|&(x, y)| far(x, y)).count();
    let edge = (0..12).flat_map(|x| (0..40).map(move |y| (x, y))).filter(|&(x, y)| far(x, y)).count();
    assert!(middle > 300 && edge == 0, "{middle} pixels show the gas, {edge} beside the domain");
}

#[test]
fn lines_of_one_dimension() {
    let pictures = render(1, 100, [640, 480], "");
    assert_eq!(pictures.len(), 1);
    assert!(pictures[0].range[0] < 1.0 && pictures[0].range[1] > 4.0);
}

#[test]
#[ignore = "large pictures for the eye: cargo test -- --ignored pictures, then look into target/tmp"]
fn pictures_to_look_at() {
    let block = "\n[[obstacles]]\nname = \"block\"\nshape.box = { center = [0.95, 0.05, 0.1], size = [0.2, 0.2, 0.4] }";
    render(1, 200, [1280, 720], "");
    let fields = r#"output.fields = ["density", "schlieren"]"#;
    render(2, 128, [1280, 720], &format!("{fields}\nrender.colormap = \"inferno\""));
    render(3, 64, [1280, 720], &format!("render.colormap = \"inferno\"{block}"));
    render(3, 64, [1024, 640], "render.mode = \"density\"\nrender.colormap = \"magma\"");
}

#[test]
fn png_tells_where_it_comes_from() {
    let folder = tempfile::tempdir().unwrap();
    let pictures = render(2, 16, [64, 48], "output.fields = [\"pressure\", \"density\"]");
    let origin = Origin { title: "Sod \u{2192} shell".to_owned(), hash: "cafe".to_owned(), ..Origin::default() };
    let (pictures, snapshot, stored) = (&pictures[..], None, None);
    let moment = Moment { index: 7, origin: &origin, time: 0.0125, step: 42, pictures, snapshot, stored };
    export::png::PngExporter::new(folder.path()).write(&moment).unwrap();
    let (info, pixels) = read_png(&folder.path().join("frames/0007.png"));
    let rgb: Vec<u8> = pictures[0].frame.rgba.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect();
    assert_eq!(pixels, rgb);
    let text = |key: &str| {
        info.uncompressed_latin1_text.iter().find(|chunk| chunk.keyword == key).map(|chunk| chunk.text.clone())
    };
    assert_eq!(text("Time").as_deref(), Some("0.0125"));
    assert_eq!(text("Step").as_deref(), Some("42"));
    assert_eq!(text("Scene").as_deref(), Some("cafe"));
    assert_eq!(text("Field").as_deref(), Some("pressure"));
    assert!(text("Range").is_some());
    assert_eq!([text("Symbol"), text("Unit")], ["p", "Pa"].map(|own| Some(own.to_owned())));
    let picture = &render(3, 8, [64, 48], "render.mode = \"schlieren\"")[0];
    let said = Moment { pictures: &[], ..moment }.provenance(picture);
    let of = |key: &str| said.iter().find(|(own, _)| *own == key).map(|(_, text)| text.as_str());
    assert_eq!([of("Field"), of("Unit")], [Some("schlieren"), Some("kg m^-4")]);
    assert_eq!(picture.name, "density");
    assert_eq!(info.utf8_text[0].get_text().unwrap(), "Sod \u{2192} shell");
    assert!(folder.path().join("frames/density/0007.png").exists());
}
