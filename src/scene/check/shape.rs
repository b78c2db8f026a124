//! Checks of shapes: sizes, and whether things lie in the domain.

use crate::scene::finding::{About, Finding, Told};
use crate::scene::{Body, Domain, Scene, Shape};

/// Sample points per axis when looking for parts of a body outside the domain.
const SAMPLES: f64 = 64.0;
/// Distances of single shapes that the search may take.
const MOST_LOOKS: f64 = 2e7;
/// Copies that one key may make.
const MAX_COPIES: u32 = 10_000;

/// Sizes that are not positive, directions without length, empty lists.
pub(crate) fn sizes(path: &str, shape: &Shape, findings: &mut Vec<Finding>) {
    let mut add = |finding: Finding| findings.push(finding.below(path));
    let mut positive = |key: &str, value: f64| {
        // infinite: an entry that was left out; the text holds no infinite numbers
        if value.is_nan() || value <= 0.0 {
            add(Finding::of_value(key, format!("{value} is not positive"), "give a length above 0 [m]"));
        }
    };
    match shape {
        Shape::Box { size, round, .. } => {
            size.iter().for_each(|edge| positive("box.size", *edge));
            let most = size.iter().fold(f64::INFINITY, |a, b| a.min(0.5 * b));
            if !(0.0..=most).contains(round) {
                let help = "give a length from 0 to half the shortest edge [m]";
                add(Finding::out_of_range("box.round", round, help));
            }
        }
        Shape::Sphere { radius, .. } => positive("sphere.radius", *radius),
        Shape::Ellipsoid { radii, .. } => radii.iter().for_each(|radius| positive("ellipsoid.radii", *radius)),
        Shape::Cylinder { axis, radius, height, .. } => {
            positive("cylinder.radius", *radius);
            positive("cylinder.height", height.unwrap_or(f64::INFINITY));
            direction(path, "cylinder.axis", *axis, findings);
        }
        Shape::Capsule { radius, .. } => positive("capsule.radius", *radius),
        Shape::Cone { axis, radius, top_radius, height, .. } => {
            positive("cone.height", *height);
            if !(*radius >= 0.0 && *top_radius >= 0.0 && radius + top_radius > 0.0) {
                let help = "give radii of at least 0, one of them positive [m]";
                add(Finding::new("cone.radius", format!("{radius} and top_radius {top_radius}"), help));
            }
            direction(path, "cone.axis", *axis, findings);
        }
        Shape::Torus { axis, major, minor, .. } => {
            positive("torus.major", *major);
            positive("torus.minor", *minor);
            direction(path, "torus.axis", *axis, findings);
        }
        Shape::HalfSpace { normal, .. } => direction(path, "half_space.normal", *normal, findings),
        Shape::Polygon { points, height, .. } => {
            positive("polygon.height", height.unwrap_or(f64::INFINITY));
            if points.len() < 3 {
                let message = format!("{} corners", points.len());
                add(Finding::new("polygon.points", message, "give at least 3 corners"));
            }
        }
        _ => combined(path, shape, findings),
    }
}

/// Shapes made of shapes.
fn combined(path: &str, shape: &Shape, findings: &mut Vec<Finding>) {
    let positive = |key: &str, value: f64, findings: &mut Vec<Finding>| {
        if value.is_nan() || value <= 0.0 {
            let message = format!("{value} is not positive");
            findings.push(Finding::of_value(format!("{path}.{key}"), message, "give a number above 0"));
        }
    };
    let copies = |key: &str, count: u32, findings: &mut Vec<Finding>| {
        if !(1..=MAX_COPIES).contains(&count) {
            let help = format!("give a whole number from 1 to {MAX_COPIES}");
            findings.push(Finding::new(format!("{path}.{key}"), format!("{count} copies"), help));
        }
    };
    match shape {
        Shape::Rotate { axis, .. } => direction(path, "rotate.axis", *axis, findings),
        Shape::Scale { factor, .. } => positive("scale.factor", *factor, findings),
        Shape::Shell { thickness, .. } => positive("shell.thickness", *thickness, findings),
        Shape::SmoothUnion { radius, .. } => positive("smooth_union.radius", *radius, findings),
        Shape::Mirror { normal, .. } => direction(path, "mirror.normal", *normal, findings),
        Shape::Repeat { count, .. } => copies("repeat.count", *count, findings),
        Shape::Around { count, axis, .. } => {
            copies("around.count", *count, findings);
            direction(path, "around.axis", *axis, findings);
        }
        Shape::Chain { points, radii } => {
            radii.iter().for_each(|radius| positive("chain.radii", *radius, findings));
            if points.len() < 2 || !(radii.len() == 1 || radii.len() == points.len()) {
                let message = format!("{} points and {} radii", points.len(), radii.len());
                let help = "give at least 2 points, and one radius for all or one for each";
                findings.push(Finding::new(format!("{path}.chain.points"), message, help));
            }
        }
        Shape::Revolve { axis, points, .. } => {
            direction(path, "revolve.axis", *axis, findings);
            if points.len() < 3 || points.iter().any(|[radius, _]| *radius < 0.0) {
                let help = "give at least 3 corners, none of them beyond the axis: [distance of at least 0, height]";
                findings.push(Finding::new(format!("{path}.revolve.points"), "no outline", help));
            }
        }
        Shape::Use(named) => {
            positive("use.scale", named.scale, findings);
            direction(path, "use.axis", named.axis, findings);
        }
        Shape::Mesh(mesh) => {
            positive("mesh.scale", mesh.scale, findings);
            direction(path, "mesh.axis", mesh.axis, findings);
        }
        // single shapes are checked by `sizes`
        _ => {}
    }
    parts(path, shape, findings);
}

