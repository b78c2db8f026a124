//! Particles add up to their bodies, named shapes, and what overlaps.

use std::f64::consts::PI;

use super::{BASE, parse, report};

/// A 3D scene of a cube of 24 cells per unit length with these bodies.
fn space(bodies: &str) -> String {
    let base = BASE.replace("dimension = 2", "dimension = 3").replace("[20, 10]", "[24, 24, 24]");
    format!("{}{bodies}", base.replace("[2.0, 1.0]", "[1.0, 1.0, 1.0]"))
}

fn body(name: &str, shape: &str) -> String {
    format!("[[bodies]]\nname = \"{name}\"\nmaterial = \"rubber\"\ndensity = 2.0\nshape = {{ {shape} }}\n")
}

#[test]
fn volumes_are_those_of_the_shapes() {
    let ball = body("b", "sphere = { center = [0.513, 0.5, 0.491], radius = 0.31 }");
    let tilted = "rotate = { axis = [1, 2, 3], degrees = 37, about = [0.5, 0.5, 0.5], shape = { box = { center = [0.5, 0.5, 0.5], size = [0.31, 0.43, 0.27] } } }";
    for (text, exact) in [(ball, 4.0 / 3.0 * PI * 0.31_f64.powi(3)), (body("b", tilted), 0.31 * 0.43 * 0.27)] {
        let scene = parse(&space(&text), &[]);
        let volume: f64 = scene.seed_particles().iter().map(|seed| seed.volume).sum();
        assert!((volume / exact - 1.0).abs() < 5e-3, "{volume} {exact}");
    }
    // what is left beside a body whose surface goes on as its own
    let half = "intersection = [{ sphere = { center = [0.5, 0.5, 0.5], radius = 0.31 } }, { half_space = { point = [0.5, 0.5, 0.5], normal = [1, 0, 0] } }]";
    let both = format!("{}{}", body("a", half), body("b", "sphere = { center = [0.5, 0.5, 0.5], radius = 0.31 }"));
    let scene = parse(&space(&both), &[]);
    for index in 0..2 {
        let own = scene.seed_particles().into_iter().filter(|seed| seed.body == index);
        let volume: f64 = own.map(|seed| seed.volume).sum();
        assert!((volume / (2.0 / 3.0 * PI * 0.31_f64.powi(3)) - 1.0).abs() < 5e-3, "{index}: {volume}");
    }
    // aligned with the lattice, every particle has the volume of its point
    let aligned = parse(&space(&body("b", "box = { center = [0.5, 0.5, 0.5], size = [0.5, 0.25, 0.25] }")), &[]);
    assert!(aligned.seed_particles().iter().all(|seed| seed.volume == aligned.domain.cell_volume() / 8.0));
}

#[test]
fn jitter_keeps_particles_inside_and_volumes_exact() {
    let text = body("b", "sphere = { center = [0.5, 0.5, 0.5], radius = 0.3 }");
    let regular = parse(&space(&text), &[]).seed_particles();
    let scene = parse(&space(&text), &["bodies[0].sampling=jittered"]);
    let jittered = scene.seed_particles();
    assert_eq!(jittered, scene.seed_particles());
    assert_eq!(regular.len(), jittered.len());
    let moved = regular.iter().zip(&jittered).filter(|(a, b)| a.position != b.position).count();
    assert!(moved > regular.len() * 9 / 10, "{moved} of {}", regular.len());
    assert!(jittered.iter().all(|seed| scene.bodies[0].shape.distance(seed.position) < 0.0));
    assert!(regular.iter().zip(&jittered).all(|(a, b)| a.volume == b.volume));
}

#[test]
fn overlaps_are_found() {
    let first = body("first", "box = { center = [0.5, 0.5, 0.5], size = [0.5, 0.5, 0.5] }");
    let second = body("second", "box = { center = [0.75, 0.5, 0.5], size = [0.25, 0.5, 0.5] }");
    let apart = body("apart", "sphere = { center = [0.1, 0.1, 0.1], radius = 0.08 }");
    let overlaps = parse(&space(&format!("{first}{second}{apart}")), &[]).overlaps();
    assert_eq!(overlaps.len(), 1, "{overlaps:?}");
    assert_eq!((overlaps[0].body.as_str(), overlaps[0].by.as_str()), ("second", "first"));
    assert!((overlaps[0].share - 0.5).abs() < 1e-12, "{overlaps:?}");
}

