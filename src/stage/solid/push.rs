//! `push`: the same change of velocity for all that is free of a body. No part of a step: it runs between two of them, when the user asks.

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Extent, Pass, readback};
use crate::state::State;
use crate::structure::structure;
use crate::structure::types::vec3f;

structure! {
    /// A body, and what its velocity changes by.
    #[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
    pub(crate) Shove as "Push" {
        /// \[m s^-1\]
        change: vec3f,
        /// Number of the body.
        body: u32,
    }
}

/// Kernels of a push.
#[derive(Debug)]
pub struct Push {
    shove: Buffer<Shove>,
    sums: Bound,
    change: Bound,
}

impl Push {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let shove = Buffer::uniform(&state.gpu, "push", 1)?;
        let bind = |entry: &str| state.bind("solid/push.wgsl", entry, &[("push", shove.raw())], &[]);
        let (sums, change) = (bind("push_sums")?, bind("push_change")?);
        Ok(Self { shove, sums, change })
    }

    /// Momentum \[kg m s^-1\] and mass \[kg\] of what of a body is inside the domain and moves by itself.
    ///
    /// # Errors
    /// Driver errors.
    pub fn moving(&self, state: &State, body: u32) -> Result<[f64; 4]> {
        self.run(state, &self.sums, Shove { body, ..Shove::default() })
    }

    /// Changes its velocity by so much \[m s^-1\] everywhere. Returns the momentum \[kg m s^-1\] and the energy \[J\] that it was given, as the
    /// device rounds them.
    ///
    /// # Errors
    /// Driver errors.
    pub fn change(&self, state: &State, body: u32, change: [f64; 3]) -> Result<[f64; 4]> {
        self.run(state, &self.change, Shove { body, change: change.map(|part| part as f32) })
    }

    fn run(&self, state: &State, kernel: &Bound, shove: Shove) -> Result<[f64; 4]> {
        let (gpu, groups) = (&state.gpu, state.params.groups);
        self.shove.write(gpu, 0, &[shove]);
        let mut pass = Pass::new(gpu, "push");
        pass.dispatch(kernel, &Extent::Groups([groups, 1, 1]));
        pass.submit()?;
        let parts = readback::read_range(gpu, &state.partials, 0, groups as usize)?;
        Ok(std::array::from_fn(|k| parts.iter().map(|part| f64::from(part[k])).sum()))
    }
}
