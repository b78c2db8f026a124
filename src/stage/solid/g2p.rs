//! `g2p`: how do the particles move and deform? [Jiang et al. 2015; Cao et al. 2022, step 7]

use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::stage::Transfer;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

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
    pub fn new(state: &State, transfer: Transfer) -> Result<Self> {
        let bind = |entry: &str| state.bind("solid/g2p.wgsl", entry, &[], &[]);
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
            Form::Particles(g2p) => pass.dispatch(g2p, &state.extent(Phase::Substep, Over::Particles)),
            Form::Cells([cells, particles]) => {
                pass.dispatch(cells, &state.extent(Phase::Substep, Over::Slots));
                pass.dispatch(particles, &state.extent(Phase::Substep, Over::Particles));
            }
        }
    }
}