#[test]
fn named_shapes_are_placed() {
    let shapes = "[shapes.bar]\nbox = { center = [0.1, 0, 0], size = [0.2, 0.1, 0.1] }\n[shapes.cross]\naround = { count = 4, shape = { use = { name = \"bar\" } } }\n";
    let placed = "use = { name = \"cross\", scale = 2, degrees = 90, axis = [0, 1, 0], offset = [0.5, 0.5, 0.5] }";
    let scene = parse(&space(&format!("{shapes}{}", body("b", placed))), &[]);
    let shape = &scene.bodies[0].shape;
    let inside = |z: f64, y: f64| shape.distance([0.5, 0.5 + y, 0.5 + z]) < 0.0;
    assert!(inside(0.39, 0.0) && inside(-0.39, 0.0) && inside(0.0, 0.39) && !inside(0.41, 0.0) && !inside(0.2, 0.2));
    let (low, high) = shape.bounds();
    assert!(low[2] <= 0.1 && high[1] >= 0.9 && high[0] < 0.61, "{low:?} {high:?}");
    let again = parse(&toml::to_string(&scene).expect("plain data"), &[]);
    assert_eq!(again.bodies[0].shape.bounds(), (low, high));
}

#[test]
fn names_that_are_wrong() {
    let missing = report(&space(&body("b", "use = { name = \"rabit\" }")), &[]);
    assert!(missing.contains("no shape `rabit`") && missing.contains("rabbit"), "{missing}");
    assert!(missing.contains("bodies[0].shape.use.name"), "{missing}");
    let circle = "[shapes.a]\nuse = { name = \"b\" }\n[shapes.b]\nuse = { name = \"a\" }\n";
    let report = report(&space(circle), &[]);
    assert!(report.contains("made of itself: a -> b -> a"), "{report}");
}

#[test]
fn bodies_below_two_cells_are_thin() {
    let cells = |n: f64| n / 24.0;
    let plate = |n: f64| body("b", &format!("box = {{ center = [0.51, 0.5, 0.5], size = [{}, 0.7, 0.6] }}", cells(n)));
    let ball = |n: f64| format!("sphere = {{ center = [0.5, 0.51, 0.5], radius = {} }}", cells(n));
    let shell = |n: f64| body("b", &format!("shell = {{ thickness = {}, shape = {{ {} }} }}", cells(n), ball(8.0)));
    let tilted = |n: f64| {
        let shape = format!("box = {{ center = [0.5, 0.5, 0.5], size = [{}, 0.5, 0.5] }}", cells(n));
        body(
            "b",
            &format!("rotate = {{ axis = [1, 2, 3], degrees = 37, about = [0.5, 0.5, 0.5], shape = {{ {shape} }} }}"),
        )
    };
    let thick = |text: String| parse(&space(&text), &[]).thin_bodies();
    for n in [1.0, 1.2, 1.5, 1.9] {
        for text in [plate(n), shell(n), tilted(n)] {
            let found = thick(text);
            assert_eq!((found.len(), found[0].body.as_str()), (1, "b"), "{n}");
            assert!((found[0].cells - n).abs() < 0.05 && found[0].share > 0.8, "{n}: {found:?}");
        }
    }
    for text in [plate(2.0), shell(2.0), tilted(2.1), plate(4.0), body("b", &ball(1.1)), body("b", &ball(5.0))] {
        assert_eq!(thick(text.clone()), [], "{text}");
    }
    // a ball with a long fin
    let fin = format!("box = {{ center = [0.5, 0.5, 0.5], size = [0.9, 0.7, {}] }}", cells(1.3));
    let both = body("b", &format!("union = [{{ {} }}, {{ {fin} }}]", ball(2.5)));
    let found = thick(both);
    assert!(found.len() == 1 && (found[0].cells - 1.3).abs() < 0.05 && found[0].share < 0.95, "{found:?}");
}

#[test]
fn a_body_turns_and_grows_from_its_centre() {
    let shape = "box = { center = [0.5, 0.5, 0.5], size = [0.5, 0.25, 0.25] }";
    let text = body("b", shape).replace("density", "velocity = [1, 0, 2]\nspin = [0, 0, 2]\nexpansion = 3.0\ndensity");
    let seeds = parse(&space(&text), &[]).seed_particles();
    for seed in seeds {
        let [x, y, z] = seed.position.map(|x| x - 0.5);
        let right = [1.0 - 2.0 * y + 3.0 * x, 2.0 * x + 3.0 * y, 2.0 + 3.0 * z];
        assert!(seed.velocity.iter().zip(right).all(|(ours, right)| (ours - right).abs() < 1e-12), "{seed:?}");
    }
}
