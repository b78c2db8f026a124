//! Signed distances, filled cells and seeded particles.

use std::f64::consts::PI;

use super::{BASE, parse};
use crate::scene::{Seed, Shape};

/// Shape, a point inside, a point outside, exact volume in the box [-1, 1]^3.
const SAMPLES: [(&str, [f64; 3], [f64; 3], f64); 24] = [
    ("box = { center = [0.1, 0, 0], size = [1, 0.6, 0.8] }", [0.5, 0.2, 0.3], [0.7, 0.0, 0.0], 0.48),
    ("box = { center = [0, 0, 0], size = [1, 1, 1], round = 0.5 }", [0.0, 0.0, 0.45], [0.4, 0.4, 0.0], ball(0.5)),
    ("sphere = { center = [0, 0.1, 0], radius = 0.8 }", [0.0, 0.85, 0.0], [0.0, -0.75, 0.0], ball(0.8)),
    (
        "ellipsoid = { center = [0, 0, 0], radii = [0.9, 0.5, 0.2] }",
        [0.8, 0.0, 0.0],
        [0.0, 0.0, 0.25],
        ball(1.0) * 0.09,
    ),
    (
        "cylinder = { center = [0, 0, 0], axis = [0, 2, 0], radius = 0.4, height = 1.2 }",
        [0.3, 0.5, 0.0],
        [0.0, 0.7, 0.0],
        PI * 0.192,
    ),
    (
        "capsule = { from = [-0.5, 0, 0], to = [0.5, 0, 0], radius = 0.3 }",
        [0.7, 0.0, 0.0],
        [0.0, 0.4, 0.0],
        PI * 0.09 + ball(0.3),
    ),
    ("cone = { center = [0, 0, -0.5], radius = 0.6, height = 1.2 }", [0.0, 0.0, 0.5], [0.4, 0.0, 0.3], PI * 0.36 * 0.4),
    (
        "cone = { center = [0, 0, 0], axis = [1, 0, 0], radius = 0.6, top_radius = 0.3, height = 0.9 }",
        [0.8, 0.2, 0.0],
        [-0.1, 0.0, 0.0],
        PI * 0.3 * 0.63,
    ),
    (
        "torus = { center = [0, 0, 0], axis = [0, 0, 1], major = 0.6, minor = 0.2 }",
        [0.5, 0.0, 0.1],
        [0.0, 0.0, 0.0],
        2.0 * PI * PI * 0.024,
    ),
    ("half_space = { point = [0, 0, 0.25], normal = [0, 0, 3] }", [0.0, 0.0, 0.2], [0.0, 0.0, 0.3], 5.0),
    (
        "polygon = { points = [[-0.8, -0.8], [0.8, -0.8], [0, 0], [0.8, 0.8], [-0.8, 0.8]], base = -0.5, height = 1 }",
        [-0.5, 0.0, 0.0],
        [0.5, 0.0, 0.0],
        1.92,
    ),
    (
        "translate = { offset = [0.3, 0, 0], shape = { sphere = { center = [0, 0, 0], radius = 0.5 } } }",
        [0.7, 0.0, 0.0],
        [-0.3, 0.0, 0.0],
        ball(0.5),
    ),
    (
        "rotate = { degrees = 90, shape = { box = { center = [0.5, 0, 0], size = [0.8, 0.2, 0.2] } } }",
        [0.0, 0.8, 0.0],
        [0.5, 0.0, 0.0],
        0.032,
    ),
    (
        "chain = { points = [[-0.5, 0, 0], [0.5, 0, 0]], radii = [0.3] }",
        [0.7, 0.0, 0.0],
        [0.0, 0.4, 0.0],
        PI * 0.09 + ball(0.3),
    ),
    // caps of the balls and a frustum between the circles where it touches them: sine 0.2 of half the opening
    (
        "chain = { points = [[-0.5, 0, 0], [0.5, 0, 0]], radii = [0.2, 0.4] }",
        [0.85, 0.0, 0.0],
        [-0.5, 0.25, 0.0],
        0.4557,
    ),
    (
        "revolve = { center = [0, 0, 0.1], axis = [0, 1, 0], points = [[0, -0.5], [0.5, -0.5], [0.5, 0.5], [0, 0.5]] }",
        [0.3, 0.45, 0.1],
        [0.0, 0.6, 0.1],
        PI * 0.25,
    ),
    (
        "mirror = { normal = [1, 0, 0], shape = { sphere = { center = [0.5, 0.1, 0], radius = 0.3 } } }",
        [-0.7, 0.1, 0.0],
        [0.0, 0.1, 0.0],
        2.0 * ball(0.3),
    ),
    (
        "around = { count = 3, shape = { repeat = { count = 2, offset = [0, 0, 0.7], shape = { sphere = { center = [0.6, 0, -0.4], radius = 0.25 } } } } }",
        [-0.3, -0.52, 0.3],
        [-0.6, 0.0, 0.3],
        6.0 * ball(0.25),
    ),
    (
        "scale = { factor = 2, shape = { sphere = { center = [0.1, 0, 0], radius = 0.35 } } }",
        [0.85, 0.0, 0.0],
        [-0.55, 0.0, 0.0],
        ball(0.7),
    ),
    (
        "union = [{ box = { center = [0, 0, 0], size = [1, 1, 1] } }, { box = { center = [0.5, 0, 0], size = [0.6, 0.2, 0.2] } }]",
        [0.7, 0.0, 0.0],
        [0.7, 0.2, 0.0],
        1.012,
    ),
    (
        "intersection = [{ sphere = { center = [0, 0, 0], radius = 0.8 } }, { half_space = { point = [0, 0, 0], normal = [1, 0, 0] } }]",
        [-0.5, 0.0, 0.0],
        [0.5, 0.0, 0.0],
        ball(0.8) / 2.0,
    ),
    (
        "difference = [{ sphere = { center = [0, 0, 0], radius = 0.8 } }, { sphere = { center = [0, 0, 0], radius = 0.5 } }]",
        [0.6, 0.0, 0.0],
        [0.4, 0.0, 0.0],
        ball(0.8) - ball(0.5),
    ),
    (
        "shell = { thickness = 0.3, shape = { sphere = { center = [0, 0, 0], radius = 0.8 } } }",
        [0.6, 0.0, 0.0],
        [0.4, 0.0, 0.0],
        ball(0.8) - ball(0.5),
    ),
    (
        "shell = { thickness = 0.2, shape = { box = { center = [0, 0, 0], size = [1, 1, 1] } } }",
        [0.4, 0.0, 0.0],
        [0.2, 0.0, 0.0],
        1.0 - 0.216,
    ),
];

const fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}

fn shape(text: &str) -> Shape {
    #[derive(serde::Deserialize)]
    struct Holder {
        shape: Shape,
    }
    toml::from_str::<Holder>(&format!("shape = {{ {text} }}")).unwrap_or_else(|error| panic!("{error}")).shape
}

/// `count` points in [-1, 1]^3, evenly spread: the Halton sequence of bases 2, 3 and 5.
fn points(count: u32) -> impl Iterator<Item = [f64; 3]> {
    let digits = |mut index: u32, base: u32| {
        let (mut sum, mut weight) = (0.0, 1.0);
        while index > 0 {
            weight /= f64::from(base);
            sum += weight * f64::from(index % base);
            index /= base;
        }
        sum
    };
    (1..=count).map(move |index| [2, 3, 5].map(|base| 2.0 * digits(index, base) - 1.0))
}

#[test]
fn signs_volumes_and_bounds() {
    for (text, inside, outside, volume) in SAMPLES {
        let shape = shape(text);
        assert!(shape.distance(inside) < 0.0, "{text}: {inside:?}");
        assert!(shape.distance(outside) > 0.0, "{text}: {outside:?}");
        let (low, high) = shape.bounds();
        let mut hits = 0;
        for point in points(100_000).filter(|point| shape.distance(*point) < 0.0) {
            hits += 1;
            assert!(
                (0..3).all(|d| low[d] <= point[d] && point[d] <= high[d]),
                "{text}: {point:?} beyond {low:?} {high:?}"
            );
        }
        let measured = 8.0 * f64::from(hits) / 1e5;
        // the smallest shape holds 400 of the points; evenly spread ones miss far less than the 5 % of random ones
        assert!((measured / volume - 1.0).abs() < 0.02, "{text}: {measured} for {volume}");
    }
}

