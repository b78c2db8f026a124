//! The surface of what particles make up in 3D: lists of the particles around a point, and where rays meet it.

use super::kernels::{bind, bind_numbers};
use super::particles::Particles;
use super::screen::Shared;
use super::view::View;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Pass};
use crate::numerics::Scan;

/// Kernels and buffers of the surface.
#[derive(Debug)]
pub(super) struct Sheets {
    particles: u64,
    cubes: u64,
    reach: Buffer<u32>,
    count: Buffer<u32>,
    start: Buffer<u32>,
    find_reach: Bound,
    tally: Bound,
    scan: Scan,
    place: Bound,
    mark: Bound,
    mark_lone: Bound,
    gather: Bound,
    trace: Bound,
    /// Normal and colour of each sample.
    sheets: Buffer<[u32; 2]>,
}

/// Cubes along each axis before they repeat: sixteen for each particle, so that few rays meet cubes that only repeat.
fn cubes_along(particles: u64) -> [u32; 3] {
    let bits = (16 * particles).clamp(1 << 12, 1 << 22).next_power_of_two().ilog2();
    [bits.div_ceil(3), (bits + 1) / 3, bits / 3].map(|own| 1 << own)
}

impl Sheets {
    /// For samples with the depths and particles that are given.
    pub(super) fn new(shared: &Shared, own: &Particles, depth: &Buffer<u32>, kept: &Buffer<u32>) -> Result<Self> {
        let Shared { gpu, gas, .. } = *shared;
        let along = cubes_along(own.count);
        let cubes = along.iter().product::<u32>();
        let reach: Buffer<u32> = Buffer::new(gpu, "largest reach", 1)?;
        let count: Buffer<u32> = Buffer::new(gpu, "particles in cubes", cubes as usize)?;
        let start: Buffer<u32> = Buffer::new(gpu, "starts and marks of cubes", 2 * cubes as usize + 1)?;
        let order: Buffer<u32> = Buffer::new(gpu, "particles by cubes", own.count as usize)?;
        let places: Buffer<[u32; 4]> = Buffer::new(gpu, "places by cubes", own.count as usize)?;
        let sheets: Buffer<[u32; 2]> = Buffer::new(gpu, "sheets", depth.len())?;
        let numbers: Vec<(&str, f64)> =
            ["CUBES_X", "CUBES_Y", "CUBES_Z"].into_iter().zip(along.map(f64::from)).collect();
        let [of_view, balls] = [("view", gas.view.raw()), ("balls", own.balls.raw())];
        let [of_reach, of_count] = [("near_reach", reach.raw()), ("near_count", count.raw())];
        let [of_start, of_order] = [("near_start", start.raw()), ("near_order", order.raw())];
        let of_places = ("near_balls", places.raw());
        let near = |entry: &str, buffers: &[(&str, &wgpu::Buffer)]| {
            bind_numbers(gpu, "picture/near.wgsl", entry, &numbers, &[&[balls], buffers].concat())
        };
        let lists = [of_view, balls, of_reach, of_start, of_order, of_places];
        let traced = [("depth_bits", depth.raw()), ("kept", kept.raw()), ("sheets", sheets.raw())];
        Ok(Self {
            particles: own.count,
            cubes: cubes.into(),
            find_reach: bind(gpu, "picture/near.wgsl", "find_reach", &[of_view, balls, of_reach])?,
            tally: near("tally_near", &[of_view, of_reach, of_count])?,
            scan: Scan::new(gpu, &count, &start, cubes)?,
            place: near("place_near", &[of_view, of_reach, of_count, of_start, of_order])?,
            mark: bind_numbers(
                gpu,
                "picture/near.wgsl",
                "mark_near",
                &numbers,
                &[("near_marks", start.raw()), of_places],
            )?,
            gather: near("gather_near", &[of_reach, of_start, of_order, of_places])?,
            mark_lone: bind_numbers(
                gpu,
                "picture/lone.wgsl",
                "mark_lone",
                &numbers,
                &[&lists[..], &[("deformation", &own.deformation)]].concat(),
            )?,
            trace: bind_numbers(
                gpu,
                "picture/trace_skin.wgsl",
                "trace_skin",
                &numbers,
                &[&lists[..], &traced].concat(),
            )?,
            reach,
            count,
            start,
            sheets,
        })
    }

    /// What kernels read that light the surface.
    pub(super) fn of_light(&self) -> [(&str, &wgpu::Buffer); 2] {
        [("sheets", self.sheets.raw()), ("near_reach", self.reach.raw())]
    }

    /// Records the surface where the depths of balls are known; the lists once per picture.
    pub(super) fn record(&self, pass: &mut Pass, view: &View) {
        if view.first_row == 0 {
            let particles = Extent::Threads(self.particles);
            pass.clear(&self.reach);
            pass.clear(&self.count);
            pass.clear(&self.start);
            pass.dispatch(&self.find_reach, &particles);
            pass.dispatch(&self.tally, &particles);
            self.scan.record(pass);
            pass.dispatch(&self.place, &particles);
            pass.dispatch(&self.gather, &Extent::Threads(self.cubes));
            pass.dispatch(&self.mark, &Extent::Threads(self.cubes));
            pass.dispatch(&self.mark_lone, &particles);
        }
        let blocks = (view.size[0] * view.samples).div_ceil(2) * (view.rows * view.samples).div_ceil(2);
        pass.dispatch(&self.trace, &Extent::Threads(blocks.into()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_are_as_many_along_each_axis_but_for_a_factor_of_two() {
        assert_eq!(cubes_along(1), [16; 3]);
        assert_eq!(cubes_along(4784), [64, 64, 32]);
        assert_eq!(cubes_along(100_124), [128; 3]);
        assert_eq!(cubes_along(1 << 40), [256, 128, 128]);
    }
}
