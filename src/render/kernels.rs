//! The drawing kernels and the constants they share with the host.

use std::fmt::Write as _;

use super::colormap::TABLE_LENGTH;
use super::quantity;
use crate::Result;
use crate::gpu::{Bound, Constants, Gpu, Kernel};
use crate::snapshot::kind;

/// Optical depth of a cell at the largest packed value of soot; its square root is packed, for faint smoke has few values.
const SOOT_DEPTH: f32 = 16.0;
/// Cubes along each edge of a brick, the unit of empty space that the ray march leaps over.
pub(super) const BRICK: u32 = 4;

/// Cubes along the last axis that one thread packs, so that it reads half of the corners of each once, not twice.
pub(super) const RUN: u32 = 8;

/// Marks cells without gas in the field.
pub(super) const NO_VALUE: f32 = -3.0e38;

/// Cells of the light grid along each axis.
pub(super) const LIGHT_CELLS: u32 = 96;

/// Texels of the shadow map along each axis, a multiple of four times [`LIGHT_CELLS`].
pub(super) const SHADOW_TEXELS: u32 = 768;

/// Cells along each axis of the grid of the light of hot gas.
pub(super) const GLOW_CELLS: u32 = 12;

/// Cells along each axis of the grid of bodies that the light of hot gas meets.
pub(super) const BLOCK_CELLS: u32 = 2 * GLOW_CELLS;

/// Distances at which the offset of a bent ray is known, along each ray that is followed.
pub(super) const BEND_KNOTS: u32 = 8;

/// Rows of samples above and below a band that smoothing may look at.
pub(super) const SAMPLE_MARGIN: u32 = 48;

/// Tone map of [`crate::scene::ToneMap::Aces`].
pub(super) const TONE_ACES: u32 = 1;

/// What is behind of [`crate::scene::Backdrop::Daylight`].
pub(super) const BACKDROP_DAYLIGHT: u32 = 1;

/// Line-of-sight pictures: of [`crate::scene::RenderMode::LineOfSight`] and [`crate::scene::RenderMode::Shadowgraph`].
pub(super) const OPTICS: [u32; 2] = [1, 2];

/// WGSL constants that the drawing shaders share with the host.
pub fn constants() -> String {
    let mut text = quantity::constants();
    let _ = writeln!(text, "const KIND_GAS: u32 = {}u;\nconst KIND_SOLID: u32 = {}u;", kind::GAS, kind::SOLID);
    let _ = writeln!(text, "const KIND_WALL: u32 = {}u;", kind::WALL);
    let _ = writeln!(text, "const NO_VALUE: f32 = {NO_VALUE:e};\nconst SAMPLE_MARGIN: u32 = {SAMPLE_MARGIN}u;");
    let _ = writeln!(
        text,
        "const COLOR_COUNT: u32 = {TABLE_LENGTH}u;\nconst BRICK: u32 = {BRICK}u;\nconst SOOT_DEPTH: f32 = {SOOT_DEPTH:?};"
    );
    let _ = writeln!(text, "const LIGHT_CELLS: u32 = {LIGHT_CELLS}u;\nconst SHADOW_TEXELS: u32 = {SHADOW_TEXELS}u;");
    let _ = writeln!(text, "const GLOW_CELLS: u32 = {GLOW_CELLS}u;\nconst BLOCK_CELLS: u32 = {BLOCK_CELLS}u;");
    let _ =
        writeln!(text, "const BEND_KNOTS: u32 = {BEND_KNOTS}u;\nconst BACKDROP_DAYLIGHT: u32 = {BACKDROP_DAYLIGHT}u;");
    let _ = writeln!(text, "const RUN: u32 = {RUN}u;");
    let _ = writeln!(text, "const RANGE_GROUPS: u32 = {}u;", super::gas::RANGE_GROUPS);
    let _ = writeln!(text, "const TONE_ACES: u32 = {TONE_ACES}u;\nconst OPTICS_SHADOWGRAPH: u32 = {}u;", OPTICS[1]);
    text
}

/// Compiles one entry point with the constants of the drawing shaders and binds it.
pub(super) fn bind(gpu: &Gpu, shader: &str, entry: &str, buffers: &[(&str, &wgpu::Buffer)]) -> Result<Bound> {
    bind_with(gpu, shader, entry, &[], buffers)
}

/// The same with switches: a kernel without the parts that a picture does not need is much faster where threads run in step.
pub(super) fn bind_with(
    gpu: &Gpu,
    shader: &str,
    entry: &str,
    switches: &[(&str, bool)],
    buffers: &[(&str, &wgpu::Buffer)],
) -> Result<Bound> {
    let overrides: Vec<(&str, f64)> = switches.iter().map(|&(name, on)| (name, f64::from(u8::from(on)))).collect();
    bind_numbers(gpu, shader, entry, &overrides, buffers)
}

/// The same with numbers.
pub(super) fn bind_numbers(
    gpu: &Gpu,
    shader: &str,
    entry: &str,
    overrides: &[(&str, f64)],
    buffers: &[(&str, &wgpu::Buffer)],
) -> Result<Bound> {
    Kernel::new(gpu, shader, entry, &Constants { source: &constants(), overrides })?.bind(gpu, buffers)
}
