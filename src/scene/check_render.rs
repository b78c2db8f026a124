//! Checks of `[render]`.

use super::check::Check;
use super::{Camera, Contours};

/// Slices of a picture at most.
const MAX_SLICES: usize = 4;
/// Contour lines of a picture at most.
const MAX_CONTOURS: u32 = 32;

impl Check<'_> {
    pub(super) fn render(&mut self) {
        let render = &self.scene.render;
        for pixels in render.size {
            self.count("render.size", pixels, 16, 8192);
        }
        for (key, range) in [("range", render.range), ("particle_range", render.particle_range)] {
            if let Some([low, high]) =
                range.filter(|[low, high]| low.partial_cmp(high) != Some(std::cmp::Ordering::Less))
            {
                self.add(format!("render.{key}"), format!("[{low}, {high}] is empty"), "give the lower value first");
            }
        }
        self.opacity();
        self.count("render.supersampling", render.supersampling, 1, 4);
        self.count("render.arrows", render.arrows, 0, 200);
        self.positive("render.exposure", render.exposure, "");
        if let Some(depth) = render.optical_depth {
            self.positive("render.optical_depth", depth, "");
        }
        if let Some(emission) = render.emission {
            self.positive("render.emission.ambient_kelvin", emission.ambient_kelvin, "[K]");
            self.not_negative("render.emission.strength", emission.strength);
            self.positive("render.emission.optical_depth", emission.optical_depth, "");
        }
        self.not_negative("render.light.strength", render.light.strength);
        self.not_negative("render.light.ambient", render.light.ambient);
        self.direction("render.light.direction", render.light.direction);
        self.planes();
        if let Some(camera) = render.camera {
            self.camera(&camera);
        }
    }

    fn not_negative(&mut self, path: &str, value: f64) {
        if !(value >= 0.0 && value.is_finite()) {
            self.add(path, format!("{value} is out of range"), "give a finite number, 0 or above");
        }
    }

    fn direction(&mut self, path: impl Into<String>, vector: [f64; 3]) {
        if vector == [0.0; 3] {
            self.add(path, "a direction without length", "give another vector");
        }
    }

    fn opacity(&mut self) {
        let points = &self.scene.render.opacity;
        let inside = points.iter().flatten().all(|value| (0.0..=1.0).contains(value));
        let ascending = points.windows(2).all(|pair| pair[0][0] <= pair[1][0]);
        if !inside || !ascending {
            let help = "give points [fraction of the colour bar, opacity] from 0 to 1, fractions in ascending order";
            self.add("render.opacity", format!("{points:?} is no curve"), help);
        }
    }

    fn planes(&mut self) {
        let render = &self.scene.render;
        if render.slices.len() > MAX_SLICES {
            self.add("render.slices", format!("{} planes", render.slices.len()), format!("give at most {MAX_SLICES}"));
        }
        for (index, slice) in render.slices.iter().enumerate() {
            self.direction(format!("render.slices[{index}].normal"), slice.normal);
        }
        let lines = match &render.contours {
            Contours::Count(count) => *count,
            Contours::Values(values) => values.len() as u32,
        };
        self.count("render.contours", lines, 0, MAX_CONTOURS);
    }

    fn camera(&mut self, camera: &Camera) {
        let view: [f64; 3] = std::array::from_fn(|d| camera.target[d] - camera.eye[d]);
        let [a, b] = [view, camera.up];
        let across = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        if view == [0.0; 3] {
            self.add("render.camera.eye", "eye and target are the same point", "move one of them");
        } else if across.iter().all(|x| x.abs() < 1e-9) {
            self.add("render.camera.up", format!("{b:?} is zero or points along the view"), "give another direction");
        }
        if !(1.0..=170.0).contains(&camera.fov_degrees) {
            let message = format!("{} is out of range", camera.fov_degrees);
            self.add("render.camera.fov_degrees", message, "give a number from 1 to 170 [degrees]");
        }
        if let Some(height) = camera.height {
            self.positive("render.camera.height", height, "[m], or leave it out");
        }
    }
}
