// odd_even: the mode of alternating cells, which pressures at vertices do not see and the solve leaves alone. Around every vertex
// whose cells are all GAS the alternating mean of the state is found, and a share of it is taken from each cell with its sign:
// what one cell loses its neighbours gain. Reads gas, cells. Writes gas, by way of work.
#include "shared/index.wgsl"
#include "shared/cell.wgsl"
#include "shared/gas.wgsl"
#include "shared/cut.wgsl"
#include "shared/whole.wgsl"

override FILTER: f32;   // share of the mode that one step removes

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> energy: array<f32>;
@group(0) @binding(5) var<storage, read> extra: array<u32>;

fn sign_of(corner: vec3i) -> f32 { return f32(1 - 2 * ((corner.x + corner.y + corner.z) & 1)); }

// What the filter takes from a cell beside a vertex, up to the sign: positive for the one below it on all axes or an even number of
// cells away.
fn taken_at(v: vec3i) -> Gas {
    var sum = Gas(vec4f(0.0), 0.0);
    var densest = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - reach() + corner_offset(k);
        if !inside(c) || kind_of(cells[slot_of(c)]) != GAS || cut_entry(slot_of(c)) != 0u { return Gas(vec4f(0.0), 0.0); }
        let sign = sign_of(corner_offset(k));
        sum.flow += sign * conserved[slot_of(c)];
        densest = max(densest, conserved[slot_of(c)].x);
        sum.energy += sign * energy[slot_of(c)];
    }
    let share = FILTER / f32(corner_count() * corner_count());
    let flow = share * sum.flow;
    return Gas(vec4f(whole(flow.x, LAST_PLACE * power_of_two(densest)), flow.yzw), share * sum.energy);
}

@compute @workgroup_size(WORKGROUP)
fn odd_even_find(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots { return; }
    var change = Gas(vec4f(0.0), 0.0);
    if kind_of(cells[slot]) == GAS {
        let c = cell_of(slot);
        for (var k = 0u; k < corner_count(); k++) {
            let corner = corner_offset(k);
            let taken = taken_at(c + corner);
            let sign = sign_of(reach() - corner);
            change.flow -= sign * taken.flow;
            change.energy -= sign * taken.energy;
        }
    }
    work[slot] = change.flow;
    energy[params.slots + slot] = change.energy;
}

@compute @workgroup_size(WORKGROUP)
fn odd_even_remove(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                   @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots { return; }
    conserved[slot] += work[slot];
    energy[slot] += energy[params.slots + slot];
}
