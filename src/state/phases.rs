//! The table of indirect dispatches: the device opens and closes phases, and each has the group counts of all that kernels go over.

use super::State;
use super::constants::SCAN_DISPATCHES;
use crate::gpu::Extent;
use crate::structure::numbers;

numbers! {
    /// Dispatches that are opened and closed together.
    Phase {
        /// A step has begun.
        Begin,
        /// Particles have to be sorted.
        Sort,
        /// The limiter has acted.
        Limit,
        /// The energy floor may have to act deep inside the gas.
        Floor,
        /// A solve is done.
        Update,
        /// The first of two solves is done.
        Second,
        /// An elastic sub-step is due.
        Substep,
        /// The same, once particles have moved.
        Again,
        /// It is the first one, or the first round of the elastic solve.
        First,
        /// The step is complete.
        End,
        /// And wants the filter.
        Filter,
        /// A round of the elastic solve begins.
        Round,
        /// An iteration of the elastic solve is due.
        Iteration,
    }
}

numbers! {
    /// What the threads of a dispatch go over, and the override `SWEEP` of kernels over slots (`shaders/shared/domain.wgsl`).
    Over {
        /// One thread per slot.
        Slots,
        /// One thread per slot; those deep inside the gas have something to do.
        Interior,
        /// One thread per slot that is not deep inside the gas, without those that periodic sides repeat.
        Listed,
        /// Both: one thread per slot at least, and among them the list.
        Both,
        /// One thread per slot deep inside the gas whose node listed vertices rest on.
        Frontier,
        /// Frontier and list: as many threads as the longer of the two.
        Near,
        /// One thread per march of [`super::Params::march`] slots.
        Marches,
        /// The same, and among them the list.
        Whole,
        /// One thread per march over a column of one color: every third column of cells along each axis but the last.
        Color,
        /// One thread per particle.
        Particles,
        /// [`super::Params::groups`] groups that stride and leave one partial result each.
        Reduce,
        /// One thread per row of the preconditioner of interface pressures, in at most as many groups as leave partial results.
        Surface,
        /// One group.
        Single,
        /// First dispatch of a prefix sum.
        Scan,
    }
}

/// Entries of a phase.
const WIDTH: usize = Over::Scan as usize + SCAN_DISPATCHES;

/// Numbers of the table.
pub(super) const LENGTH: usize = 4 * WIDTH * Phase::NAMES.len();

impl Phase {
    /// Its first entry.
    pub fn first(self) -> u32 {
        self as u32 * WIDTH as u32
    }
}

/// The first entries of all phases and the numbers of all that kernels go over, as WGSL.
pub(super) fn source() -> String {
    let first = |(number, name): (usize, &&str)| {
        format!("const PHASE_{}_EXTENTS = {}u;\n", name.to_uppercase(), number * WIDTH)
    };
    Phase::NAMES.iter().enumerate().map(first).chain([Over::wgsl("OVER")]).collect()
}

impl State {
    /// Group counts of what a kernel goes over in a phase, which the device opens and closes.
    pub fn extent(&self, phase: Phase, over: Over) -> Extent<'_> {
        Extent::Indirect(&self.extents, 16 * u64::from(phase.first() + over as u32))
    }

    /// Group counts of a prefix sum over all slots, in a phase.
    pub fn scan_extents(&self, phase: Phase) -> Vec<Extent<'_>> {
        let first = phase.first() + Over::Scan as u32;
        (0..SCAN_DISPATCHES as u32).map(|k| Extent::Indirect(&self.extents, 16 * u64::from(first + k))).collect()
    }
}
