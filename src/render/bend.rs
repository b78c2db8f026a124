//! Gas that bends the view: a grid of rays is followed through it once for a whole picture, and all rays between them bend alike.

use glam::Vec3;

use super::View;
use super::kernels::{BACKDROP_DAYLIGHT, BEND_KNOTS, bind_with};
use super::screen::Shared;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Pass};
use crate::scene::{Backdrop, GasState, RenderSettings};

/// Rays from one that is followed to the next, at least.
const PITCH: u32 = 4;
/// The same over the rays across a cell in the middle of the domain.
const CELL_PITCH: f32 = 0.4;
/// Rays that are followed along each edge of a picture at most: more would take more memory and show nothing more.
const MOST_FOLLOWED: u32 = 1024;

/// What of a view says how light is bent, and what is behind it.
pub(super) fn set(view: &mut View, look: &RenderSettings, ambient: &GasState) {
    if view.dimension < 3 {
        return;
    }
    view.backdrop = if look.backdrop == Backdrop::Daylight { BACKDROP_DAYLIGHT } else { 0 };
    let Some(refraction) = look.refraction.filter(|own| own.exaggeration > 0.0 && view.optics == 0) else { return };
    view.refraction = (refraction.gladstone_dale * refraction.exaggeration) as f32;
    view.ambient_density = ambient.density as f32;
    let extent = Vec3::from_array(view.cells.map(|count| count as f32 * view.spacing));
    let away = Vec3::from(view.origin) + 0.5 * extent - Vec3::from(view.eye);
    let middle = if view.parallel == 1 { away.dot(view.forward.into()) } else { away.length() };
    view.bend_near = (middle - 0.5 * extent.length()).max(0.0);
    let across = 2.0 * view.half_height * if view.parallel == 1 { 1.0 } else { middle } / view.size[1] as f32;
    view.bend_pitch = ((CELL_PITCH * view.spacing / across) as u32).max(least_pitch(view));
    view.bend_far = view.bend_near.max(middle + 0.5 * extent.length());
}

/// The least pitch of a picture of this size.
fn least_pitch(view: &View) -> u32 {
    PITCH.max(view.size[0].max(view.size[1]).div_ceil(MOST_FOLLOWED))
}

/// Rays that are followed at a pitch.
fn followed(view: &View, pitch: u32) -> u64 {
    view.size.map(|rays| u64::from(rays / pitch + 2)).iter().product()
}

/// Kernels and buffers of the rays that are followed, for one size of picture.
#[derive(Debug)]
pub(super) struct Bend {
    /// Their offsets.
    pub(super) bends: Buffer<[f32; 2]>,
    kernels: Option<Kernels>,
}

#[derive(Debug)]
struct Kernels {
    cells: u64,
    weigh_gas: Bound,
    bend_rays: Bound,
    shift_balls: Option<(u64, Bound)>,
}

impl Bend {
    /// For a view; nothing if it bends no rays.
    pub(super) fn new(shared: &Shared, view: &View) -> Result<Self> {
        let Shared { gpu, sources, gas, .. } = *shared;
        if view.refraction == 0.0 {
            return Ok(Self { bends: Buffer::new(gpu, "no bends", 1)?, kernels: None });
        }
        let most = followed(view, least_pitch(view)) as usize;
        let bends: Buffer<[f32; 2]> = Buffer::new(gpu, "bends", most * BEND_KNOTS as usize)?;
        let index: Buffer<f32> = Buffer::new(gpu, "index of refraction", sources.grid.cell_count())?;
        let (of_view, of_index) = (("view", gas.view.raw()), ("index", index.raw()));
        let bind = |entry: &str, own: &[(&str, &wgpu::Buffer)]| {
            bind_with(gpu, "picture/bend.wgsl", entry, &[("REFRACTION", true)], own)
        };
        let state = [("conserved", &sources.conserved), ("cells", &sources.cells)];
        let of_bends = ("bends", bends.raw());
        let shift = |own: &super::particles::Particles| {
            let bound = bind("shift_balls", &[of_view, of_bends, ("balls", own.balls.raw())])?;
            Ok::<_, crate::Error>((own.count, bound))
        };
        let kernels = Kernels {
            cells: sources.grid.cell_count() as u64,
            weigh_gas: bind("weigh_gas", &[&state[..], &[of_view, of_index]].concat())?,
            bend_rays: bind("bend_rays", &[of_view, of_index, of_bends])?,
            shift_balls: shared.particles.map(shift).transpose()?,
        };
        Ok(Self { bends, kernels: Some(kernels) })
    }

    /// Follows the rays of a view, and moves its particles to where they are seen.
    pub(super) fn follow(&self, shared: &Shared, view: &View) -> Result<()> {
        let Some(kernels) = &self.kernels else { return Ok(()) };
        shared.gas.view.write(shared.gpu, 0, &[*view]);
        let mut pass = Pass::new(shared.gpu, "bent rays");
        pass.dispatch(&kernels.weigh_gas, &Extent::Threads(kernels.cells));
        pass.dispatch(&kernels.bend_rays, &Extent::Threads(followed(view, view.bend_pitch)));
        if let Some((count, shift_balls)) = kernels.shift_balls.as_ref().filter(|_| view.particles > 0) {
            pass.dispatch(shift_balls, &Extent::Threads(*count));
        }
        pass.submit().map(|_| ())
    }
}
