//! Conjugate gradients with a diagonal preconditioner, one of its own for a block of unknowns, and coarse levels on top, matrix-free,
//! all scalars on the device.
//!
//! The operator is given as dispatches that turn `direction` into `product` and leave the partial sums of their dot product
//! in the first component of `partials`, at [`Layout::dots_at`]. Iterations beyond convergence are dispatches of no groups. [Saad 2003, algorithm 9.1]
//! An operator that leaves [`Dots::Both`] lets an iteration without block and levels do with one kernel besides it.

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Constants, Extent, Gpu, Kernel, Pass, WORKGROUP, group_counts};
use crate::structure::{numbers, structure, wgsl_numbers};

/// Levels at most, the finest included.
pub const LEVELS: usize = 12;
use self::LEVELS as PCG_LEVELS;

numbers! {
    /// Whose group counts an iteration has.
    Groups {
        /// One thread per slot.
        Slots,
        /// Groups that stride and leave partial sums.
        Partial,
        /// One thread per entry of the caller's list.
        Near,
        /// [`super::Block`].
        Block,
        /// Residual and direction, one after the other.
        Apart,
        /// Both at once.
        Joined,
        /// The finest level; the others follow.
        Level,
    }
}

/// What a solve may have come to, from 0.
const OUTCOMES: [&str; 3] = ["RUNNING", "CONVERGED", "STALLED"];
/// Numbers of the group counts of an iteration.
pub(crate) const EXTENTS: usize = 4 * (Groups::Level as usize + LEVELS);

/// The vectors of one system.
#[derive(Debug)]
pub struct PcgVectors {
    /// The solution, from zero, where it is a step behind: add [`PcgControl::alpha`] times the direction.
    pub solution: Buffer<f32>,
    /// Right-hand side at the start, residual after.
    pub residual: Buffer<f32>,
    /// Search direction: what the operator is applied to.
    pub direction: Buffer<f32>,
    /// Operator times direction; before the first iteration the vector whose norm the tolerance refers to, unless the caller sums that up.
    pub product: Buffer<f32>,
    /// Inverse of the diagonal; 0 for unknowns that are not used.
    pub inverse_diagonal: Buffer<f32>,
}

impl PcgVectors {
    /// Allocates vectors of one length.
    ///
    /// # Errors
    /// If the device has no room.
    pub fn new(gpu: &Gpu, length: usize) -> Result<Self> {
        Ok(Self {
            solution: Buffer::new(gpu, "solution", length)?,
            residual: Buffer::new(gpu, "residual", length)?,
            direction: Buffer::new(gpu, "direction", length)?,
            product: Buffer::new(gpu, "product", length)?,
            inverse_diagonal: Buffer::new(gpu, "inverse_diagonal", length)?,
        })
    }
}

structure! {
    /// Scalars of a solve.
    #[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
    pub PcgControl as "Pcg" {
        /// r . z, z the preconditioner times r.
        rho: f32,
        /// Step length.
        alpha: f32,
        /// Weight of the old direction.
        beta: f32,
        /// Squared norm that the tolerance refers to.
        reference: f32,
        /// Relative tolerance.
        tolerance: f32,
        /// Iterations so far.
        iterations: u32,
        /// Iterations after which the solve counts as stalled.
        max_iterations: u32,
        /// PCG_RUNNING, PCG_CONVERGED, PCG_STALLED.
        outcome: u32,
        /// Unknowns.
        length: u32,
        /// Groups of kernels over a list that the caller keeps, x.
        near_wide: u32,
        /// The same, y.
        near_high: u32,
        /// Groups of the kernels with one thread per slot, x.
        groups_wide: u32,
        /// The same, y.
        groups_high: u32,
        /// Groups of the kernels that leave partial sums.
        groups_partial: u32,
        /// Groups, at most as many, of the kernels of [`Block`].
        groups_block: u32,
        /// Its first unknown.
        block_at: u32,
        /// Its unknowns, now.
        block_length: u32,
        /// r . D^-1 r, and r . z of [`Block`]: what the tolerance looks at.
        size: f32,
        /// A solve that begins with a larger one is not worth it: it ends with nothing done.
        most: f32,
        /// Coarse levels in use.
        levels: u32,
        /// 1 for [`Dots::Both`].
        joined: u32,
        /// Unknowns of a row, as sums take them.
        row: u32,
        /// Place of the partial sums for the reference, 0 if `pcg_begin` makes them from `product`.
        reference_at: u32,
        /// Place of the partial sums that the operator leaves.
        dots_at: u32,
        /// Groups, at most as many as leave partial sums, of the kernels of each level, the finest first; 0 without.
        level_groups: [u32; PCG_LEVELS],
    }
}

