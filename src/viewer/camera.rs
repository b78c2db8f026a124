//! Moving a camera: orbit, pan, zoom to a point, fit. Pure arithmetic on the scene's own camera.

use glam::{DQuat, DVec2, DVec3};

use crate::scene::Camera;

/// Degrees of a turn per picture height of a drag.
const TURN: f64 = 180.0;
/// The camera stays so many degrees away from looking along `up`.
const POLE: f64 = 1.0;
/// Change of the distance per notch of the wheel.
const NOTCH: f64 = 0.85;

/// Opening angle of a camera above a plane \[degrees\]; only the height of what it shows matters.
const PLANE_OPENING: f64 = 40.0;

/// Position, unit vectors to the right, up and forward, and the distance to the target.
struct Frame {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    distance: f64,
}

fn frame(camera: &Camera) -> Frame {
    let (eye, target) = (DVec3::from(camera.eye), DVec3::from(camera.target));
    let distance = (target - eye).length().max(f64::MIN_POSITIVE);
    let forward = (target - eye) / distance;
    let right = forward.cross(camera.up.into()).normalize_or(forward.any_orthonormal_vector());
    Frame { eye, right, up: right.cross(forward), forward, distance }
}

/// Half the height of the picture at the target \[m\].
fn half_height(camera: &Camera, distance: f64) -> f64 {
    camera.height.map_or_else(|| distance * (0.5 * camera.fov_degrees).to_radians().tan(), |height| 0.5 * height)
}

/// Turns the camera about its target; `drag` in picture heights, to the right and down.
pub fn orbit(camera: &Camera, drag: [f64; 2]) -> Camera {
    let Frame { right, forward, distance, .. } = frame(camera);
    let axis = DVec3::from(camera.up).normalize_or(DVec3::Z);
    let height = (-forward.dot(axis)).clamp(-1.0, 1.0).asin().to_degrees();
    let tilt = (TURN * drag[1]).clamp(POLE - 90.0 - height, 90.0 - POLE - height);
    let turned = DQuat::from_axis_angle(axis, (-TURN * drag[0]).to_radians())
        * DQuat::from_axis_angle(right, -tilt.to_radians())
        * forward;
    Camera { eye: (DVec3::from(camera.target) - distance * turned).into(), ..*camera }
}

/// Shifts eye and target so that the point under the mouse stays there; `drag` in picture heights, to the right and down.
pub fn pan(camera: &Camera, drag: [f64; 2]) -> Camera {
    let Frame { eye, right, up, distance, .. } = frame(camera);
    let unit = 2.0 * half_height(camera, distance);
    let shift = unit * (drag[1] * up - drag[0] * right);
    Camera { eye: (eye + shift).into(), target: (DVec3::from(camera.target) + shift).into(), ..*camera }
}

/// Comes nearer by `notches` of the wheel, or goes away; what is shown at `at`, at the depth of the target, stays there. `at` is in
/// picture heights from the middle, to the right and down.
pub fn zoom(camera: &Camera, notches: f64, at: [f64; 2]) -> Camera {
    let Frame { right, up, forward, distance, .. } = frame(camera);
    let unit = 2.0 * half_height(camera, distance);
    let target = DVec3::from(camera.target);
    let kept = target + unit * (at[0] * right - at[1] * up);
    let factor = NOTCH.powf(notches);
    let target = kept + factor * (target - kept);
    let eye = (target - factor * distance * forward).into();
    Camera { eye, target: target.into(), height: camera.height.map(|height| factor * height), ..*camera }
}

/// The camera looking along another direction at the same target, from the same distance.
pub fn from_side(camera: &Camera, towards: [f64; 3], up: [f64; 3]) -> Camera {
    let distance = frame(camera).distance;
    let forward = DVec3::from(towards).normalize_or(DVec3::Y);
    Camera { eye: (DVec3::from(camera.target) - distance * forward).into(), up, ..*camera }
}

/// The same view of the target with parallel rays, or through a pinhole again.
pub fn with_parallel_rays(camera: &Camera, parallel: bool) -> Camera {
    let Frame { forward, distance, .. } = frame(camera);
    let half = half_height(camera, distance);
    if parallel {
        return Camera { height: Some(2.0 * half), ..*camera };
    }
    let away = half / (0.5 * camera.fov_degrees).to_radians().tan();
    Camera { eye: (DVec3::from(camera.target) - away * forward).into(), height: None, ..*camera }
}

