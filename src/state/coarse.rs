//! Sizes of the coarse levels of the pressure solve's preconditioner.

use bytemuck::{Pod, Zeroable};

use crate::numerics::pcg;
use crate::scene::{Pair, Preconditioner, Scene};
use crate::structure::structure;
use crate::structure::types::vec3u;

structure! {
    /// A space on one level.
    #[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
    pub(crate) Grid as "Grid" {
        /// Vertices along the axes.
        count: vec3u,
        /// Place of the first one.
        first: u32,
        /// 1 along the axes that the space coarsens.
        halves: vec3u,
        /// Axes whose ends meet, as bits.
        wraps: u32,
    }
}

structure! {
    /// A level with all its spaces, and the one below it.
    #[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
    pub(crate) Level as "Level" {
        /// One per space.
        own: [Grid; SPACES],
        /// The same of the level below.
        below: [Grid; SPACES],
        /// Entries of all spaces.
        length: u32,
        /// From 1, the finest coarse level.
        number: u32,
        /// Fills the last 16 bytes.
        unused: [u32; 2],
    }
}

/// Axes that the spaces coarsen: hat functions all, those that alternate along two axes these two. In 2D the first two.
const COARSENS: [[u32; 3]; SPACES] = [[1, 1, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1]];
/// Spaces at most.
pub(super) const SPACES: usize = 4;
/// Vertices along the shortest axis that are not worth a coarser level.
const FEWEST: u32 = 4;
/// Numbers of the table of group counts before the first iteration: nodes, those near the list, all unknowns, levels.
pub(crate) const EXTENTS: usize = 4 * (3 + pcg::LEVELS);

/// Courant number of the gas below which the diagonal alone is quicker (measured on the software driver), infinite where it is not known.
pub(crate) fn least_courant(scene: &Scene) -> f64 {
    let space = scene.domain.dimension == 3;
    match (scene.numerics.expert.preconditioner, scene.numerics.pair) {
        (Preconditioner::Multigrid, _) => 0.0,
        (_, Pair::B1b0) if space && scene.bodies.is_empty() => 5.0,
        (_, Pair::B1b0) if space => 7.0,
        (_, Pair::B2b1) if space => f64::INFINITY,
        (_, Pair::B1b0) if scene.bodies.is_empty() => 3.0,
        (_, Pair::B1b0) => 5.0,
        (_, Pair::B2b1) => 12.0,
    }
}

/// Spaces in so many dimensions.
pub(crate) fn spaces(dimension: u32) -> usize {
    if dimension == 3 { SPACES } else { 2 }
}

/// The levels from the finest coarse one, and one more that only tells how the last is seen from above. None where they cannot pay.
pub(crate) fn plan(scene: &Scene) -> Option<Vec<Level>> {
    let least = least_courant(scene);
    let steps = least.is_finite() && (scene.time.fixed_step.is_some() || scene.time.max_courant >= least);
    let wanted = scene.numerics.expert.preconditioner != Preconditioner::Jacobi && steps;
    let dimension = scene.domain.dimension;
    if dimension < 2 || !wanted {
        return None;
    }
    let mut level = Level { own: COARSENS.map(|halves| Grid::finest(scene, halves)), ..Level::default() };
    let mut levels: Vec<Level> = Vec::new();
    while levels.len() < pcg::LEVELS {
        let fewest = level.own[0].count[..dimension as usize].iter().copied().min();
        level = level.coarser(spaces(dimension));
        levels.push(level);
        if fewest < Some(FEWEST) {
            break;
        }
    }
    Some(levels).filter(|levels| levels.len() > 1)
}

/// Entries of all levels but the last.
pub(crate) fn length(levels: &[Level]) -> usize {
    levels.last().map_or(0, |level| level.own[0].first as usize)
}

impl Level {
    fn coarser(&self, spaces: usize) -> Self {
        let start = self.own[0].first + self.length;
        let mut level = Self { below: self.own, number: self.number + 1, ..Self::default() };
        for (own, below) in level.own.iter_mut().zip(&self.own).take(spaces) {
            *own = below.coarser(start + level.length);
            level.length += own.count.iter().product::<u32>();
        }
        level
    }
}

impl Grid {
    /// The vertices of the grid, below every first level.
    fn finest(scene: &Scene, halves: [u32; 3]) -> Self {
        let domain = &scene.domain;
        let wraps = [0, 1, 2].map(|axis| u32::from(scene.boundary.periodic(axis)));
        let beyond = |axis: usize| u32::from(axis < domain.axes() && wraps[axis] == 0);
        let active = |axis: usize| halves[axis] * u32::from(axis < domain.axes());
        Self {
            count: [0, 1, 2].map(|axis| domain.cells[axis] + beyond(axis)),
            first: 0,
            halves: [0, 1, 2].map(active),
            wraps: wraps[0] + 2 * wraps[1] + 4 * wraps[2],
        }
    }

    /// Every other vertex along the axes that are coarsened, and one beyond where the last would be left out.
    fn coarser(&self, first: u32) -> Self {
        let mut grid = Self { first, ..*self };
        for axis in (0..3).filter(|axis| self.halves[*axis] == 1) {
            if !self.count[axis].is_multiple_of(2) {
                grid.wraps &= !(1 << axis);
            }
            grid.count[axis] = self.count[axis] / 2 + 1 - (grid.wraps >> axis & 1);
        }
        grid
    }
}