/// The iteration.
#[derive(Debug)]
pub struct Pcg {
    /// Scalars on the device.
    pub control: Buffer<PcgControl>,
    /// Group counts of an iteration: per slot, partial sums, single.
    pub(crate) extents: Buffer<u32>,
    begin: [Bound; 2],
    update: Bound,
    beta: Bound,
    direction: Bound,
    /// Update and direction at once, for [`Dots::Both`].
    step: Option<Bound>,
}

/// What an operator leaves in `partials`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dots {
    /// direction . product, in the first component.
    Product,
    /// In the second component product . D^-1 product, too; such a solve has no [`Block`].
    Both,
}

/// How the kernels share the unknowns out.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Threads of operators with one per slot.
    pub threads: usize,
    /// Groups of the kernels that leave partial sums.
    pub groups: u32,
    /// What the operator leaves.
    pub dots: Dots,
    /// Place above 0 in the partial sums where the caller leaves, in the second component, those of the squared norm that the
    /// tolerance refers to; with 0 the first kernel makes them from [`PcgVectors::product`].
    pub reference_at: u32,
    /// Place in the partial sums, behind those of the other kernels, where the operator leaves its own.
    pub dots_at: u32,
    /// The first unknown of a [`Block`].
    pub block_at: u32,
    /// Unknowns of a row, as sums take them (`shaders/shared/pcg.wgsl`); all make one row without it.
    pub row: Option<u32>,
}

/// A block of unknowns with a preconditioner of its own; their inverse diagonal is 0. The caller sets
/// [`PcgControl::groups_block`] and [`PcgControl::block_length`]; the kernels stride over what their groups do not cover.
#[derive(Clone, Copy, Debug, Default)]
pub struct Block<'a> {
    /// Turn the residual into z, in order; the last one leaves z in [`PcgVectors::product`] and adds z . r to the partial sums.
    pub terms: &'a [Bound],
    /// The same before the first iteration, for [`PcgVectors::direction`].
    pub begin: &'a [Bound],
    /// Whether there is a single one, of one group, which sees for itself whether there is something to do.
    pub together: bool,
    /// Whether that one opens and ends the iterations, too; not with [`Levels`].
    pub ends: bool,
}

/// Coarse levels, which add to what the diagonal gives. The caller sets [`PcgControl::level_groups`] before the iteration begins.
#[derive(Clone, Copy, Debug, Default)]
pub struct Levels<'a> {
    /// Take the residual down, from level 1 on; each adds its share of z . r to the third of the partial sums.
    pub down: &'a [Bound],
    /// Take z up; the one of the finest level, which comes first here and last in time, adds to the direction.
    pub up: &'a [Bound],
    /// Group counts of every level before the first iteration, and the entry of the finest one.
    pub opened: Option<(&'a Buffer<u32>, u64)>,
}

impl Levels<'_> {
    fn record_down(&self, pass: &mut Pass, table: &Buffer<u32>, first: u64) {
        for (level, kernel) in (first + 1..).zip(self.down) {
            pass.dispatch(kernel, &Extent::Indirect(table, 16 * level));
        }
    }

    fn record_up(&self, pass: &mut Pass, table: &Buffer<u32>, first: u64) {
        for (level, kernel) in (first..).zip(self.up).collect::<Vec<_>>().into_iter().rev() {
            pass.dispatch(kernel, &Extent::Indirect(table, 16 * level));
        }
    }
}

impl Pcg {
    /// Changes the relative tolerance, from the next solve on.
    pub fn set_tolerance(&self, gpu: &Gpu, tolerance: f32) {
        let place = std::mem::offset_of!(PcgControl, tolerance) as u64;
        gpu.queue.write_buffer(self.control.raw(), place, &tolerance.to_ne_bytes());
    }

