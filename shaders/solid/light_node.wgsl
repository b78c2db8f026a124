// Solid nodes lighter than the mass floor of the solve take less momentum than they are given. What is left goes to the nodes around
// them, by mass, so that momentum is kept. Needs the bindings node and inertia.
#include "shared/index.wgsl"

// Mass that a node lacks, over that of the nodes around it with its own.
fn share_left(slot: u32) -> f32 {
    let missing = inertia[slot] - node[slot].w;
    var mass = 0.0;
    for (var k = 0u; k < select(0u, block_size(), missing > 0.0); k++) {
        let near = cell_of(slot) + block_offset(k);
        if in_ring(near) { mass += node[slot_of(near)].w; }
    }
    return select(0.0, missing / mass, mass > 0.0);
}

// Velocity that a node with mass gets from the nodes around it, which left it there.
fn gain_around(slot: u32, count: u32) -> vec3f {
    var gain = vec3f(0.0);
    for (var k = 0u; k < count; k++) {
        let near = cell_of(slot) + block_offset(k);
        if in_ring(near) { gain += work[part(LEFT_KICK, slot_of(near))].xyz; }
    }
    return gain;
}
