//! The surface of what particles make up in 3D: lists of the particles around a point, and where rays meet it.

use super::kernels::{bind, bind_numbers};
use super::particles::Particles;
use super::screen::Shared;
use super::view::View;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass};
use crate::numerics::Scan;

/// Kernels and buffers of the surface.
#[derive(Debug)]
pub(super) struct Sheets {
    near: Near,
    trace_coarse: Bound,
    trace_first: Bound,
    trace_beside: Bound,
    /// Samples that each of them lists, and the kernel that finds their sheets.
    lists: [(Buffer<u32>, Bound); 2],
    /// Normal and colour of each sample.
    sheets: Buffer<[u32; 2]>,
}

/// Lists of the particles around a point.
#[derive(Debug)]
struct Near {
    particles: u64,
    along: [u32; 3],
    reach: Buffer<u32>,
    count: Buffer<u32>,
    start: Buffer<u32>,
    places: Buffer<[u32; 4]>,
    names: Buffer<[u32; 2]>,
    find_reach: Bound,
    tally: Bound,
    scan: Scan,
    place: Bound,
    gather: Bound,
    mark: Bound,
    mark_lone: Bound,
}

/// Cubes along each axis before they repeat: two for each particle, so that few rays meet cubes that only repeat.
fn cubes_along(particles: u64) -> [u32; 3] {
    let bits = (2 * particles).clamp(1 << 12, 1 << 22).next_power_of_two().ilog2();
    [bits.div_ceil(3), (bits + 1) / 3, bits / 3].map(|own| 1 << own)
}

/// The overrides of what reads the cubes.
fn numbers(along: [u32; 3]) -> Vec<(&'static str, f64)> {
    ["CUBES_X", "CUBES_Y", "CUBES_Z"].into_iter().zip(along.map(f64::from)).collect()
}

impl Near {
    fn new(shared: &Shared, own: &Particles) -> Result<Self> {
        let Shared { gpu, gas, .. } = *shared;
        let along = cubes_along(own.count);
        let (cubes, particles) = (along.iter().product::<u32>(), own.count as usize);
        let reach: Buffer<u32> = Buffer::new(gpu, "largest reach", 1)?;
        let count: Buffer<u32> = Buffer::new(gpu, "particles in cubes", cubes as usize)?;
        let start: Buffer<u32> = Buffer::new(gpu, "starts and marks of cubes", 2 * cubes as usize + 1)?;
        let order: Buffer<u32> = Buffer::new(gpu, "particles by cubes", particles)?;
        let places: Buffer<[u32; 4]> = Buffer::new(gpu, "places by cubes", particles)?;
        let names: Buffer<[u32; 2]> = Buffer::new(gpu, "colours by cubes", particles)?;
        let balls = [("view", gas.view.raw()), ("balls", own.balls.raw()), ("near_reach", reach.raw())];
        let [of_start, of_order] = [("near_start", start.raw()), ("near_order", order.raw())];
        let [of_count, of_places] = [("near_count", count.raw()), ("near_balls", places.raw())];
        let [of_names, deformation] = [("near_names", names.raw()), ("deformation", &own.deformation)];
        let lists = [balls[0], balls[2], of_start, of_places, of_names, deformation];
        let kernel = |entry: &str, buffers: &[(&str, &wgpu::Buffer)]| {
            bind_numbers(gpu, "picture/near.wgsl", entry, &numbers(along), buffers)
        };
        let of_balls = |entry: &str, own: &[(&str, &wgpu::Buffer)]| kernel(entry, &[&balls[..], own].concat());
        Ok(Self {
            particles: own.count,
            along,
            find_reach: bind(gpu, "picture/near.wgsl", "find_reach", &balls)?,
            tally: of_balls("tally_near", &[of_count])?,
            scan: Scan::new(gpu, &count, &start, cubes)?,
            place: of_balls("place_near", &[of_count, of_start, of_order])?,
            gather: of_balls("gather_near", &[of_start, of_order, of_places, of_names])?,
            mark: kernel("mark_near", &[("near_marks", start.raw()), of_places])?,
            mark_lone: bind_numbers(gpu, "picture/lone.wgsl", "mark_lone", &numbers(along), &lists)?,
            reach,
            count,
            start,
            places,
            names,
        })
    }

