//! The kernels that turn the state of the gas into the field that a picture shows. They know nothing of the picture's size.

use super::buffers::Sources;
use super::kernels::{BRICK, bind};
use super::view::View;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass, readback};

/// Workgroups that search the range; each leaves one pair of values.
const RANGE_GROUPS: u32 = 64;

/// Kernels and buffers of the field shown.
#[derive(Debug)]
pub(super) struct Gas {
    cell_count: u64,
    cube_count: u64,
    pub(super) view: Buffer<View>,
    pub(super) field: Buffer<f32>,
    ranges: Buffer<[f32; 2]>,
    /// Per cube between eight cell centres, their fractions of the range; empty in 2D.
    pub(super) corners: Buffer<[u32; 2]>,
    /// One word per brick of cubes: whether the ray march must enter it.
    pub(super) bricks: Buffer<u32>,
    evaluate_field: Bound,
    find_range: Bound,
    pack: Option<[Bound; 2]>,
}

impl Gas {
    pub(super) fn new(gpu: &Gpu, sources: &Sources) -> Result<Self> {
        let grid = &sources.grid;
        let volume = grid.dimension == 3;
        let cube_count = if volume { grid.cells.map(|n| u64::from(n) + 1).iter().product() } else { 0 };
        let brick_count = grid.cells.iter().map(|n| (n + 1).div_ceil(BRICK) as usize).product();
        let view: Buffer<View> = Buffer::uniform(gpu, "view", 1)?;
        let field: Buffer<f32> = Buffer::new(gpu, "field shown", grid.cell_count())?;
        let ranges: Buffer<[f32; 2]> = Buffer::new(gpu, "ranges", RANGE_GROUPS as usize)?;
        let corners: Buffer<[u32; 2]> = Buffer::new(gpu, "field corners", cube_count as usize)?;
        let bricks: Buffer<u32> = Buffer::new(gpu, "bricks", brick_count)?;

        let (view_raw, field_raw) = (("view", view.raw()), ("field", field.raw()));
        let state = [("conserved", &sources.conserved), ("energy", &sources.energy), ("cells", &sources.cells)];
        let shader = "field.wgsl";
        let evaluate_field = bind(gpu, shader, "evaluate_field", &[&state[..], &[view_raw, field_raw]].concat())?;
        let find_range = bind(gpu, shader, "find_range", &[view_raw, field_raw, ("ranges", ranges.raw())])?;
        let (corners_raw, bricks_raw) = (("corners", corners.raw()), ("bricks", bricks.raw()));
        let pack = if volume {
            Some([
                bind(gpu, shader, "pack_corners", &[view_raw, field_raw, corners_raw])?,
                bind(gpu, shader, "mark_bricks", &[view_raw, corners_raw, bricks_raw])?,
            ])
        } else {
            None
        };
        let cell_count = grid.cell_count() as u64;
        Ok(Self { cell_count, cube_count, view, field, ranges, corners, bricks, evaluate_field, find_range, pack })
    }

    /// Computes the view's field and returns its least and largest value; the first is the larger where there is no gas.
    pub(super) fn evaluate(&self, gpu: &Gpu, view: &View) -> Result<[f64; 2]> {
        self.view.write(gpu, 0, &[*view]);
        let mut pass = Pass::new(gpu, "picture field");
        pass.dispatch(&self.evaluate_field, &Extent::Threads(self.cell_count));
        pass.dispatch(&self.find_range, &Extent::Groups([RANGE_GROUPS, 1, 1]));
        pass.submit()?;
        let ranges = readback::read(gpu, &self.ranges)?;
        let low = ranges.iter().map(|range| f64::from(range[0])).fold(f64::INFINITY, f64::min);
        let high = ranges.iter().map(|range| f64::from(range[1])).fold(f64::NEG_INFINITY, f64::max);
        Ok([low, high])
    }

    /// Records what the ray march needs of the field evaluated last, for the range of the view.
    pub(super) fn record_packing(&self, pass: &mut Pass) {
        if let Some([pack_corners, mark_bricks]) = &self.pack {
            pass.dispatch(pack_corners, &Extent::Threads(self.cube_count));
            pass.dispatch(mark_bricks, &Extent::Threads(self.bricks.len() as u64));
        }
    }
}
