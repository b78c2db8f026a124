// Which slot has a thread? A kernel over slots is compiled once for each kind of slots that it goes over: deep inside the gas (INTERIOR), where
// every stencil is the same, and over the list of the others, without those that periodic sides repeat. So no thread waits for a
// neighbour's special case. Kernels whose results only listed slots read go over the frontier in place of the interior: slots deep inside
// the gas whose nodes listed vertices rest on. Marches pass columns of slots of every kind: their kernels ask for INTERIOR themselves.
// src/stage/sweep.rs binds the forms. Needs the bindings cells and extra.
#include "shared/arrays.wgsl"
#include "shared/blocks.wgsl"
#include "shared/cell.wgsl"

override SWEEP: u32;    // OVER_SLOTS: all; OVER_INTERIOR, OVER_LISTED, OVER_FRONTIER; OVER_MARCHES: columns of params.march slots

// Threads of the sweep; beyond them none has a slot.
fn swept_threads() -> u32 {
    if SWEEP == OVER_LISTED { return extra[part(LENGTHS, LENGTH_LISTED)]; }
    if SWEEP == OVER_FRONTIER { return extra[part(LENGTHS, LENGTH_FRONTIER)]; }
    return params.slots;
}

// Slot of a thread, of a column the first one; params.slots if it has none.
fn swept_slot(thread: u32) -> u32 {
    if SWEEP == OVER_MARCHES {
        let slot = corner_of(thread / STILL_BLOCK) + thread % STILL_BLOCK;
        let column = thread / STILL_BLOCK % blocks_across() * STILL_BLOCK + thread % STILL_BLOCK;
        return select(params.slots, slot, column < columns());
    }
    if thread >= swept_threads() { return params.slots; }
    if SWEEP == OVER_LISTED { return extra[part(LISTED_SLOTS, thread)]; }
    if SWEEP == OVER_FRONTIER { return extra[part(LENGTHS, 0u) - 1u - thread]; }
    if SWEEP == OVER_INTERIOR && !has(cells[thread], INTERIOR) { return params.slots; }
    return thread;
}
