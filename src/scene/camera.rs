//! Where the eye is, and how it moves with the simulated time.

use glam::{DQuat, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::geometry::camera_file::CameraFile;

/// A camera: a pinhole, or parallel rays where `height` is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Position of the eye `[m]`.
    pub eye: [f64; 3],
    /// The point in the middle of the picture `[m]`.
    pub target: [f64; 3],
    /// Direction that is up in the picture.
    #[serde(default = "Camera::default_up")]
    pub up: [f64; 3],
    /// Vertical opening angle of the pinhole `[degrees]`.
    #[serde(default = "Camera::default_fov")]
    #[schemars(extend("minimum" = 1, "maximum" = 170))]
    pub fov_degrees: f64,
    /// Height of what is seen `[m]`: rays are parallel then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height: Option<f64>,
}

impl Camera {
    pub(super) fn default_up() -> [f64; 3] {
        [0.0, 0.0, 1.0]
    }
    pub(super) fn default_fov() -> f64 {
        40.0
    }
}

/// How a camera moves with the simulated time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CameraPath {
    /// Turns the camera about its target around `up` on top of that, counterclockwise seen from above `[degrees s^-1]`.
    pub orbit: f64,
    /// Key frames in the order of their times; the camera stands still before the first and after the last.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<CameraKey>,
    /// A camera of a glTF file, instead of keys.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<CameraFile>,
}

/// A key frame: the camera at a time. The eye stands at `eye`, or where `azimuth`, `elevation` and `distance` from the target lead.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraKey {
    /// Simulated time `[s]`.
    pub time: f64,
    /// Position of the eye `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// Direction of the eye around `up`, from x towards y `[degrees]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<f64>,
    /// The same above the plane across `up` `[degrees]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = -89.9, "maximum" = 89.9))]
    pub elevation: Option<f64>,
    /// From the target to the eye `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub distance: Option<f64>,
    /// The point in the middle of the picture `[m]`.
    pub target: [f64; 3],
    /// Direction that is up in the picture.
    #[serde(default = "Camera::default_up")]
    pub up: [f64; 3],
    /// Vertical opening angle of the pinhole `[degrees]`.
    #[serde(default = "Camera::default_fov")]
    #[schemars(extend("minimum" = 1, "maximum" = 170))]
    pub fov_degrees: f64,
    /// Height of what is seen `[m]`: rays are parallel then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height: Option<f64>,
}

/// What is interpolated of a key: place (eye, or azimuth, elevation and distance), target, up, opening angle, height.
const CHANNELS: usize = 11;

impl CameraKey {
    /// Azimuth, elevation and distance, if the key is given by them.
    #[must_use]
    pub fn sphere(&self) -> Option<[f64; 3]> {
        Some([self.azimuth?, self.elevation?, self.distance?])
    }

    fn channels(&self) -> [f64; CHANNELS] {
        let [a, b, c] = self.eye.or(self.sphere()).unwrap_or_default();
        let ([d, e, f], [g, h, i]) = (self.target, self.up);
        [a, b, c, d, e, f, g, h, i, self.fov_degrees, self.height.unwrap_or_default()]
    }

    /// The camera that some channels stand for; this key says which kind of place they hold.
    fn camera_of(&self, [a, b, c, d, e, f, g, h, i, fov_degrees, height]: [f64; CHANNELS]) -> Camera {
        let (target, up) = ([d, e, f], [g, h, i]);
        let eye = match self.sphere() {
            Some(_) => (DVec3::from(target) + from_sphere([a, b, c], up)).into(),
            None => [a, b, c],
        };
        let fov_degrees = fov_degrees.clamp(1.0, 170.0);
        Camera { eye, target, up, fov_degrees, height: self.height.map(|_| height.max(f64::MIN_POSITIVE)) }
    }

    /// The camera at the key's own time.
    #[must_use]
    pub fn camera(&self) -> Camera {
        self.camera_of(self.channels())
    }
}

