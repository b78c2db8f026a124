//! The drawing kernels and the constants they share with the host.

use std::fmt::Write as _;

use super::colormap::{TABLE_LENGTH, linear_from_srgb};
use super::{BODY_COLORS, quantity};
use crate::Result;
use crate::gpu::{Bound, Constants, Gpu, Kernel};
use crate::snapshot::kind;

/// Samples of a pixel along each axis where particles are drawn.
pub(super) const SAMPLES: u32 = 2;

/// Cubes along each edge of a brick, the unit of empty space that the ray march leaps over.
pub(super) const BRICK: u32 = 4;

/// Contrasts below this are transparent: a little over one step of 8 bits.
const FAINTEST: f32 = 0.01;

/// Marks cells without gas in the field.
const NO_VALUE: f32 = -3.0e38;

/// WGSL constants that the drawing shaders share with the host.
pub fn constants() -> String {
    let mut text = quantity::constants();
    let _ = writeln!(text, "const KIND_GAS: u32 = {}u;\nconst KIND_WALL: u32 = {}u;", kind::GAS, kind::WALL);
    let _ = writeln!(text, "const SAMPLES: u32 = {SAMPLES}u;\nconst NO_VALUE: f32 = {NO_VALUE:e};");
    let _ = writeln!(text, "const COLOR_COUNT: u32 = {TABLE_LENGTH}u;");
    let _ = writeln!(text, "const BRICK: u32 = {BRICK}u;\nconst FAINTEST: f32 = {FAINTEST};");
    let count = BODY_COLORS.len();
    let colors = BODY_COLORS.map(|color| {
        let [red, green, blue] = color.map(|channel| linear_from_srgb(f32::from(channel) / 255.0));
        format!("vec3f({red:?}, {green:?}, {blue:?})")
    });
    let _ = writeln!(text, "const BODY_COLOR_COUNT: u32 = {count}u;");
    let _ = writeln!(text, "const BODY_COLORS = array<vec3f, {count}>({});", colors.join(", "));
    text
}

/// Compiles one entry point with the constants of the drawing shaders and binds it.
pub(super) fn bind(gpu: &Gpu, shader: &str, entry: &str, buffers: &[(&str, &wgpu::Buffer)]) -> Result<Bound> {
    Kernel::new(gpu, shader, entry, &Constants { source: &constants(), ..Constants::default() })?.bind(gpu, buffers)
}
