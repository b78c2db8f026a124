// Two forms of one kernel. The plain form runs over all slots and acts on those deep inside the gas (INTERIOR), where every stencil is the
// same; the LISTED form runs over the list of all others. So no thread waits for a neighbour's special case. Needs the binding extra: places
// of the extra unknowns; one block that the list fills from its start, and the frontier, the INTERIOR slots whose nodes listed vertices rest
// on, from its end; then the lengths of both.
#include "shared/arrays.wgsl"

override LISTED: bool;

// Threads that have a slot, or find that they have none.
fn listed_threads() -> u32 {
    if LISTED { return extra[part(LENGTHS, LENGTH_LISTED)]; }
    return params.slots;
}

// Slot of a thread, or the number of slots if it has none.
fn listed_slot(thread: u32) -> u32 {
    if !LISTED { return min(thread, params.slots); }
    if thread < listed_threads() { return extra[part(LISTED_SLOTS, thread)]; }
    return params.slots;
}

// The same for kernels whose results only listed slots read, so that the plain form visits the frontier alone.
fn frontier_slot(thread: u32) -> u32 {
    if LISTED || QUADRATIC { return listed_slot(thread); }
    if thread < frontier_threads() { return extra[part(LENGTHS, 0u) - 1u - thread]; }
    return params.slots;
}

// Threads of such kernels.
fn frontier_threads() -> u32 {
    if LISTED || QUADRATIC { return listed_threads(); }
    return extra[part(LENGTHS, LENGTH_FRONTIER)];
}
