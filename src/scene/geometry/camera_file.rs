//! The path of a camera from a glTF file: its key frames are put in place of the file when a scene is read.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::Value;

use crate::scene::camera::{Camera, CameraKey, CameraPath};
use crate::scene::finding::Finding;
use crate::scene::geometry::distance;
use crate::scene::geometry::mesh::{FileCamera, MeshFolder, Sight, Up, camera};
use crate::scene::geometry::named::one;
use crate::scene::{Scene, shape, vector};

/// Frames of a path at most.
const MOST_FRAMES: f64 = 100_000.0;

/// A camera of a `.gltf` or `.glb`, turned, scaled and moved, in this order, as a mesh from the same file. y is up in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraFile {
    /// The file, from the folder of the scene: `.glb` or `.gltf`.
    pub path: String,
    /// Name of the node whose camera; may be left out where the file has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node: Option<String>,
    /// Frame 0 shows the first key of the file's animation, frame n what comes n / fps seconds later.
    #[serde(default = "default_fps")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub fps: f64,
    /// Ratio of lengths.
    #[serde(default = "one")]
    pub scale: f64,
    /// Axis that it is turned about.
    #[serde(default = "shape::along_z", with = "vector::Point")]
    pub axis: [f64; 3],
    /// Angle, by the right-hand rule `[degrees]`.
    #[serde(default)]
    pub degrees: f64,
    /// Where the file's origin comes to lie `[m]`.
    #[serde(default, with = "vector::Point")]
    pub offset: [f64; 3],
}

fn default_fps() -> f64 {
    25.0
}

impl Scene {
    /// Puts the key frames of camera files in their place: those of the scene's own path, and of its views.
    pub(crate) fn resolve_cameras(&mut self, place: MeshFolder<'_>) -> Vec<Finding> {
        let mut findings = Vec::new();
        let own = self.render.path.clone();
        if let Some(path) = own.filter(|path| path.file.is_some()) {
            match self.sampled(&path, place) {
                Ok(keys) => self.render.path = Some(CameraPath { file: None, keys, ..path }),
                Err(finding) => findings.push(finding.below("render.path")),
            }
        }
        let views: Vec<String> = self.render.views.keys().cloned().collect();
        for name in views {
            // what no path is, the check of views tells
            let given = self.render.views[&name].get("path").cloned();
            let Some(path) = given.and_then(|path| path.try_into::<CameraPath>().ok()).filter(|p| p.file.is_some())
            else {
                continue;
            };
            let keys = self.sampled(&path, place);
            let view = self.render.views.get_mut(&name).and_then(|view| view.get_mut("path")?.as_table_mut());
            match (keys.map(Value::try_from), view) {
                (Ok(Ok(keys)), Some(table)) => {
                    table.remove("file");
                    table.insert("keys".to_owned(), keys);
                }
                (Err(finding), _) => findings.push(finding.below(&format!("render.views.{name}.path"))),
                _ => {}
            }
        }
        findings
    }

    /// A key for every frame of the run, and for the rest of the animation, so that a later end finds it; or what is wrong below the path.
    fn sampled(&self, path: &CameraPath, place: MeshFolder<'_>) -> Result<Vec<CameraKey>, Finding> {
        let Some(file) = &path.file else { return Ok(Vec::new()) };
        if !path.keys.is_empty() {
            let help = "leave out `keys` or `file`";
            return Err(Finding::new("keys", "both key frames and a file of them", help));
        }
        for (key, value) in [("file.fps", file.fps), ("file.scale", file.scale)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Finding::out_of_range(key, value, "give a positive number"));
            }
        }
        if file.degrees != 0.0 && file.axis == [0.0; 3] {
            return Err(Finding::new("file.axis", "a direction without length", "give another vector"));
        }
        let found = camera(&file.path, file.node.as_deref(), place).map_err(|finding| finding.below("file"))?;
        let Some([first, last]) = found.span else { return Ok(vec![file.key(&found, 0.0, 0.0, self)]) };
        let interval = self.frame_interval();
        let frames = ((last - first) * file.fps).ceil().max(f64::from(self.time.frames));
        if !(frames <= MOST_FRAMES && interval > 0.0) {
            let help = format!("{MOST_FRAMES} at most; see time.frames and `fps`");
            return Err(Finding::new("file.path", format!("{frames} frames of a camera"), help));
        }
        let key = |n: u32| file.key(&found, first + f64::from(n) / file.fps, f64::from(n) * interval, self);
        Ok((0..=frames as u32).map(key).collect())
    }
}

impl CameraFile {
    /// The camera at a time of the file, as a key at a simulated time. It looks at the point of its axis beside the middle of the domain.
    fn key(&self, camera: &FileCamera, file_time: f64, time: f64, scene: &Scene) -> CameraKey {
        let to = Up::of_scene(scene.domain.dimension);
        let turned = |vector: DVec3| {
            let own = Up::Y.turned(to, vector.to_array());
            DVec3::from(if self.degrees == 0.0 { own } else { distance::turn(own, [0.0; 3], self.axis, self.degrees) })
        };
        let [eye, view, up] = camera.at(file_time).map(turned);
        let eye = eye * self.scale + DVec3::from(self.offset);
        let (origin, size) = (DVec3::from(scene.domain.origin), DVec3::from(scene.domain.size));
        let arm = origin + 0.5 * size - eye;
        let reach = arm.dot(view).max(0.01 * size.max_element());
        let (fov_degrees, height) = match camera.sight {
            Sight::Pinhole { fov_degrees } => (fov_degrees, None),
            Sight::Parallel { height } => (Camera::default_fov(), Some(self.scale * height)),
        };
        let place = (Some(eye.to_array()), (eye + reach * view).to_array());
        let (azimuth, elevation, distance) = (None, None, None);
        let up = up.to_array();
        CameraKey { time, eye: place.0, azimuth, elevation, distance, target: place.1, up, fov_degrees, height }
    }
}