    /// Prepares a system.
    pub fn new(
        gpu: &Gpu,
        vectors: &PcgVectors,
        partials: &Buffer<[f32; 4]>,
        limits: (f32, u32),
        layout: &Layout,
    ) -> Result<Self> {
        let dots = layout.dots;
        let length = vectors.solution.len();
        let control = Buffer::new(gpu, "pcg", 1)?;
        let [wide, high, _] = group_counts((layout.threads as u64).div_ceil(u64::from(WORKGROUP)));
        let start = PcgControl {
            tolerance: limits.0,
            max_iterations: limits.1,
            length: length as u32,
            groups_wide: wide,
            groups_high: high,
            groups_partial: layout.groups,
            outcome: 1,
            most: f32::MAX,
            joined: u32::from(dots == Dots::Both),
            row: layout.row.unwrap_or(length as u32),
            reference_at: layout.reference_at,
            dots_at: layout.dots_at,
            block_at: layout.block_at,
            ..PcgControl::default()
        };
        control.write(gpu, 0, &[start]);
        let extents = Buffer::indirect(gpu, "pcg_extents", EXTENTS)?;
        let named = [
            ("pcg", control.raw()),
            ("solution", vectors.solution.raw()),
            ("residual", vectors.residual.raw()),
            ("direction", vectors.direction.raw()),
            ("product", vectors.product.raw()),
            ("inverse_diagonal", vectors.inverse_diagonal.raw()),
            ("partials", partials.raw()),
            ("pcg_extents", extents.raw()),
        ];
        let constants = source();
        let bound = |entry: &str| -> Result<Bound> {
            let constants = Constants { overrides: &[], source: &constants };
            let kernel = Kernel::new(gpu, "numerics/linear_algebra.wgsl", entry, &constants)?;
            let used = |name: &str| kernel.bindings().iter().any(|binding| binding.name == name);
            let buffers: Vec<_> = named.iter().copied().filter(|(name, _)| used(name)).collect();
            kernel.bind(gpu, &buffers)
        };
        Ok(Self {
            begin: [bound("pcg_begin")?, bound("pcg_begin_choose")?],
            update: bound("pcg_update")?,
            beta: bound("pcg_beta")?,
            direction: bound("pcg_direction")?,
            step: (dots == Dots::Both).then(|| bound("pcg_step")).transpose()?,
            control,
            extents,
        })
    }

    /// Takes `residual` as right-hand side and opens the iteration. The extents gate the dispatches: kernels that leave partial sums,
    /// those of one group, those of the block.
    pub fn begin(
        &self,
        pass: &mut Pass,
        [partial, single, own]: &[Extent<'_>; 3],
        block: &Block<'_>,
        levels: &Levels<'_>,
    ) {
        pass.dispatch(&self.begin[0], partial);
        for term in block.begin {
            pass.dispatch(term, if block.together { single } else { own });
        }
        if let Some((table, first)) = levels.opened {
            levels.record_down(pass, table, first);
        }
        if !block.ends {
            pass.dispatch(&self.begin[1], single);
        }
        if let Some((table, first)) = levels.opened {
            levels.record_up(pass, table, first);
        }
    }

    /// Records one iteration: nothing happens on the device once the solve is done.
    pub fn iterate(&self, pass: &mut Pass, operator: &[(&Bound, Groups)], block: &Block<'_>, levels: &Levels<'_>) {
        let extent = |groups: Groups| Extent::Indirect(&self.extents, 16 * groups as u64);
        for (kernel, groups) in operator {
            pass.dispatch(kernel, &extent(*groups));
        }
        if let Some(step) = &self.step {
            pass.dispatch(step, &extent(Groups::Joined));
        }
        let apart = self.step.is_none() || levels.opened.is_some();
        if apart {
            pass.dispatch(&self.update, &extent(Groups::Apart));
        }
        let always = Extent::Groups([1, 1, 1]);
        let gated = extent(Groups::Block);
        for term in block.terms {
            pass.dispatch(term, if block.together { &always } else { &gated });
        }
        levels.record_down(pass, &self.extents, Groups::Level as u64);
        if !block.ends {
            pass.dispatch(&self.beta, &always);
        }
        if apart {
            pass.dispatch(&self.direction, &extent(Groups::Apart));
        }
        levels.record_up(pass, &self.extents, Groups::Level as u64);
    }
}

/// WGSL constants that other shaders need to read the outcome of a solve.
pub fn source() -> String {
    let mut text = wgsl_numbers("PCG", &OUTCOMES) + &Groups::wgsl("PCG");
    text.push_str(&format!("const PCG_LEVELS = {LEVELS}u;\n"));
    text
}
