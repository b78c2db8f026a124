//! Gas that bends the view, and what is behind everything.

use brisance::gpu::readback;
use brisance::render::{Depth, Picture, Renderer};
use brisance::scene::{Backdrop, Camera, Field, Refraction, RenderSettings};

use crate::synthetic::{State, every_cell, gpu, pixel, scene};

const SIZE: [u32; 2] = [400, 400];

/// Pictures of a state whose density rises along x by so much per metre, each with another look.
fn pictures(slope: f32, looks: &[&dyn Fn(&mut RenderSettings)]) -> Vec<Picture> {
    let gpu = gpu();
    let obstacle =
        "[[obstacles]]\nname = \"step\"\nshape.box = { center = [0.925, 0.075, 0.15], size = [0.15, 0.15, 0.3] }";
    let text = format!(
        "render.look = \"film\"\nrender.supersampling = 1\nrender.ground = true\nrender.volume = false\n{obstacle}"
    );
    let scene = scene(3, 40, SIZE, &text);
    let state = State::new(&gpu, &scene);
    let mut conserved = readback::read(&gpu, &state.conserved).unwrap();
    for (slot, cell) in every_cell(&state.grid, [1; 3]) {
        conserved[slot] = [1.0 + slope * state.grid.centre(cell)[0], 0.0, 0.0, 0.0];
    }
    state.conserved.write(&gpu, 0, &conserved);
    let depth = Depth { layers: true, fine: false };
    let mut renderer = Renderer::new(&gpu, &scene, &state.buffers()).unwrap().with_depth(depth);
    let draw = |change: &&dyn Fn(&mut RenderSettings)| {
        let mut look = scene.render.clone();
        look.camera = Some(Camera {
            eye: [0.5, 0.5, 3.0],
            target: [0.5; 3],
            up: [0.0, 1.0, 0.0],
            fov_degrees: 40.0,
            height: Some(1.0),
        });
        look.refraction = None;
        change(&mut look);
        renderer.draw(&look, Field::Density, 0.0).unwrap()
    };
    looks.iter().map(draw).collect()
}

/// The full constant of Gladstone and Dale, for the slopes of these tests.
fn bent(look: &mut RenderSettings) {
    look.refraction = Some(Refraction { gladstone_dale: 0.1, exaggeration: 10.0 });
}

/// Rays that fall straight through a gradient g of the index are g s^2 / 2 off after a way s: things seem to lie as far on the other side.
/// Over the first three cells bending sets in.
#[test]
fn a_gradient_of_density_shifts_what_is_behind_it() {
    let slope = 0.2;
    let pictures = pictures(slope, &[&|_| (), &bent]);
    let wanted = |height: f32| {
        let (way, fading) = (1.0 - height, 3.0 / 40.0);
        slope * (0.5 * way * way - 0.5 * fading * (way - fading / 3.0))
    };
    // a row across the obstacle, more than three cells from the side: rays meet the upper half of its face
    let edge = |picture: &Picture| {
        let row = &picture.layers.pixels[352 * 400..353 * 400];
        row.iter().position(|own| own.depth < 2.85).unwrap() as f32 / 400.0
    };
    let found = edge(&pictures[0]) - edge(&pictures[1]);
    assert!((found / wanted(0.15) - 1.0).abs() < 0.08, "obstacle: {found} m, not {}", wanted(0.15));
    // the right side of the shell of particles at half of the height; to the left of it bending fades
    let side = |picture: &Picture| {
        let rows = (110..155).map(|row| &picture.layers.pixels[row * 400..(row + 1) * 400]);
        let sides: Vec<f32> = rows.map(|row| row.iter().rposition(|own| own.depth < 2.65).unwrap() as f32).collect();
        sides.iter().sum::<f32>() / sides.len() as f32 / 400.0
    };
    let found = side(&pictures[0]) - side(&pictures[1]);
    assert!((found / wanted(0.5) - 1.0).abs() < 0.15, "bodies: {found} m, not {}", wanted(0.5));
}

#[test]
fn gas_of_one_density_bends_nothing() {
    let pictures = pictures(
        0.0,
        &[&|_| (), &bent, &|look| look.refraction = Some(Refraction { exaggeration: 0.0, ..Refraction::default() })],
    );
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
}

#[test]
fn daylight_has_a_horizon_and_earth() {
    let view = |look: &mut RenderSettings| {
        look.backdrop = Backdrop::Daylight;
        look.particles = false;
        look.camera = Some(Camera {
            eye: [0.5, -3.0, 0.4],
            target: [0.5, 0.5, 0.4],
            up: [0.0, 0.0, 1.0],
            fov_degrees: 40.0,
            height: None,
        });
    };
    let picture = &pictures(0.0, &[&view])[0];
    let [zenith, sky, earth, near] = [5, 190, 230, 395].map(|row| pixel(picture, 60, row));
    assert!(zenith[2] > zenith[0] + 20, "blue above: {zenith:?}");
    assert!(sky.iter().sum::<i32>() > 450 && sky[0] + 5 > zenith[0], "bright at the horizon: {sky:?}");
    assert!(near[0] > near[2] + 20 && near != earth, "brown below: {near:?}");
}
