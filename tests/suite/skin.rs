//! Bodies in pictures: their colours and their smooth surfaces.

use brisance::gpu::readback;
use brisance::render::{Picture, Renderer};
use brisance::scene::{Camera, Field, ParticleColor, Surface};
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

/// Side of the pictures of a ball, and the ball's radius in them: they show 0.8 on 400 pixels.
const SIDE: u32 = 400;
const BALL_RADIUS: f64 = 175.0;

/// Brightness around the middle of a picture.
fn shade(picture: &Picture, x: f64, y: f64) -> f64 {
    let middle = f64::from(SIDE / 2);
    f64::from(brightness(pixel(picture, (middle + x) as u32, (middle - y) as u32)))
}

/// A ball of particles on a lattice, 28 of them across, seen along y and lit from above the eye; without it; and its particles as balls.
fn lattice_ball() -> [Picture; 3] {
    let gpu = gpu();
    let text = "render.look = \"film\"\nrender.volume = false\n\
                render.light = { direction = [-0.6, -1.0, 1.0] }\n\
                materials.jelly.neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }\n\
                [[bodies]]\nname = \"ball\"\nmaterial = \"jelly\"\ndensity = 1.0\ncolor = \"#c0c0c0\"\n\
                shape.sphere = { center = [0.5, 0.5, 0.5], radius = 0.35 }\n";
    let scene = scene(3, 20, [SIDE; 2], text);
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    let mut look = scene.render.clone();
    let (eye, up) = ([0.5, -3.0, 0.5], [0.0, 0.0, 1.0]);
    look.camera = Some(Camera { eye, target: [0.5; 3], up, fov_degrees: 40.0, height: Some(0.8) });
    let mut renderer = Renderer::of(&simulation, &scene).unwrap();
    let mut draw = |look: &_| renderer.draw(look, Field::Density, 0.0).unwrap();
    let ball = draw(&look);
    look.particles = false;
    let empty = draw(&look);
    (look.particles, look.surface) = (true, Surface::Spheres);
    [ball, empty, draw(&look)]
}

/// Root mean square and largest difference between a shade of the ball and the mean of those a particle's distance around, away from
/// its side and from where light only grazes it.
fn ripple(picture: &Picture) -> [f64; 2] {
    let reach = (0.7 * BALL_RADIUS) as i32;
    let places = (-reach..reach).flat_map(|x| (-reach..reach).map(move |y| (f64::from(x), f64::from(y))));
    let seen = places.filter(|(x, y)| y - x > -0.2 * BALL_RADIUS && x.hypot(*y) < 0.7 * BALL_RADIUS);
    let differ = |(x, y): (f64, f64)| {
        let around = [(12.5, 0.0), (-12.5, 0.0), (0.0, 12.5), (0.0, -12.5)];
        shade(picture, x, y) - around.iter().map(|(a, b)| shade(picture, x + a, y + b)).sum::<f64>() / 4.0
    };
    let all: Vec<f64> = seen.map(differ).collect();
    let mean = all.iter().map(|value| value * value).sum::<f64>() / all.len() as f64;
    [mean.sqrt(), all.iter().fold(0.0, |worst, value| value.abs().max(worst))]
}

/// Mean distance of the silhouette from the middle, and the root mean square of its bends: how far it is from the mean of what is two
/// degrees beside.
fn silhouette(picture: &Picture, empty: &Picture) -> [f64; 2] {
    let edge = |k: u32| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 720.0).sin_cos();
        let covered = |r: f64| (shade(picture, r * cos, r * sin) - shade(empty, r * cos, r * sin)).abs() > 12.0;
        (0..1990).rev().map(|tenth| 0.1 * f64::from(tenth)).find(|&r| covered(r)).unwrap_or(0.0)
    };
    let edges: Vec<f64> = (0..720).map(edge).collect();
    let bend = |k: usize| edges[k] - 0.5 * (edges[(k + 4) % 720] + edges[(k + 716) % 720]);
    let bends = (0..720).map(|k| bend(k).powi(2)).sum::<f64>() / 720.0;
    [edges.iter().sum::<f64>() / 720.0, bends.sqrt()]
}

