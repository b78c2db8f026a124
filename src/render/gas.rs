//! The kernels that turn the state of the gas into the field that a picture shows. They know nothing of the picture's size.

use glam::Vec4;

use super::buffers::Sources;
use super::colormap::TABLE_LENGTH;
use super::kernels::{BRICK, RUN, bind, bind_with};
use super::quantity;
use super::transfer::Tables;
use super::view::View;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass, readback};
use crate::scene::Field;
use crate::state::Grid;

/// Workgroups that search a range; each leaves one pair of values.
pub(super) const RANGE_GROUPS: u32 = 64;

/// Kernels and buffers of the field shown, and the uniform and colour tables that all drawing kernels read.
#[derive(Debug)]
pub(super) struct Gas {
    cell_count: u64,
    cube_count: u64,
    /// Runs of cubes that a thread packs.
    run_count: u64,
    pub(super) view: Buffer<View>,
    /// Colours and opacity of the field, of hot gas, of the particles.
    pub(super) colors: Buffer<Vec4>,
    visible: Buffer<u32>,
    pub(super) field: Buffer<f32>,
    /// p / rho.
    pub(super) heat: Buffer<f32>,
    ranges: Buffer<[f32; 2]>,
    /// Per cube between eight cell centres, their fractions of the range; empty in 2D.
    pub(super) corners: Buffer<[u32; 2]>,
    /// The same cubes' places in the black-body ramp; behind each with soot, and with dust, how much of it is there.
    pub(super) glow: Buffer<[u32; 2]>,
    /// One word per brick of cubes: whether the ray march must enter it.
    pub(super) bricks: Buffer<u32>,
    /// Of the density gradient, of vorticity, and of all other quantities.
    evaluate_field: [Bound; 3],
    find_range: Bound,
    pack_corners: Bound,
    pack_glow: Bound,
    pack_soot: Bound,
    /// Of dust: the field, and what the ray march needs.
    dust: Option<[Bound; 2]>,
    mark_bricks: Bound,
}

impl Gas {
    pub(super) fn new(gpu: &Gpu, sources: &Sources) -> Result<Self> {
        let grid = &sources.grid;
        let volume = grid.dimension == 3;
        let cube_count = if volume { grid.cells.map(|n| u64::from(n) + 1).iter().product() } else { 0 };
        let brick_count = grid.cells.iter().map(|n| (n + 1).div_ceil(BRICK) as usize).product();
        let view: Buffer<View> = Buffer::uniform(gpu, "view", 1)?;
        let colors: Buffer<Vec4> = Buffer::new(gpu, "colour tables", 3 * TABLE_LENGTH)?;
        let visible: Buffer<u32> = Buffer::new(gpu, "visible colours", 2 * (TABLE_LENGTH + 1))?;
        let field: Buffer<f32> = Buffer::new(gpu, "field shown", grid.cell_count())?;
        let heat: Buffer<f32> = Buffer::new(gpu, "heat", grid.cell_count())?;
        let ranges: Buffer<[f32; 2]> = Buffer::new(gpu, "ranges", RANGE_GROUPS as usize)?;
        let corners: Buffer<[u32; 2]> = Buffer::new(gpu, "field corners", cube_count as usize)?;
        let words = 1 + usize::from(sources.species.is_some()) + usize::from(sources.dust.is_some());
        let glow: Buffer<[u32; 2]> = Buffer::new(gpu, "heat corners", words * cube_count as usize)?;
        let bricks: Buffer<u32> = Buffer::new(gpu, "bricks", brick_count)?;

        let shared = ("view", view.raw());
        let (of_field, of_heat) = (("field", field.raw()), ("heat", heat.raw()));
        let (of_corners, of_glow) = (("corners", corners.raw()), ("glow", glow.raw()));
        let nothing: Buffer<[f32; 4]> = Buffer::new(gpu, "nothing owed or kept", 1)?;
        let owed = sources.owed.as_ref().unwrap_or(nothing.raw());
        let species = ("species", sources.species.as_ref().map_or(&sources.energy, |(buffer, ..)| buffer));
        let state = [
            ("conserved", &sources.conserved),
            ("energy", &sources.energy),
            species,
            ("owed_flow", owed),
            ("maps", sources.maps.as_ref().unwrap_or(nothing.raw())),
            ("cells", &sources.cells),
        ];
        let bind = |entry: &str, buffers: &[(&str, &wgpu::Buffer)]| bind(gpu, "picture/field.wgsl", entry, buffers);
        let bricks_and_tables = [("bricks", bricks.raw()), ("visible", visible.raw())];
        Ok(Self {
            evaluate_field: evaluate(gpu, sources, &[&state[..], &[shared, of_field, of_heat]].concat())?,
            find_range: bind("find_range", &[shared, of_field, ("ranges", ranges.raw())])?,
            pack_corners: bind("pack_corners", &[shared, of_field, of_corners])?,
            pack_glow: bind("pack_glow", &[shared, of_heat, of_glow])?,
            pack_soot: bind("pack_soot", &[shared, species, ("cells", &sources.cells), of_glow])?,
            dust: dust_kernels(gpu, sources, shared, [of_field, of_glow])?,
            mark_bricks: self::bind(
                gpu,
                "picture/bricks.wgsl",
                "mark_bricks",
                &[&bricks_and_tables[..], &[shared, of_corners, of_glow]].concat(),
            )?,
            cell_count: grid.cell_count() as u64,
            cube_count,
            run_count: cube_count.min(runs(grid)),
            view,
            colors,
            visible,
            field,
            heat,
            ranges,
            corners,
            glow,
            bricks,
        })
    }

