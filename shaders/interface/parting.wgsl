// parting, of fluid_update: what pressures at a vertex ask beyond what the cells of its faces can pay where velocities part. At a convex corner
// the pressure of a vertex is many times that of the thin cell behind it. The sum goes to all gas cells around the vertex in proportion to their
// pressures. Reads pressure, cells, gas, nodes. Writes the sum over the sum of these pressures behind the pressures: 0 nearly everywhere.
#include "shared/parting.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read_write> pressure: array<f32>;
@group(0) @binding(5) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(6) var<storage, read> energy: array<f32>;
@group(0) @binding(7) var<storage, read> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> work: array<vec4f>;

// Least pressure of the gas cells around a vertex; below 0 where one of them is cut by an obstacle.
fn least_around(v: vec3i) -> f32 {
    var least = 3.4e38;
    for (var k = 0u; k < corner_count(); k++) {
        let slot = slot_of(v - corner_offset(k));
        if is_listed() && kind_of(cells[slot]) != GAS { continue; }
        if is_listed() && cut_entry(slot) != 0u { return -1.0; }
        least = min(least, own_pressure(slot));
    }
    return least;
}

// What the cell at a corner would pay beyond the caps, and its pressure.
fn asked_of(v: vec3i, corner: vec3i) -> vec2f {
    let c = v - corner;
    if !shares_at(v, c) { return vec2f(0.0); }
    let slot = slot_of(c);
    return vec2f(beyond_caps(v, c, slot), own_pressure(slot));
}

fn surplus(v: vec3i) -> f32 {
    var sum = vec2f(0.0);
    for (var k = 0u; k < corner_count() / 2u; k++) {
        sum += asked_of(v, corner_offset(k)) + asked_of(v, corner_offset(corner_count() - 1u - k));
    }
    return select(0.0, sum.x / sum.y, sum.y > 0.0);
}

fn ask(slot: u32) {
    let v = cell_of(slot);
    if !is_vertex(v) || is_alias(v) { return; }
    let least = least_around(v);
    var asked = 0.0;
    let most = max(pressure[slot], pressure[interface_index(slot)]);
    for (var turn = 0u; turn < when(least >= 0.0 && most > 2.0 * least); turn++) { asked = surplus(v); }
    if asked > most_asked() { atomicAdd(&control.limited[3], 1u); }
    pressure[surplus_index(slot)] = asked;
}

@compute @workgroup_size(WORKGROUP)
fn parting_surplus(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { ask(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { ask(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { ask(listed_slot(k)); }
}
