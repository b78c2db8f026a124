//! Where the eye is: cameras, and the rays through pixels.

use glam::{DVec3, Vec2, Vec3};

use crate::scene::Camera;
use crate::state::Grid;

/// Position and orientation of the eye.
#[derive(Debug, Clone, Copy)]
pub(super) struct Eye {
    /// In the device's coordinates \[m\].
    pub(super) position: Vec3,
    /// Zero of those in the coordinates of the scene \[m\].
    pub(super) frame: DVec3,
    pub(super) forward: Vec3,
    pub(super) up: Vec3,
    pub(super) parallel: bool,
    /// Half the height of the picture: at unit distance, or in metres for parallel rays.
    pub(super) half_height: f32,
}

/// The line of sight through a point of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts \[m\].
    pub origin: [f64; 3],
    /// Unit vector into the picture.
    pub direction: [f64; 3],
}

impl Eye {
    /// A camera in space, whose places are those of the scene.
    pub(super) fn of_camera(camera: &Camera, frame: [f64; 3]) -> Self {
        let vector = |v: [f64; 3]| Vec3::from_array(v.map(|coordinate| coordinate as f32));
        let frame = DVec3::from(frame);
        let place = |point: [f64; 3]| (DVec3::from(point) - frame).as_vec3();
        let position = place(camera.eye);
        let forward = (place(camera.target) - position).normalize_or(Vec3::Y);
        // A camera that looks along its own `up` still needs some picture: any direction across will do.
        let right = forward.cross(vector(camera.up)).normalize_or(forward.any_orthonormal_vector());
        let half_height = match camera.height {
            Some(height) => 0.5 * height as f32,
            None => (0.5 * camera.fov_degrees as f32).to_radians().tan(),
        };
        Self { position, frame, forward, up: right.cross(forward), parallel: camera.height.is_some(), half_height }
    }

    /// Straight onto a plane domain: all of it in the picture, or what a camera shows of it around its target.
    pub(super) fn onto_plane(grid: &Grid, camera: Option<&Camera>) -> Self {
        let extent = Vec3::from(grid.extent());
        let (mut middle, mut half_height) = (middle_of(grid), 0.5 * extent.y);
        if let Some(camera) = camera {
            let distance = DVec3::from(camera.eye).distance(camera.target.into());
            let seen = distance * (0.5 * camera.fov_degrees).to_radians().tan();
            half_height = camera.height.map_or(seen, |height| 0.5 * height) as f32;
            (middle.x, middle.y) =
                ((camera.target[0] - grid.frame[0]) as f32, (camera.target[1] - grid.frame[1]) as f32);
        }
        let position = middle - extent.max_element() * Vec3::NEG_Z;
        Self { position, frame: grid.frame.into(), forward: Vec3::NEG_Z, up: Vec3::Y, parallel: true, half_height }
    }

    /// The ray through a place of a picture of `size` pixels, in pixels from the top left corner.
    pub(super) fn ray(&self, size: Vec2, pixel: Vec2) -> Ray {
        let offset = (pixel - 0.5 * size) / (0.5 * size.y) * self.half_height;
        let across = offset.x * self.forward.cross(self.up) - offset.y * self.up;
        let (origin, direction) = if self.parallel {
            (self.position + across, self.forward)
        } else {
            (self.position, (self.forward + across).normalize())
        };
        Ray { origin: (self.frame + origin.as_dvec3()).into(), direction: direction.as_dvec3().into() }
    }

    /// Where a point appears in such a picture; none behind the eye.
    pub(super) fn place(&self, size: Vec2, point: [f64; 3]) -> Option<Vec2> {
        let relative = (DVec3::from(point) - self.frame).as_vec3() - self.position;
        let depth = if self.parallel { 1.0 } else { relative.dot(self.forward) };
        let offset = Vec2::new(relative.dot(self.forward.cross(self.up)), -relative.dot(self.up)) / depth;
        (depth > 0.0).then(|| 0.5 * size + offset / self.half_height * 0.5 * size.y)
    }
}

/// Middle of the domain in the device's coordinates \[m\].
pub(super) fn middle_of(grid: &Grid) -> Vec3 {
    Vec3::from(grid.origin) + 0.5 * Vec3::from(grid.extent())
}

/// The camera onto a plane domain that shows all of it.
pub(super) fn above(grid: &Grid) -> Camera {
    let target = DVec3::from(grid.in_scene(middle_of(grid).with_z(0.0).into()));
    let height = f64::from(grid.extent()[1]);
    let (eye, up) = ((target + height * DVec3::Z).into(), [0.0, 1.0, 0.0]);
    Camera { eye, target: target.into(), up, fov_degrees: 40.0, height: Some(height) }
}