/// The shapes below a shape.
fn parts(path: &str, shape: &Shape, findings: &mut Vec<Finding>) {
    let parts = shape.parts();
    let empty = match shape {
        Shape::Union(_) => Some("union"),
        Shape::Intersection(_) => Some("intersection"),
        Shape::Difference(_) => Some("difference"),
        Shape::SmoothUnion { .. } => Some("smooth_union.shapes"),
        _ => None,
    };
    if let Some(key) = empty.filter(|_| parts.is_empty()) {
        findings.push(Finding::new(format!("{path}.{key}"), "the list is empty", "give at least one shape"));
    }
    for (key, part) in parts {
        sizes(&format!("{path}.{key}"), part, findings);
    }
}

fn direction(path: &str, key: &str, vector: [f64; 3], findings: &mut Vec<Finding>) {
    if vector == [0.0; 3] {
        findings.push(Finding::new(
            format!("{path}.{key}"),
            "the direction has no length",
            "give a vector that is not zero",
        ));
    }
}

/// What misses the domain among shapes without fault, where others have one.
pub(crate) fn strays(scene: &Scene, findings: &mut Vec<Finding>) {
    let mut own = Vec::new();
    let told = Told::new(findings);
    if !told.below("shapes.") {
        for (path, shape) in scene.placed_shapes().into_iter().filter(|(path, _)| path.ends_with(".shape")) {
            if !told.below(&path) {
                misses(scene, &path, shape, &mut own);
            }
        }
    }
    findings.extend(own);
}

/// Bodies, obstacles and regions that miss the domain, and bodies that reach out of it.
pub(crate) fn places(scene: &Scene, findings: &mut Vec<Finding>) {
    for (index, region) in scene.gas.regions.iter().enumerate() {
        misses(scene, &format!("gas.regions[{index}].shape"), &region.shape, findings);
    }
    for (index, obstacle) in scene.obstacles.iter().enumerate() {
        misses(scene, &format!("obstacles[{index}].shape"), &obstacle.shape, findings);
    }
    for (index, body) in scene.bodies.iter().enumerate() {
        let path = format!("bodies[{index}].shape");
        if misses(scene, &path, &body.shape, findings) {
            continue;
        }
        if let Some(point) = outside_point(scene, body) {
            let message = format!("body `{}` reaches out of the domain, at {point:?} for example", body.name);
            let (low, high) = body.shape.bounds();
            let hint = remedy(&scene.domain, place(&body.shape), low, high);
            let help =
                format!("{}; {hint}move or shrink the body, or cut it with an intersection", extent(&scene.domain));
            findings.push(Finding::new(&path, message, help));
        } else if !scene.has_particles(index) {
            let message = format!("body `{}` holds no particle", body.name);
            let help = "it is thinner than the particle spacing, or covered by obstacles or earlier bodies: enlarge it, \
                        refine the grid or raise particles_per_cell";
            findings.push(Finding { about: About::Remainder, ..Finding::new(&path, message, help) });
        } else if body.clamped.is_some() && !scene.seed_particles_of(index).any(|seed| seed.driven) {
            let message = format!("the clamped part of body `{}` holds no particle", body.name);
            let finding = Finding::new(format!("bodies[{index}].clamped"), message, "move or enlarge it");
            findings.push(Finding { about: About::Remainder, ..finding });
        }
    }
}

/// The domain in words.
pub(crate) fn extent(domain: &Domain) -> String {
    let range = |d: usize| format!("{} to {}", domain.origin[d], domain.origin[d] + domain.size[d]);
    let ranges = (0..domain.axes()).map(|d| format!("{} from {}", ["x", "y", "z"][d], range(d)));
    format!("the domain has {}", ranges.collect::<Vec<_>>().join(", "))
}

/// Where a mesh puts the origin of its file; that of the domain for other shapes.
fn place(shape: &Shape) -> [f64; 3] {
    if let Shape::Mesh(mesh) = shape { mesh.offset } else { [0.0; 3] }
}