/// The camera straight above a plane domain of some origin and size \[m\] that shows all of it.
pub fn above(origin: [f64; 3], size: [f64; 3]) -> Camera {
    let target = [origin[0] + 0.5 * size[0], origin[1] + 0.5 * size[1], 0.0];
    let height = 0.5 * size[1] / (0.5 * PLANE_OPENING).to_radians().tan();
    Camera {
        eye: [target[0], target[1], height],
        target,
        up: [0.0, 1.0, 0.0],
        fov_degrees: PLANE_OPENING,
        height: None,
    }
}

/// Keeps the view of a camera above a plane domain inside the domain, at most all of it.
pub fn kept_inside(camera: &Camera, origin: [f64; 3], size: [f64; 3]) -> Camera {
    let whole = above(origin, size);
    let share = (2.0 * half_height(camera, frame(camera).distance) / size[1]).min(1.0);
    let mut kept = whole;
    for (axis, size) in size.into_iter().enumerate().take(2) {
        let room = 0.5 * size * (1.0 - share);
        kept.target[axis] = camera.target[axis].clamp(whole.target[axis] - room, whole.target[axis] + room);
        kept.eye[axis] = kept.target[axis];
    }
    kept.eye[2] = share * whole.eye[2];
    kept
}

/// The camera as the lines that a scene file takes.
pub fn as_scene_text(camera: &Camera) -> String {
    let vector = |v: [f64; 3]| format!("[{}]", v.map(short).join(", "));
    let mut text = format!("[render.camera]\neye = {}\ntarget = {}\n", vector(camera.eye), vector(camera.target));
    if camera.up != [0.0, 0.0, 1.0] {
        text.push_str(&format!("up = {}\n", vector(camera.up)));
    }
    text.push_str(&format!("fov_degrees = {}\n", short(camera.fov_degrees)));
    if let Some(height) = camera.height {
        text.push_str(&format!("height = {}\n", short(height)));
    }
    text
}

