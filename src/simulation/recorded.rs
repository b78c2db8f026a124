//! How much of each loop of a step is recorded at a time.

use crate::diagnostics::StepRecord;
use crate::stage::MAX_ELASTIC_ITERATIONS;
use crate::state::State;
use crate::state::constants::MAX_ROUNDS;

/// Elastic sub-steps that are recorded at a time.
const MOST_SUBSTEPS: u32 = 64;
/// Iterations that a file may ask to be recorded at a time.
const MOST_RECORDED: u32 = 4096;

/// What is recorded per step; a step that needs more goes on in the next recording.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorded {
    /// Of the pressure solve, per solve.
    pub(super) iterations: u32,
    /// Elastic sub-steps.
    pub(super) substeps: u32,
    /// Of the implicit elastic step.
    pub(super) rounds: u32,
    /// In each of them.
    pub(super) round_iterations: u32,
}

impl Recorded {
    /// Before the solver's habit is known.
    pub(super) const FIRST: Self = Self { iterations: 12, substeps: 1, rounds: 3, round_iterations: 12 };

    /// As numbers, for files.
    pub(super) fn numbers(self) -> [u32; 4] {
        [self.iterations, self.substeps, self.rounds, self.round_iterations]
    }

    /// From numbers that a file holds.
    pub(super) fn of(numbers: [u32; 4]) -> Self {
        let [iterations, substeps, rounds, round_iterations] = numbers.map(|n| n.clamp(1, MOST_RECORDED));
        Self { iterations, substeps: substeps.min(MOST_SUBSTEPS), rounds: rounds.min(MAX_ROUNDS), round_iterations }
    }

    /// What the newest steps took, and twice as much of everything if a step was left unfinished.
    pub(super) fn next(self, newest: &[StepRecord], unfinished: bool, solves: u32, state: &State) -> Self {
        let most = |of: fn(&StepRecord) -> u32| newest.iter().map(of).fold(1, u32::max);
        let enough = |took: u32, now: u32| if unfinished { took.max(2 * now) } else { took };
        let iterations = enough(most(|record| record.iterations).div_ceil(solves) + 2, self.iterations);
        let substeps = enough(most(|record| record.substeps), self.substeps)
            .min(state.params.max_substeps.clamp(1, MOST_SUBSTEPS));
        let round_iterations = enough(most(|record| record.longest_round) + 2, self.round_iterations);
        Self {
            iterations: iterations.min(state.params.max_iterations + 1),
            substeps: if state.has_solids() { substeps } else { 1 },
            rounds: enough(most(|record| record.rounds), self.rounds).min(MAX_ROUNDS),
            round_iterations: round_iterations.min(MAX_ELASTIC_ITERATIONS + 1),
        }
    }
}