impl CameraPath {
    /// The camera at a time \[s\]; without keys it is `base`, turned by the orbit.
    #[must_use]
    pub fn at(&self, time: f64, base: &Camera) -> Camera {
        let camera = self.through_keys(time).unwrap_or(*base);
        let axis = DVec3::from(camera.up).normalize_or(DVec3::Z);
        let turn = DQuat::from_axis_angle(axis, (self.orbit * time).to_radians());
        let arm = DVec3::from(camera.eye) - DVec3::from(camera.target);
        if self.orbit == 0.0 {
            return camera;
        }
        Camera { eye: (DVec3::from(camera.target) + turn * arm).into(), ..camera }
    }

    fn through_keys(&self, time: f64) -> Option<Camera> {
        let (first, last) = (self.keys.first()?, self.keys.last()?);
        if time <= first.time {
            return Some(first.camera());
        }
        if time >= last.time {
            return Some(last.camera());
        }
        let next = self.keys.partition_point(|key| key.time <= time);
        let times: Vec<f64> = self.keys.iter().map(|key| key.time).collect();
        let values: Vec<[f64; CHANNELS]> = self.keys.iter().map(CameraKey::channels).collect();
        let channel = |k: usize| spline(&times, |n| values[n][k], next - 1, time);
        Some(first.camera_of(std::array::from_fn(channel)))
    }
}

/// The vector from target to eye.
fn from_sphere([azimuth, elevation, distance]: [f64; 3], up: [f64; 3]) -> DVec3 {
    let (a, e) = (azimuth.to_radians(), elevation.to_radians());
    let upright = DVec3::new(e.cos() * a.cos(), e.cos() * a.sin(), e.sin());
    distance * (DQuat::from_rotation_arc(DVec3::Z, DVec3::from(up).normalize_or(DVec3::Z)) * upright)
}

