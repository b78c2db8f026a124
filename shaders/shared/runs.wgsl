// Slots in runs of up to eight neighbours, which eight lanes take together. In scenes where gas may sleep (SLEEPS, see still.wgsl) they
// are those that are awake, and the binding extra holds their list from params.runs_at on: for each octet of lanes where its runs begin,
// and where the last one's end; then two words per run: its first slot, and as bits which of the eight are slots deep inside the gas,
// and from bit 8 on which are slots at all. The list of the other slots (shared/listed.wgsl) has runs of its own from
// params.list_runs_at on, of eight entries: one word per run, which of them are awake, and from bit 8 on which eight they are.
// Elsewhere all slots have their runs in order.
// A reduction gives every octet the same slots, in the same order, whoever sleeps: they would add zero, so the sums keep their bits.
#include "shared/arrays.wgsl"

// Entries of the list, awake or not.
fn list_length() -> u32 { return extra[part(LENGTHS, LENGTH_LISTED)]; }

// Runs that so many slots take.
fn runs_over(slots: u32) -> u32 { return (slots + OCTET - 1u) / OCTET; }

fn octets() -> u32 { return OCTET * params.groups; }

// Runs of an octet of threads: the first one, one beyond the last, and the step from one to the next.
struct Runs { first: u32, end: u32, step: u32 }

fn octet_runs(table: u32, thread: u32, all: u32) -> Runs {
    let octet = thread / OCTET;
    if !SLEEPS { return Runs(octet, runs_over(all), octets()); }
    return Runs(extra[table + octet], extra[table + octet + 1u], 1u);
}

fn runs_of(thread: u32) -> Runs { return octet_runs(params.runs_at, thread, params.slots); }

// Slot of a lane in a run, and its two bits; of all slots the caller knows whether they are deep inside the gas.
struct RunSlot { slot: u32, deep: bool, any: bool }

fn run_slot(run: u32, thread: u32) -> RunSlot {
    let lane = thread % OCTET;
    if !SLEEPS {
        let slot = OCTET * run + lane;
        return RunSlot(slot, slot < params.slots, slot < params.slots);
    }
    let at = params.runs_at + octets() + 1u + 2u * run;
    let bits = extra[at + 1u] >> lane;
    return RunSlot(extra[at] + lane, (bits & 1u) == 1u, (bits & 0x100u) != 0u);
}