#[test]
fn distances_are_never_steeper_than_one() {
    let smooth = "smooth_union = { radius = 0.3, shapes = [{ sphere = { center = [-0.3, 0, 0], radius = 0.4 } }, { box = { center = [0.4, 0, 0], size = [0.4, 0.4, 0.4] } }] }";
    for text in SAMPLES.into_iter().map(|sample| sample.0).chain([smooth]) {
        let shape = shape(text);
        for (a, b) in points(2000).zip(points(4000).skip(2000)) {
            let apart = (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt();
            let change = (shape.distance(a) - shape.distance(b)).abs();
            assert!(change <= apart * (1.0 + 1e-9), "{text}: {change} between points {apart} apart");
        }
    }
}

#[test]
fn single_shapes_give_exact_distances() {
    let ellipsoid = shape("ellipsoid = { center = [0, 0, 0], radii = [0.9, 0.5, 0.2] }");
    for (point, exact) in [([1.2, 0.0, 0.0], 0.3), ([0.0, 0.0, 0.5], 0.3), ([0.0; 3], -0.2), ([0.0, 0.7, 0.0], 0.2)] {
        assert!((ellipsoid.distance(point) - exact).abs() < 1e-9, "{point:?}: {}", ellipsoid.distance(point));
    }
    let cuboid = shape("box = { center = [0, 0, 0], size = [1, 1, 1] }");
    assert!((cuboid.distance([0.8, 0.9, 0.0]) - 0.5).abs() < 1e-12);
    let cone = shape("cone = { center = [0, 0, 0], radius = 0.3, height = 0.4 }");
    assert!((cone.distance([0.0, 0.0, 0.5]) - 0.1).abs() < 1e-12);
    assert!((cone.distance([0.4, 0.0, -0.1]) - 0.02_f64.sqrt()).abs() < 1e-12);
    let smooth = shape(
        "smooth_union = { radius = 0.3, shapes = [{ sphere = { center = [0, 0, 0], radius = 0.4 } }, { sphere = { center = [0, 0, 0], radius = 0.4 } }] }",
    );
    assert!((smooth.distance([1.0, 0.0, 0.0]) - (0.6 - 0.075)).abs() < 1e-12);
}

#[test]
fn missing_entries_have_no_end() {
    let prism = shape("box = { center = [0.5, 0.5], size = [1, 1] }");
    assert!((prism.distance([0.5, 0.2, 0.0]) + 0.2).abs() < 1e-12);
    assert_eq!(prism.bounds().1, [1.0, 1.0, f64::INFINITY]);
    let slab = shape("box = { center = [0.5], size = [0.2] }");
    assert!((slab.distance([0.45, 7.0, 3.0]) + 0.05).abs() < 1e-12);
    let ellipse = shape("ellipsoid = { center = [0, 0], radii = [2, 1] }");
    assert!((ellipse.distance([0.0, 0.0, 5.0]) + 1.0).abs() < 1e-9);
    let turned = shape("rotate = { degrees = 30, shape = { box = { center = [0, 0], size = [1, 1] } } }");
    assert!(turned.bounds().1[0].is_finite() && turned.bounds().1[2] == f64::INFINITY);
}

#[test]
fn regions_fill_by_volume_fraction() {
    let region = "[[gas.regions]]\nshape = { sphere = { center = [1.0, 0.5], radius = 0.4 } }\ndensity = 3.0\nvelocity = [2.0, 0.0]\npressure = 5.0\n";
    let scene = parse(&format!("{BASE}{region}"), &["domain.cells=[80, 40]"]);
    let gas = scene.initial_gas();
    let area = scene.domain.cell_volume();
    let mass = gas.iter().map(|cell| cell[0] * area).sum::<f64>();
    let exact = 2.0 + 2.0 * PI * 0.16;
    assert!((mass / exact - 1.0).abs() < 2e-3, "{mass} {exact}");
    let gases = scene.gas.equation_of_state();
    let (outside, inside) = (gases.conserved(&scene.gas.ambient), gases.conserved(&scene.gas.regions[0].state));
    assert_eq!((gas[0], gas[20 * 80 + 40]), (outside, inside));
    assert!((inside[4] - (12.5 + 6.0)).abs() < 1e-12 && inside[1] == 6.0);
    assert!(gas.iter().any(|cell| cell[0] > 1.1 && cell[0] < 2.9));
}

#[test]
fn a_jump_on_a_face_stays_sharp() {
    let region = "[[gas.regions]]\nshape = { half_space = { point = [1.0, 0.0], normal = [1.0, 0.0] } }\ndensity = 3.0\npressure = 1.0\n";
    let gas = parse(&format!("{BASE}{region}"), &[]).initial_gas();
    assert!(gas.iter().all(|cell| cell[0] == 1.0 || cell[0] == 3.0));
    assert_eq!(gas.iter().filter(|cell| cell[0] == 3.0).count(), 100);
}

#[test]
fn later_regions_cover_earlier_ones() {
    let region = |radius: f64, density: f64| {
        format!(
            "[[gas.regions]]\nshape = {{ sphere = {{ center = [1.0, 0.5], radius = {radius} }} }}\ndensity = {density}\npressure = 1.0\n"
        )
    };
    let scene = parse(&format!("{BASE}{}{}", region(0.3, 2.0), region(0.45, 5.0)), &[]);
    assert!(scene.initial_gas().iter().all(|cell| cell[0] == 1.0 || cell[0] == 5.0 || cell[0] > 1.0));
    assert_eq!(scene.gas_at([1.0, 0.5, 0.0]).density, 5.0);
}

#[test]
fn particles_have_the_mass_of_their_body() {
    let body = "[[bodies]]\nname = \"b\"\nmaterial = \"rubber\"\ndensity = 7.0\nvelocity = [1, 2]\nshape = { shell = { thickness = 0.1, shape = { sphere = { center = [1.0, 0.5], radius = 0.4 } } } }\n";
    let scene = parse(&format!("{BASE}{body}"), &["domain.cells=[80, 40]"]);
    let seeds = scene.seed_particles();
    let mass = seeds.iter().map(|seed| seed.volume * seed.density).sum::<f64>();
    let exact = 7.0 * PI * (0.16 - 0.09);
    assert!((mass / exact - 1.0).abs() < 2e-3, "{mass} {exact}");
    let center = |d: usize| seeds.iter().map(|seed| seed.position[d]).sum::<f64>() / seeds.len() as f64;
    assert!((center(0) - 1.0).abs() < 1e-9 && (center(1) - 0.5).abs() < 1e-9);
    assert!(seeds.iter().all(|seed| seed.velocity == [1.0, 2.0, 0.0] && seed.position[2] == 0.0 && seed.body == 0));
    let regular = scene.domain.cell_volume() / 4.0;
    let outer = seeds.iter().filter(|seed| seed.volume != regular).count();
    assert!(outer > 0 && outer < seeds.len() / 2, "{outer} of {}", seeds.len());
}

#[test]
fn obstacles_and_earlier_bodies_come_first() {
    let body = |name: &str, x: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"rubber\"\ndensity = 1.0\nshape = {{ box = {{ center = [{x}, 0.5], size = [0.4, 0.4] }} }}\n"
        )
    };
    let obstacle = "[[obstacles]]\nname = \"o\"\nshape = { box = { center = [0.8, 0.5], size = [0.2, 1.0] } }\n";
    let scene = parse(&format!("{BASE}{}{}{obstacle}", body("a", 0.8), body("b", 1.0)), &[]);
    let blocked = scene.obstacle_cells();
    assert_eq!(blocked.iter().filter(|cell| **cell).count(), 20);
    let seeds = scene.seed_particles();
    // each body has 8 x 8 particles; the obstacle takes 4 x 8 of the first, which takes 4 x 8 of the second
    assert_eq!(seeds.iter().filter(|seed| seed.body == 0).count(), 32);
    assert_eq!(seeds.iter().filter(|seed| seed.body == 1).count(), 32);
}

