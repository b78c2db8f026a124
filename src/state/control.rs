//! What the device decides about a run.

use bytemuck::{Pod, Zeroable};

use crate::structure::structure;
use crate::structure::types::atomic_u32;

structure! {
    /// What the device decides: time step, phase, failure, counts.
    #[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
    pub Control as "Control" {
        /// What one solve spans \[s\].
        dt: f32,
        /// Current step: `dt`, or with two solves the span of both \[s\].
        duration: f32,
        /// The step before \[s\].
        dt_previous: f32,
        /// Time left to the target \[s\].
        remaining: f32,
        /// PHASE_IDLE, PHASE_SOLVE, PHASE_BETWEEN, PHASE_SUBSTEP, PHASE_ELASTIC.
        phase: u32,
        /// Elastic sub-steps of this step.
        substeps: u32,
        /// Next one to run.
        substep: u32,
        /// Solves of this step that are done.
        stage: u32,
        /// Finished steps.
        step: u32,
        /// Smallest stage << 27 | slot that met an impossible value; NO_FAULT if none.
        fault: atomic_u32,
        /// Cells where the flux limiter acted in each stage of the advection; last vertices whose gas could not pay for all that they
        /// asked, this step.
        limited: [atomic_u32; 4],
        /// Sum of the first three when a stage ended.
        limited_before: u32,
        /// Cells where the energy floor acted, this step.
        floored: atomic_u32,
        /// 1 if the energy floor may have to act deep inside the gas.
        cold: atomic_u32,
        /// Cells whose pressure had to be raised before one of two solves, this step.
        raised: atomic_u32,
        /// Cells whose products are denser than their law allows, this step.
        dense: atomic_u32,
        /// Particles held back at a wall, this step.
        clamped: atomic_u32,
        /// 1 if a particle may have left its cell since they were sorted.
        unsorted: atomic_u32,
        /// Particles that left through an open side or were dropped as debris, since the start.
        escaped: atomic_u32,
        /// Vertices that carry P, h and Q apart, this step.
        extra: u32,
        /// Iterations of all solves of the last step.
        iterations: u32,
        /// Relative residual of the last solve.
        residual: f32,
        /// Slots that are not INTERIOR.
        listed: u32,
        /// INTERIOR slots whose nodes listed vertices rest on.
        frontier: u32,
        /// Of the eigenvalues of the preconditioner of interface pressures an upper bound, bits of a number.
        surface_bound: atomic_u32,
        /// Largest speed of sound at the end of the step \[m s^-1\].
        sound: f32,
        /// Simulated time at the start of the step \[s\].
        time: f32,
        /// What rounding has taken from it so far \[s\].
        time_error: f32,
        /// Rounds of Newton's method in the elastic solve, this step.
        rounds: u32,
        /// 1 while the linear system of a round is being solved.
        round_open: u32,
        /// Nodes that a wall has begun to stop in this round.
        newly_held: atomic_u32,
        /// Iterations of all rounds, this step.
        elastic_iterations: u32,
        /// Iterations of the longest one.
        longest_round: u32,
        /// r . D^-1 r at the start of this round.
        imbalance: f32,
        /// Momentum and energy that the energy floor has taken from gas cells that have no ledger entry, since the start: each a number
        /// of 64 bits, the low half first, in 2^-32 of a unit.
        borrowed: [atomic_u32; 8],
    }
}

impl Control {
    /// [`Control::borrowed`] in its units: momentum, energy.
    pub fn borrowed(&self) -> [f64; 4] {
        std::array::from_fn(|k| {
            let [low, high] = [self.borrowed[2 * k], self.borrowed[2 * k + 1]].map(u64::from);
            ((high << 32) | low).cast_signed() as f64 / 2f64.powi(32)
        })
    }
}
