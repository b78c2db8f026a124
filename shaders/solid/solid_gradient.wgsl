// coupled_solve, the other update of the solid: V = V* - dt grad p / rho from local differences, as the gas has it, instead of the
// forces G Q + H h of the solve. [Cao et al. 2022, eq. 23 and fig. 13]
// The gradient is that of the node's own cell, from the means over its faces; faces between gas and solid carry h. rho is the mass of
// the node over the solid volume that the elements around give it. Nodes at walls keep their forces, which the film belongs to.
// Reads the solved pressure. Writes SOLID_NODE of work, as solve_forces does.
#include "shared/system.wgsl"

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> pressure: array<f32>;
@group(0) @binding(4) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(5) var<storage, read> inertia: array<f32>;

// Mean pressure of a face of cell c across axis n.
fn face_mean(c: vec3i, solid: bool, n: u32, up: bool) -> f32 {
    let other = neighbour_kind(c, n, up);
    let meets = other == select(SOLID, GAS, solid);
    let low = select(c, c + axis(n), up);
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        if corner[n] == 1 { continue; }
        let v = slot_of(low + corner);
        var at = v;
        if solid { at = ghost_index(v); }
        if meets { at = interface_index(v); }
        sum += pressure[at];
    }
    return sum / f32(1u << (DIM - 1u));
}

// Solid volume that a node stands for, in cells.
fn solid_share(c: vec3i) -> f32 {
    var share = 0.0;
    for (var k = 0u; k < block_size(); k++) {
        let offset = block_offset(k);
        if inside(c + offset) && kind_of(cells[slot_of(c + offset)]) == SOLID { share += mass_entry(true, -offset); }
    }
    return share;
}

@compute @workgroup_size(WORKGROUP)
fn solid_gradient(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || !has(cells[slot], NODE_SOLID) || has(cells[slot], NODE_FILM) { return; }
    let c = cell_of(slot);
    let solid = kind_of(cells[slot]) == SOLID;
    var difference = vec3f(0.0);
    for (var n = 0u; n < DIM; n++) { difference[n] = face_mean(c, solid, n, true) - face_mean(c, solid, n, false); }
    let inverse = select(1.0 / inertia[slot], 0.0, DRIVEN && has(cells[slot], NODE_DRIVEN));
    work[part(SOLID_NODE, slot)] = vec4f(difference * face_area() * solid_share(c) * inverse, inverse);
}
