// elastic_solve, control: opens and closes the dispatches of Newton's rounds and of the iterations in them.
#include "shared/extents.wgsl"
#include "shared/pcg.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;

// A round that starts with more than this share of the imbalance of the one before (squared) is the last.
const STILL = 0.5;
const ANY = 3e38;

// Before a round: a new one begins unless the iterations of the last one still run.
@compute @workgroup_size(1)
fn control_round() {
    let solving = control.phase == PHASE_ELASTIC && atomicLoad(&control.fault) == NO_FAULT;
    let begins = solving && control.round_open == 0u;
    open_phase(PHASE_ROUND_EXTENTS, begins);
    open_phase(PHASE_FIRST_EXTENTS, begins && control.rounds == 0u);
    if !begins { return; }
    control.round_open = 1u;
    atomicStore(&control.newly_held, 0u);
    if control.rounds == 0u { pcg.most = ANY; }
}

@compute @workgroup_size(1)
fn control_iteration() {
    let runs = control.phase == PHASE_ELASTIC && pcg.outcome == PCG_RUNNING;
    open_phase(PHASE_ITERATION_EXTENTS, runs);
    if runs && pcg.iterations == 0u { control.imbalance = pcg.size; }
}

// After the recorded iterations: takes the solution, or ends the stage.
@compute @workgroup_size(1)
fn control_balanced() {
    let ends = control.phase == PHASE_ELASTIC && control.round_open == 1u && pcg.outcome != PCG_RUNNING;
    // Balance, or rounds no longer help: rounding sets the limit. The force and the imbalance of the nodes are those of their velocities.
    let held = atomicLoad(&control.newly_held) > 0u;
    let last = (pcg.iterations == 0u && !held) || control.rounds + 1u >= MAX_ROUNDS;
    open_phase(PHASE_ROUND_EXTENTS, ends && !last);
    if !ends { return; }
    pcg.most = select(STILL * control.imbalance, ANY, held);
    // The last round of all only looks: a solution that nothing takes would leave its own imbalance.
    if control.rounds + 2u >= MAX_ROUNDS { pcg.most = 0.0; }
    control.round_open = 0u;
    control.rounds += 1u;
    control.elastic_iterations += pcg.iterations;
    control.longest_round = max(control.longest_round, pcg.iterations);
    if last { control.phase = PHASE_SUBSTEP; }
}
