//! `elastic_solve`: which node velocities balance the elastic force at the end of the step? Backward Euler by Newton's method, each of
//! its linear systems matrix-free by conjugate gradients: `numerics.elasticity = "implicit"`. [Gast et al. 2015]

use super::p2g::Force;
use crate::error::Result;
use crate::gpu::{Bound, Extent, Pass};
use crate::numerics::{Block, Dots, Groups, Layout, Levels, Pcg, PcgVectors};
use crate::scene::{Elasticity, Scene};
use crate::stage::Transfer;
use crate::state::constants::{BLOCK_DOTS, PARTIALS};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Iterations of one linear system at most: a system that needs more is left where it is, and the next round goes on from there.
pub const MAX_ITERATIONS: u32 = 300;

/// Kernels of the stage.
#[derive(Debug)]
pub struct ElasticSolve {
    pcg: Pcg,
    round: [Bound; 3],
    keep: Bound,
    ghost: Bound,
    trial: Bound,
    force: Force,
    diagonal: Bound,
    residual: Bound,
    strain: Bound,
    /// Carries the stress change to the nodes.
    change: Force,
    operator: Bound,
    add: Bound,
    finish: Bound,
    balance: [Bound; 3],
}

impl ElasticSolve {
    /// Binds, if the scene wants it.
    pub fn new(state: &State, scene: &Scene, transfer: Transfer) -> Result<Option<Self>> {
        let gpu = &state.gpu;
        let Some(own) = state.elastic_solve.as_ref().filter(|_| scene.numerics.elasticity == Elasticity::Implicit)
        else {
            return Ok(None);
        };
        let limits = (scene.numerics.expert.elastic_tolerance as f32, MAX_ITERATIONS);
        let (threads, groups) = (state.grid.slots(), state.params.groups);
        let dots_at = PARTIALS * BLOCK_DOTS;
        let layout = Layout { threads, groups, dots: Dots::Product, reference_at: 0, dots_at, block_at: 0, row: None };
        let pcg = Pcg::new(gpu, &own.vectors, &state.partials, limits, &layout)?;
        let PcgVectors { solution, residual, direction, product, inverse_diagonal } = &own.vectors;
        let renamed = [
            ("solution", solution.raw()),
            ("residual", residual.raw()),
            ("direction", direction.raw()),
            ("product", product.raw()),
            ("inverse_diagonal", inverse_diagonal.raw()),
            ("change", own.change.raw()),
            ("portions", own.portions.raw()),
            ("missing", own.missing.raw()),
            ("pcg", pcg.control.raw()),
        ];
        let bind = |shader: &str, entry: &str| state.bind(shader, entry, &renamed, &[]);
        let solve = |entry: &str| bind("solid/elastic_solve.wgsl", entry);
        let operator = |entry: &str| bind("solid/elastic_operator.wgsl", entry);
        let control = |entry: &str| bind("solid/elastic_control.wgsl", entry);
        let balance = |entry: &str| bind("solid/elastic_balance.wgsl", entry);
        Ok(Some(Self {
            round: [control("control_round")?, control("control_iteration")?, control("control_balanced")?],
            keep: solve("elastic_keep")?,
            ghost: solve("elastic_ghost")?,
            trial: solve("elastic_trial")?,
            force: Force::new(state, transfer, state.particles.stress.raw())?,
            diagonal: solve("elastic_diagonal")?,
            residual: solve("elastic_residual")?,
            strain: operator("elastic_strain")?,
            change: Force::new(state, transfer, own.change.raw())?,
            operator: operator("elastic_operator")?,
            add: operator("elastic_add")?,
            finish: solve("elastic_finish")?,
            balance: [balance("elastic_missing")?, balance("elastic_missing_bodies")?, balance("elastic_give")?],
            pcg,
        }))
    }

    /// One round of Newton's method. A round that needs more than the recorded iterations goes on in the next recording, and so does
    /// a step that needs more rounds.
    pub fn record_round(&self, pass: &mut Pass, state: &State, iterations: u32) {
        pass.stage(Stage::ElasticSolve.name());
        let single = Extent::Groups([1, 1, 1]);
        let [round, iteration, balanced] = &self.round;
        pass.dispatch(round, &single);
        pass.dispatch(&self.keep, &state.extent(Phase::First, Over::Slots));
        pass.dispatch(&self.ghost, &state.extent(Phase::First, Over::Particles));
        pass.dispatch(&self.trial, &state.extent(Phase::Round, Over::Particles));
        self.force.record(pass, state, Phase::Round);
        pass.dispatch(&self.diagonal, &state.extent(Phase::Round, Over::Slots));
        pass.dispatch(&self.residual, &state.extent(Phase::Round, Over::Slots));
        let extents = [Over::Reduce, Over::Single, Over::Surface].map(|entry| state.extent(Phase::Round, entry));
        self.pcg.begin(pass, &extents, &Block::default(), &Levels::default());
        for _ in 0..iterations {
            pass.dispatch(iteration, &single);
            pass.dispatch(&self.strain, &state.extent(Phase::Iteration, Over::Particles));
            self.change.record(pass, state, Phase::Iteration);
            self.pcg.iterate(pass, &[(&self.operator, Groups::Partial)], &Block::default(), &Levels::default());
        }
        pass.dispatch(balanced, &single);
        pass.dispatch(&self.add, &state.extent(Phase::Round, Over::Slots));
    }

    /// Walls and what they give, once the velocities are found; and what is missing from the momentum of bodies.
    pub fn record_finish(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::ElasticSolve.name());
        let [missing, bodies, _] = &self.balance;
        pass.dispatch(&self.finish, &state.extent(Phase::Substep, Over::Reduce));
        pass.dispatch(missing, &state.extent(Phase::Substep, Over::Reduce));
        pass.dispatch(bodies, &state.extent(Phase::Substep, Over::Single));
    }

    /// That momentum, to the particles once they have moved.
    pub fn record_balance(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::ElasticSolve.name());
        pass.dispatch(&self.balance[2], &state.extent(Phase::Substep, Over::Particles));
    }
}
