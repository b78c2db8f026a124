//! How many bytes a run will write, about: pictures, states and fields, tables, the page.
//!
//! Numbers are those of shipped scenes, see docs/notes/foreign_readers.md; how well something compresses differs from scene to scene.

use crate::scene::Scene;

/// Share of the raw pixels that a PNG takes, by axes of the scene; in a plane, of those that show it. How much more small pictures in
/// a moving one take.
const PNG: [f64; 3] = [0.022, 0.185, 0.30];
const MOVING: [f64; 3] = [1.8, 1.4, 0.67];
/// What a plane without bodies, where less is torn up, takes of that.
const GAS_ALONE: f64 = 0.57;
/// What gas alone takes of that where it stays far below the speed of its sound.
const QUIET_GAS: f64 = 0.65;
/// Pixels beside and above a plane, for bar and letters.
const MARGINS: [f64; 2] = [220.0, 70.0];
/// Pictures in the moving one at most, and pixels of a row of it at most.
const MOVING_FRAMES: f64 = 32.0;
const MOVING_WIDTH: u32 = 320;
/// Bytes of a pixel in PNG before compression, in pictures of 16 bits per channel, in those of linear light: what is fine hardly shrinks.
const RAW: f64 = 3.0;
const PNG16: f64 = 4.0;
const EXR: f64 = 9.0;
/// Bytes that a frame takes for each cell and each particle, by format.
const STORED: [(&str, f64, f64); 5] =
    [("fields", 13.0, 85.0), ("vtk", 23.0, 40.0), ("usd", 0.0, 36.0), ("npz", 23.0, 38.0), ("mesh", 0.0, 490.0)];
/// The same of volumes, by axes: leaves of fewer axes hold few cells.
const VOLUMES: [f64; 3] = [25.0, 25.0, 6.0];
/// Bytes of a number in tables, by axes: zeros are short.
const NUMBER: [f64; 3] = [8.0, 13.5, 15.0];
/// Numbers of a row: of steps, of each probe and gauge in theirs, of a body and of its piece in a frame.
const STEP_COLUMNS: f64 = 52.0;
const PROBE_COLUMNS: f64 = 6.0;
const GAUGE_COLUMNS: f64 = 13.0;
const BODY_COLUMNS: f64 = 30.0;
const PIECE_COLUMNS: f64 = 29.0;
/// Bytes of a plot on the page: its frame, and each of at most so many places along its curves.
const PLOT: f64 = 1500.0;
const PLACE: f64 = 30.0;
const PLACES: f64 = 300.0;
/// Plots of every page beside momentum along each axis, of bodies, of a gauge.
const PLOTS: usize = 7;
const BODY_PLOTS: usize = 5;
const GAUGE_PLOTS: usize = 4;
/// Bytes of a page and a report without plots and pictures, and what letters make of bytes.
const PAGE: f64 = 20e3;
const BASE64: f64 = 4.0 / 3.0;

impl Scene {
    /// Bytes that a run of so many particles and steps writes in some formats, about, beside checkpoints and films.
    #[must_use]
    pub fn disk_bytes(&self, (particles, steps): (usize, f64), formats: &[&str]) -> f64 {
        let frames = f64::from(self.time.frames.max(1)) + 1.0;
        let each = self.picture_bytes(formats) + self.stored_bytes(particles, formats);
        frames * each + self.table_bytes(steps, frames) + self.page_bytes(steps, frames, formats)
    }

    fn axis(&self) -> usize {
        self.domain.axes().clamp(1, 3) - 1
    }

    /// Of all pictures of a frame. In one dimension a picture has all fields.
    fn picture_bytes(&self, formats: &[&str]) -> f64 {
        let share = |name: &str, bytes: f64| if formats.contains(&name) { bytes } else { 0.0 };
        let of_shots = self.shots().unwrap_or_default().into_iter().map(|shot| {
            let fields = if self.axis() == 0 { 1 } else { shot.fields.len() };
            let size = shot.settings.size.map(f64::from);
            let pixel = share("png", RAW * self.png(size)) + share("png16", PNG16) + share("exr", EXR);
            pixel * fields as f64 * size[0] * size[1]
        });
        of_shots.sum()
    }

    /// Share of the raw pixels of a picture of some size that a PNG takes.
    fn png(&self, [wide, high]: [f64; 2]) -> f64 {
        let all = PNG[self.axis()];
        if self.axis() != 1 {
            return all;
        }
        let aspect = self.domain.size[0] / self.domain.size[1];
        let room = [wide - MARGINS[0], high - MARGINS[1]].map(|side| side.max(1.0));
        let width = room[0].min(room[1] * aspect);
        let bodies = if self.bodies.is_empty() { GAS_ALONE } else { 1.0 };
        let quiet = if self.is_quiet() { QUIET_GAS } else { 1.0 };
        all * bodies * quiet * width * (width / aspect) / (wide * high)
    }

    /// Of cells and particles of a frame.
    fn stored_bytes(&self, particles: usize, formats: &[&str]) -> f64 {
        let (cells, particles) = (self.domain.cell_count() as f64, particles as f64);
        let own = STORED.iter().filter(|(name, ..)| formats.contains(name));
        let volumes = if formats.contains(&"vdb") || formats.contains(&"usd") { VOLUMES[self.axis()] } else { 0.0 };
        volumes * cells + own.map(|(_, cell, particle)| cell * cells + particle * particles).sum::<f64>()
    }

    fn table_bytes(&self, steps: f64, frames: f64) -> f64 {
        let measured = PROBE_COLUMNS * self.probes.len() as f64 + GAUGE_COLUMNS * self.gauges.len() as f64;
        let rows =
            steps * (STEP_COLUMNS + measured) + frames * (BODY_COLUMNS + PIECE_COLUMNS) * self.bodies.len() as f64;
        NUMBER[self.axis()] * rows
    }

    /// Of the page and the report.
    fn page_bytes(&self, steps: f64, frames: f64, formats: &[&str]) -> f64 {
        let bodies = if self.bodies.is_empty() { 0 } else { BODY_PLOTS };
        let plots = PLOTS + self.axis() + 1 + bodies + self.probes.len() + GAUGE_PLOTS * self.gauges.len();
        let plots = plots as f64 * (PLOT + PLACE * steps.min(PLACES));
        let [wide, high] = self.render.size;
        let pixels = |block: u32| f64::from(wide / block) * f64::from(high / block);
        let share = self.png([wide, high].map(f64::from));
        let last = pixels(1) * share;
        let shown = frames / (frames / MOVING_FRAMES).ceil();
        let moving = shown * pixels(wide.div_ceil(MOVING_WIDTH).max(1)) * share * MOVING[self.axis()];
        let pictures = if formats.contains(&"png") { BASE64 * RAW * (last + moving) } else { 0.0 };
        PAGE + plots + pictures
    }
}
