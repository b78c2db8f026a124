//! What the device decides about a run.

use bytemuck::{Pod, Zeroable};

/// Mirror of `Control` in `shaders/shared/control.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Control {
    /// What one solve spans \[s\].
    pub dt: f32,
    /// Current step: `dt`, or with two solves the span of both \[s\].
    pub duration: f32,
    /// The step before \[s\].
    pub dt_previous: f32,
    /// Time left to the target \[s\].
    pub remaining: f32,
    /// 0 idle, 1 solving, 2 between two solves, 3 sub-stepping, 4 in the elastic solve.
    pub phase: u32,
    /// Elastic sub-steps of this step.
    pub substeps: u32,
    /// Next one to run.
    pub substep: u32,
    /// Solves of this step that are done.
    pub stage: u32,
    /// Finished steps.
    pub step: u32,
    /// Smallest stage << 27 | slot that met an impossible value.
    pub fault: u32,
    /// Cells where the flux limiter acted, and vertices whose gas could not pay for all that they asked, this step.
    pub limited: u32,
    /// The same when the first advection stage ended.
    pub limited_before: u32,
    /// Cells where the energy floor acted, this step.
    pub floored: u32,
    /// 1 if the energy floor may have to act deep inside the gas.
    pub cold: u32,
    /// Cells whose pressure had to be raised before one of two solves, this step.
    pub raised: u32,
    /// Particles held back at a wall, this step.
    pub clamped: u32,
    /// 1 if a particle may have left its cell since they were sorted.
    pub unsorted: u32,
    /// Particles that left through an open side, since the start.
    pub escaped: u32,
    /// Vertices that carry P, h and Q apart, this step.
    pub extra: u32,
    /// Iterations of all solves of the last step.
    pub iterations: u32,
    /// Relative residual of the last solve.
    pub residual: f32,
    /// Slots that are not INTERIOR.
    pub listed: u32,
    /// INTERIOR slots whose nodes listed vertices rest on.
    pub frontier: u32,
    /// Runs of slots that are awake.
    pub runs: u32,
    /// Runs of the list of the other slots, as far as they are awake.
    pub list_runs: u32,
    /// Largest speed of sound at the end of the step \[m s^-1\].
    pub sound: f32,
    /// Iterations that the solve of this step may take while some sleep.
    pub reach: u32,
    /// 1 if all slots are awake, because the solve of this step took many iterations or the host has changed the gas.
    pub woken: u32,
    /// The same in the step before.
    pub woken_before: u32,
    /// Simulated time at the start of the step \[s\].
    pub time: f32,
    /// What rounding has taken from it so far \[s\].
    pub time_error: f32,
    /// Rounds of Newton's method in the elastic solve, this step.
    pub rounds: u32,
    /// 1 while the linear system of a round is being solved.
    pub round_open: u32,
    /// Nodes that a wall has begun to stop in this round.
    pub newly_held: u32,
    /// Iterations of all rounds, this step.
    pub elastic_iterations: u32,
    /// Iterations of the longest one.
    pub longest_round: u32,
    /// Norm of the imbalance at the start of this round, squared.
    pub imbalance: f32,
    /// Momentum and energy that the energy floor has taken from gas cells that have no books of their own, since the start: each a number
    /// of 64 bits, the low half first, in 2^-32 of a unit.
    pub borrowed: [u32; 8],
}

impl Control {
    /// [`Control::borrowed`] in its units: momentum, energy.
    #[must_use]
    pub fn borrowed(&self) -> [f64; 4] {
        std::array::from_fn(|k| {
            let [low, high] = [self.borrowed[2 * k], self.borrowed[2 * k + 1]].map(u64::from);
            ((high << 32) | low).cast_signed() as f64 / 2f64.powi(32)
        })
    }
}
