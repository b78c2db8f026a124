//! Bodies in pictures: their colours and their smooth surfaces.

use brisance::gpu::readback;
use brisance::render::{Picture, Renderer};
use brisance::scene::{Camera, Field, ParticleColor};
use brisance::simulation::Simulation;

use crate::synthetic::{brightness, gpu, pixel, scene};

/// Whether a pixel has a colour, but for rounding.
fn has(found: [i32; 3], wanted: [i32; 3]) -> bool {
    found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= 3)
}

#[test]
fn bodies_have_their_own_colour_or_that_of_their_material() {
    let gpu = gpu();
    let body = |name: &str, material: &str, x: f64, more: &str| {
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"{material}\"\ndensity = 1.0\n{more}\n\
             shape.box = {{ center = [{x}, 0.5], size = [0.15, 0.3] }}\n"
        )
    };
    let bodies = [
        body("red", "jelly", 0.2, "color = \"#c02040\""),
        body("hard", "steel", 0.5, ""),
        body("plain", "jelly", 0.8, ""),
    ];
    let text = format!(
        "render.overlays = {{ scale_bar = false }}\n\
         materials.jelly.neo_hookean = {{ young_modulus = 1e3, poisson_ratio = 0.3 }}\n{}",
        bodies.concat()
    );
    let scene = scene(2, 20, [480, 360], &text);
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    let mut renderer = Renderer::of(&simulation, &scene).unwrap();
    let mut look = scene.render.clone();
    let by_body = renderer.draw(&look, Field::Density, 0.0).unwrap();
    look.particle_color = ParticleColor::Material;
    let by_material = renderer.draw(&look, Field::Density, 0.0).unwrap();
    let at = |picture: &Picture, x: f64| {
        let origin = |pixel: f64| renderer.ray(&look, 0.0, [pixel, 180.0]).origin[0];
        let column = (x - origin(0.0)) / (origin(1.0) - origin(0.0));
        pixel(picture, column as u32, 180)
    };
    let (red, steel) = ([0xc0, 0x20, 0x40], [150, 158, 168]);
    assert!(has(at(&by_body, 0.2), red), "{:?}", at(&by_body, 0.2));
    assert!(has(at(&by_body, 0.5), steel), "{:?}", at(&by_body, 0.5));
    let plain = at(&by_body, 0.8);
    assert!(!has(plain, red) && !has(plain, steel), "{plain:?}");
    assert!(has(at(&by_material, 0.5), steel), "{:?}", at(&by_material, 0.5));
    assert_eq!(at(&by_material, 0.2), at(&by_material, 0.8), "one material");
}

/// A plate seen from above, stretched along x by plastic flow.
fn stretched_plate(stretch: f32) -> Picture {
    let gpu = gpu();
    let text = "render.look = \"film\"\nrender.volume = false\n\
                materials.metal.von_mises = { young_modulus = 1e3, poisson_ratio = 0.3, yield_stress = 10.0 }\n\
                [[bodies]]\nname = \"plate\"\nmaterial = \"metal\"\ndensity = 1.0\ncolor = \"#ffffff\"\n\
                shape.box = { center = [0.5, 0.5, 0.5], size = [0.4, 0.6, 0.1] }\n";
    let scene = scene(3, 20, [480, 360], text);
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    let particles = &simulation.state.particles;
    let mut position = readback::read(&gpu, &particles.position).unwrap();
    position.iter_mut().for_each(|row| row[0] = 0.5 + stretch * (row[0] - 0.5));
    particles.position.write(&gpu, 0, &position);
    let mut affine = readback::read(&gpu, &particles.affine).unwrap();
    affine.iter_mut().skip(1).step_by(3).for_each(|row| row[3] = stretch.ln());
    particles.affine.write(&gpu, 0, &affine);
    let mut look = scene.render.clone();
    look.camera =
        Some(Camera { eye: [0.5, 0.5, 2.5], target: [0.5; 3], up: [0.0, 1.0, 0.0], fov_degrees: 40.0, height: None });
    Renderer::of(&simulation, &scene).unwrap().draw(&look, Field::Density, 0.0).unwrap()
}

#[test]
fn a_stretched_plate_has_a_closed_surface() {
    let picture = stretched_plate(2.2);
    let middle = brightness(pixel(&picture, 240, 180));
    let background = brightness(pixel(&picture, 240, 5));
    assert!(middle > background + 100, "{middle} on {background}");
    // two thirds of what the plate covers
    let holes = (160..320).flat_map(|x| (130..230).map(move |y| (x, y)));
    let holes = holes.filter(|&(x, y)| brightness(pixel(&picture, x, y)) < (middle + background) / 2).count();
    assert_eq!(holes, 0, "dark pixels in the plate");
}
