//! Sizes of the coarse levels of the pressure solve's preconditioner.

use bytemuck::{Pod, Zeroable};

use crate::numerics::pcg;
use crate::scene::{Pair, Preconditioner, Scene};

/// Mirror of `Level` in `shaders/shared/coarse.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct Level {
    /// Vertices along x and y.
    pub count: [u32; 2],
    /// 1 where the ends meet.
    pub wraps: [u32; 2],
    /// Vertices of the level below.
    pub fine_count: [u32; 2],
    /// Place of the first vertex.
    pub first: u32,
    /// The same of the level below.
    pub fine_first: u32,
    /// From 1, the finest coarse level.
    pub number: u32,
    /// Fills the last 16 bytes.
    pub unused: [u32; 3],
}

/// Vertices along the shorter axis that are not worth a coarser level.
const FEWEST: u32 = 4;
/// Numbers of the table of group counts before the first iteration: nodes, listed slots, levels.
pub(crate) const EXTENTS: usize = 4 * (2 + pcg::LEVELS);

/// Courant number of the gas below which the diagonal alone is quicker (measured on the software driver).
pub(crate) fn least_courant(scene: &Scene) -> f64 {
    match (scene.numerics.preconditioner, scene.numerics.pair) {
        (Preconditioner::Multigrid, _) => 0.0,
        (_, Pair::B1b0) if scene.bodies.is_empty() => 3.0,
        (_, Pair::B1b0) => 5.0,
        (_, Pair::B2b1) => 12.0,
    }
}

/// The levels from the finest coarse one, and one more that only tells how the last is seen from above. None where they cannot pay.
pub(crate) fn plan(scene: &Scene) -> Option<Vec<Level>> {
    let steps = scene.time.fixed_step.is_some() || scene.time.max_courant >= least_courant(scene);
    let wanted = scene.numerics.preconditioner != Preconditioner::Jacobi && steps;
    if scene.domain.dimension != 2 || !wanted {
        return None;
    }
    let wraps = [0, 1].map(|axis| u32::from(scene.boundary.periodic(axis)));
    let count = [0, 1].map(|axis| scene.domain.cells[axis] + 1 - wraps[axis]);
    let mut levels: Vec<Level> = Vec::new();
    let mut level = Level { count, wraps, ..Level::default() };
    let mut length = 0;
    while levels.len() < pcg::LEVELS {
        let coarser = level.coarser(length);
        length += coarser.count[0] * coarser.count[1];
        levels.push(coarser);
        if level.count[0].min(level.count[1]) < FEWEST {
            break;
        }
        level = coarser;
    }
    Some(levels).filter(|levels| levels.len() > 1)
}

/// Entries of all levels but the last.
pub(crate) fn length(levels: &[Level]) -> usize {
    levels.last().map_or(0, |level| level.first as usize)
}

impl Level {
    /// Every other vertex, and one beyond where the last would be left out.
    fn coarser(&self, first: u32) -> Self {
        let wraps = [0, 1].map(|axis| self.wraps[axis] * u32::from(self.count[axis].is_multiple_of(2)));
        Self {
            count: [0, 1].map(|axis| self.count[axis] / 2 + 1 - wraps[axis]),
            wraps,
            fine_count: self.count,
            first,
            fine_first: self.first,
            number: self.number + 1,
            unused: [0; 3],
        }
    }
}
