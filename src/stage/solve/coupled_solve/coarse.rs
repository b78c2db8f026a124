//! The coarse levels of the preconditioner: hat functions, and hat functions with alternating sign, see `shaders/solve/solve_coarse.wgsl`.

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Extent, Pass};
use crate::numerics::{Groups, Levels};
use crate::scene::Scene;
use crate::stage::sweep::{Form, Sweep};
use crate::state::coarse::{self, EXTENTS, Level};
use crate::state::{Over, Phase, State};

/// Entries of the table of group counts.
const NODES: u64 = 0;
const NEAR: u64 = 1;
const ALL: u64 = 2;
const FINEST: u64 = 3;

/// Kernels of the preconditioner.
#[derive(Debug)]
pub(super) struct Coarse {
    measure: Bound,
    /// One per phase in which a solve may begin.
    choose: [(Phase, Bound); 2],
    /// The listed operator.
    operator: Form,
    /// Per space: the function, its sums on the first level.
    sums: Vec<[Bound; 2]>,
    /// Sums on the other levels.
    coarser: Vec<Bound>,
    invert: Vec<Bound>,
    down: Vec<Bound>,
    up: Vec<Bound>,
    extents: Buffer<u32>,
    _levels: Buffer<[f32; 2]>,
    _plan: Vec<Buffer<Level>>,
}

impl Coarse {
    /// Binds, in scenes where it may pay.
    pub(super) fn new(state: &State, scene: &Scene, pcg: &wgpu::Buffer) -> Result<Option<Self>> {
        let gpu = &state.gpu;
        let Some(plan) = coarse::plan(scene) else { return Ok(None) };
        let levels: Buffer<[f32; 2]> = Buffer::new(gpu, "levels", coarse::length(&plan))?;
        let extents = Buffer::indirect(gpu, "coarse_extents", EXTENTS)?;
        let uniform = |level: &Level| -> Result<Buffer<Level>> {
            let buffer = Buffer::uniform(gpu, "level", 1)?;
            buffer.write(gpu, 0, &[*level]);
            Ok(buffer)
        };
        let buffers: Vec<Buffer<Level>> = plan.iter().map(uniform).collect::<Result<_>>()?;
        let count = plan.len() - 1;
        let limits = [("LEVELS", count as f64), ("LEAST_COURANT", coarse::least_courant(scene))];
        let bind = |shader: &str, entry: &str, level: usize, switches: &[(&str, f64)]| {
            let named = [
                ("level", buffers[level].raw()),
                ("levels", levels.raw()),
                ("pcg", pcg),
                ("coarse_extents", extents.raw()),
            ];
            state.bind(shader, entry, &named, &[&limits[..], switches].concat())
        };
        let setup = |entry: &str, level: usize, switches: &[(&str, f64)]| {
            let common = [("FINEST", f64::from(u8::from(level == 0))), ("SPACE", 0.0), ("PHASE_AT", 0.0)];
            let others = common.into_iter().filter(|(name, _)| switches.iter().all(|(given, _)| given != name));
            bind(
                "solve/solve_coarse_setup.wgsl",
                entry,
                level,
                &others.chain(switches.iter().copied()).collect::<Vec<_>>(),
            )
        };
        let solve = |entry: &str, level: usize| bind("solve/solve_coarse.wgsl", entry, level, &[]);
        let choose = |phase: Phase| -> Result<(Phase, Bound)> {
            Ok((phase, setup("coarse_choose", 0, &[("PHASE_AT", f64::from(phase.first()))])?))
        };
        let image = [("x", state.pcg.direction.raw()), ("y", state.pcg.solution.raw())];
        let sums = |space: usize| -> Result<[Bound; 2]> {
            let space = [("SPACE", space as f64)];
            Ok([setup("coarse_ones", 0, &space)?, setup("coarse_first_sums", 0, &space)?])
        };
        let down = |level: usize| solve(if level == 0 { "coarse_residual" } else { "coarse_down" }, level);
        let up = |level: usize| solve(if level == 0 { "coarse_direction" } else { "coarse_up" }, level);
        Ok(Some(Self {
            measure: setup("coarse_measure", 0, &[])?,
            choose: [choose(Phase::Begin)?, choose(Phase::Second)?],
            operator: Form::new(state, Over::Listed, ["solve/solve_operator.wgsl", "solve_operator"], &image, &[])?,
            sums: (0..coarse::spaces(scene.domain.dimension)).map(sums).collect::<Result<_>>()?,
            coarser: (1..count).map(|level| setup("coarse_sums", level, &[])).collect::<Result<_>>()?,
            invert: (0..count).map(|level| setup("coarse_invert", level, &[])).collect::<Result<_>>()?,
            down: (0..count).map(down).collect::<Result<_>>()?,
            up: (0..=count).map(up).collect::<Result<_>>()?,
            extents,
            _levels: levels,
            _plan: buffers,
        }))
    }

    fn extent(&self, entry: u64) -> Extent<'_> {
        Extent::Indirect(&self.extents, 16 * entry)
    }

    /// Chooses the levels and finds their diagonals; the diagonal must be there. `forces`: those of the direction.
    pub(super) fn record_setup(&self, pass: &mut Pass, state: &State, phase: Phase, forces: &Sweep) {
        pass.dispatch(&self.measure, &state.extent(phase, Over::Reduce));
        for (_, choose) in self.choose.iter().filter(|(own, _)| *own == phase) {
            pass.dispatch(choose, &Extent::Groups([1, 1, 1]));
        }
        for [ones, sums] in &self.sums {
            pass.dispatch(ones, &self.extent(ALL));
            for form in &forces.forms {
                pass.dispatch(&form.kernel, &self.extent(if form.groups() == Groups::Near { NEAR } else { NODES }));
            }
            pass.dispatch(&self.operator.kernel, &self.extent(ALL));
            pass.dispatch(sums, &self.extent(FINEST + 1));
        }
        for (level, kernel) in (FINEST + 2..).zip(&self.coarser) {
            pass.dispatch(kernel, &self.extent(level));
        }
        for (level, kernel) in (FINEST + 1..).zip(&self.invert) {
            pass.dispatch(kernel, &self.extent(level));
        }
    }

    /// What the iteration adds to the diagonal.
    pub(super) fn levels(&self) -> Levels<'_> {
        Levels { down: &self.down, up: &self.up, opened: Some((&self.extents, FINEST)) }
    }
}