    fn record(&self, pass: &mut Pass) {
        let particles = Extent::Threads(self.particles);
        pass.clear(&self.reach);
        pass.clear(&self.count);
        pass.clear(&self.start);
        pass.dispatch(&self.find_reach, &particles);
        pass.dispatch(&self.tally, &particles);
        self.scan.record(pass);
        pass.dispatch(&self.place, &particles);
        pass.dispatch(&self.gather, &particles);
        pass.dispatch(&self.mark, &Extent::Threads(self.along.iter().map(|cubes| u64::from(*cubes)).product()));
        pass.dispatch(&self.mark_lone, &particles);
    }
}

/// Numbers before the entries of a list of samples, as it is while it is empty: the workgroups of a dispatch, then the number of entries.
const EMPTY_LIST: [u32; 4] = [0, 1, 1, 0];

impl Sheets {
    /// For samples with the depths and particles that are given.
    pub(super) fn new(shared: &Shared, own: &Particles, depth: &Buffer<u32>, kept: &Buffer<u32>) -> Result<Self> {
        let Shared { gpu, gas, .. } = *shared;
        let near = Near::new(shared, own)?;
        let sheets: Buffer<[u32; 2]> = Buffer::new(gpu, "sheets", depth.len())?;
        let of_near = [
            ("view", gas.view.raw()),
            ("near_reach", near.reach.raw()),
            ("near_start", near.start.raw()),
            ("near_balls", near.places.raw()),
            ("near_names", near.names.raw()),
        ];
        let of_samples = [("depth_bits", depth.raw()), ("sheets", sheets.raw())];
        let kernel = |entry: &str, own: &[(&str, &wgpu::Buffer)]| {
            let buffers = [&of_near[..], &of_samples, own].concat();
            bind_numbers(gpu, "picture/trace_skin.wgsl", entry, &numbers(near.along), &buffers)
        };
        let list = |share: usize| {
            let list = Buffer::indirect(gpu, "listed samples", EMPTY_LIST.len() + depth.len() * share / 4)?;
            let look = kernel("look_sheets", &[("samples", list.raw())])?;
            Ok::<_, crate::Error>((list, look))
        };
        let lists = [list(1)?, list(3)?];
        let trace = |entry: &str, list: &Buffer<u32>| kernel(entry, &[("kept", kept.raw()), ("listed", list.raw())]);
        Ok(Self {
            trace_coarse: trace("trace_coarse", &lists[0].0)?,
            trace_first: trace("trace_first", &lists[0].0)?,
            trace_beside: trace("trace_beside", &lists[1].0)?,
            lists,
            near,
            sheets,
        })
    }

    /// What kernels read that light the surface.
    pub(super) fn of_light(&self) -> [(&str, &wgpu::Buffer); 2] {
        [("sheets", self.sheets.raw()), ("near_reach", self.near.reach.raw())]
    }

    /// Records the surface where the depths of balls are known and no particle is kept; the lists once per picture.
    pub(super) fn record(&self, gpu: &Gpu, pass: &mut Pass, view: &View) {
        if view.first_row == 0 {
            self.near.record(pass);
        }
        let [across, rows] = [view.size[0], view.rows].map(|rays| u64::from(rays * view.samples));
        let blocks = |apart: u64| Extent::Threads(across.div_ceil(apart) * rows.div_ceil(apart));
        let [first, beside] = &self.lists;
        for (list, _) in &self.lists {
            list.write(gpu, 0, &EMPTY_LIST);
        }
        pass.dispatch(&self.trace_coarse, &blocks(4));
        pass.dispatch(&self.trace_first, &blocks(2));
        pass.dispatch(&first.1, &Extent::Indirect(&first.0, 0));
        pass.dispatch(&self.trace_beside, &blocks(2));
        pass.dispatch(&beside.1, &Extent::Indirect(&beside.0, 0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_are_as_many_along_each_axis_but_for_a_factor_of_two() {
        assert_eq!(cubes_along(1), [16; 3]);
        assert_eq!(cubes_along(4784), [32, 32, 16]);
        assert_eq!(cubes_along(100_124), [64; 3]);
        assert_eq!(cubes_along(1 << 40), [256, 128, 128]);
    }
}
