//! `g2p`: how do the particles move and deform? [Jiang et al. 2015; Cao et al. 2022, step 7]

use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;

/// Kernels of the stage.
#[derive(Debug)]
pub struct G2p {
    g2p: Bound,
}

impl G2p {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        Ok(Self { g2p: state.bind(gpu, "g2p.wgsl", "g2p", &[], &[])? })
    }

    /// One sub-step of the particles.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage("g2p");
        pass.dispatch(&self.g2p, &extent(state, "SUBSTEP", Entry::Particles));
    }
}