/// A view from the side and above that shows the whole domain, below the title.
pub(super) fn fitting_camera(grid: &Grid, size: [u32; 2]) -> Camera {
    const FIELD_OF_VIEW: f32 = 32.0;
    /// Share of the picture that the domain may take.
    const FILLED: f32 = 0.86;
    let half_height = (0.5 * FIELD_OF_VIEW).to_radians().tan();
    let half_size = half_height * FILLED * Vec2::new((size[0] as f32 / size[1] as f32).min(1.2), 1.0);
    let forward = -Vec3::new(0.55, -0.90, 0.42).normalize();
    let right = forward.cross(Vec3::Z).normalize();
    let up = right.cross(forward);
    let extent = Vec3::from(grid.extent());
    let mut target = middle_of(grid);
    let mut distance = 2.0 * extent.length() / half_height;
    // Perspective makes the fit depend on the distance; a few rounds settle it.
    for _ in 0..8 {
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for corner in 0..8 {
            let part = Vec3::new((corner & 1) as f32, ((corner >> 1) & 1) as f32, (corner >> 2) as f32);
            let relative = Vec3::from(grid.origin) + part * extent - (target - distance * forward);
            let place = Vec2::new(relative.dot(right), relative.dot(up)) / relative.dot(forward);
            (low, high) = (low.min(place), high.max(place));
        }
        let middle = 0.5 * (low + high) * distance;
        target += middle.x * right + middle.y * up;
        distance *= (0.5 * (high - low) / half_size).max_element();
    }
    Camera {
        eye: grid.in_scene((target - distance * forward).into()),
        target: grid.in_scene(target.into()),
        up: [0.0, 0.0, 1.0],
        fov_degrees: FIELD_OF_VIEW.into(),
        height: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_pass_through_the_pixels_where_points_appear() {
        let mut camera =
            Camera { eye: [2.0, -3.0, 1.5], target: [0.5; 3], up: [0.0, 0.0, 1.0], fov_degrees: 30.0, height: None };
        let (eye, size) = (Eye::of_camera(&camera, [0.0; 3]), Vec2::new(640.0, 360.0));
        let middle = eye.ray(size, 0.5 * size);
        let towards = DVec3::from(camera.target) - DVec3::from(camera.eye);
        assert!(DVec3::from(middle.direction).distance(towards.normalize()) < 1e-6, "{middle:?}");
        // the upper edge of the picture is half the opening angle away from the middle
        let top = eye.ray(size, Vec2::new(320.0, 0.0));
        let angle = DVec3::from(top.direction).angle_between(middle.direction.into()).to_degrees();
        assert!((angle - 15.0).abs() < 1e-4 && top.direction[2] > middle.direction[2], "{angle} {top:?}");
        // parallel rays: one direction, and the edge is half the height away
        camera.height = Some(2.0);
        let eye = Eye::of_camera(&camera, [0.0; 3]);
        let (middle, top) = (eye.ray(size, 0.5 * size), eye.ray(size, Vec2::new(320.0, 0.0)));
        assert_eq!(middle.direction, top.direction);
        for camera in [camera, Camera { height: None, ..camera }] {
            let (eye, pixel) = (Eye::of_camera(&camera, [1.0, 2.0, 3.0]), Vec2::new(411.0, 77.0));
            let ray = eye.ray(size, pixel);
            let point = DVec3::from(ray.origin) + 2.5 * DVec3::from(ray.direction);
            assert!(
                eye.place(size, point.into()).unwrap().distance(pixel) < 1e-2,
                "{:?}",
                eye.place(size, point.into())
            );
            let behind = DVec3::from(ray.origin) - 2.5 * DVec3::from(ray.direction);
            assert_eq!(eye.place(size, behind.into()).is_some(), camera.height.is_some());
        }
        let apart = DVec3::from(middle.origin).distance(top.origin.into());
        assert!((apart - 1.0).abs() < 1e-6, "{apart}");
    }

    #[test]
    fn the_plane_fills_its_picture() {
        let grid = Grid { dimension: 2, cells: [8, 4, 1], frame: [0.0; 3], origin: [1.0, 2.0, 0.0], spacing: 0.5 };
        let corner = Eye::onto_plane(&grid, None).ray(Vec2::new(80.0, 40.0), Vec2::ZERO);
        assert_eq!(corner.origin[..2], [1.0, 4.0]);
        assert_eq!(corner.direction, [0.0, 0.0, -1.0]);
        // 90 degrees from one quarter of a metre away: half a metre of height around the target
        let camera = Camera {
            eye: [2.0, 3.5, 0.25],
            target: [2.0, 3.5, 0.0],
            up: [0.0, 1.0, 0.0],
            fov_degrees: 90.0,
            height: None,
        };
        let corner = Eye::onto_plane(&grid, Some(&camera)).ray(Vec2::new(80.0, 40.0), Vec2::ZERO);
        assert!((corner.origin[0] - 1.5).abs() < 1e-6 && (corner.origin[1] - 3.75).abs() < 1e-6, "{corner:?}");
    }
}
