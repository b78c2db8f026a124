// What the device decides about the run: time step, phase, failure, counts.

// Generated from src/state/control.rs by scripts/generate.
struct Control {
    dt: f32,                    // What one solve spans [s]
    duration: f32,              // Current step: dt, or with two solves the span of both [s]
    dt_previous: f32,           // The step before [s]
    remaining: f32,             // Time left to the target [s]
    phase: u32,                 // PHASE_IDLE, PHASE_SOLVE, PHASE_BETWEEN, PHASE_SUBSTEP, PHASE_ELASTIC
    substeps: u32,              // Elastic sub-steps of this step
    substep: u32,               // Next one to run
    stage: u32,                 // Solves of this step that are done
    step: u32,                  // Finished steps
    fault: atomic<u32>,         // Smallest stage << 27 | slot that met an impossible value; NO_FAULT if none
    limited: atomic<u32>,       // Cells where the flux limiter acted, and vertices whose gas could not pay for all that they asked, this step
    limited_before: u32,        // The same when the first advection stage ended
    floored: atomic<u32>,       // Cells where the energy floor acted, this step
    cold: atomic<u32>,          // 1 if the energy floor may have to act deep inside the gas
    raised: atomic<u32>,        // Cells whose pressure had to be raised before one of two solves, this step
    clamped: atomic<u32>,       // Particles held back at a wall, this step
    unsorted: atomic<u32>,      // 1 if a particle may have left its cell since they were sorted
    escaped: atomic<u32>,       // Particles that left through an open side, since the start
    extra: u32,                 // Vertices that carry P, h and Q apart, this step
    iterations: u32,            // Iterations of all solves of the last step
    residual: f32,              // Relative residual of the last solve
    listed: u32,                // Slots that are not INTERIOR
    frontier: u32,              // INTERIOR slots whose nodes listed vertices rest on
    sound: f32,                 // Largest speed of sound at the end of the step [m s^-1]
    time: f32,                  // Simulated time at the start of the step [s]
    time_error: f32,            // What rounding has taken from it so far [s]
    rounds: u32,                // Rounds of Newton's method in the elastic solve, this step
    round_open: u32,            // 1 while the linear system of a round is being solved
    newly_held: atomic<u32>,    // Nodes that a wall has begun to stop in this round
    elastic_iterations: u32,    // Iterations of all rounds, this step
    longest_round: u32,         // Iterations of the longest one
    imbalance: f32,             // r . D^-1 r at the start of this round
    borrowed: array<atomic<u32>, 8>, // Momentum and energy that the energy floor has taken from gas cells that have no books of their own, since the start: each a number of 64 bits, the low half first, in 2^-32 of a unit
}
// End of what is generated.

// True for NaN and infinities; comparisons alone do not find a NaN on every driver.
fn is_broken(x: f32) -> bool { return (bitcast<u32>(x) & 0x7f800000u) == 0x7f800000u; }
