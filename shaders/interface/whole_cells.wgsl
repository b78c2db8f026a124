// interface, before it where bodies and obstacles are: which cut cells does a body come near?
// Bodies see whole cells. A cut cell that a particle comes near becomes whole for good, with all that share its state: WALL if the obstacle
// holds its centre, else GAS, which then holds more or less gas than before, and owes it. All of that is seen in the word of the slot:
// a cut cell is GAS with a blocked share of 1, so a stored state says which are left. Reads sorted particles. Writes words, gas, what it owes.
#include "shared/domain.wgsl"
#include "shared/gas_at.wgsl"
#include "interface/owed_species.wgsl"

@group(0) @binding(1) var<storage, read_write> cells: array<u32>;
@group(0) @binding(2) var<storage, read_write> extra: array<u32>;
@group(0) @binding(3) var<storage, read> cell_start: array<u32>;
@group(0) @binding(4) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> energy: array<f32>;
@group(0) @binding(6) var<storage, read_write> owed_flow: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> owed_energy: array<f32>;

// Cells between a cut cell and a particle at least: vertices and nodes beside a body see two cells, and in a step it moves by less than one.
const ROOM = 4;

// Whether a particle lies in the rows of cells around one.
fn body_near(c: vec3i) -> bool {
    let last = vec3i(params.cells) - 1;
    let first_x = max(c.x - ROOM, 0);
    let last_x = min(c.x + ROOM, last.x);
    for (var z = max(c.z - ROOM * reach().z, 0); z <= min(c.z + ROOM * reach().z, last.z); z++) {
        for (var y = max(c.y - ROOM * reach().y, 0); y <= min(c.y + ROOM * reach().y, last.y); y++) {
            if cell_start[slot_of(vec3i(last_x, y, z)) + 1u] > cell_start[slot_of(vec3i(first_x, y, z))] { return true; }
        }
    }
    return false;
}

// Makes one of `count` GAS cells of a cluster whole: each has its share of the gas.
fn make_gas(slot: u32, share: f32, count: f32) {
    let room = (share / count - 1.0) * cell_volume();
    owed_flow[slot] += room * conserved[slot];
    owed_energy[slot] += room * energy[slot];
    owe_species(slot, owed_species(slot) + room * summed_species(gas_at(slot)));
    cells[slot] &= 0xffffu;
}

fn make_wall(slot: u32) {
    conserved[slot] = vec4f(0.0);
    energy[slot] = 0.0;
    hold_species(slot, vec2f(0.0));
    owed_flow[slot] = vec4f(0.0);
    owed_energy[slot] = 0.0;
    owe_species(slot, vec2f(0.0));
    cells[slot] = (cells[slot] & 0xfff0u) | WALL | (WALL << 2u);
}

// What the cells of a cluster owe that become WALL goes to the last one that does not.
fn hand_over(first: u32) {
    var taker = first;
    var flow = vec4f(0.0);
    var heat = 0.0;
    var species = vec2f(0.0);
    for (var at = first; at != NO_EXTRA; at = cluster_next(at)) {
        if cut_word(cut_entry(at), CUT_WHOLE) == 1u { taker = at; continue; }
        flow += owed_flow[at];
        heat += owed_energy[at];
        species += owed_species(at);
    }
    owed_flow[taker] += flow;
    owed_energy[taker] += heat;
    owe_species(taker, owed_species(taker) + species);
}

// One thread per cluster: that of its first cell.
@compute @workgroup_size(WORKGROUP)
fn interface_whole(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let entry = thread_index(group, lane) + 1u;
    if entry > extra[cut_place(0u) - 1u] || cut_word(entry, CUT_FIRST) != cut_word(entry, CUT_SLOT) { return; }
    let slot = cut_word(entry, CUT_SLOT);
    if cut_entry(slot) == 0u { return; }
    let was = is_cut_word(cells[slot]);
    let share = cluster_share(slot);
    var near = false;
    var count = 0.0;
    for (var at = slot; at != NO_EXTRA; at = cluster_next(at)) {
        near = near || body_near(cell_of(at));
        count += f32(cut_word(cut_entry(at), CUT_WHOLE));
    }
    if was && !near { return; }
    if was { hand_over(slot); }
    var at = slot;
    for (var more = true; more; more = at != NO_EXTRA) {
        let next = cluster_next(at);
        if was && cut_word(cut_entry(at), CUT_WHOLE) == 1u { make_gas(at, share, count); }
        else if was { make_wall(at); }
        extra[cut_place(at)] &= CUT_NEAR;
        at = next;
    }
}
