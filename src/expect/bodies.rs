//! What a run did to its bodies: where they went, what is left of them, how far their shape has changed.

use glam::{DMat3, DVec3};

use super::Checks;
use crate::bodies::BodyState;
use crate::math::plain;
use crate::scene::{Quantity, Scene, Seed};
use crate::snapshot::Snapshot;

/// The start and the end of one body.
struct Change<'a> {
    state: &'a BodyState,
    start: DVec3,
    seeds: u64,
    distortion: f64,
}

impl Change<'_> {
    fn of(&self, quantity: Quantity) -> f64 {
        let moved = DVec3::from(self.state.centroid) - self.start;
        match quantity {
            Quantity::Moved => moved.length(),
            Quantity::MovedX => moved.x,
            Quantity::MovedY => moved.y,
            Quantity::MovedZ => moved.z,
            Quantity::Pieces => self.state.pieces.into(),
            Quantity::PlasticStrain => self.state.plastic_strain,
            Quantity::Distortion => self.distortion,
            Quantity::Left => self.state.particles as f64 / self.seeds as f64,
        }
    }
}

impl Checks {
    /// Every expectation about bodies.
    pub(super) fn bodies(&mut self, scene: &Scene, snapshot: &Snapshot) {
        let expect = &scene.expect;
        if expect.pieces.is_none() && expect.bodies.is_empty() && expect.order.is_empty() {
            return;
        }
        let bodies = snapshot.bodies(scene.bodies.len());
        if let Some(fewest) = expect.pieces {
            let pieces: u32 = bodies.iter().map(|body| body.pieces).sum();
            self.add("pieces", pieces.into(), format!("at least {fewest}"), pieces >= fewest);
        }
        let compares = expect.bodies.iter().any(|expected| expected.ranges().next().is_some());
        let changes = if compares || !expect.order.is_empty() { changes(scene, snapshot, &bodies) } else { Vec::new() };
        let named = |name: &String| scene.bodies.iter().position(|body| body.name == *name);
        for expected in &expect.bodies {
            let Some(index) = named(&expected.body) else { continue };
            if let Some(center) = expected.center {
                let distance = DVec3::from(bodies[index].centroid).distance(center.into());
                self.at_most(&format!("bodies.{}.center", expected.body), distance, expected.tolerance);
            }
            for (quantity, range) in expected.ranges() {
                let name = format!("bodies.{}.{}", expected.body, quantity.name());
                self.within(&name, changes[index].of(quantity), range);
            }
        }
        for order in &expect.order {
            for pair in order.bodies.windows(2) {
                let [more, less] = [&pair[0], &pair[1]]
                    .map(|name| named(name).map_or(f64::NAN, |index| changes[index].of(order.quantity)));
                let name = format!("order.{}.{}", order.quantity.name(), pair[0]);
                self.add(&name, more, format!("above {} of {}", plain(less), pair[1]), more > less);
            }
        }
    }
}

fn changes<'a>(scene: &Scene, snapshot: &Snapshot, bodies: &'a [BodyState]) -> Vec<Change<'a>> {
    let seeds = scene.seed_particles();
    let change = |(index, state): (usize, &'a BodyState)| {
        let own: Vec<&Seed> = seeds.iter().filter(|seed| seed.body as usize == index).collect();
        let sum: DVec3 = own.iter().map(|seed| seed.volume * DVec3::from(seed.position)).sum();
        let start = sum / own.iter().map(|seed| seed.volume).sum::<f64>();
        let pairs = snapshot.particles.iter().filter(|particle| particle.body as usize == index).map(|particle| {
            let now = snapshot.place_of(particle);
            [seeds[particle.index as usize].position.into(), now.into()]
        });
        let distortion = distortion(&pairs.collect::<Vec<_>>());
        Change { state, start, seeds: own.len() as u64, distortion }
    };
    bodies.iter().enumerate().map(change).collect()
}

/// Rms distance between where points are and where the best rigid motion brings them, over their rms distance from their centre. The
/// rotation is the orthogonal part of the sum of products of then and now. [Kabsch 1976]
fn distortion(pairs: &[[DVec3; 2]]) -> f64 {
    let count = pairs.len() as f64;
    let center = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<DVec3>() / count;
    let [from, to] = [center(0), center(1)];
    let mut products = DMat3::ZERO;
    let mut size = 0.0;
    for [then, now] in pairs {
        let (then, now) = (*then - from, *now - to);
        products += DMat3::from_cols(now * then.x, now * then.y, now * then.z);
        size += then.length_squared();
    }
    let rotation = orthogonal_part(products, size);
    let gap: f64 = pairs.iter().map(|[then, now]| (*now - to - rotation * (*then - from)).length_squared()).sum();
    (gap / size).sqrt()
}

