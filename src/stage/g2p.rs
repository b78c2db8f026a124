//! `g2p`: how do the particles move and deform? [Jiang et al. 2015; Cao et al. 2022, step 7]

use super::{Parts, Transfer, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// How nodes reach particles.
#[derive(Debug)]
enum Form {
    /// Each particle reads its nodes.
    Particles(Bound),
    /// Each cell reads its nodes for all its particles, then each particle goes on.
    Cells([Bound; 2]),
}

/// Kernels of the stage.
#[derive(Debug)]
pub struct G2p {
    form: Form,
}

impl G2p {
    /// Binds the form that goes with the one of `p2g`: [`Transfer::Columns`] works cell by cell.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, transfer: Transfer) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let bind = |entry: &str| state.bind(gpu, "g2p.wgsl", entry, &[], &[]);
        let form = match transfer {
            Transfer::Columns => Form::Cells([bind("g2p_cells")?, bind("g2p_particles")?]),
            Transfer::Nodes => Form::Particles(bind("g2p")?),
        };
        Ok(Self { form })
    }

    /// One sub-step of the particles.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::G2p.name());
        match &self.form {
            Form::Particles(g2p) => pass.dispatch(g2p, &extent(state, "SUBSTEP", Entry::Particles)),
            Form::Cells([cells, particles]) => {
                pass.dispatch(cells, &extent(state, "SUBSTEP", Entry::Slots));
                pass.dispatch(particles, &extent(state, "SUBSTEP", Entry::Particles));
            }
        }
    }
}
