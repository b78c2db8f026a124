// The advection has carried gas through the faces of bodies with their velocity of before the solve. Half of what a body gains in the solve
// carries gas, too, so that gas follows it with the mean velocity of the step: between the cell and the slot of the body, which owes it.
// Needs the bindings control, cells, node, and work.
#include "shared/domain.wgsl"

// Share of a cell that passes one face at most.
const MOST_LATE = 0.1;

// Share of GAS cell c that leaves it through a face to a body.
fn late_share(c: vec3i, n: u32, up: bool) -> f32 {
    let a = slot_of(c);
    let b = slot_of(select(c - axis(n), c + axis(n), up));
    let mass = vec2f(node[a].w, node[b].w);
    let gain = -control.dt * dot(mass, vec2f(work[part(SOLID_NODE, a)][n], work[part(SOLID_NODE, b)][n])) / max(mass.x + mass.y, 1e-30);
    let share = select(-0.5, 0.5, up) * gain * blocked_of(cells[b]) * control.dt / params.spacing;
    return clamp(share, -MOST_LATE, MOST_LATE);
}

// Share that leaves it through all of them.
fn late_share_of(c: vec3i) -> f32 {
    var share = 0.0;
    for (var face = 0u; face < 2u * DIM; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;
        let other = select(c - axis(n), c + axis(n), up);
        if inside(other) && kind_of(cells[slot_of(other)]) == SOLID { share += late_share(c, n, up); }
    }
    return share;
}
