// Two forms of one kernel. The plain form runs over the slots deep inside the gas (INTERIOR) that are awake, where every stencil is
// the same; the LISTED form runs over the list of all that are not INTERIOR. So no thread waits for a neighbour's special case.
// Needs the binding extra: places of the extra unknowns; one block that the list fills from its start, and the frontier, the
// INTERIOR slots whose nodes listed vertices rest on, from its end; then the lengths of both; then the runs of slots.
#include "shared/runs.wgsl"

override LISTED: bool;

// Slot of a thread, or the number of slots if it has none.
fn listed_slot(thread: u32) -> u32 {
    if LISTED {
        if thread < extra[2u * params.slots] { return extra[params.slots + thread]; }
        return params.slots;
    }
    if thread / RUN_LANES >= runs_awake() { return params.slots; }
    let own = run_slot(thread / RUN_LANES, thread);
    return select(params.slots, own.slot, own.deep);
}

// The same for kernels whose results only listed slots read, so that the plain form visits the frontier alone.
fn frontier_slot(thread: u32) -> u32 {
    if LISTED || QUADRATIC { return listed_slot(thread); }
    if thread < extra[2u * params.slots + 1u] { return extra[2u * params.slots - 1u - thread]; }
    return params.slots;
}

// Threads that have a slot, or find that they have none.
fn listed_count() -> u32 {
    if LISTED { return extra[2u * params.slots]; }
    return RUN_LANES * runs_awake();
}
