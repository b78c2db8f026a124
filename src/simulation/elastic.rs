//! The elastic part of a step.

use super::Simulation;
use crate::gpu::Pass;
use crate::stage::Decision;
use crate::state::Phase;
use crate::state::stages::Stage;

impl Simulation {
    /// Keeps what the pressure solve knows of the elastic force of the present stress.
    pub(super) fn record_force(&self, pass: &mut Pass) {
        pass.stage(Stage::ElasticForce.name());
        if let Some(elastic_reaction) = &self.elastic_reaction {
            elastic_reaction.record_start(pass, &self.state);
        }
        if let Some(elastic_first) = &self.elastic_first {
            elastic_first.record_start(pass, &self.state);
        }
    }

    /// Elasticity: one implicit step, or explicit sub-steps.
    pub(super) fn record_elastic(&self, pass: &mut Pass) {
        if let (Some(elastic_solve), Some(g2p)) = (&self.elastic_solve, &self.g2p) {
            for _ in 0..self.recorded.rounds {
                elastic_solve.record_round(pass, &self.state, self.recorded.round_iterations);
            }
            self.time_step.decide(pass, Decision::Substep);
            elastic_solve.record_finish(pass, &self.state);
            g2p.record(pass, &self.state);
            elastic_solve.record_balance(pass, &self.state);
            return;
        }
        if self.state.has_solids() {
            (0..self.recorded.substeps).for_each(|substep| self.record_substep(pass, substep));
        }
    }

    /// One elastic sub-step. The first recorded one, which `Decision::Solved` opens, may be the first of a step or the continuation of a
    /// long one.
    fn record_substep(&self, pass: &mut Pass, recorded: u32) {
        let state = &self.state;
        if recorded > 0 {
            self.time_step.decide(pass, Decision::Substep);
        }
        let stages = (&self.particle_sort, &self.p2g, &self.mpm_grid_update, &self.g2p);
        let (Some(particle_sort), Some(p2g), Some(mpm_grid_update), Some(g2p)) = stages else { return };
        if let Some(elastic_first) = &self.elastic_first {
            elastic_first.record_substep(pass, state);
            g2p.record(pass, state);
            return;
        }
        if recorded == 0 {
            p2g.record_substep(pass, state, true);
        } else {
            particle_sort.record(pass, state); // before the first recorded one the step did
        }
        p2g.record_substep(pass, state, false);
        self.record_held(pass, Phase::Again);
        if let Some(elastic_reaction) = &self.elastic_reaction {
            elastic_reaction.record_substep(pass, state);
        }
        mpm_grid_update.record(pass, state);
        g2p.record(pass, state);
    }
}
