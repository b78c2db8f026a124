// Slots in runs of up to eight neighbours, which eight lanes take together: those that are awake, see still.wgsl. Their list is in the
// binding extra, from params.runs_at on: for each octet of lanes where its runs begin, and where the last one's end; then two words per
// run: its first slot, and as bits which of the eight are slots deep inside the gas, and from bit 8 on which are slots at all.
// The list of the other slots (shared/listed.wgsl) has runs of its own from params.list_runs_at on, of eight entries: one word per run,
// which of them are awake, and from bit 8 on which eight they are.
// A reduction gives every octet the same slots, in the same order, whoever sleeps: they would add zero, so the sums keep their bits.

fn octets() -> u32 { return RUN_LANES * params.groups; }

fn runs_awake() -> u32 { return extra[params.runs_at + octets()]; }

// First run of the octet that a thread is in, and the one after its last.
fn runs_of(thread: u32) -> vec2u {
    let octet = params.runs_at + thread / RUN_LANES;
    return vec2u(extra[octet], extra[octet + 1u]);
}

// Slot of a lane in a run, and its two bits.
struct RunSlot { slot: u32, deep: bool, any: bool }

fn run_slot(run: u32, thread: u32) -> RunSlot {
    let at = params.runs_at + octets() + 1u + 2u * run;
    let lane = thread % RUN_LANES;
    let bits = extra[at + 1u] >> lane;
    return RunSlot(extra[at] + lane, (bits & 1u) == 1u, (bits & 0x100u) != 0u);
}

fn list_runs_awake() -> u32 { return extra[params.list_runs_at + octets()]; }

fn list_runs_of(thread: u32) -> vec2u {
    let octet = params.list_runs_at + thread / RUN_LANES;
    return vec2u(extra[octet], extra[octet + 1u]);
}

// Listed slot of a lane in a run, or the number of slots if it has none.
fn listed_in(run: u32, thread: u32) -> u32 {
    let word = extra[params.list_runs_at + octets() + 1u + run];
    let lane = thread % RUN_LANES;
    if ((word >> lane) & 1u) == 0u { return params.slots; }
    return extra[params.slots + (word >> 8u) * RUN_LANES + lane];
}
