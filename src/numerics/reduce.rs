//! Sum, minimum or maximum of an array of f32, in an order that depends on its length only.

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Constants, Extent, Gpu, Kernel, Pass, WORKGROUP};

/// What a [`Reduce`] computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Sum; zero if there is nothing.
    Sum,
    /// Minimum; the largest finite f32 if there is nothing. Values are finite.
    Min,
    /// Maximum; the most negative finite f32 if there is nothing. Values are finite.
    Max,
}

/// Workgroups of the first pass at most: enough threads for a large GPU, few enough partial results for one workgroup.
const MAX_GROUPS: u32 = 1024;

/// Reduces one buffer to one number in two dispatches.
#[derive(Debug)]
pub struct Reduce {
    result: Buffer<f32>,
    many: Bound,
    one: Bound,
    groups: u32,
}

impl Reduce {
    /// Prepares the reduction of the first `count` elements of `values`.
    ///
    /// # Errors
    /// Those of [`Buffer::new`] and [`Kernel::new`].
    pub fn new(gpu: &Gpu, operator: Operator, values: &Buffer<f32>, count: u32) -> Result<Reduce> {
        let entry = match operator {
            Operator::Sum => "reduce_sum",
            Operator::Min => "reduce_min",
            Operator::Max => "reduce_max",
        };
        let kernel = Kernel::new(gpu, "numerics/reduce.wgsl", entry, &Constants::default())?;
        let groups = count.div_ceil(WORKGROUP).clamp(1, MAX_GROUPS);
        let partial = Buffer::<f32>::new(gpu, "reduce partial results", groups as usize)?;
        let result = Buffer::<f32>::new(gpu, "reduce result", 1)?;
        let bind = |count: u32, groups: u32, values: &Buffer<f32>, result: &Buffer<f32>| {
            let params = Buffer::<u32>::uniform(gpu, "reduce count", 2)?;
            params.write(gpu, 0, &[count, groups * WORKGROUP]);
            kernel.bind(gpu, &[("params", params.raw()), ("values", values.raw()), ("result", result.raw())])
        };
        let many = bind(count, groups, values, &partial)?;
        let one = bind(groups, 1, &partial, &result)?;
        Ok(Reduce { result, many, one, groups })
    }

    /// Records both dispatches.
    pub fn record(&self, pass: &mut Pass) {
        pass.dispatch(&self.many, &Extent::Groups([self.groups, 1, 1]));
        pass.dispatch(&self.one, &Extent::Groups([1, 1, 1]));
    }

    /// Where the number arrives: one element.
    pub fn result(&self) -> &Buffer<f32> {
        &self.result
    }
}