#[test]
fn the_lattice_of_a_ball_is_not_seen() {
    let [ball, empty, spheres] = lattice_ball();
    let [[own, worst], [bare, _]] = [ripple(&ball), ripple(&spheres)];
    let [[radius, bends], [_, bare_bends]] = [silhouette(&ball, &empty), silhouette(&spheres, &empty)];
    println!("ripple {own:.2}, at most {worst:.1}, of balls {bare:.2}");
    println!("radius {radius:.1}, bends {bends:.2}, of balls {bare_bends:.2}");
    assert!(own < 4.5 && worst < 25.0, "ripple {own} of 765, at most {worst}");
    assert!((radius - BALL_RADIUS).abs() < 5.0, "radius {radius}");
    assert!(bends < 1.5, "silhouette bends by {bends} pixels");
}

/// One particle far from any other; without it; and it as a ball.
fn lone_particle() -> [Picture; 3] {
    let gpu = gpu();
    let text = "render.look = \"film\"\nrender.volume = false\nrender.ground = false\nrender.supersampling = 1\n\
                materials.jelly.neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }\n\
                [[bodies]]\nname = \"crumb\"\nmaterial = \"jelly\"\ndensity = 1.0\nparticles_per_cell = 1\n\
                shape.box = { center = [0.525, 0.525, 0.525], size = [0.05, 0.05, 0.05] }\n";
    let scene = scene(3, 20, [SIDE; 2], text);
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    let mut look = scene.render.clone();
    let (eye, up) = ([0.525, -3.0, 0.525], [0.0, 0.0, 1.0]);
    look.camera = Some(Camera { eye, target: [0.525; 3], up, fov_degrees: 40.0, height: Some(0.3) });
    let mut renderer = Renderer::of(&simulation, &scene).unwrap();
    let mut draw = |look: &_| renderer.draw(look, Field::Density, 0.0).unwrap();
    let shard = draw(&look);
    look.particles = false;
    let empty = draw(&look);
    (look.particles, look.surface) = (true, Surface::Spheres);
    [shard, empty, draw(&look)]
}

/// Least and largest distance of the silhouette from its middle, along 72 directions.
fn outline(picture: &Picture, empty: &Picture) -> [f64; 2] {
    let shown = |x, y| (brightness(pixel(picture, x, y)) - brightness(pixel(empty, x, y))).abs() > 3;
    let own: Vec<(u32, u32)> =
        (0..SIDE).flat_map(|x| (0..SIDE).map(move |y| (x, y))).filter(|&(x, y)| shown(x, y)).collect();
    let mean =
        |of: fn(&(u32, u32)) -> u32| own.iter().map(|place| f64::from(of(place))).sum::<f64>() / own.len() as f64;
    let middle = [mean(|place| place.0), mean(|place| place.1)];
    let mut far = [0.0_f64; 72];
    for place in own {
        let offset = [f64::from(place.0) - middle[0], f64::from(place.1) - middle[1]];
        let turn = (offset[1].atan2(offset[0]) / std::f64::consts::TAU).rem_euclid(1.0);
        let own = &mut far[(72.0 * turn) as usize % 72];
        *own = own.max(offset[0].hypot(offset[1]));
    }
    [far.iter().copied().fold(f64::MAX, f64::min), far.iter().copied().fold(0.0, f64::max)]
}

#[test]
fn a_lone_particle_is_a_shard_and_no_ball() {
    let [shard, empty, ball] = lone_particle();
    let [shard, ball] = [shard, ball].map(|picture| outline(&picture, &empty));
    eprintln!("shard {shard:.1?}, ball {ball:.1?} pixels");
    assert!(shard[0] > 15.0, "shard {shard:?}");
    assert!(shard[1] > 1.3 * shard[0] && ball[1] < 1.05 * ball[0], "shard {shard:?}, ball {ball:?}");
}
