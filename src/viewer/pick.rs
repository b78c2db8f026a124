//! Which point of the scene a click means.

use glam::DVec3;

use crate::render::Ray;
use crate::snapshot::ParticleSample;
use crate::state::Grid;

/// Distance from the middle of a particle up to which it holds points, over the edge of its volume.
const HELD: f64 = 0.8;

/// The point that a line of sight means: in 2D where it meets the plane of the domain; in 3D the first particle that it hits, or else
/// its point in the domain next to the plane through the middle that faces the viewer. None if it misses the domain.
pub fn point(ray: &Ray, grid: &Grid, particles: &[ParticleSample]) -> Option<[f64; 3]> {
    let (origin, direction) = (DVec3::from(ray.origin), DVec3::from(ray.direction));
    let low = DVec3::from(grid.low());
    let extent = DVec3::from(grid.extent().map(f64::from));
    if grid.dimension < 3 {
        let inside = (0..grid.dimension as usize).all(|a| (0.0..=extent[a]).contains(&(origin[a] - low[a])));
        return inside.then_some([origin.x, origin.y, 0.0]);
    }
    let near = particles.iter().filter_map(|particle| depth_of(particle, origin - DVec3::from(grid.frame), direction));
    if let Some(depth) = near.min_by(f64::total_cmp) {
        return Some((origin + depth * direction).into());
    }
    let [enters, leaves] = crossing(origin, direction, low, low + extent)?;
    let middle = (low + 0.5 * extent - origin).dot(direction);
    Some((origin + middle.clamp(enters, leaves) * direction).into())
}

/// The nearest particle, where it holds a point: the point belongs to its body.
pub fn particle<'a>(point: [f64; 3], grid: &Grid, particles: &'a [ParticleSample]) -> Option<&'a ParticleSample> {
    let near = particles.iter().filter_map(|particle| {
        let away = DVec3::from(grid.in_scene(particle.position)).distance(point.into());
        let edge = f64::from(particle.volume0).powf(1.0 / f64::from(grid.dimension));
        (away < HELD * edge).then_some((away, particle))
    });
    near.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, particle)| particle)
}

/// Distance along a ray to the ball of a particle's volume; none if it misses it.
fn depth_of(particle: &ParticleSample, origin: DVec3, direction: DVec3) -> Option<f64> {
    let radius = (0.75 / std::f64::consts::PI * f64::from(particle.volume0)).cbrt();
    let relative = DVec3::from(particle.position.map(f64::from)) - origin;
    let depth = relative.dot(direction);
    let aside = relative.length_squared() - depth * depth;
    (depth > 0.0 && aside <= radius * radius).then(|| depth - (radius * radius - aside).sqrt())
}

/// Distances at which a ray enters and leaves a box in front of its origin.
fn crossing(origin: DVec3, direction: DVec3, low: DVec3, high: DVec3) -> Option<[f64; 2]> {
    let (to_low, to_high) = ((low - origin) / direction, (high - origin) / direction);
    let enters = to_low.min(to_high).max_element().max(0.0);
    let leaves = to_low.max(to_high).min_element();
    (enters < leaves).then_some([enters, leaves])
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid = Grid { dimension: 3, cells: [10, 10, 10], frame: [0.0; 3], origin: [0.0; 3], spacing: 0.1 };

    fn particle(position: [f32; 3]) -> ParticleSample {
        ParticleSample { position, volume0: 1e-3, ..ParticleSample::default() }
    }

    #[test]
    fn the_first_particle_comes_before_the_middle() {
        let ray = Ray { origin: [0.5, -2.0, 0.5], direction: [0.0, 1.0, 0.0] };
        assert_eq!(point(&ray, &GRID, &[]), Some([0.5, 0.5, 0.5]));
        let hit = point(&ray, &GRID, &[particle([0.5, 0.8, 0.5]), particle([0.52, 0.2, 0.5])]).unwrap();
        assert!(hit[1] > 0.1 && hit[1] < 0.2 && hit[0] == 0.5, "{hit:?}");
        let aside = point(&ray, &GRID, &[particle([0.7, 0.2, 0.5])]).unwrap();
        assert!((aside[1] - 0.5).abs() < 1e-9, "{aside:?}");
        let behind = point(&ray, &GRID, &[particle([0.5, -3.0, 0.5])]).unwrap();
        assert!((behind[1] - 0.5).abs() < 1e-9, "{behind:?}");
    }

    #[test]
    fn a_slanted_ray_stays_inside_and_a_ray_beside_the_domain_means_nothing() {
        let direction = DVec3::new(0.2, 1.0, 0.0).normalize();
        let ray = Ray { origin: [0.88, -0.5, 0.5], direction: direction.into() };
        let hit = point(&ray, &GRID, &[]).unwrap();
        assert!((0..3).all(|axis| (-1e-9..=1.0 + 1e-9).contains(&hit[axis])), "{hit:?}");
        let beside = Ray { origin: [1.5, -2.0, 0.5], direction: [0.0, 1.0, 0.0] };
        assert_eq!(point(&beside, &GRID, &[]), None);
        let away = Ray { origin: [0.5, -2.0, 0.5], direction: [0.0, -1.0, 0.0] };
        assert_eq!(point(&away, &GRID, &[]), None);
    }

    #[test]
    fn a_point_belongs_to_the_body_of_the_nearest_particle() {
        let two = [particle([0.3, 0.5, 0.5]), ParticleSample { body: 1, ..particle([0.4, 0.5, 0.5]) }];
        let at = |x: f64| super::particle([x, 0.5, 0.5], &GRID, &two).map(|found| found.body);
        assert_eq!([at(0.34), at(0.36), at(0.47), at(0.49)], [Some(0), Some(1), Some(1), None]);
    }

    #[test]
    fn the_plane_is_hit_where_the_ray_starts() {
        let grid = Grid { dimension: 2, cells: [10, 10, 1], ..GRID };
        let ray = Ray { origin: [0.25, 0.75, 5.0], direction: [0.0, 0.0, -1.0] };
        assert_eq!(point(&ray, &grid, &[]), Some([0.25, 0.75, 0.0]));
        let beside = Ray { origin: [1.25, 0.75, 5.0], ..ray };
        assert_eq!(point(&beside, &grid, &[]), None);
    }
}