    /// Records the view's field and its range.
    pub(super) fn record_field(&self, pass: &mut Pass, view: &View) {
        let [gradient, vorticity, others] = &self.evaluate_field;
        let is = |field| view.field == quantity::code(field);
        let evaluate = if is(Field::Schlieren) {
            gradient
        } else if is(Field::Vorticity) {
            vorticity
        } else {
            others
        };
        pass.dispatch(evaluate, &Extent::Threads(self.cell_count));
        if let Some([evaluate, _]) = self.dust.as_ref().filter(|_| view.field == quantity::code(Field::Dust)) {
            pass.dispatch(evaluate, &Extent::Threads(self.cell_count));
        }
        pass.dispatch(&self.find_range, &Extent::Groups([RANGE_GROUPS, 1, 1]));
    }

    /// Least and largest value of the field recorded last; the first is the larger where there is no gas.
    pub(super) fn range(&self, gpu: &Gpu) -> Result<[f64; 2]> {
        Ok(bounds(&readback::read(gpu, &self.ranges)?))
    }

    /// Uploads the tables.
    pub(super) fn set_tables(&self, gpu: &Gpu, tables: &Tables) {
        self.colors.write(gpu, 0, &tables.colors);
        self.visible.write(gpu, 0, &tables.visible);
    }

    /// Records what the ray march needs of the field evaluated last, for the range and tables of the view.
    pub(super) fn record_packing(&self, pass: &mut Pass, view: &View) {
        if self.cube_count > 0 {
            let runs = Extent::Threads(self.run_count);
            pass.dispatch(&self.pack_corners, &runs);
            if view.heat_opacity > 0.0 {
                pass.dispatch(&self.pack_glow, &runs);
            }
            if view.soot > 0.0 {
                pass.dispatch(&self.pack_soot, &Extent::Threads(self.cube_count));
            }
            if let Some([_, pack]) = self.dust.as_ref().filter(|_| view.dust > 0.0) {
                pass.dispatch(pack, &Extent::Threads(self.cube_count));
            }
            pass.dispatch(&self.mark_bricks, &Extent::Threads(self.bricks.len() as u64));
        }
    }
}

/// Runs of cubes along the last axis, each packed by a thread.
fn runs(grid: &Grid) -> u64 {
    let [across, along, up] = grid.cells.map(|n| u64::from(n) + 1);
    across * along * up.div_ceil(RUN.into())
}

/// The kernels that evaluate fields, in the order of [`Gas::evaluate_field`].
fn evaluate(gpu: &Gpu, sources: &Sources, buffers: &[(&str, &wgpu::Buffer)]) -> Result<[Bound; 3]> {
    let parts = sources.species.as_ref().map_or(0, |(_, _, parts)| *parts);
    let of = |schlieren: bool, vorticity: bool| {
        let made_for =
            [("SCHLIEREN", schlieren), ("VORTICITY", vorticity), ("MIXED", parts > 0), ("EXPLOSIVE", parts > 2)];
        bind_with(gpu, "picture/field.wgsl", "evaluate_field", &made_for, buffers)
    };
    Ok([of(true, false)?, of(false, true)?, of(false, false)?])
}

/// The kernels of dust, in scenes with some.
fn dust_kernels(
    gpu: &Gpu,
    sources: &Sources,
    view: (&str, &wgpu::Buffer),
    [field, glow]: [(&str, &wgpu::Buffer); 2],
) -> Result<Option<[Bound; 2]>> {
    let Some(dust) = &sources.dust else { return Ok(None) };
    let own = [view, ("dust", dust), ("cells", &sources.cells)];
    let bind = |entry: &str, into| bind(gpu, "picture/dust.wgsl", entry, &[&own[..], &[into]].concat());
    Ok(Some([bind("evaluate_dust", field)?, bind("pack_dust", glow)?]))
}

/// What the workgroups of a search saw together.
pub(super) fn bounds(ranges: &[[f32; 2]]) -> [f64; 2] {
    let low = ranges.iter().map(|range| f64::from(range[0])).fold(f64::INFINITY, f64::min);
    let high = ranges.iter().map(|range| f64::from(range[1])).fold(f64::NEG_INFINITY, f64::max);
    [low, high]
}