/// What would make a thing fit that other programs wrote: thousandths, or a quarter turn, at its place or at another one.
fn remedy(domain: &Domain, place: [f64; 3], low: [f64; 3], high: [f64; 3]) -> String {
    let axes = domain.axes();
    let inside = |low: [f64; 3], high: [f64; 3]| {
        (0..axes).all(|d| low[d] >= domain.origin[d] && high[d] <= domain.origin[d] + domain.size[d])
    };
    let fits = |low: [f64; 3], high: [f64; 3]| {
        let seen = (0..axes).any(|d| high[d] - low[d] >= domain.spacing());
        seen && (0..axes).all(|d| high[d] - low[d] <= domain.size[d])
    };
    let ends = [low, high].map(|end| [0, 1, 2].map(|d| end[d] - place[d]));
    let scaled = |factor: f64| ends.map(|end| end.map(|x| x * factor));
    let [from, to] = ends;
    let upright = [[from[0], -to[2], from[1]], [to[0], -from[2], to[1]]];
    let lying = [[from[0], from[2], -to[1]], [to[0], to[2], -from[1]]];
    let turned = "after a quarter turn about x: `axis = [1, 0, 0]`, `degrees = 90` or -90, or `up` of a mesh";
    let remedies = [
        (scaled(1e-3), "with `scale = 0.001`, from millimetres"),
        (scaled(1e3), "with `scale = 1000`, to millimetres"),
        (upright, turned),
        (lying, turned),
    ];
    if !low.iter().chain(&high).all(|x| x.is_finite()) {
        return String::new();
    }
    let there = |[low, high]: [[f64; 3]; 2]| {
        let [low, high] = [low, high].map(|end| [0, 1, 2].map(|d| end[d] + place[d]));
        fits(low, high) && inside(low, high)
    };
    let at_its_place = remedies.iter().find(|(ends, _)| there(*ends)).map(|(_, what)| format!("it would fit {what}; "));
    let elsewhere = || {
        let (_, what) = remedies.iter().find(|([low, high], _)| !fits(from, to) && fits(*low, *high))?;
        Some(format!("it would fit {what}, at another place; "))
    };
    at_its_place.or_else(elsewhere).unwrap_or_default()
}

fn misses(scene: &Scene, path: &str, shape: &Shape, findings: &mut Vec<Finding>) -> bool {
    let domain = &scene.domain;
    let (low, high) = shape.bounds();
    let apart = |d: usize| high[d] <= domain.origin[d] || low[d] >= domain.origin[d] + domain.size[d];
    let outside = (0..domain.axes()).any(apart);
    if outside {
        let corner = |v: [f64; 3]| v[..domain.axes()].to_vec();
        let message = format!("lies outside the domain, between {:?} and {:?}", corner(low), corner(high));
        let hint = remedy(domain, place(shape), low, high);
        findings.push(Finding::new(
            path,
            message,
            format!("{}; {hint}move the shape or enlarge the domain", extent(domain)),
        ));
    }
    outside
}

/// A point of a bounded body outside the domain. Endless bodies, such as a half space, are cut at the sides.
fn outside_point(scene: &Scene, body: &Body) -> Option<[f64; 3]> {
    let domain = &scene.domain;
    let (low, high) = body.shape.bounds();
    let axes = domain.axes();
    let slack = 1e-9 * domain.spacing();
    let beyond = |d: usize, x: f64| x < domain.origin[d] - slack || x > domain.origin[d] + domain.size[d] + slack;
    if (0..axes).any(|d| !low[d].is_finite() || !high[d].is_finite())
        || !(0..axes).any(|d| beyond(d, low[d]) || beyond(d, high[d]))
    {
        return None;
    }
    let affordable = (MOST_LOOKS / body.shape.parts_count() as f64).powf(1.0 / axes as f64).clamp(4.0, SAMPLES);
    let finest = domain.spacing() / f64::from(scene.particles_along_axis(body));
    let count =
        |d: usize| if d < axes { ((high[d] - low[d]) / finest).ceil().clamp(1.0, affordable) as u32 } else { 1 };
    let at = |d: usize, index: u32| {
        if d < axes { low[d] + (high[d] - low[d]) * (f64::from(index) + 0.5) / f64::from(count(d)) } else { 0.0 }
    };
    let total = count(0) * count(1) * count(2);
    let point = |index: u32| {
        let steps = [index % count(0), index / count(0) % count(1), index / (count(0) * count(1))];
        std::array::from_fn(|d| at(d, steps[d]))
    };
    let outside = |point: &[f64; 3]| (0..axes).any(|d| beyond(d, point[d])) && body.shape.distance(*point) < 0.0;
    (0..total).map(point).find(outside)
}
