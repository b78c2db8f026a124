//! Checks of `[render]` and its views.

use crate::scene::check::Check;
use crate::scene::finding::Finding;
use crate::scene::{Camera, CameraPath, Contours, Field, RenderSettings};

/// Slices of a picture at most.
const MAX_SLICES: usize = 4;
/// Views of a scene: each is drawn at every frame.
const MAX_VIEWS: usize = 100;
/// Contour lines of a picture at most.
const MAX_CONTOURS: u32 = 32;

impl Check<'_> {
    pub(crate) fn render(&mut self) {
        self.look("render", &self.scene.render);
        let own = self.findings.clone();
        let views = self.findings.len();
        self.views();
        // what a view takes over from the scene is told once
        let again = |finding: &Finding, other: &Finding| {
            let key = other.path.strip_prefix("render").filter(|key| finding.path.ends_with(*key));
            key.is_some() && finding.message == other.message
        };
        let found = self.findings.split_off(views);
        self.findings.extend(found.into_iter().filter(|finding| !own.iter().any(|other| again(finding, other))));
    }

    fn views(&mut self) {
        let count = self.scene.render.views.len();
        if count > MAX_VIEWS {
            return self.add("render.views", format!("{count} views"), format!("give at most {MAX_VIEWS}"));
        }
        for name in self.scene.render.views.keys() {
            let path = format!("render.views.{name}");
            if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') {
                let message = format!("`{name}` is no name of a view");
                self.add("render.views", message, "use letters, digits, _ and -: the view's folder has this name");
            } else if Field::ALL.iter().any(|field| field.keyword() == name) {
                self.add(&path, format!("`{name}` is the name of a field"), "use another name: both name folders");
            }
            match self.scene.shot(name) {
                Ok(shot) => self.look(&path, &shot.settings),
                Err((key, message)) => {
                    let key = if key.is_empty() { path } else { format!("{path}.{key}") };
                    self.add(key, message, "a view has the keys of [render], and `fields`; see docs/scenes/render.md");
                }
            }
        }
    }

    fn look(&mut self, path: &str, render: &RenderSettings) {
        let key = |name: &str| format!("{path}.{name}");
        for (name, range) in [("range", render.range), ("particle_range", render.particle_range)] {
            if let Some([low, high]) =
                range.filter(|[low, high]| low.partial_cmp(high) != Some(std::cmp::Ordering::Less))
            {
                self.add(key(name), format!("[{low}, {high}] is empty"), "give the lower value first");
            }
        }
        self.opacity(key("opacity"), &render.opacity);
        if render.soot.is_some() && self.scene.gas.species.is_empty() {
            self.add(key("soot"), "there is no second gas", "add a table such as [gas.species.products] with gamma");
        }
        if render.dust.is_some() && self.scene.gas.dust.is_none() {
            self.add(key("dust"), "there is no dust", "add a table [gas.dust] with sides, amount, threshold and rate");
        }
        self.direction(key("light.direction"), render.light.direction);
        self.planes(path, render);
        if let Some(camera) = &render.camera {
            self.camera(&key("camera"), camera);
        }
        if let Some(camera_path) = &render.path {
            self.camera_path(&key("path"), camera_path);
            if render.camera.is_some() && !camera_path.keys.is_empty() {
                self.add(
                    key("camera"),
                    "both a camera and key frames of one",
                    "leave out `camera`, or `path.keys` and `path.file`",
                );
            }
        }
    }

    fn direction(&mut self, path: impl Into<String>, vector: [f64; 3]) {
        if vector == [0.0; 3] {
            self.add(path, "a direction without length", "give another vector");
        }
    }

    fn opacity(&mut self, path: String, points: &[[f64; 2]]) {
        let inside = points.iter().flatten().all(|value| (0.0..=1.0).contains(value));
        let ascending = points.windows(2).all(|pair| pair[0][0] <= pair[1][0]);
        if !inside || !ascending {
            let help = "give points [fraction of the colour bar, opacity] from 0 to 1, fractions in ascending order";
            self.add(path, format!("{points:?} is no curve"), help);
        }
    }

    fn planes(&mut self, path: &str, render: &RenderSettings) {
        if render.slices.len() > MAX_SLICES {
            let message = format!("{} planes", render.slices.len());
            self.add(format!("{path}.slices"), message, format!("give at most {MAX_SLICES}"));
        }
        for (index, slice) in render.slices.iter().enumerate() {
            self.direction(format!("{path}.slices[{index}].normal"), slice.normal);
        }
        let lines = match &render.contours {
            Contours::Count(count) => *count,
            Contours::Values(values) => values.len() as u32,
        };
        if lines > MAX_CONTOURS {
            self.out_of_range(format!("{path}.contours"), lines, format!("give at most {MAX_CONTOURS}"));
        }
    }

    fn camera(&mut self, path: &str, camera: &Camera) {
        let view: [f64; 3] = std::array::from_fn(|d| camera.target[d] - camera.eye[d]);
        let [a, b] = [view, camera.up];
        let across = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        if view == [0.0; 3] {
            self.add(format!("{path}.eye"), "eye and target are the same point", "move one of them");
        } else if across.iter().all(|x| x.abs() < 1e-9) {
            self.add(format!("{path}.up"), format!("{b:?} is zero or points along the view"), "give another direction");
        }
    }

    fn camera_path(&mut self, path: &str, own: &CameraPath) {
        if !own.orbit.is_finite() {
            self.add(format!("{path}.orbit"), format!("{} is not finite", own.orbit), "give [degrees s^-1]");
        }
        for (index, key) in own.keys.iter().enumerate() {
            let place = format!("{path}.keys[{index}]");
            let given = [key.azimuth, key.elevation, key.distance].iter().flatten().count();
            if !matches!((key.eye, given), (Some(_), 0) | (None, 3)) {
                let help = "give either `eye`, or `azimuth`, `elevation` and `distance`";
                self.add(place, "the place of the eye is not said, or said twice", help);
                return;
            }
            self.camera(&place, &key.camera());
        }
        for (index, pair) in own.keys.windows(2).enumerate() {
            let place = format!("{path}.keys[{}]", index + 1);
            if pair[1].time.partial_cmp(&pair[0].time) != Some(std::cmp::Ordering::Greater) {
                let message = format!("{} does not come after {}", pair[1].time, pair[0].time);
                self.add(format!("{place}.time"), message, "give the keys in the order of their times");
            }
            let kinds = pair.iter().map(|key| (key.eye.is_some(), key.height.is_some())).collect::<Vec<_>>();
            if kinds[0] != kinds[1] {
                let help = "give all keys of a path by `eye` or all around the target, and `height` to all or none";
                self.add(place, "not the same kind of key as the one before", help);
            }
        }
    }
}
