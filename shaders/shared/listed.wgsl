// Two forms of one kernel. The plain form runs over the slots that are awake and acts on those deep inside the gas (INTERIOR), where every
// stencil is the same; the LISTED form runs over the list of all others, as far as they are awake. So no thread waits for a neighbour's
// special case. Needs the binding extra: places of the extra unknowns; one block that the list fills from its start, and the frontier, the
// INTERIOR slots whose nodes listed vertices rest on, from its end; then the lengths of both; then the runs of slots, and of the list.
#include "shared/arrays.wgsl"
#include "shared/runs.wgsl"

override LISTED: bool;

// Slot of a thread, or the number of slots if it has none: of all slots or, LISTED, of all listed ones.
fn every_slot(thread: u32) -> u32 {
    if !LISTED { return min(thread, params.slots); }
    if thread < list_length() { return extra[part(LISTED_SLOTS, thread)]; }
    return params.slots;
}

fn listed_in(run: u32, thread: u32) -> u32 {
    let lane = thread % OCTET;
    if !SLEEPS { return every_slot(OCTET * run + lane); }
    let word = extra[params.list_runs_at + octets() + 1u + run];
    if ((word >> lane) & 1u) == 0u { return params.slots; }
    return extra[part(LISTED_SLOTS, (word >> 8u) * OCTET + lane)];
}

// Slot that a lane of a thread has in a run, of slots deep inside the gas or of the list; the number of slots if it has none.
fn slot_in(run: u32, thread: u32) -> u32 {
    if LISTED { return listed_in(run, thread); }
    let own = run_slot(run, thread);
    return select(params.slots, own.slot, own.deep);
}

// Runs of an octet of threads, for reductions.
fn listed_runs(thread: u32) -> Runs {
    if LISTED { return octet_runs(params.list_runs_at, thread, list_length()); }
    return runs_of(thread);
}

// Threads that have a slot, or find that they have none.
fn awake_threads() -> u32 {
    if SLEEPS { return OCTET * extra[select(params.runs_at, params.list_runs_at, LISTED) + octets()]; }
    if LISTED { return list_length(); }
    return params.slots;
}

// Slot of a thread, for kernels with one slot per thread.
fn listed_slot(thread: u32) -> u32 {
    if !SLEEPS { return every_slot(thread); }
    if thread >= awake_threads() { return params.slots; }
    return slot_in(thread / OCTET, thread);
}

// The same for kernels that have something to do in all listed slots: walls bear the pressure of gas that sleeps, too.
fn busy_slot(thread: u32) -> u32 {
    if LISTED { return every_slot(thread); }
    return listed_slot(thread);
}

// The same for kernels whose results only listed slots read, so that the plain form visits the frontier alone.
fn frontier_slot(thread: u32) -> u32 {
    if LISTED || QUADRATIC { return listed_slot(thread); }
    if thread < frontier_threads() { return extra[part(LENGTHS, 0u) - 1u - thread]; }
    return params.slots;
}

// Threads of such kernels.
fn frontier_threads() -> u32 {
    if LISTED || QUADRATIC { return awake_threads(); }
    return extra[part(LENGTHS, LENGTH_FRONTIER)];
}