/// The rotation next to a matrix by Newton's iteration. What is flat, as bodies in a plane, keeps its normal. [Higham 1986]
fn orthogonal_part(matrix: DMat3, size: f64) -> DMat3 {
    // along axes without extent the sum of products says nothing
    const FLAT: f64 = 1e-9;
    let mut rotation = matrix * (1.0 / size);
    for axis in 0..3 {
        if rotation.col(axis).length() < FLAT {
            rotation.col_mut(axis)[axis] = 1.0;
        }
    }
    for _ in 0..60 {
        if rotation.determinant().abs() < f64::MIN_POSITIVE {
            return DMat3::IDENTITY;
        }
        rotation = (rotation + rotation.inverse().transpose()) * 0.5;
    }
    rotation
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::ParticleSample;
    use crate::state::Grid;

    fn pairs(map: impl Fn(DVec3) -> DVec3) -> Vec<[DVec3; 2]> {
        let points = (0..60).map(|k| DVec3::new(f64::from(k % 5), f64::from(k / 5 % 4), f64::from(k / 20)));
        points.map(|point| [point, map(point)]).collect()
    }

    #[test]
    fn rigid_motion_is_no_distortion_and_stretch_is() {
        let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 2.5);
        assert!(distortion(&pairs(|x| turn * x + DVec3::new(3.0, -1.0, 7.0))) < 1e-12);
        // all lengths by 1.3: the rms gap is 0.3 of the size, whatever the turn
        assert!((distortion(&pairs(|x| 1.3 * (turn * x))) - 0.3).abs() < 1e-12);
        let flat = |x: DVec3| turn_in_plane(x) * DVec3::new(1.0, 1.0, 0.0);
        let plane: Vec<_> = pairs(flat).into_iter().map(|[a, b]| [a * DVec3::new(1.0, 1.0, 0.0), b]).collect();
        assert!(distortion(&plane) < 1e-12);
    }

    const SCENE: &str = r#"
title = "two boxes"
[domain]
dimension = 2
cells = [20, 10]
size = [2.0, 1.0]
[gas]
ambient = { density = 1.0, pressure = 1.0 }
[time]
until = 1.0
[materials.rubber]
neo_hookean = { young_modulus = 100.0, poisson_ratio = 0.3 }
[[bodies]]
name = "near"
material = "rubber"
density = 1.0
shape = { box = { center = [0.5, 0.5], size = [0.4, 0.4] } }
[[bodies]]
name = "far"
material = "rubber"
density = 1.0
shape = { box = { center = [1.5, 0.5], size = [0.4, 0.4] } }
[expect]
bodies = [
    { body = "near", moved = [0.09, 0.11], moved_x = [0.0, 0.2], moved_y = [-0.01, 0.01], pieces = [1, 1], distortion = [0.0, 1e-6] },
    { body = "far", moved_x = [-0.21, -0.19], left = [0.4, 0.6], plastic_strain = [0.2, 0.4], center = [1.2, 0.5], tolerance = 0.01 },
]
order = [{ quantity = "moved_x", bodies = ["near", "far"] }, { quantity = "moved", bodies = ["near", "far"] }]
"#;

    /// `near` has moved by 0.1 along x, `far` by -0.2; the right half of it is gone.
    fn ending(scene: &Scene) -> Snapshot {
        let sample = |(index, seed): (usize, Seed)| ParticleSample {
            index: index as u32,
            position: [(seed.position[0] + [0.1, -0.2][seed.body as usize]) as f32, seed.position[1] as f32, 0.0],
            mass: (seed.volume * seed.density) as f32,
            volume0: seed.volume as f32,
            plastic_strain: 0.3,
            body: seed.body,
            ..ParticleSample::default()
        };
        let particles = scene.seed_particles().into_iter().enumerate().map(sample);
        let grid = Grid { dimension: 2, cells: [20, 10, 1], frame: [0.0; 3], origin: [0.0; 3], spacing: 0.1 };
        Snapshot::of_particles((1.0, 1), grid, particles.filter(|particle| particle.position[0] < 1.3).collect())
    }

    #[test]
    fn bodies_are_judged_by_what_happened_to_them() {
        let scene = Scene::parse(SCENE, "test.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let mut checks = Checks(Vec::new());
        checks.bodies(&scene, &ending(&scene));
        let failed: Vec<&str> =
            checks.0.iter().filter(|check| !check.passed).map(|check| check.name.as_str()).collect();
        // what is left of `far` has its centre 0.1 further to the left: 0.3 in all
        assert_eq!(failed, ["bodies.far.moved_x", "order.moved.near"], "{:?}", checks.0);
        assert_eq!(checks.0.len(), 11);
        assert!(checks.0.iter().any(|check| check.name == "bodies.far.center" && check.passed));
    }

    fn turn_in_plane(x: DVec3) -> DVec3 {
        DMat3::from_rotation_z(2.0) * x
    }
}