/// The walk over cells leaves out what is far away and asks nothing where a cell is whole: the particles stay the same.
#[test]
fn particles_are_the_lattice_points_inside() {
    let ring = "torus = { center = [1.0, 0.5], axis = [0, 0, 1], major = 0.3, minor = 0.12 }";
    let blob = "smooth_union = { radius = 0.2, shapes = [{ sphere = { center = [0.5, 0.4], radius = 0.3 } }, { box = { center = [1.2, 0.6], size = [0.5, 0.3] } }] }";
    for shape in [ring, blob] {
        let body = |name: &str, shape: &str| {
            format!("[[bodies]]\nname = \"{name}\"\nmaterial = \"rubber\"\ndensity = 1.0\nshape = {{ {shape} }}\n")
        };
        let first = body("first", "sphere = { center = [0.7, 0.5], radius = 0.1 }");
        let obstacle = "[[obstacles]]\nname = \"o\"\nshape = { box = { center = [1.25, 0.5], size = [0.1, 0.1] } }\n";
        let scene = parse(&format!("{BASE}{first}{}{obstacle}", body("second", shape)), &[]);
        let (seeds, spacing) = (scene.seed_particles(), scene.domain.spacing());
        let owned = |point: [f64; 3]| {
            let inside = |body: usize| scene.bodies[body].shape.distance(point) < 0.0;
            (scene.obstacles[0].shape.distance(point) >= 0.0)
                .then(|| if inside(0) { Some(0) } else { inside(1).then_some(1) })
                .flatten()
        };
        let mut count = 0;
        for (y, x) in (0..2 * scene.domain.cells[1]).flat_map(|y| (0..2 * scene.domain.cells[0]).map(move |x| (y, x))) {
            let at = |k: u32| (f64::from(k) + 0.5) * 0.5 * spacing;
            let point = [at(x), at(y), 0.0];
            let near = |seed: &&Seed| (0..2).all(|d| (seed.position[d] - point[d]).abs() < 1e-9);
            count += usize::from(owned(point).is_some());
            assert_eq!(seeds.iter().find(near).map(|seed| seed.body), owned(point), "{shape} {point:?}");
        }
        assert!(count > 100 && seeds.len() == count && scene.particle_count() == count, "{count} {}", seeds.len());
    }
}

