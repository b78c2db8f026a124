//! Light and shadow in 3D, and the obstacles as a signed distance. Nothing here has the picture's size.

use rayon::prelude::*;

use super::gas::Gas;
use super::kernels::{self, BLOCK_CELLS, GLOW_CELLS, LIGHT_CELLS, SHADOW_TEXELS};
use super::particles::Particles;
use super::view::View;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass};
use crate::scene::Scene;
use crate::state::Grid;

/// Nodes of the obstacles' distance at most where there are two per cell.
const MOST_FINE_NODES: u64 = 4_000_000;

/// Kernels and buffers of light and shadow.
#[derive(Debug)]
pub(super) struct Light {
    /// Distance from the light of the first solid, as bits.
    shadow_map: Buffer<u32>,
    /// Light that arrives in each cell of a grid along the light.
    pub(super) grid: Buffer<u32>,
    /// Light of hot gas that arrives in each coarse cell of the domain.
    glow_grid: Buffer<[f32; 4]>,
    clear_shadow: Bound,
    splat_shadow: Option<(u64, Bound)>,
    trace_shadow: Option<Bound>,
    cast_light: Bound,
    glow: Glow,
}

/// The kernels of the light of hot gas on surfaces.
#[derive(Debug)]
struct Glow {
    /// Share of each cell that bodies fill.
    blocks: Buffer<u32>,
    gather: Bound,
    block_bodies: Option<(u64, Bound)>,
    block_walls: Option<Bound>,
    spread: Bound,
}

impl Light {
    pub(super) fn new(gpu: &Gpu, gas: &Gas, particles: Option<&Particles>, distance: &Distance) -> Result<Self> {
        let texels = (SHADOW_TEXELS * SHADOW_TEXELS) as usize;
        let shadow_map: Buffer<u32> = Buffer::new(gpu, "shadow map", texels)?;
        let grid: Buffer<u32> = Buffer::new(gpu, "light grid", LIGHT_CELLS.pow(3) as usize)?;
        let shared = [("view", gas.view.raw()), ("shadow_bits", shadow_map.raw())];
        let bind = |entry: &str, own: &[(&str, &wgpu::Buffer)]| {
            kernels::bind(gpu, "picture/light.wgsl", entry, &[&shared[..], own].concat())
        };
        let look = [("corners", gas.corners.raw()), ("glow", gas.glow.raw()), ("colors", gas.colors.raw())];
        let glow_grid: Buffer<[f32; 4]> = Buffer::new(gpu, "glow grid", 2 * GLOW_CELLS.pow(3) as usize)?;
        let splat = |own: &Particles| {
            let bound = bind("splat_shadow", &[("balls", own.balls.raw())])?;
            Ok::<_, crate::Error>((own.count, bound))
        };
        let trace = || bind("trace_shadow", &[("distance", distance.nodes.raw())]);
        Ok(Self {
            clear_shadow: kernels::bind(gpu, "picture/light.wgsl", "clear_shadow", &shared[1..])?,
            splat_shadow: particles.map(splat).transpose()?,
            trace_shadow: (distance.fineness > 0).then(trace).transpose()?,
            cast_light: bind("cast_light", &[&look[..], &[("light_grid", grid.raw())]].concat())?,
            glow: Glow::new(gpu, gas, (particles, distance), &glow_grid)?,
            shadow_map,
            grid,
            glow_grid,
        })
    }

    /// What kernels read that light surfaces.
    pub(super) fn of_surfaces(&self) -> [(&str, &wgpu::Buffer); 3] {
        [("shadow_map", self.shadow_map.raw()), ("light_grid", self.grid.raw()), ("glow_grid", self.glow_grid.raw())]
    }

    /// Records the light of hot gas, and the shadows of particles, obstacles and gas.
    pub(super) fn record(&self, pass: &mut Pass, view: &View) {
        if view.heat_opacity > 0.0 {
            self.glow.record(pass, view);
        }
        if view.shadows == 0 {
            return;
        }
        let texels = Extent::Threads(u64::from(SHADOW_TEXELS * SHADOW_TEXELS));
        pass.dispatch(&self.clear_shadow, &texels);
        if let Some((count, splat_shadow)) = self.splat_shadow.as_ref().filter(|_| view.particles > 0) {
            pass.dispatch(splat_shadow, &Extent::Threads(*count));
        }
        if let Some(trace_shadow) = &self.trace_shadow {
            pass.dispatch(trace_shadow, &texels);
        }
        pass.dispatch(&self.cast_light, &Extent::Threads(u64::from(LIGHT_CELLS * LIGHT_CELLS)));
    }
}