/// Five significant digits, with a point, as TOML wants it.
fn short(value: f64) -> String {
    let digits = if value == 0.0 { 4 } else { (4.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize };
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').to_owned() } else { text };
    if text.ends_with('.') || !text.contains('.') { format!("{}.0", text.trim_end_matches('.')) } else { text }
}

/// Where a point appears, in picture heights from the middle, to the right and down; and its depth \[m\].
pub fn project(camera: &Camera, point: [f64; 3]) -> (DVec2, f64) {
    let Frame { eye, right, up, forward, .. } = frame(camera);
    let relative = DVec3::from(point) - eye;
    let depth = relative.dot(forward);
    let scale = 0.5 / half_height(camera, depth);
    (scale * DVec2::new(relative.dot(right), -relative.dot(up)), depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        eye: [3.0, -4.0, 2.0],
        target: [0.5, 0.25, 0.5],
        up: [0.0, 0.0, 1.0],
        fov_degrees: 32.0,
        height: None,
    };

    fn distance(camera: &Camera) -> f64 {
        DVec3::from(camera.eye).distance(camera.target.into())
    }

    #[test]
    fn orbits_keep_target_and_distance() {
        let turned = orbit(&CAMERA, [0.3, -0.1]);
        assert_eq!(turned.target, CAMERA.target);
        assert!((distance(&turned) - distance(&CAMERA)).abs() < 1e-12);
        let back = orbit(&turned, [-0.3, 0.1]);
        assert!(DVec3::from(back.eye).distance(CAMERA.eye.into()) < 1e-9, "{back:?}");
        let round = orbit(&CAMERA, [2.0, 0.0]);
        assert!(DVec3::from(round.eye).distance(CAMERA.eye.into()) < 1e-9, "two heights are a whole turn");
    }

    #[test]
    fn dragging_to_the_right_turns_the_scene_to_the_right_and_down_shows_its_top() {
        // a point in front of the target
        let towards = DVec3::from(CAMERA.target) + 0.2 * (DVec3::from(CAMERA.eye) - DVec3::from(CAMERA.target));
        let (before, _) = project(&CAMERA, towards.into());
        let (after, _) = project(&orbit(&CAMERA, [0.05, 0.0]), towards.into());
        assert!(after.x > before.x + 1e-3, "{before} {after}");
        assert!(orbit(&CAMERA, [0.0, 0.1]).eye[2] > CAMERA.eye[2]);
    }

    #[test]
    fn the_camera_stops_before_the_poles() {
        for drag in [5.0, -5.0] {
            let top = orbit(&CAMERA, [0.0, drag]);
            let forward = (DVec3::from(top.target) - DVec3::from(top.eye)).normalize();
            let angle = forward.z.abs().asin().to_degrees();
            assert!((angle - 89.0).abs() < 1e-6, "{angle}");
        }
    }

    #[test]
    fn a_pan_moves_the_target_with_the_mouse() {
        let moved = pan(&CAMERA, [0.2, -0.1]);
        let (place, depth) = project(&moved, CAMERA.target);
        assert!((place - DVec2::new(0.2, -0.1)).length() < 1e-12, "{place}");
        assert!((depth - distance(&CAMERA)).abs() < 1e-12);
    }

    #[test]
    fn zoom_keeps_the_point_under_the_mouse() {
        let at = [0.3, 0.2];
        let Frame { right, up, distance: away, .. } = frame(&CAMERA);
        let unit = 2.0 * half_height(&CAMERA, away);
        let point = DVec3::from(CAMERA.target) + unit * (at[0] * right - at[1] * up);
        let near = zoom(&CAMERA, 3.0, at);
        let (place, _) = project(&near, point.into());
        assert!((place - DVec2::from(at)).length() < 1e-12, "{place}");
        assert!((distance(&near) / distance(&CAMERA) - NOTCH.powi(3)).abs() < 1e-12);
    }

    #[test]
    fn sides_keep_target_and_distance() {
        let top = from_side(&CAMERA, [0.0, 0.0, -2.0], [0.0, 1.0, 0.0]);
        assert_eq!(top.target, CAMERA.target);
        assert!((top.eye[2] - CAMERA.target[2] - distance(&CAMERA)).abs() < 1e-12);
    }

    #[test]
    fn parallel_rays_show_the_same_target_in_the_same_size() {
        let parallel = with_parallel_rays(&CAMERA, true);
        let Frame { right, forward, .. } = frame(&CAMERA);
        let at = |depth: f64| (DVec3::from(CAMERA.target) + 0.4 * right + depth * forward).into();
        let (near, same) = (project(&CAMERA, at(0.0)).0, project(&parallel, at(0.0)).0);
        assert!((near - same).length() < 1e-12, "{near} {same}");
        let (front, back) = (project(&parallel, at(-0.5)).0, project(&parallel, at(0.5)).0);
        assert!((front - back).length() < 1e-12, "{front} {back}");
        let nearer = with_parallel_rays(&zoom(&parallel, 2.0, [0.0; 2]), false);
        assert!((distance(&nearer) / distance(&CAMERA) - NOTCH.powi(2)).abs() < 1e-12);
    }

    #[test]
    fn a_plane_view_stays_inside() {
        let (origin, size) = ([1.0, 2.0, 0.0], [4.0, 2.0, 1.0]);
        let whole = above(origin, size);
        assert_eq!(kept_inside(&zoom(&whole, -5.0, [0.0, 0.0]), origin, size), whole);
        let corner = kept_inside(&pan(&zoom(&whole, 4.0, [0.0, 0.0]), [9.0, 9.0]), origin, size);
        let share = NOTCH.powi(4);
        assert!((corner.target[0] - (1.0 + 2.0 * share)).abs() < 1e-12, "{corner:?}");
        assert!((corner.target[1] - (4.0 - share)).abs() < 1e-12, "{corner:?}");
    }

    #[test]
    fn text_is_read_again_as_the_same_camera() {
        let text = as_scene_text(&CAMERA);
        let table: toml::Table = toml::from_str(&text).unwrap();
        let camera: Camera = table["render"]["camera"].clone().try_into().unwrap();
        assert_eq!(camera, CAMERA);
        assert_eq!(
            (short(1234.5678), short(-1e-3 / 3.0), short(40.0)),
            ("1234.6".into(), "-0.00033333".into(), "40.0".into())
        );
        assert_eq!((short(0.0), short(123_456_789.0)), ("0.0".into(), "123456789.0".into()));
    }
}
