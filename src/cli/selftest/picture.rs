//! A picture against a stored one.

use super::Found;
use crate::gpu::Gpu;
use crate::render::Renderer;
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::{Error, Result};

/// Made on llvmpipe by `brisance check bursting_shell_3d --resolution 16 --set "render.size=[96,72]" --picture assets/selftest.png`.
const STORED: &[u8] = include_bytes!("../../../assets/selftest.png");

/// Share of the pixels that differ by more than a sixteenth: edges may fall on the other side of a pixel.
pub(super) fn picture(gpu: &Gpu, _full: bool) -> Result<Found> {
    let scene = Scene::find("bursting_shell_3d", &["render.size=[96,72]".to_owned()])?.with_resolution(16)?;
    let simulation = Simulation::new(gpu, &scene)?;
    let mut renderer = Renderer::of(&simulation, &scene)?;
    let drawn = renderer.render(0.0)?;
    let frame = &drawn.first().ok_or_else(|| Error::Gpu("no picture was drawn".to_owned()))?.frame;
    let stored = stored().ok_or_else(|| Error::Gpu("the stored picture cannot be read".to_owned()))?;
    let limit = 0.01;
    let channels = stored.len() / (frame.width * frame.height) as usize;
    if channels < 3 || stored.len() != channels * (frame.width * frame.height) as usize {
        return Ok(Found { difference: f64::INFINITY, limit, place: "another size".to_owned() });
    }
    let far = |(is, should): (&[u8], &[u8])| is.iter().zip(should).take(3).any(|(a, b)| a.abs_diff(*b) > 16);
    let pairs = || frame.rgba.chunks_exact(4).zip(stored.chunks_exact(channels));
    let first = pairs().position(far).unwrap_or(0);
    let difference = pairs().filter(|pair| far(*pair)).count() as f64 / f64::from(frame.width * frame.height);
    let place = format!("pixel [{}, {}] is the first", first as u32 % frame.width, first as u32 / frame.width);
    Ok(Found { difference, limit, place })
}

/// Pixels of the stored picture.
fn stored() -> Option<Vec<u8>> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(STORED)).read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut pixels).ok()?;
    pixels.truncate(info.buffer_size());
    Some(pixels)
}
