// What the device decides about the run: time step, phase, failure, counts. Mirror of src/state/control.rs (Control).

struct Control {
    dt: f32,                    // [s] what one solve spans
    duration: f32,              // [s] current step: dt, or with ARS the span of both its solves
    dt_previous: f32,           // [s] the step before
    remaining: f32,             // [s] to the time the host asked for
    phase: u32,                 // PHASE_IDLE, PHASE_SOLVE, PHASE_BETWEEN, PHASE_SUBSTEP, PHASE_ELASTIC
    substeps: u32,              // elastic sub-steps of this step
    substep: u32,               // next one to run
    stage: u32,                 // solves of this step that are done
    step: u32,                  // finished steps since the start of the run
    fault: atomic<u32>,         // smallest stage << 27 | slot that met an impossible value; NO_FAULT if none
    limited: atomic<u32>,       // cells where the flux limiter acted, and vertices that asked too much [shared/parting.wgsl], this step
    limited_before: u32,        // the same when the first advection stage ended
    floored: atomic<u32>,       // cells where the energy floor acted, this step
    cold: atomic<u32>,          // 1 if the energy floor may have to act deep inside the gas
    raised: atomic<u32>,        // cells whose pressure was raised before a solve with ARS, this step
    clamped: atomic<u32>,       // particles held back at a wall, this step
    unsorted: atomic<u32>,      // 1 if a particle may have left its cell since they were sorted
    escaped: atomic<u32>,       // particles that left through an open side, since the start
    extra: u32,                 // vertices that carry P, h and Q apart, this step
    iterations: u32,            // of the last solve
    residual: f32,              // of the last solve, relative
    listed: u32,                // slots that are not INTERIOR
    frontier: u32,              // INTERIOR slots whose nodes listed vertices rest on
    runs: u32,                  // runs of slots that are awake [shared/runs.wgsl]
    list_runs: u32,             // and of the list of the others
    sound: f32,                 // [m s^-1] largest speed of sound at the end of the step
    reach: u32,                 // iterations that the solve may take while some sleep
    woken: u32,                 // 1 if the solve of this step, or the host, has woken all
    woken_before: u32,          // the same in the step before
    time: f32,                  // [s] at the start of the step
    time_error: f32,            // [s] what rounding has taken from it so far
    rounds: u32,                // of Newton's method in the elastic solve, this step
    round_open: u32,            // 1 while the linear system of a round is being solved
    newly_held: atomic<u32>,    // nodes that a wall has begun to stop in this round
    elastic_iterations: u32,    // of all rounds, this step
    longest_round: u32,         // iterations of the longest one
    imbalance: f32,             // r . D^-1 r at the start of this round
    borrowed: array<atomic<u32>, 8>,    // what floors took from gas without a place of its own [shared/books.wgsl]: momentum, energy, each
                                        // a number of 64 bits, the low half first, in 2^-32 of the unit: integers, so order does not matter
}

// True for NaN and infinities; comparisons alone do not find a NaN on every driver.
fn is_broken(x: f32) -> bool { return (bitcast<u32>(x) & 0x7f800000u) == 0x7f800000u; }