/// Cubic Hermite interpolation between the times `k` and `k + 1`. The slope at a time is that of the parabola through it and its two
/// neighbours, for even times half the difference of the neighbours [Catmull and Rom 1974]; at the ends it is that of the chord.
fn spline(times: &[f64], value: impl Fn(usize) -> f64, k: usize, time: f64) -> f64 {
    let width = |n: usize| times[n + 1] - times[n];
    let chord = |n: usize| (value(n + 1) - value(n)) / width(n);
    let slope = |n: usize| match n {
        0 => chord(0),
        n if n + 1 == times.len() => chord(n - 1),
        n => (width(n) * chord(n - 1) + width(n - 1) * chord(n)) / (width(n - 1) + width(n)),
    };
    let (h, s) = (width(k), (time - times[k]) / width(k));
    let (square, cube) = (s * s, s * s * s);
    (2.0 * cube - 3.0 * square + 1.0) * value(k)
        + (cube - 2.0 * square + s) * h * slope(k)
        + (3.0 * square - 2.0 * cube) * value(k + 1)
        + (cube - square) * h * slope(k + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(time: f64, eye: [f64; 3]) -> CameraKey {
        CameraKey {
            time,
            eye: Some(eye),
            azimuth: None,
            elevation: None,
            distance: None,
            target: [0.0; 3],
            up: [0.0, 0.0, 1.0],
            fov_degrees: 40.0,
            height: None,
        }
    }

    fn around(time: f64, azimuth: f64, distance: f64) -> CameraKey {
        let (azimuth, elevation, distance) = (Some(azimuth), Some(30.0), Some(distance));
        CameraKey { eye: None, azimuth, elevation, distance, target: [1.0, 2.0, 3.0], ..key(time, [0.0; 3]) }
    }

    fn base() -> Camera {
        key(0.0, [2.0, 0.0, 1.0]).camera()
    }

    #[test]
    fn the_path_passes_through_its_keys_and_rests_at_its_ends() {
        let keys = vec![key(1.0, [0.0, 1.0, 2.0]), key(2.0, [4.0, -1.0, 2.5]), key(4.0, [5.0, 7.0, 0.0])];
        let path = CameraPath { keys: keys.clone(), ..CameraPath::default() };
        for key in &keys {
            let found = DVec3::from(path.at(key.time, &base()).eye);
            assert!(found.distance(key.eye.unwrap().into()) < 1e-12, "{found}");
        }
        assert_eq!(path.at(-1.0, &base()).eye, [0.0, 1.0, 2.0]);
        assert_eq!(path.at(9.0, &base()).eye, [5.0, 7.0, 0.0]);
    }

    /// Even motion stays even, whatever the times of the keys, and the velocity has no jump at a key.
    #[test]
    fn motion_is_smooth() {
        let even = [0.0, 0.3, 1.0, 1.1, 2.0];
        let path = CameraPath { keys: even.map(|t| key(t, [3.0 * t, 1.0 - t, 2.0])).to_vec(), ..CameraPath::default() };
        for n in 0..=20 {
            let t = 0.1 * f64::from(n);
            let expected = DVec3::new(3.0 * t, 1.0 - t, 2.0);
            assert!(DVec3::from(path.at(t, &base()).eye).distance(expected) < 1e-12, "t = {t}");
        }
        let keys = vec![key(0.0, [1.0, 0.0, 0.0]), key(0.5, [0.0, 1.0, 0.5]), key(2.0, [-1.0, 0.0, 1.0])];
        let path = CameraPath { keys, ..CameraPath::default() };
        let eye = |t: f64| DVec3::from(path.at(t, &base()).eye);
        let (step, at) = (1e-6, 0.5);
        let [before, after] = [(eye(at) - eye(at - step)) / step, (eye(at + step) - eye(at)) / step];
        assert!(before.distance(after) < 1e-4 && before.length() > 0.5, "{before} {after}");
    }

    /// Between inner keys a constant acceleration is kept, whatever the times of the keys.
    #[test]
    fn a_parabola_stays_a_parabola() {
        let fall = |t: f64| [t, 0.0, 3.0 - t * t];
        let path = CameraPath { keys: [0.0, 0.3, 1.3, 1.5].map(|t| key(t, fall(t))).to_vec(), ..CameraPath::default() };
        for t in [0.4, 0.7, 1.2] {
            let eye = DVec3::from(path.at(t, &base()).eye);
            assert!(eye.distance(fall(t).into()) < 1e-12, "{eye} at {t}");
        }
    }

    /// Keys on a circle keep their distance in between, which keys by their places would not.
    #[test]
    fn keys_around_a_target_stay_around_it() {
        let path = CameraPath { keys: vec![around(0.0, 0.0, 5.0), around(1.0, 180.0, 5.0)], ..CameraPath::default() };
        for t in [0.0, 0.2, 0.5, 0.9] {
            let camera = path.at(t, &base());
            let arm = DVec3::from(camera.eye) - DVec3::from(camera.target);
            assert!((arm.length() - 5.0).abs() < 1e-12 && (arm.z - 2.5).abs() < 1e-12, "{arm} at {t}");
        }
        let half = DVec3::from(path.at(0.5, &base()).eye) - DVec3::new(1.0, 2.0, 3.0);
        assert!(half.x.abs() < 1e-12 && half.y > 4.0, "a quarter turn from x leads to y: {half}");
    }

    #[test]
    fn an_orbit_turns_around_up() {
        let path = CameraPath { orbit: 90.0, ..CameraPath::default() };
        let eye = DVec3::from(path.at(1.0, &base()).eye);
        assert!(eye.distance(DVec3::new(0.0, 2.0, 1.0)) < 1e-12, "{eye}");
        assert_eq!(path.at(0.0, &base()), base());
        // with keys it comes on top of them
        let keys = vec![key(0.0, [2.0, 0.0, 1.0]), key(2.0, [4.0, 0.0, 1.0])];
        let eye = DVec3::from(CameraPath { orbit: 90.0, keys, file: None }.at(1.0, &base()).eye);
        assert!(eye.distance(DVec3::new(0.0, 3.0, 1.0)) < 1e-12, "{eye}");
    }

    #[test]
    fn the_opening_angle_stays_possible() {
        let wide = |time: f64, fov_degrees: f64| CameraKey { fov_degrees, ..key(time, [1.0; 3]) };
        let path =
            CameraPath { keys: vec![wide(0.0, 100.0), wide(1.0, 169.0), wide(2.0, 169.0)], ..CameraPath::default() };
        assert!((0..20).all(|n| path.at(0.1 * f64::from(n), &base()).fov_degrees <= 170.0));
    }
}
