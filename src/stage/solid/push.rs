//! `push`: the same change of velocity for all that is free of a body, or another density for all of it. No part of a step: it runs between two of them, when the user asks.

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Extent, Pass, readback};
use crate::state::State;
use crate::structure::structure;
use crate::structure::types::vec3f;

structure! {
    /// A body, and what its velocity changes by; or its density.
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
    weigh: Bound,
}

impl Push {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let shove = Buffer::uniform(&state.gpu, "push", 1)?;
        let bind = |entry: &str| state.bind("solid/push.wgsl", entry, &[("push", shove.raw())], &[]);
        let (sums, change, weigh) = (bind("push_sums")?, bind("push_change")?, bind("push_weigh")?);
        Ok(Self { shove, sums, change, weigh })
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

    /// Gives all of it another density \[kg m^-3\].
    ///
    /// # Errors
    /// Driver errors.
    pub fn weigh(&self, state: &State, body: u32, density: f64) -> Result<()> {
        self.submit(state, &self.weigh, Shove { body, change: [density as f32, 0.0, 0.0] })
    }

    fn submit(&self, state: &State, kernel: &Bound, shove: Shove) -> Result<()> {
        self.shove.write(&state.gpu, 0, &[shove]);
        let mut pass = Pass::new(&state.gpu, "push");
        pass.dispatch(kernel, &Extent::Groups([state.params.groups, 1, 1]));
        pass.submit().map(drop)
    }

    fn run(&self, state: &State, kernel: &Bound, shove: Shove) -> Result<[f64; 4]> {
        let (gpu, groups) = (&state.gpu, state.params.groups);
        self.submit(state, kernel, shove)?;
        let parts = readback::read_range(gpu, &state.partials, 0, groups as usize)?;
        Ok(std::array::from_fn(|k| parts.iter().map(|part| f64::from(part[k])).sum()))
    }
}