impl Glow {
    fn new(
        gpu: &Gpu,
        gas: &Gas,
        (particles, distance): (Option<&Particles>, &Distance),
        glow_grid: &Buffer<[f32; 4]>,
    ) -> Result<Self> {
        let sources: Buffer<[f32; 4]> = Buffer::new(gpu, "glow sources", GLOW_CELLS.pow(3) as usize)?;
        let blocks: Buffer<u32> = Buffer::new(gpu, "glow blocks", BLOCK_CELLS.pow(3) as usize)?;
        let of_view = ("view", gas.view.raw());
        let (of_sources, of_blocks) = (("sources", sources.raw()), ("blocks", blocks.raw()));
        let look = [("corners", gas.corners.raw()), ("glow", gas.glow.raw()), ("colors", gas.colors.raw())];
        let bind = |entry: &str, own: &[(&str, &wgpu::Buffer)]| {
            kernels::bind(gpu, "picture/glow.wgsl", entry, &[&[of_view], own].concat())
        };
        let bodies = |own: &Particles| {
            let bound = bind("block_bodies", &[of_blocks, ("balls", own.balls.raw())])?;
            Ok::<_, crate::Error>((own.count, bound))
        };
        let walls = || bind("block_walls", &[of_blocks, ("distance", distance.nodes.raw())]);
        Ok(Self {
            gather: bind("gather_glow", &[&look[..], &[of_sources]].concat())?,
            block_bodies: particles.map(bodies).transpose()?,
            block_walls: (distance.fineness > 0).then(walls).transpose()?,
            spread: bind("spread_glow", &[of_sources, of_blocks, ("glow_grid", glow_grid.raw())])?,
            blocks,
        })
    }

    fn record(&self, pass: &mut Pass, view: &View) {
        let cells = Extent::Threads(u64::from(GLOW_CELLS.pow(3)));
        pass.dispatch(&self.gather, &cells);
        pass.clear(&self.blocks);
        if let Some((count, block_bodies)) = self.block_bodies.as_ref().filter(|_| view.particles > 0) {
            pass.dispatch(block_bodies, &Extent::Threads(*count));
        }
        if let Some(block_walls) = &self.block_walls {
            pass.dispatch(block_walls, &Extent::Threads(u64::from(BLOCK_CELLS.pow(3))));
        }
        pass.dispatch(&self.spread, &cells);
    }
}

/// The obstacles as a signed distance on nodes.
#[derive(Debug)]
pub(super) struct Distance {
    /// Nodes per cell and axis; 0 without obstacles.
    pub(super) fineness: u32,
    pub(super) nodes: Buffer<f32>,
}

impl Distance {
    pub(super) fn new(gpu: &Gpu, scene: &Scene, grid: &Grid) -> Result<Self> {
        if scene.obstacles.is_empty() {
            return Ok(Self { fineness: 0, nodes: Buffer::new(gpu, "obstacle distance", 0)? });
        }
        let along = |fineness: u32| -> [u32; 3] {
            std::array::from_fn(|d| if d < grid.dimension as usize { grid.cells[d] * fineness + 1 } else { 1 })
        };
        let count = |nodes: [u32; 3]| nodes.iter().map(|&n| u64::from(n)).product::<u64>();
        let fineness = if count(along(2)) <= MOST_FINE_NODES { 2 } else { 1 };
        let [nx, ny, nz] = along(fineness);
        let step = f64::from(grid.spacing) / f64::from(fineness);
        let place = |d: usize, k: u32| {
            if d < grid.dimension as usize { grid.low()[d] + f64::from(k) * step } else { 0.0 }
        };
        let nearest = |point: [f64; 3]| scene.obstacle_distance(point) as f32;
        let values: Vec<f32> = (0..ny * nz)
            .into_par_iter()
            .flat_map_iter(|row| {
                let (y, z) = (place(1, row % ny), place(2, row / ny));
                (0..nx).map(move |x| nearest([place(0, x), y, z]))
            })
            .collect();
        Ok(Self { fineness, nodes: Buffer::from_slice(gpu, "obstacle distance", &values)? })
    }
}
