// The device steers its own step: each entry point looks at what has been decided and opens or closes the dispatches that
// follow. A step whose solve or sub-steps need more than was recorded simply goes on in the next recording.
#include "shared/extents.wgsl"
#include "shared/pcg.wgsl"

override FILTER_COURANT: f32;   // cells that sound crosses at least in a step with the filter of odd_even.wgsl

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(3) var<storage, read> extra: array<u32>;

// Before the first step: lets the marks of the start run.
@compute @workgroup_size(1)
fn control_start() {
    open_with_scan(PHASE_BEGIN_EXTENTS, true);
    open_with_scan(PHASE_SORT_EXTENTS, true);
}

// After the lists of slots: their lengths rule the dispatches over them.
@compute @workgroup_size(1)
fn control_listed() {
    control.listed = extra[part(LENGTHS, LENGTH_LISTED)];
    control.frontier = extra[part(LENGTHS, LENGTH_FRONTIER)];
    let listed = groups_for(control.listed);
    let near = groups_for(max(control.listed, control.frontier));
    pcg.near_wide = near.x;
    pcg.near_high = near.y;
    pcg.groups_block = surface_groups().x;
    pcg.block_length = surface_rows();
    let keep = extents[PHASE_BEGIN_EXTENTS + OVER_SINGLE].x;
    extents[PHASE_BEGIN_EXTENTS + OVER_SURFACE] = surface_groups() * keep;
    extents[PHASE_BEGIN_EXTENTS + OVER_LISTED] = listed * keep;
    extents[PHASE_BEGIN_EXTENTS + OVER_FRONTIER] = groups_for(control.frontier) * keep;
    extents[PHASE_BEGIN_EXTENTS + OVER_NEAR] = near * keep;
}

// After an advection stage, on a CPU: did the limiter act? A GPU launches the correction always, which sees for itself.
@compute @workgroup_size(1)
fn control_limiter() {
    let now = atomicLoad(&control.limited[0]) + atomicLoad(&control.limited[1]) + atomicLoad(&control.limited[2]);
    open_slots(PHASE_LIMIT_EXTENTS, now > control.limited_before);
    control.limited_before = now;
}

// After the energies, on a CPU: may the floor have to act deep inside the gas? A GPU launches it always, and it sees for itself.
@compute @workgroup_size(1)
fn control_cold() {
    let updated = extents[PHASE_UPDATE_EXTENTS + OVER_SINGLE].x == 1u;
    extents[PHASE_FLOOR_EXTENTS + OVER_INTERIOR] = groups_for(params.slots) * u32(updated && atomicLoad(&control.cold) == 1u);
}

// After the recorded iterations: has the solve finished? Then the first explicit sub-step follows, or the next one of a step that goes on.
@compute @workgroup_size(1)
fn control_solved() {
    take_solution();
    if SOLIDS && !IMPLICIT { open_substep(); }
}

fn take_solution() {
    let solving = control.phase == PHASE_SOLVE;
    if solving && pcg.outcome == PCG_STALLED { atomicMin(&control.fault, STAGE_COUPLED_SOLVE << 27u); }
    let done = solving && pcg.outcome == PCG_CONVERGED && atomicLoad(&control.fault) == NO_FAULT;
    open_phase(PHASE_UPDATE_EXTENTS, done);
    if !done { return; }
    control.iterations = select(0u, control.iterations, control.stage > 0u) + pcg.iterations;
    control.residual = select(0.0, sqrt(max(pcg.size, 0.0) / pcg.reference), pcg.reference > 0.0);
    control.phase = select(select(PHASE_SUBSTEP, PHASE_ELASTIC, IMPLICIT), PHASE_BETWEEN, ARS && control.stage == 0u);
}

// After the first of two solves and its updates: opens the second advection and solve.
@compute @workgroup_size(1)
fn control_second() {
    let due = control.phase == PHASE_BETWEEN && atomicLoad(&control.fault) == NO_FAULT;
    open_phase(PHASE_SECOND_EXTENTS, due);
    if !due { return; }
    atomicStore(&control.cold, 0u);
    atomicStore(&control.surface_bound, 0u);
    control.stage = 1u;
    control.phase = PHASE_SOLVE;
}

// Before each further recorded sub-step, and after the elastic solve.
@compute @workgroup_size(1)
fn control_substep() { open_substep(); }

// `again`: the particles have moved since the last P2G.
fn open_substep() {
    let go = control.phase == PHASE_SUBSTEP && control.substep < control.substeps && atomicLoad(&control.fault) == NO_FAULT;
    open_phase(PHASE_SUBSTEP_EXTENTS, go);
    let again = go && control.substep > 0u;
    open_phase(PHASE_AGAIN_EXTENTS, again);
    open_sort(again);
    open_phase(PHASE_FIRST_EXTENTS, go && control.substep == 0u);
    if go { control.substep += 1u; }
}

// After the recorded sub-steps: is the step complete?
@compute @workgroup_size(1)
fn control_finish() {
    let done = control.phase == PHASE_SUBSTEP && control.substep == control.substeps && atomicLoad(&control.fault) == NO_FAULT;
    open_phase(PHASE_END_EXTENTS, done);
    open_slots(PHASE_FILTER_EXTENTS, done && control.sound * control.duration >= FILTER_COURANT * params.spacing);
    if !done { return; }
    control.phase = PHASE_IDLE;
    control.step += 1u;
    control.remaining -= control.duration;
    // Compensated: many small steps must not lose their sum. [Kahan 1965]
    let step = control.duration + control.time_error;
    let time = control.time + step;
    control.time_error = step - (time - control.time);
    control.time = time;
}