#[test]
fn material_indices_follow_sorted_names() {
    let text = format!(
        "{BASE}[materials.iron]\nvon_mises = {{ young_modulus = 1e4, poisson_ratio = 0.2, yield_stress = 9 }}\n"
    );
    let body = "[[bodies]]\nname = \"b\"\nmaterial = \"rubber\"\ndensity = 7.0\nshape = { sphere = { center = [1.0, 0.5], radius = 0.4 } }\n";
    let scene = parse(&format!("{text}{body}"), &[]);
    assert_eq!((scene.material_index("iron"), scene.material_index("rubber")), (Some(0), Some(1)));
    assert!(scene.seed_particles().iter().all(|seed| seed.material == 1));
    let parameters = scene.material_parameters();
    assert_eq!((parameters[0].kind, parameters[1].kind), (1, 0));
}

/// What lies between centres and corners of cells is in no cell, and is told with its share.
#[test]
fn obstacles_thinner_than_a_cell_are_told() {
    // cells of 0.1
    let lost = |shape: &str, kind: &str| {
        let scene = parse(
            &format!("{BASE}[[obstacles]]\nname = \"o\"\nshape = {{ {shape} }}\n"),
            &[&format!("numerics.paper.obstacles={kind}")],
        );
        scene.thin_obstacles().first().map(|found| (found.cells, found.share))
    };
    let wall = |x: f64, thickness: f64| format!("box = {{ center = [{x}, 0.5], size = [{thickness}, 1.0] }}");
    let (cells, share) = lost(&wall(1.025, 0.04), "auto").unwrap();
    assert!((cells - 0.4).abs() < 0.02 && share == 1.0, "between centres and corners: {cells} {share}");
    assert_eq!(lost(&wall(1.05, 0.04), "auto"), None, "over the centres");
    assert_eq!(lost(&wall(1.02, 0.15), "auto"), None, "thick enough");
    let (_, share) = lost("sphere = { center = [1.025, 0.525], radius = 0.02 }", "auto").unwrap();
    assert_eq!(share, 1.0, "a ball between centre and corner");
    assert_eq!(lost("sphere = { center = [1.0, 0.5], radius = 0.3 }", "auto"), None);
    // along a slanted wall some cells hold it and some do not
    let slanted = "polygon = { points = [[0.4, 0.2], [1.6, 0.7], [1.6, 0.74], [0.4, 0.24]] }";
    let (_, share) = lost(slanted, "cells").unwrap();
    assert!(share > 0.2 && share < 0.8, "a slanted wall: {share}");
    let thick = "polygon = { points = [[0.4, 0.2], [1.6, 0.7], [1.6, 0.9], [0.4, 0.4]] }";
    assert_eq!(lost(thick, "cells"), None);
}

/// Rows that all have as many cells near a wall must not hide what lies in them.
#[test]
fn a_long_wall_at_a_side_is_not_told() {
    let cell = 2.0 / 1600.0;
    let wall = format!("box = {{ center = [{}, 0.5], size = [{}, 1.0] }}", 2.0 - 1.5 * cell, 3.0 * cell);
    let text = format!("{BASE}[[obstacles]]\nname = \"o\"\nshape = {{ {wall} }}\n");
    assert_eq!(parse(&text, &["domain.cells=[1600, 800]"]).thin_obstacles(), []);
}

/// An outlet keeps the gas of the start beyond it, while a stream along it may become another one.
#[test]
fn outlets_along_changing_streams_are_told() {
    let told = |pressure: f64, side: &str| {
        let table = format!("[{{time=0.0,density=1.0,pressure=1.0}},{{time=0.1,density=1.0,pressure={pressure}}}]");
        let inlet = format!("boundary.x_min={{timed_inlet={{table={table}}}}}");
        let scene = parse(BASE, &[&inlet, "boundary.x_max=\"outlet\"", &format!("boundary.y_max={side}")]);
        scene.boundary.outlets_along_changing_streams(scene.domain.dimension)
    };
    assert_eq!(told(3.0, "\"outlet\""), [["y_max", "x_min"]]);
    assert_eq!(told(1.05, "\"outlet\""), [[""; 2]; 0], "a stream that hardly changes");
    assert_eq!(told(3.0, "\"wall\""), [[""; 2]; 0], "the other end of the stream is no matter");
}
